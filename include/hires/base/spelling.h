#pragma once

#include <cstddef>
#include <string>

namespace hires::base {

/// Levenshtein's distance: letters to replace, insert or delete.
std::size_t EditDistance(const std::string& a, const std::string& b);

/// Whether one may be a slip of the pen for the other: they differ, case apart, by one letter in
/// names of three or more, or by two in names of eight or more.
bool AreSpeltAlike(const std::string& a, const std::string& b);

}  // namespace hires::base
