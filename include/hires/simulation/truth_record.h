#pragma once

#include <map>
#include <optional>
#include <string>

#include "hires/simulation/fall_watch.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::simulation {

/// How one loose object fared.
struct ObjectFate {
  geometry::Pose3 X_MO;     ///< now
  std::string attached_to;  ///< link that holds it now, or empty
  double tilt{0.0};         ///< [rad] now, against the world's up-axis
  double max_tilt{0.0};     ///< [rad]
  int falls{0};
  world::Fall first_fall{world::Fall::kNone};  ///< what slid and fell then: how it fell
  bool stands{false};  ///< now: it is there, nothing holds it, it is not down
};

/// How loose objects really fared when a run ends, by name in lower case.
struct RunTruth {
  std::map<std::string, ObjectFate> objects;
  std::string contact;  ///< the robot's first collision, or empty
};

/// Keeps the record of what really happens, for evaluation. Falls are judged by the same detector
/// as in imagination.
class TruthRecord {
 public:
  explicit TruthRecord(const world::StandingCriterion& criterion) : criterion_(criterion) {}

  /// Looks; call it every world::kFallLookInterval of simulated time.
  void Look(const RobotSimulator& simulator);
  /// The robot drives on after it was put somewhere else: not counted as way.
  void ForgetPosition() { last_.reset(); }
  /// That object was put somewhere else (case ignored): where it is found next, it stands.
  void ForgetPlaceOf(const std::string& object);

  /// By name in lower case; also of things that are there no more.
  const std::map<std::string, ObjectFate>& objects() const { return objects_; }
  int falls() const;
  double distance() const { return distance_; }            ///< [m] driven by the base
  const std::string& contact() const { return contact_; }  ///< first collision, or empty

 private:
  void LookAt(const RobotSimulator& simulator, int index, const world::ObjectState& object);

  world::StandingCriterion criterion_;
  std::map<std::string, ObjectFate> objects_;
  std::map<std::string, FallWatch> watches_;  // by name, likewise
  std::optional<geometry::Pose2> last_;
  double distance_{0.0};
  std::string contact_;
};

}  // namespace hires::simulation
