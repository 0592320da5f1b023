#include "hires/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include "hires/base/error.h"
#include "hires/base/spelling.h"

namespace hires::base {
namespace {

constexpr char kUnfinished[] = ".unfinished";  // behind the name of a file that is being written

[[noreturn]] void FailToWrite(const std::string& path) {
  throw ConfigError(fmt::format("{}: cannot be written; check folder, rights and space", path));
}

/// Something that is written to, and neither replaced nor made: /dev/stdout, a pipe.
bool IsDevice(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error);
}

/// Of a link, where it leads to.
std::string TargetOf(const std::string& path) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  return error ? path : target.string();
}

/// How many letters the two have in common at their beginnings and at their ends.
std::size_t CommonEnds(const std::string& a, const std::string& b) {
  const std::size_t shorter = std::min(a.size(), b.size());
  std::size_t begin = 0, end = 0;
  while (begin < shorter && a[begin] == b[begin]) ++begin;
  while (begin + end < shorter && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  return begin + end;
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

std::vector<std::string> SplitWords(std::string_view text) {
  std::vector<std::string> words;
  bool is_inside = false;  // of a word
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (std::isspace(static_cast<unsigned char>(text[at])) != 0) {
      is_inside = false;
      continue;
    }
    if (!is_inside) words.emplace_back();
    is_inside = true;
    const std::size_t close = text[at] == '"' ? text.find('"', at + 1) : std::string_view::npos;
    if (close == std::string_view::npos) {
      words.back() += text[at];
    } else {
      words.back() += text.substr(at + 1, close - at - 1);
      at = close;
    }
  }
  return words;
}

std::string Join(const std::vector<std::string>& parts, std::string_view separator) {
  return fmt::format("{}", fmt::join(parts, separator));
}

std::vector<std::string> NearestNames(const std::string& name,
                                      const std::vector<std::string>& known, std::size_t at_most) {
  const std::string lower = ToLower(name.substr(0, kMostCompared));
  // Of two as near, the one that begins and ends alike: peppermil1 is peppermill1.
  std::set<std::tuple<std::size_t, std::ptrdiff_t, std::string>> ranked;
  for (const std::string& candidate : known) {
    const std::string other = ToLower(candidate);
    ranked.emplace(EditDistance(lower, other),
                   -static_cast<std::ptrdiff_t>(CommonEnds(lower, other)), candidate);
  }
  std::vector<std::string> nearest;
  for (const auto& entry : ranked) {
    if (nearest.size() == at_most) break;
    nearest.push_back(std::get<std::string>(entry));
  }
  return nearest;
}

std::string UnknownName(std::string_view kind, const std::string& name,
                        const std::vector<std::string>& known, std::string_view lister) {
  if (known.empty()) return fmt::format("{} '{}' is unknown; none is defined", kind, name);
  const std::vector<std::string> guesses = known.size() == 1 ? known : LikelyNames(name, known);
  if (!guesses.empty()) {
    return fmt::format("{} '{}' is unknown; did you mean '{}'?", kind, name,
                       Join(guesses, "' or '"));
  }
  constexpr std::size_t kMostListed = 12;
  if (known.size() <= kMostListed) {
    return fmt::format("{} '{}' is unknown; did you mean one of '{}'?", kind, name,
                       Join(known, "', '"));
  }
  if (!lister.empty()) {
    return fmt::format("{} '{}' is unknown; `{}` lists what there is", kind, name, lister);
  }
  // Of many the first ones of the alphabet would tell nothing.
  return fmt::format("{} '{}' is unknown; did you mean one of '{}', ...?", kind, name,
                     Join(NearestNames(name, known), "', '"));
}

void RefuseUtf16(std::string_view text, const std::string& path) {
  const std::string_view mark = text.substr(0, 2);
  const auto is_zero = [&](std::size_t i) { return text[i] == '\0'; };
  const bool is_marked = mark == "\xFF\xFE" || mark == "\xFE\xFF";
  const bool has_zeros = text.size() > 3 && is_zero(0) != is_zero(1) && is_zero(2) != is_zero(3) &&
                         is_zero(0) == is_zero(2);
  if (!is_marked && !has_zeros) return;
  throw ConfigError(fmt::format(
      "{}: is text in UTF-16, wanted UTF-8; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)", path));
}

std::string ReadTextFile(const std::string& path, std::size_t max_bytes) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    const bool is_whole = std::filesystem::path(path).is_absolute();
    throw ConfigError(  // nodes of a launch run in ROS_HOME, not where roslaunch was called
        is_whole
            ? fmt::format("{}: no such file; check the path", path)
            : fmt::format("{}: no such file in {}, where this program runs; check the path, or "
                          "give a whole one",
                          path, std::filesystem::current_path(error).string()));
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
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of editors that write UTF-8 so
  std::string read = text.str();
  if (read.rfind(kByteOrderMark, 0) == 0) read.erase(0, kByteOrderMark.size());
  return read;
}

void ReplaceTextFile(const std::string& path, const std::string& text) {
  const bool is_device = IsDevice(path);
  const std::string target = is_device ? path : TargetOf(path);
  const std::string opened = is_device ? path : target + kUnfinished;
  std::ofstream file(opened, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  std::error_code error;
  if (file && !is_device) std::filesystem::rename(opened, target, error);
  if (file && !error) return;
  if (!is_device) std::filesystem::remove(opened, error);
  FailToWrite(path);
}

void RequireReplaceable(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ConfigError(fmt::format("{}: cannot be written: it is a folder; name a file", path));
  }
  if (IsDevice(path)) return;  // only opening it would tell, and would be noticed
  const std::string unfinished = TargetOf(path) + kUnfinished;
  const bool is_made = std::ofstream(unfinished, std::ios::app).is_open();
  std::filesystem::remove(unfinished, error);
  if (!is_made) FailToWrite(path);
}

}  // namespace hires::base
