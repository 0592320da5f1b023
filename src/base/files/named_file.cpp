#include "hires/base/files/named_file.h"

#include <algorithm>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<std::string> NamesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string FileNamed(const std::string& kind, const std::string& name, const std::string& folder,
                      const std::vector<std::string>& others) {
  std::vector<std::string> known = NamesIn(folder);
  if (std::find(known.begin(), known.end(), name) != known.end()) {
    return folder + "/" + name + ".yaml";
  }
  known.insert(known.end(), others.begin(), others.end());
  throw ConfigError(folder + ": " + UnknownName(kind, name, known) + "; or give a path");
}

std::string NamedFile(const std::string& kind, const std::string& name, const std::string& folder,
                      const std::vector<std::string>& others) {
  const fs::path path(name);
  std::error_code error;
  const bool is_path =
      path.has_parent_path() || path.has_extension() || fs::is_regular_file(path, error);
  return is_path ? name : FileNamed(kind, name, folder, others);
}

}  // namespace hires::base
