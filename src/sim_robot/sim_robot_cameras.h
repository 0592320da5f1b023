#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/heat_picture.h"
#include "hires/perception/picture_scene.h"
#include "hires/perception/warm_objects.h"
#include "sim_robot/sim_robot_world.h"

namespace hires::sim_robot {

/// The pictures of the robot that stands in for a real one. Field of view and range of the depth
/// camera are the robot's own (its profile).
struct SimCameraParams {
  double depth_period{1.0};  ///< [s], a multiple of the tick
  int depth_width{640}, depth_height{480};
  perception::DepthSensorParams depth;
  double heat_period{0.2};  ///< [s], likewise
  int heat_width{640}, heat_height{480};
  double heat_field_of_view{1.5708};  ///< [rad] from border to border
  perception::HeatSensorParams heat;
  double coldest{288.15}, hottest{343.15};     ///< [K] at the ends of the scale of colours
  std::map<std::string, double> temperatures;  ///< [K] by object; not of the file: the scenario's
  /// Sd [m], [rad] by which the depth camera sits otherwise than the robot believes: drawn once,
  /// along x, y and z, and about the upright of a point 1.2 m in front of it, so that what stands
  /// there is off by so much. Not of the file: the truth's.
  double mount_bias{0.0}, mount_bias_yaw{0.0};
};

/// The blocks `depth_camera` and `thermal_camera` of a file like config/sim_robot.yaml.
/// @throws base::ConfigError naming file and key.
SimCameraParams ReadSimCameraParams(base::ParamReader* in);

/// A cloud in the optical frame of the head's camera.
struct SeenCloud {
  perception::PointCloud cloud;
  geometry::Pose3 X_MC;  ///< the camera's pose as tf tells it: believed place, measured joints
};

/// Depth camera on the head, with colours, and thermal camera. What they see is where everything
/// really is, the robot's own links included; of depth and colour the eye is the same, and may sit
/// otherwise than the robot believes. Noise is a
/// stream of its own for each moment: asked twice, they say the same twice. Pictures are made when
/// asked for.
class SimRobotCameras {
 public:
  /// @param rng  of all noise; forked only.
  SimRobotCameras(const SimCameraParams& params, const base::Rng& rng,
                  std::shared_ptr<const simulation::Scene> scene);
  ~SimRobotCameras();

  bool has_depth_camera() const { return scene_->has_camera(); }
  bool has_thermal_camera() const;
  bool IsDepthDue(const SimRobotWorld& world) const;
  bool IsHeatDue(const SimRobotWorld& world) const;
  const perception::PinholeCamera& depth_camera() const { return depth_camera_; }  ///< X_MC unset
  const perception::PinholeCamera& heat_camera() const { return heat_camera_; }    ///< likewise

  /// What the depth camera measures; organised.  @pre has_depth_camera()
  perception::PointCloud Cloud(const SimRobotWorld& world) const;
  /// The same with where the robot believes that its camera is: all that a recogniser gets.
  /// @param readings  of the same moment.
  SeenCloud See(const SimRobotWorld& world, const SensorReadings& readings) const;
  /// The same view in colours, one for each kind of thing (of twelve).  @pre has_depth_camera()
  perception::Picture Colours(const SimRobotWorld& world);
  perception::HeatPicture Heat(const SimRobotWorld& world) const;  ///< @pre has_thermal_camera()
  /// The same with where the robot believes that its camera and its links are.
  /// @param readings  of the same moment.  @pre has_thermal_camera()
  perception::HeatView SeeHeat(const SimRobotWorld& world, const SensorReadings& readings) const;
  /// For people.
  perception::Picture InColours(const perception::HeatPicture& heat) const;

 private:
  perception::LineOfSight Sight(const SimRobotWorld& world) const;
  geometry::Pose3 TrueEye(const SimRobotWorld& world) const;

  const SimCameraParams params_;
  const base::Rng depth_rng_, heat_rng_;  // forked for each moment
  const std::shared_ptr<const simulation::Scene> scene_;
  perception::PinholeCamera depth_camera_, heat_camera_;
  geometry::Pose3 X_CE_;  // the true eye in the frame where the robot believes it
  std::unique_ptr<perception::PictureScene> paint_;  // made when first asked for
};

}  // namespace hires::sim_robot
