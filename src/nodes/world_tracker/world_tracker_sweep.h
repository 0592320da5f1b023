#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/robot/observation.h"
#include "hires/sensing/body_reading.h"
#include "hires/translation/areas.h"
#include "nodes/world_tracker/world_tracker_params.h"

namespace hires_ros {

/// Turns the head to the places that the task is about, one after the other, whichever was not
/// looked at for longest first; only while no action uses the head. Knows no clock and no
/// connection.
class HeadSweep {
 public:
  HeadSweep(std::shared_ptr<const hires::robot::Robot> robot, SweepParams params);

  /// @param places  areas or objects, lower case.
  void SetPlaces(std::vector<std::string> places, hires::translation::Areas areas);
  /// Whether actions that run now use the head.
  void SetBusy(bool is_busy, double time);

  /// @param has_looked  the camera took a picture at that moment.
  /// @param known       objects that are remembered now.
  /// @return how to move the head, if it shall move.
  std::optional<hires::robot::JointTrajectory> Update(
      const hires::sensing::BodyReading& body, bool has_looked,
      const std::vector<hires::robot::SeenObject>& known);

  const std::string& target() const { return target_; }  ///< looked at last, or empty

 private:
  std::optional<Eigen::Vector3d> PointOf(const std::string& place,
                                         const std::vector<hires::robot::SeenObject>& known) const;
  hires::robot::JointTrajectory Turn(const hires::robot::JointPositions& from,
                                     const std::vector<double>& to) const;

  std::shared_ptr<const hires::robot::Robot> robot_;
  SweepParams params_;
  std::vector<std::string> places_;
  hires::translation::Areas areas_;
  std::map<std::string, double> looked_at_;  // place -> [s]
  std::string target_;
  bool is_busy_{false};
  double free_from_{0.0};  // [s] the head is others' until then, or rests on the target
};

}  // namespace hires_ros
