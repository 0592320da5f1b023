#include "base/files/nearest_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <vector>

#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFiles = 5000;
constexpr int kMostDepth = 6;
constexpr std::size_t kLeastLetters = 2;  // that may differ, however short the path is

/// Regular files below a folder, relative to it, in order.
std::vector<std::string> FilesBelow(const fs::path& folder, int most_depth) {
  std::vector<std::string> files;
  std::error_code error;
  int num_entries = 0;
  for (fs::recursive_directory_iterator
           entry(folder, fs::directory_options::skip_permission_denied, error),
       end;
       !error && entry != end && num_entries < kMostFiles; entry.increment(error)) {
    ++num_entries;
    std::error_code ignored;
    const bool is_hidden = entry->path().filename().string().rfind('.', 0) == 0;
    if (entry->is_directory(ignored) && (is_hidden || entry.depth() + 1 >= most_depth))
      entry.disable_recursion_pending();
    if (!is_hidden && entry->is_regular_file(ignored))
      files.push_back(entry->path().lexically_relative(folder).generic_string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string EndingOf(const std::string& file) {
  return ToLower(fs::path(file).extension().string());
}

/// A world, model or robot is no remedy for a mesh, which it may be the one to name.
bool IsOtherKind(const std::string& file, const std::string& wanted) {
  const auto describes = [](const std::string& ending) {
    return ending == ".sdf" || ending == ".urdf" || ending == ".world" || ending == ".xacro";
  };
  const std::string its = EndingOf(file), of_wanted = EndingOf(wanted);
  return describes(its) && !describes(of_wanted) && EditDistance(its, of_wanted) > 1;
}

std::string NearestOf(const std::vector<std::string>& files, const std::string& wanted) {
  const std::string lower = ToLower(wanted.substr(0, kMostCompared));
  const std::string name = ToLower(fs::path(wanted).filename().string());
  const std::size_t most = std::max(kLeastLetters, name.size() / 3);
  // Of the same name first, then by letters that differ, then by the alphabet.
  std::tuple<bool, std::size_t, std::string> best{true, most + 1, ""};
  for (const std::string& file : files) {
    if (IsOtherKind(file, wanted)) continue;
    const bool differs = ToLower(fs::path(file).filename().string()) != name;
    const std::size_t distance = EditDistance(lower, ToLower(file.substr(0, kMostCompared)));
    if (differs && distance > most) continue;
    const auto rank = std::make_tuple(differs, distance, file);
    if (std::get<std::string>(best).empty() || rank < best) best = rank;
  }
  return std::get<std::string>(best);
}

}  // namespace

std::string NearestFile(const std::string& folder, const std::string& wanted) {
  return NearestOf(FilesBelow(folder, kMostDepth), wanted);
}

std::string DidYouMeanFile(const std::string& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  fs::path folder = whole.parent_path();
  int num_missing = 0;
  std::error_code error;
  while (!fs::is_directory(folder, error) && folder != folder.parent_path()) {
    folder = folder.parent_path();
    ++num_missing;
  }
  // Only as deep as the path itself would go: a folder of one's own may hold a whole disk.
  const std::string nearest = NearestOf(FilesBelow(folder, num_missing + 2),
                                        whole.lexically_relative(folder).generic_string());
  if (nearest.empty()) return "";
  return fmt::format(" (did you mean '{}'?)", (folder / nearest).string());
}

}  // namespace hires::base
