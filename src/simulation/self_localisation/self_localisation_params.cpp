#include <cmath>
#include <filesystem>
#include <string>

#include "hires/simulation/self_localisation.h"

namespace hires::simulation {
namespace {

using base::Between;
using base::ParamReader;

constexpr std::size_t kFewestCasters = 2;
constexpr double kFarthestCaster = 10.0;  // [m]

CasterParams ReadCasters(ParamReader in) {
  CasterParams params;
  for (ParamReader& caster : in.SubList("at")) {
    const double x = caster.Get("x", Between(-kFarthestCaster, kFarthestCaster));
    params.casters_B.emplace_back(x, caster.Get("y", Between(-kFarthestCaster, kFarthestCaster)));
  }
  if (params.casters_B.size() < kFewestCasters)
    in.Fail("at", "wanted two casters or more, like {x: 0.2, y: 0.2}");
  params.track = in.Get("track", Between(0.001, 10.0));
  params.wear = in.Get("wear", Between(0.0, 0.2));
  params.radius_error = in.Get("radius_error", Between(0.0, 0.2));
  params.slip = in.Get("slip", Between(0.0, 1.0));
  params.scrub = in.Get("scrub", Between(0.0, 1.0));
  params.resolution = in.Get("resolution", Between(0.0, 0.1));
  return params;
}

GyroParams ReadGyro(ParamReader in) {
  GyroParams params;
  params.walk = in.Get("walk", Between(0.0, 1.0));
  params.bias = in.Get("bias", Between(0.0, 1.0));
  params.bias_walk = in.Get("bias_walk", Between(0.0, 1.0));
  return params;
}

}  // namespace

SelfLocalisationParams LoadSelfLocalisation(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  const auto beside = [&](const std::string& key) {
    return (std::filesystem::path(path).parent_path() / in.GetString(key)).string();
  };
  SelfLocalisationParams params;
  params.filter =
      localisation::ReadLocalisationConfig(ParamReader::FromFile(beside("filter"))).filter;
  params.odometry =
      localisation::ReadOdometryFilterConfig(ParamReader::FromFile(beside("odometry_filter")))
          .filter;
  params.casters = ReadCasters(in.Sub("casters"));
  params.gyro = ReadGyro(in.Sub("gyro"));
  ParamReader laser = in.Sub("laser");
  params.laser = ReadLaser(&laser);
  params.scan_period = in.Get("scan_period", Between(0.01, 10.0));
  params.start_sd = in.Get("start_sd", Between(0.0, 10.0));
  params.start_sd_yaw = in.Get("start_sd_yaw", Between(0.0, 3.2));
  params.map_resolution = in.Get("map_resolution", Between(0.005, 1.0));
  in.RejectUnknownKeys();
  return params;
}

}  // namespace hires::simulation
