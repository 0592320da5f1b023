#include "reports/text/configuration_hash.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"

namespace hires::reports {
namespace {

namespace fs = std::filesystem;

/// Whether a result may rest on it: not how it is shown.
bool Counts(const fs::path& name, const std::vector<std::string>& without) {
  const auto begins_name = [&](const std::string& start) {
    return name.string().rfind(start, 0) == 0;
  };
  return name.extension() != ".rviz" && name.extension() != ".launch" &&
         std::none_of(without.begin(), without.end(), begins_name);
}

/// Of a file or of all below a folder, those that count, from the package's folder on; sorted.
std::vector<fs::path> FilesOf(const fs::path& package, const std::string& input,
                              const std::vector<std::string>& without = {}) {
  if (!fs::is_directory(package / input)) return {input};
  std::vector<fs::path> names;
  for (const auto& entry : fs::recursive_directory_iterator(package / input)) {
    const fs::path name =
        entry.path().lexically_normal().lexically_relative(package.lexically_normal());
    if (entry.is_regular_file() && Counts(name, without)) names.push_back(name);
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

/// Name, and what counts of the content.
void Add(const fs::path& package, const fs::path& name, base::Hasher* hasher) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  const std::string path = (package / name).string();
  hasher->Add(name.string());
  hasher->Add(name.extension() == ".yaml" ? YamlContent(path)
                                          : base::ReadTextFile(path, kMostBytes));
}

}  // namespace

std::string ConfigurationHash(const std::string& package_folder) {
  base::Hasher hasher;
  for (const char* folder : {"config", "urdf", "worlds"}) {
    for (const fs::path& name : FilesOf(package_folder, folder)) Add(package_folder, name, &hasher);
  }
  return base::HexOf(hasher.value());
}

std::string InputHash(const std::string& package_folder, const std::string& input,
                      const std::vector<std::string>& without) {
  base::Hasher hasher;
  for (const fs::path& name : FilesOf(package_folder, input, without)) {
    Add(package_folder, name, &hasher);
  }
  return base::HexOf(hasher.value());
}

}  // namespace hires::reports
