#include "base/files/package_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/files/nearest_file.h"
#include "base/trimmed.h"
#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

namespace fs = std::filesystem;

constexpr char kScheme[] = "package://";
constexpr int kMaxDepth = 5;                 // of packages below a folder of ROS_PACKAGE_PATH
constexpr int kMaxFolders = 100000;          // looked at in one search
constexpr std::size_t kMaxBytes = 1u << 20;  // of a package.xml

bool IsThere(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// The text of the first <name> outside of comments, blanks cut off; "" where there is none.
std::string NameIn(const std::string& xml) {
  std::string bare;
  for (std::size_t at = 0; at < xml.size();) {
    const std::size_t comment = std::min(xml.find("<!--", at), xml.size());
    bare += xml.substr(at, comment - at);
    const std::size_t end = xml.find("-->", comment);
    at = end == std::string::npos ? xml.size() : end + 3;
  }
  std::size_t begin = bare.find("<name>");
  if (begin == std::string::npos) return "";
  begin += 6;
  return Trimmed(bare.substr(begin, bare.find('<', begin) - begin));
}

fs::path Normal(const std::string& folder) {
  const fs::path path = fs::absolute(folder.empty() ? "." : folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// The folder itself and those above it, but for the root.
std::vector<fs::path> FoldersAbove(const std::string& folder) {
  std::vector<fs::path> above;
  for (fs::path at = Normal(folder); at != at.parent_path(); at = at.parent_path())
    above.push_back(at);
  return above;
}

/// What a folder counts as where no variable says anything: one without a package.xml may be a copy
/// of a package's folder.
std::string NameOrFolder(const fs::path& folder) {
  const std::string name = PackageNameIn(folder);
  return name.empty() ? folder.filename().string() : name;
}

bool IsLeftOut(const fs::path& folder) {
  return folder.filename().string().rfind('.', 0) == 0 || IsThere(folder / "CATKIN_IGNORE") ||
         IsThere(folder / "rospack_nosubdirs");
}

/// Packages in and below a folder, without looking into packages; links to folders are followed, as
/// people link packages into their workspaces.
void Collect(const fs::path& folder, int depth, int* num_folders,
             std::vector<std::pair<std::string, std::string>>* found) {
  const std::string name = PackageNameIn(folder);
  if (!name.empty()) found->emplace_back(name, Normal(folder.string()).string());
  if (!name.empty() || depth > kMaxDepth || (depth > 0 && IsLeftOut(folder))) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored) || ++*num_folders > kMaxFolders) continue;
    Collect(entry->path(), depth + 1, num_folders, found);
  }
}

void AddOnce(const std::string& folder, std::vector<std::string>* folders) {
  if (std::find(folders->begin(), folders->end(), folder) == folders->end())
    folders->push_back(folder);
}

}  // namespace

std::string PackageNameIn(const fs::path& folder) {
  if (IsThere(folder / "package.xml")) {
    std::ifstream stream(folder / "package.xml", std::ios::binary);
    std::string text(kMaxBytes, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    const std::string name = NameIn(text);
    return name.empty() ? folder.filename().string() : name;
  }
  return IsThere(folder / "manifest.xml") ? folder.filename().string() : "";
}

PackageFinder::PackageFinder() {
  const char* value = std::getenv("ROS_PACKAGE_PATH");
  variable_ = value == nullptr ? "" : value;
  for (const std::string& part : Split(variable_, ':')) {
    if (!part.empty()) tops_.push_back(part);
  }
}

const PackageFinder::Packages& PackageFinder::PackagesBelow(const fs::path& top) const {
  const auto [known, is_new] = packages_.emplace(top.string(), Packages{});
  if (is_new) {
    int num_folders = 0;
    Collect(top, 0, &num_folders, &known->second);
    std::sort(known->second.begin(), known->second.end(),
              [](const auto& a, const auto& b) { return a.second < b.second; });
  }
  return known->second;
}

std::vector<std::string> PackageFinder::FoldersOf(const std::string& package,
                                                  const std::vector<std::string>& near) const {
  std::vector<std::string> folders;
  const auto add_below = [&](const fs::path& top) {
    for (const auto& [name, folder] : PackagesBelow(top)) {
      if (name == package) AddOnce(folder, &folders);
    }
  };
  for (const std::string& top : tops_) add_below(top);
  for (const std::string& folder : near) {
    for (const fs::path& above : FoldersAbove(folder)) {
      if (NameOrFolder(above) == package) AddOnce(above.string(), &folders);
    }
  }
  if (!folders.empty()) return folders;
  for (const std::string& folder : near) {
    for (const fs::path& above : FoldersAbove(folder)) {
      if (!PackageNameIn(above).empty()) add_below(above.parent_path());
    }
  }
  return folders;
}

std::vector<std::string> PackageFinder::NamesNear(const std::vector<std::string>& near) const {
  std::vector<std::string> names;
  for (const std::string& top : tops_) {
    for (const auto& [name, folder] : PackagesBelow(top)) AddOnce(name, &names);
  }
  for (const std::string& folder : near) {
    for (const fs::path& above : FoldersAbove(folder)) {
      const std::string name = PackageNameIn(above);
      if (!name.empty()) AddOnce(name, &names);
    }
  }
  return names;
}

void PackageFinder::FailNoPackage(const std::string& uri, const std::string& package,
                                  const std::vector<std::string>& near) const {
  const std::vector<std::string> alike = LikelyNames(package, NamesNear(near));
  throw ConfigError(fmt::format(
      "'{}' is not there: no package of that name found{}; add the folder of package '{}' to "
      "ROS_PACKAGE_PATH (now '{}')",
      uri, alike.empty() ? "" : fmt::format(" (did you mean package '{}'?)", Join(alike, "' or '")),
      package, variable_));
}

std::string PackageFinder::Find(const std::string& uri,
                                const std::vector<std::string>& near) const {
  const std::string rest = uri.substr(sizeof(kScheme) - 1);
  const std::size_t slash = rest.find('/');
  // Several slashes are one, as in any path.
  const std::size_t begin = slash == std::string::npos ? slash : rest.find_first_not_of('/', slash);
  const fs::path inside =
      begin == std::string::npos ? fs::path() : fs::path(rest.substr(begin)).lexically_normal();
  if (slash == 0 || inside.empty() || *inside.begin() == "..") {
    throw ConfigError(
        fmt::format("'{}' names no file inside a package; wanted package://<package>/<path>", uri));
  }
  const std::string package = rest.substr(0, slash);
  const std::vector<std::string> folders = FoldersOf(package, near);
  if (folders.empty()) FailNoPackage(uri, package, near);
  for (const std::string& folder : folders) {
    if (IsThere(fs::path(folder) / inside)) return (fs::path(folder) / inside).string();
  }
  const std::string nearest = NearestFile(folders.front(), inside.generic_string());
  throw ConfigError(fmt::format(
      "'{}' is not there: package '{}' is {}, which has no '{}'; {}", uri, package,
      "'" + Join(folders, "', '") + "'", inside.generic_string(),
      nearest.empty() ? "correct the path, or put the file there"
                      : fmt::format("did you mean '{}{}/{}'?", kScheme, package, nearest)));
}

}  // namespace hires::base
