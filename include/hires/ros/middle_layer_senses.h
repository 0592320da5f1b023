#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_names.h"
#include "hires/sensing/object_memory.h"
#include "hires/sensing/scan_obstacles.h"
#include "hires/world/world.h"

namespace hires_ros {

/// Puts together what skills see from what the robot's sensors say, each at its own time. Knows no
/// clock: all times are the messages' stamps [s].
///
/// Objects are remembered here from looks and fingers, moment by moment, as skills need them; what
/// others say is known counts as hearsay, for what was never seen here.
class Senses {
 public:
  /// @param surroundings  what the camera looks at; null: the robot has none, and sees no objects.
  /// @param names         for messages to people.
  /// @param stale_after   [s] an older correction of the odometry is none.
  /// @pre the obstacles outlive it.
  Senses(std::shared_ptr<const hires::robot::Robot> robot,
         std::shared_ptr<const hires::perception::Surroundings> surroundings,
         const hires::sensing::ScanObstacles& obstacles, const RobotNames& names,
         double stale_after);

  void OnOdometry(double stamp, const OdometryReading& reading);
  void OnLocalisation(double stamp, const hires::geometry::Pose2& X_MO);  ///< odometry's origin
  void OnJoints(double stamp, JointReading reading);
  void OnScan(double stamp, hires::sensing::ScanReading reading);
  void OnKnownObjects(const hires::world::WorldState& state);
  void OnDetections(double stamp, std::vector<hires::perception::Detection> detections);

  /// Time up to which base, joints and place are known; nothing while one of them is missing or the
  /// place is too old.
  std::optional<double> CompleteUntil() const;

  /// @pre stamp <= CompleteUntil(). `time` and the objects' times are stamps.
  hires::robot::Observation Look(double stamp);

  std::string Missing() const;  ///< for people: what keeps it from being complete; else empty

 private:
  template <typename T>
  struct Stamped {
    double stamp;
    T value;
  };
  template <typename T>
  static const T& At(double stamp, const std::deque<Stamped<T>>& history);
  hires::geometry::Pose2 BaseAt(double stamp) const;
  hires::sensing::BodyReading BodyAt(double stamp) const;
  void FindObstacles();
  void LookAtObjects(double stamp, hires::robot::Observation* seen);
  void Hear(const hires::sensing::BodyReading& body);

  std::shared_ptr<const hires::robot::Robot> robot_;
  const hires::sensing::ScanObstacles& find_obstacles_;
  RobotNames names_;
  double stale_after_;
  hires::geometry::Pose2 X_BL_;                    // laser
  std::deque<Stamped<OdometryReading>> odometry_;  // of the last seconds, oldest first
  std::deque<Stamped<JointReading>> joints_;       // likewise
  std::optional<Stamped<hires::geometry::Pose2>> X_MO_;
  std::optional<Stamped<hires::sensing::ScanReading>> scan_;  // not looked at yet
  std::vector<hires::geometry::Polygon> obstacles_M_;
  std::optional<hires::sensing::ObjectMemory> memory_;
  std::deque<Stamped<std::vector<hires::perception::Detection>>> looks_;  // not remembered yet
  std::optional<hires::world::WorldState> hearsay_;                       // not believed yet
  std::set<std::string> believed_;
};

}  // namespace hires_ros
