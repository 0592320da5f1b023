#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/perception/detector.h"
#include "hires/robot/observation.h"

namespace hires::simulation {

/// The camera's pose as it is and as the robot believes it.
struct CameraPoses {
  geometry::Pose3 X_MC;          ///< true
  geometry::Pose3 X_MCbelieved;  ///< in the map as the robot believes it
};

/// What a robot knows of loose objects: by looking, and by holding. An object stays where it was
/// seen last until the robot looks there and does not see it; what stands on the robot drives along
/// with it. A value: copy it to save it.
class ObjectMemory {
 public:
  /// Whether an object of a model stands on the robot: its pose in the base frame.
  using RidesAlong = std::function<bool(const std::string& model, const geometry::Pose3& X_BO)>;
  explicit ObjectMemory(RidesAlong rides_along) : rides_along_(std::move(rides_along)) {}

  /// Known from elsewhere, e.g. because somebody told. Replaces what is known of these objects, but
  /// of those that a link holds: hands know better, also that they hold nothing.
  /// @param X_MBbelieved  here and below: where the robot believes to stand.
  void Remember(const std::vector<robot::SeenObject>& objects, const geometry::Pose2& X_MBbelieved);

  /// @param detections  all that the camera sees now.
  /// @param sight  with the true objects: tells which remembered objects ought to be seen.
  void Look(const std::vector<perception::Detection>& detections,
            const perception::LineOfSight& sight, const perception::CameraView& true_view,
            const CameraPoses& camera, const perception::DetectorParams& params, double time,
            const geometry::Pose2& X_MBbelieved);

  /// A link has taken hold of an object; from now on it is where the link is.
  /// @param X_MLbelieved  of the link.
  /// @param object  true: counts for what is not known yet.
  void Take(const std::string& link, const geometry::Pose3& X_MLbelieved,
            const robot::SeenObject& object, const geometry::Pose3& X_LO,
            const geometry::Pose2& X_MBbelieved);
  /// The link holds it no more.
  void Release(const std::string& name, const geometry::Pose3& X_MLbelieved,
               const geometry::Pose2& X_MBbelieved);

  /// All, by name; what is held moves with its link.
  /// @param X_MLbelieved  of the links that hold something, by name.
  std::vector<robot::SeenObject> Known(const std::map<std::string, geometry::Pose3>& X_MLbelieved,
                                       const geometry::Pose2& X_MBbelieved) const;

 private:
  struct Entry {
    robot::SeenObject seen;
    geometry::Pose3 X_LO;                 // in the link that holds it
    std::optional<geometry::Pose3> X_BO;  // where it stands on the robot
  };
  void Place(const geometry::Pose3& X_MO, const geometry::Pose2& X_MBbelieved, Entry* entry) const;
  static geometry::Pose3 PoseOf(const Entry& entry, const geometry::Pose2& X_MBbelieved);

  RidesAlong rides_along_;
  std::map<std::string, Entry> entries_;  // by lower-case name
};

}  // namespace hires::simulation
