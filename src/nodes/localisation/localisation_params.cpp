#include "nodes/localisation/localisation_params.h"

#include <fmt/format.h>
#include <ros/package.h>

#include <algorithm>
#include <iterator>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/localisation/monte_carlo.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {
namespace {

using hires::base::Between;

const std::vector<std::string> kPoseKeys{"initial_pose_x", "initial_pose_y", "initial_pose_a"};

/// Private parameters that win over the file's keys.
std::vector<std::string> InitialKeys() {
  std::vector<std::string> keys{"initial_cov_xx", "initial_cov_yy", "initial_cov_aa"};
  keys.insert(keys.end(), kPoseKeys.begin(), kPoseKeys.end());
  return keys;
}

std::vector<std::string> KnownKeys() {
  std::vector<std::string> keys{"config", "names", "seed", "map_file"};
  for (const auto& more : {InitialKeys(), KeptKeys()})
    std::copy(more.begin(), more.end(), std::back_inserter(keys));
  return keys;
}

void OverrideStart(hires::localisation::MonteCarloParams* params) {
  const auto override_one = [](const char* key, double least, double most, double* target) {
    Override(key, PrivateNumber(key), Between(least, most), target);
  };
  override_one("initial_pose_x", -1e5, 1e5, &params->initial_pose.x);
  override_one("initial_pose_y", -1e5, 1e5, &params->initial_pose.y);
  override_one("initial_pose_a", -6.3, 6.3, &params->initial_pose.yaw);
  override_one("initial_cov_xx", 0.0, 1e6, &params->initial_variance.x());
  override_one("initial_cov_yy", 0.0, 1e6, &params->initial_variance.y());
  override_one("initial_cov_aa", 0.0, 40.0, &params->initial_variance.z());
}

std::optional<hires::world::OccupancyGrid> MapOfFile(const std::string& path) {
  if (path.empty()) return std::nullopt;
  hires::world::OccupancyGrid map = hires::world::LoadMap(path);
  const std::string why = hires::localisation::WhyUseless(map);
  if (!why.empty()) {
    throw hires::base::ConfigError(
        fmt::format("~map_file: the map of {} {}; name another file", path, why));
  }
  return map;
}

}  // namespace

LocalisationNodeParams LoadLocalisationNodeParams() {
  RejectUnknownPrivate(KnownKeys());
  LocalisationNodeParams params;
  params.config = hires::localisation::ReadLocalisationConfig(
      hires::base::ParamReader::FromFile(PrivateText("config").value_or(
          ros::package::getPath("hires") + "/config/localisation.yaml")));
  params.names = LoadRobotNames();
  if (params.names.base_scan.empty()) {
    throw hires::base::ConfigError(
        "the names file has no base_scan; name there the topic of the base laser's LaserScan");
  }
  int seed = 1;
  Override("seed", PrivateInt("seed"), Between(0, 2147483647), &seed);
  params.seed = static_cast<std::uint64_t>(seed);
  params.map = MapOfFile(PrivateText("map_file").value_or(""));
  OverrideStart(&params.config.filter);
  params.is_start_given =
      std::any_of(kPoseKeys.begin(), kPoseKeys.end(),
                  [](const std::string& key) { return PrivateNumber(key).has_value(); });
  params.kept = ReadKeptPlace();
  return params;
}

}  // namespace hires_ros
