#include "nodes/localisation/pose_keeper.h"

#include <algorithm>
#include <map>

#include "hires/ros/node/private_params.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose2;

constexpr double kKeepPeriod = 2.0;  // [s], save_pose_rate of AMCL: 0.5 Hz

/// By the names of the parameters.
std::map<std::string, double> NumbersOf(const KeptPlace& place) {
  return {{"initial_pose_x", place.X_MB.x},       {"initial_pose_y", place.X_MB.y},
          {"initial_pose_a", place.X_MB.yaw},     {"initial_cov_xx", place.variance.x()},
          {"initial_cov_yy", place.variance.y()}, {"initial_cov_aa", place.variance.z()},
          {"initial_odometry_x", place.X_OB.x},   {"initial_odometry_y", place.X_OB.y},
          {"initial_odometry_a", place.X_OB.yaw}, {"initial_odometry_time", place.time}};
}

}  // namespace

std::vector<std::string> KeptKeys() {
  return {"initial_odometry_x", "initial_odometry_y", "initial_odometry_a",
          "initial_odometry_time"};
}

std::optional<KeptPlace> ReadKeptPlace() {
  std::map<std::string, double> numbers = NumbersOf({});
  for (auto& [key, number] : numbers) {
    const auto given = PrivateNumber(key);
    if (!given) return std::nullopt;
    number = *given;
  }
  const auto pose = [&](const std::string& prefix) {
    return Pose2{numbers[prefix + "_x"], numbers[prefix + "_y"], numbers[prefix + "_a"]};
  };
  return KeptPlace{
      pose("initial_pose"),
      {numbers["initial_cov_xx"], numbers["initial_cov_yy"], numbers["initial_cov_aa"]},
      pose("initial_odometry"),
      numbers["initial_odometry_time"]};
}

std::optional<Pose2> PlaceNow(const KeptPlace& kept, const Pose2& X_OB, double time,
                              double max_speed) {
  const Pose2 driven = kept.X_OB.Inverse() * X_OB;
  const double passed = time - kept.time;
  if (passed < 0.0 || driven.position().norm() > max_speed * passed) return std::nullopt;
  const Pose2 X_MB = kept.X_MB * driven;
  return X_MB.IsFinite() ? std::optional(X_MB) : std::nullopt;
}

void PoseKeeper::Note(const KeptPlace& place) {
  if (kept_ && place.time >= *kept_ && place.time < *kept_ + kKeepPeriod) return;
  kept_ = place.time;
  thread_.Post([this, place] { Write(place); });
}

void PoseKeeper::Write(const KeptPlace& place) const {
  for (const auto& [key, number] : NumbersOf(place)) node_.setParam(key, number);
}

}  // namespace hires_ros
