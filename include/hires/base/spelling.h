#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hires::base {

/// Letters of a name that are compared with known ones: who asks decides how long a name is, and
/// all else would wait.
constexpr std::size_t kMostCompared = 200;

/// Levenshtein's distance: letters to replace, insert or delete.
std::size_t EditDistance(const std::string& a, const std::string& b);

/// Whether one may be a slip of the pen for the other: they differ, case apart, by one letter in
/// names of three or more, or by two in names of eight or more.
bool AreSpeltAlike(const std::string& a, const std::string& b);

/// Those of the `known` names that a name which is none of them may have meant, the best three at
/// most: slips of the pen (a third of the letters, or two swapped), else names of which it is a
/// part or short for. Empty where nothing comes near enough for a guess.
std::vector<std::string> LikelyNames(const std::string& name,
                                     const std::vector<std::string>& known);

/// "1 run", "20 runs".
std::string Counted(std::size_t count, std::string_view noun);

}  // namespace hires::base
