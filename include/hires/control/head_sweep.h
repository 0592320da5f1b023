#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/sensing/body_reading.h"
#include "hires/translation/areas.h"

namespace hires::control {

/// How the head looks around when no action needs it.
struct SweepParams {
  bool enabled{true};
  double range{3.2};      ///< [m] from the camera to what is worth looking at
  double period{4.0};     ///< [s] after which a place is looked at again
  double dwell{1.0};      ///< [s] that the head rests on a place once it has arrived: some looks
  double speed{1.0};      ///< [rad/s] of the head
  double hands_off{2.0};  ///< [s] after an action that uses the head
};

/// @throws base::ConfigError naming the key.
SweepParams ReadSweepParams(base::ParamReader in);

/// Turns the head to the places that the task is about, one after the other, whichever was not
/// looked at for longest first; only while no action uses the head. Knows no clock and no
/// connection.
class HeadSweep {
 public:
  HeadSweep(std::shared_ptr<const robot::Robot> robot, SweepParams params);

  /// @param places  areas or objects, lower case.
  void SetPlaces(std::vector<std::string> places, translation::Areas areas);
  /// Whether actions that run now use the head.
  void SetBusy(bool is_busy, double time);

  /// @param has_looked  the camera took a picture at that moment.
  /// @param known       objects that are remembered now.
  /// @return how to move the head, if it shall move.
  std::optional<robot::JointTrajectory> Update(const sensing::BodyReading& body, bool has_looked,
                                               const std::vector<robot::SeenObject>& known);

  const std::string& target() const { return target_; }  ///< looked at last, or empty

 private:
  std::optional<Eigen::Vector3d> PointOf(const std::string& place,
                                         const std::vector<robot::SeenObject>& known) const;
  robot::JointTrajectory Turn(const robot::JointPositions& from,
                              const std::vector<double>& to) const;
  bool IsTurning(const sensing::BodyReading& body);

  std::shared_ptr<const robot::Robot> robot_;
  SweepParams params_;
  std::vector<std::string> places_;
  translation::Areas areas_;
  std::map<std::string, double> looked_at_;  // place -> [s]
  std::string target_;
  std::optional<robot::JointTrajectory> turn_;  // until the head has arrived
  double given_up_at_{0.0};                     // [s] then it counts as held by something else
  bool is_busy_{false};
  double free_from_{0.0};  // [s] the head is others' until then, or rests on the target
};

}  // namespace hires::control
