#pragma once

#include <map>
#include <optional>
#include <string>

#include "hires/simulation/robot_simulator.h"

namespace hires_ros {

/// How one loose object fared.
struct ObjectFate {
  double tilt{0.0};      ///< [rad] now, against the world's up-axis
  double max_tilt{0.0};  ///< [rad]
  int falls{0};
  bool is_down{false};  ///< fallen, and not put up again
  double held_up{0.0};  ///< [m] height of its origin when it last stood
};

/// Keeps the record of what really happens, for evaluation. An object has fallen when it tilts
/// beyond the topple threshold (0.5 rad), or when it drops by more than 0.3 m without being held;
/// it counts again once it has stood upright in between.
class TruthRecord {
 public:
  /// Looks; call it every few milliseconds of simulated time.
  void Look(const hires::simulation::RobotSimulator& simulator);
  /// Where it drives on after it was put somewhere else: not counted as way.
  void ForgetPosition() { last_.reset(); }

  const std::map<std::string, ObjectFate>& objects() const { return objects_; }
  int falls() const;
  double distance() const { return distance_; }            ///< [m] driven by the base
  const std::string& contact() const { return contact_; }  ///< first collision, or empty

 private:
  void LookAt(const hires::world::ObjectState& object);

  std::map<std::string, ObjectFate> objects_;
  std::optional<hires::geometry::Pose2> last_;
  double distance_{0.0};
  std::string contact_;
};

}  // namespace hires_ros
