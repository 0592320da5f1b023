#include "sim_robot/map_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/progress.h"
#include "hires/imagination/rollout.h"
#include "hires/simulation/laser_scanner.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::sim_robot {
namespace {

using geometry::Pose2;
using localisation::RobotLog;
using translation::Area;

constexpr int kSamplesPerScan = 4;  // of 20 in a second
enum MapDriveStreams : std::uint64_t { kRollouts, kSenses, kScanNoise };

/// What the robot went through at one moment of a leg.
struct Moment {
  double time{0.0};  // [s] of the leg
  Pose2 X_MB;
  std::optional<robot::ScanReading> scan;
  Pose2 X_BL;
};

std::vector<Area> AreasToStandAt(const imagination::ImaginationSetup& setup) {
  std::vector<Area> areas;
  for (const Area& area : setup.translator.areas.all) {
    if (area.kind == translation::AreaKind::kStanding && area.link.empty()) areas.push_back(area);
  }
  return areas;
}

Pose2 PoseOf(const Area& area) { return geometry::Flatten(area.X_FA); }

class MapDriver {
 public:
  MapDriver(const imagination::ImaginationSetup& setup, const MapDriveParams& params)
      : params_(params),
        rng_(params.seed),
        left_(AreasToStandAt(setup)),
        first_(TakeFirst(*setup.scene)),
        laser_(params.senses.laser),
        rollout_(imagination::MakeRolloutSetup(
            setup, imagination::MakeStartState(setup, first_, {}), rng_.Fork(kRollouts).seed())),
        senses_(CommonOf(setup, params.senses), rollout_.robot_state.X_MB, rng_.Fork(kSenses)) {
    laser_.link = setup.scene->robot.profile.laser_link;
    drive_.visited.push_back(first_);
  }

  std::optional<MapDrive> Drive(const std::string& task, const std::function<bool()>& cancelled);

 private:
  static std::shared_ptr<const simulation::SelfLocalisation> CommonOf(
      const imagination::ImaginationSetup& setup,
      const simulation::SelfLocalisationParams& params) {
    return simulation::FindingItsPlace(*setup.scene, params, setup.scene->world)->self_localisation;
  }
  std::string TakeFirst(const simulation::Scene& scene);
  std::string TakeNearest();
  bool Play(const std::string& area, const std::function<bool()>& cancelled);
  Moment Look(const simulation::RobotSimulator& simulator, std::size_t number) const;
  void Record(const std::vector<Moment>& moments);

  MapDriveParams params_;
  base::Rng rng_;
  std::vector<Area> left_;  // to be visited
  std::string first_;
  simulation::LaserParams laser_;
  imagination::RolloutSetup rollout_;  // where the next leg begins
  simulation::SelfLocaliser senses_;
  MapDrive drive_;
  int num_legs_{0};
  double time_{0.0};  // [s] at the end of the last leg
};

std::string MapDriver::TakeFirst(const simulation::Scene& scene) {
  const auto first = std::find_if(left_.begin(), left_.end(), [&](const Area& area) {
    return !scene.clearance.FindContact(PoseOf(area));
  });
  if (first == left_.end() || left_.size() < 2) {
    throw base::ConfigError(fmt::format(
        "a drive for a map goes from area to area; wanted two at least at which the robot can "
        "stand, the world has {}: add frames to it, or name one with --area",
        left_.size()));
  }
  const std::string name = first->name;
  left_.erase(first);
  return name;
}

/// As the crow flies; the first one when all were taken.
std::string MapDriver::TakeNearest() {
  if (left_.empty()) return first_;
  const Eigen::Vector2d at = rollout_.robot_state.X_MB.position();
  const auto nearest =
      std::min_element(left_.begin(), left_.end(), [&](const Area& a, const Area& b) {
        return (PoseOf(a).position() - at).norm() < (PoseOf(b).position() - at).norm();
      });
  const std::string name = nearest->name;
  left_.erase(nearest);
  return name;
}

std::optional<MapDrive> MapDriver::Drive(const std::string& task,
                                         const std::function<bool()>& cancelled) {
  const std::size_t num_legs = left_.size() + 1;
  for (std::size_t leg = 0; leg < num_legs; ++leg) {
    base::ReportProgress(task, static_cast<double>(leg) / static_cast<double>(num_legs));
    if (!Play(TakeNearest(), cancelled)) return std::nullopt;
  }
  base::ReportProgress(task, 1.0);
  if (drive_.visited.size() < 2) {
    throw base::ConfigError("the robot came from " + first_ +
                            " to no other area: " + drive_.missed.front());
  }
  return std::move(drive_);
}

/// @return false when cancelled.
bool MapDriver::Play(const std::string& area, const std::function<bool()>& cancelled) {
  const base::ActionCall action{"move_base_param", {area, params_.motion_set}};
  imagination::CheckSetup(rollout_, action);
  std::vector<Moment> moments;
  const auto look = [&](const simulation::RobotSimulator& simulator, double) {
    // The engine may have begun again.
    if (!moments.empty() && simulator.time() <= moments.back().time) moments.clear();
    moments.push_back(Look(simulator, moments.size()));
  };
  const auto result =
      imagination::PlayRollout(rollout_, action, num_legs_++, {cancelled, look});
  if (!result) return false;
  Record(moments);
  time_ += result->simulated;
  if (result->action_finished) {
    drive_.visited.push_back(area);
  } else {
    drive_.missed.push_back(area + ": " + base::ToString(result->failure));
  }
  const Pose2& X_MB = result->final_robot.X_MB;
  if (const auto contact = rollout_.scene->clearance.FindContact(X_MB)) {
    throw base::ConfigError(
        fmt::format("on its way to {} the robot touched {} with {}; wanted a "
                    "world through which it can drive",
                    area, contact->obstacle, contact->robot_part));
  }
  rollout_.robot_state.X_MB = X_MB;
  return true;
}

/// Noise is that of the leg and the moment, so that a leg which is played again has the same.
Moment MapDriver::Look(const simulation::RobotSimulator& simulator, std::size_t number) const {
  Moment moment{simulator.time(), simulator.base().X_MB, std::nullopt, {}};
  if (number % kSamplesPerScan != 0) return moment;
  base::Rng rng = rng_.Fork(kScanNoise).Fork(num_legs_).Fork(number);
  simulation::LevelScan scan = simulation::ScanLevel(simulator, laser_, &rng);
  moment.scan = std::move(scan.reading);
  moment.scan->range_max = laser_.range_max;
  moment.X_BL = scan.X_BL;
  return moment;
}

void MapDriver::Record(const std::vector<Moment>& moments) {
  for (const Moment& moment : moments) {
    const double time = time_ + moment.time;
    senses_.Drive(time, moment.X_MB);
    drive_.log.odometry.push_back({time, {senses_.X_OB(), {}}});
    if (!moment.scan) continue;
    drive_.log.scans.push_back({time, moment.X_BL, *moment.scan, senses_.X_OB()});
    drive_.truth.push_back({time, moment.X_MB});
  }
}

}  // namespace

std::optional<MapDrive> DriveForMap(const imagination::ImaginationSetup& setup,
                                    const MapDriveParams& params, const std::string& task,
                                    const std::function<bool()>& cancelled) {
  return MapDriver(setup, params).Drive(task, cancelled);
}

}  // namespace hires::sim_robot
