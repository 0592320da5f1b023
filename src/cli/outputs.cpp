#include "cli/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "cli/verbs/imagine/imagine_start.h"
#include "hires/base/error.h"
#include "hires/base/files/own_input.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "hires/world/occupancy_grid.h"
#include "reports/text/report_json.h"

namespace hires::cli {
namespace {

void CheckOutput(const VerbFile& output, const std::vector<VerbFile>& inputs) {
  if (output.path == "-") {
    throw base::ConfigError(
        fmt::format("{} -: is no file; name one, or /dev/stdout to print it", output.what));
  }
  reports::RequireFolderOf(output.path);
  base::RequireReplaceable(output.path);
  for (const VerbFile& input : inputs)
    base::RefuseOwnInput(output.what, output.path, input.what, input.path);
}

/// Of devices, as /dev/null, one does for several.
bool AreSame(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code none_there;
  if (fs::exists(a, none_there) && !fs::is_regular_file(a, none_there)) return false;
  return fs::equivalent(a, b, none_there) || fs::weakly_canonical(fs::absolute(a), none_there) ==
                                                 fs::weakly_canonical(fs::absolute(b), none_there);
}

}  // namespace

VerbFile PictureFile(const std::string& map) {
  return {"picture of the map", map.empty() ? "" : world::PictureOfMap(map)};
}

std::vector<VerbFile> SceneFiles(const std::string& world, const std::string& map,
                                 const std::string& robot, const std::vector<std::string>& areas) {
  std::vector<VerbFile> files{
      {"world", world}, {"map", map}, PictureFile(map), {"robot", robot::FileOfRobot(robot)}};
  for (const std::string& file : AreaFilesOf(areas)) files.push_back({"areas", file});
  return files;
}

void CheckOutputs(const std::vector<VerbFile>& outputs, const std::vector<VerbFile>& inputs) {
  std::vector<std::string> wrong;
  std::vector<VerbFile> files;
  for (const VerbFile& output : outputs) {
    if (output.path.empty() || (output.path == "-" && output.may_be_printed)) continue;
    try {
      CheckOutput(output, inputs);
    } catch (const base::ConfigError& error) {
      wrong.push_back(error.what());
      continue;
    }
    for (const VerbFile& other : files) {
      if (AreSame(other.path, output.path)) {
        wrong.push_back(fmt::format("{} and {}: both {}; name two files", other.what, output.what,
                                    output.path));
      }
    }
    files.push_back(output);
  }
  if (!wrong.empty()) throw base::ConfigError(base::Join(wrong, "\n"));
}

}  // namespace hires::cli
