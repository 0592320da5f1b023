#include "hires/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/spelling.h"

namespace hires::base {
namespace {

/// Whether one may have been mistyped for the other: at most half of it differs, or one holds the
/// other.
bool IsAlike(const std::string& a, const std::string& b) {
  if (EditDistance(a, b) <= std::max(a.size(), b.size()) / 2) return true;
  return a.find(b) != std::string::npos || b.find(a) != std::string::npos;
}

}  // namespace

std::string ToLower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::vector<std::string> Split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(separator); end != std::string_view::npos;
       end = text.find(separator, begin)) {
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.emplace_back(text.substr(begin));
  return parts;
}

std::string Join(const std::vector<std::string>& parts, std::string_view separator) {
  return fmt::format("{}", fmt::join(parts, separator));
}

std::vector<std::string> NearestNames(const std::string& name,
                                      const std::vector<std::string>& known, std::size_t at_most) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  ranked.reserve(known.size());
  const std::string lower = ToLower(name);
  for (const std::string& candidate : known) {
    ranked.emplace_back(EditDistance(lower, ToLower(candidate)), candidate);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < std::min(at_most, ranked.size()); ++i) {
    nearest.push_back(ranked[i].second);
  }
  return nearest;
}

std::string UnknownName(std::string_view kind, const std::string& name,
                        const std::vector<std::string>& known) {
  if (known.empty()) return fmt::format("{} '{}' is unknown; none is defined", kind, name);
  std::vector<std::string> alike;
  for (const std::string& candidate : NearestNames(name, known)) {
    if (IsAlike(ToLower(name), ToLower(candidate))) alike.push_back(candidate);
  }
  const bool is_guess = !alike.empty() || known.size() == 1;
  if (is_guess) {
    return fmt::format("{} '{}' is unknown; did you mean '{}'?", kind, name,
                       Join(alike.empty() ? known : alike, "' or '"));
  }
  constexpr std::size_t kMost = 12;
  if (known.size() <= kMost) {
    return fmt::format("{} '{}' is unknown; did you mean one of '{}'?", kind, name,
                       Join(known, "', '"));
  }
  // Of many the first ones of the alphabet would tell nothing.
  return fmt::format("{} '{}' is unknown; did you mean one of '{}', ...?", kind, name,
                     Join(NearestNames(name, known, kMost), "', '"));
}

std::string ReadTextFile(const std::string& path, std::size_t max_bytes) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw ConfigError(fmt::format("{}: no such file; check the path", path));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw ConfigError(fmt::format("{}: is no regular file; name a file", path));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > max_bytes) {
    throw ConfigError(fmt::format("{}: has {} bytes, at most {} are read; split the file", path,
                                  size, max_bytes));
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw ConfigError(fmt::format("{}: cannot be read; check its permissions", path));
  return text.str();
}

void ReplaceTextFile(const std::string& path, const std::string& text) {
  const std::string unfinished = path + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(unfinished, path, error);
  if (file && !error) return;
  std::filesystem::remove(unfinished, error);
  throw ConfigError(fmt::format("{}: cannot be written; check folder, rights and space", path));
}

}  // namespace hires::base
