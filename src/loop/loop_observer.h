#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/control/action_runner.h"
#include "hires/perception/detector.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/warm_objects.h"
#include "hires/sensing/scan_obstacles.h"
#include "loop/achieve.h"
#include "sim_robot/sim_robot_world.h"

namespace hires::loop {

/// What the laser over the tray measures.
struct TrayScan {
  std::string frame;
  robot::ScanReading reading;
};

/// What the robot's sensors say at one moment, as one who listens to them gets it.
struct SensorNews {
  double stamp{0.0};  ///< [s]
  sim_robot::SensorReadings readings;
  /// With the moments at which the laser, the localisation and the camera speak, too.
  bool is_tick{false};
  std::vector<double> scan;  ///< [m]; empty: the robot has no laser
  std::optional<perception::Sighting> seen;
  std::optional<TrayScan> tray;
  std::shared_ptr<const perception::HeatView> heat;  ///< null: no picture was taken
  /// Of a sweep of the laser that nods, in the odometry's frame; null: none ended since the last
  /// tick.
  std::shared_ptr<const perception::PointCloud> sweep;
};

/// Told of all that passes between the parts of a loop, as topics would carry it between nodes, in
/// the order of time [s]. Each may be empty; none may change anything.
struct LoopObserver {
  std::function<void(const SensorNews&)> sensed;
  std::function<void(double time, const robot::Command&)> commanded;
  /// What the tracker remembers of objects.
  std::function<void(double time, const world::WorldState&)> known;
  /// @param activity  number of the action; none comes twice.
  std::function<void(double time, int activity, const base::ActionCall&)> began;
  std::function<void(double time, int activity, control::ActionEnd, const base::Failure&)> ended;
};

/// Keeps what an observer is told, in a form of its own.
class LoopRecording {
 public:
  virtual ~LoopRecording() = default;
  virtual LoopObserver observer() = 0;  ///< @pre this outlives it
  /// The task is over: what was planned and predicted.
  virtual void Finish(const AchieveReport& report) = 0;
};
/// @throws base::ConfigError if the file `path` cannot be written.
using RecordLoop = std::function<std::unique_ptr<LoopRecording>(const std::string& path)>;

}  // namespace hires::loop
