#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hires::base {

/// Messages repeat what came, however long that was: at most so many bytes of it and " ...", never
/// cut within a UTF-8 character.
std::string Shortened(const std::string& text, std::size_t at_most = 2000);

constexpr std::size_t kMostListed = 50;  ///< lines of a message; more nobody reads

/// The first kMostListed lines; a line more says how many the others are.
std::vector<std::string> FirstLines(std::vector<std::string> lines);

/// "a, b and 3 more": the first names, and how many the others are.
std::string FirstNames(const std::vector<std::string>& names, std::size_t at_most);

/// "hall.yaml: 3 things are wrong:", and a line for each, as FirstLines has them. One alone:
/// itself, as it names its place.  @pre not empty
std::string AllThatIsWrong(const std::string& where, const std::vector<std::string>& problems);

}  // namespace hires::base
