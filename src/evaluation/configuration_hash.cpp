#include "hires/evaluation/configuration_hash.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"

namespace hires::evaluation {
namespace {

namespace fs = std::filesystem;

bool IsRead(const fs::path& name) {
  const std::string text = name.string();
  if (text.rfind("config/experiments/", 0) == 0 || text.rfind("config/reproduce", 0) == 0) {
    return false;
  }
  return name.extension() != ".rviz" && name.extension() != ".launch";
}

/// Below the package's folder, sorted.
std::vector<fs::path> FilesRead(const fs::path& package) {
  std::vector<fs::path> names;
  for (const char* folder : {"config", "worlds", "urdf"}) {
    for (const auto& entry : fs::recursive_directory_iterator(package / folder)) {
      const fs::path name = entry.path().lexically_relative(package);
      if (entry.is_regular_file() && IsRead(name)) names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// As yaml-cpp writes it: without comments, in the order of the file.
std::string YamlContent(const std::string& path) {
  try {
    std::string content;
    for (const YAML::Node& document : YAML::LoadAll(base::ReadTextFile(path))) {
      content += YAML::Dump(document) + "\n---\n";
    }
    return content;
  } catch (const YAML::Exception& e) {
    throw base::ConfigError(
        fmt::format("{}: line {}: {}; wanted YAML: mend the file", path, e.mark.line + 1, e.msg));
  }
}

}  // namespace

std::string ConfigurationHash(const std::string& package_folder) {
  base::Hasher hasher;
  for (const fs::path& name : FilesRead(package_folder)) {
    const std::string path = (fs::path(package_folder) / name).string();
    hasher.Add(name.string());
    hasher.Add(ContentThatCounts(path));
  }
  return base::HexOf(hasher.value());
}

std::string ContentThatCounts(const std::string& path) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  return fs::path(path).extension() == ".yaml" ? YamlContent(path)
                                               : base::ReadTextFile(path, kMostBytes);
}

}  // namespace hires::evaluation
