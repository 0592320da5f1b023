#include "sim_robot/sim_robot_cameras.h"

#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/hash.h"
#include "hires/perception/camera_view.h"
#include "hires/perception/line_of_sight.h"
#include "hires/robot/posture.h"
#include "sim_robot/sensor_period.h"

namespace hires::sim_robot {
namespace {

using base::Between;
using base::ParamReader;
using perception::Colour;
using perception::PaintedBody;
using perception::PinholeCamera;

constexpr double kHeatRange = 100.0;  // [m] of the thermal camera
constexpr std::uint64_t kDepthStream = 0, kHeatStream = 1, kMountStream = 2;
constexpr Colour kRobot{112, 136, 172};
constexpr Colour kOfThings[] = {{200, 48, 40},   {40, 110, 190},  {70, 160, 70},  {230, 170, 40},
                                {140, 70, 160},  {240, 240, 235}, {30, 150, 150}, {120, 80, 50},
                                {230, 120, 150}, {60, 60, 70},    {150, 190, 60}, {235, 110, 30}};

int ReadPixels(const char* key, ParamReader* in) { return in->Get(key, Between(8, 4096)); }

void ReadDepthCamera(ParamReader in, SimCameraParams* params) {
  params->depth_period = ReadPeriod("period", kSensorTick, &in);
  params->depth_width = ReadPixels("width", &in);
  params->depth_height = ReadPixels("height", &in);
  params->depth.depth_noise = in.Get("depth_noise", Between(0.0, 100.0));
  params->depth.lateral_noise = in.Get("lateral_noise", Between(0.0, 20.0));
}

void ReadThermalCamera(ParamReader in, SimCameraParams* params) {
  params->heat_period = ReadPeriod("period", kSensorTick, &in);
  params->heat_width = ReadPixels("width", &in);
  params->heat_height = ReadPixels("height", &in);
  params->heat_field_of_view = in.Get("field_of_view", Between(0.01, 3.0));
  params->heat.noise = in.Get("noise", Between(0.0, 10.0));
  params->heat.room_temperature = in.Get("room_temperature", Between(200.0, 600.0));
  params->coldest = in.Get("coldest", Between(200.0, 600.0));
  params->hottest = in.Get("hottest", Between(200.0, 600.0));
  if (params->hottest <= params->coldest) in.Fail("hottest", "wanted more than `coldest`");
}

bool IsDue(const SimRobotWorld& world, double period) {
  return world.milliseconds() % std::lround(1000.0 * period) == 0;
}

Colour ColourOf(const std::string& kind) {
  base::Hasher hash;
  hash.Add(kind);
  return kOfThings[hash.value() % std::size(kOfThings)];
}

std::vector<geometry::Collision> RobotIn(const SimRobotWorld& world) {
  const robot::RobotState truth = world.simulator().GetRobotState();
  return perception::ShapesOf(world.scene()->robot, truth.X_MB, truth.joints);
}

std::vector<PaintedBody> MovingIn(const SimRobotWorld& world) {
  std::vector<PaintedBody> bodies{{RobotIn(world), {}, kRobot, false}};
  for (const world::ObjectState& object : world.simulator().GetWorldState().objects) {
    bodies.push_back({world.scene()->world.ModelOf(object)->collisions, object.X_MO,
                      ColourOf(object.model), false});
  }
  return bodies;
}

/// @return the eye in the camera's frame.
geometry::Pose3 DrawMount(const SimCameraParams& params, base::Rng rng) {
  if (params.mount_bias <= 0.0 && params.mount_bias_yaw <= 0.0) return {};
  const Eigen::Vector3d pivot(1.2, 0.0, 0.0);  // [m]
  const auto draw = [&] { return rng.Normal(0.0, params.mount_bias); };
  const double x = draw(), y = draw(), z = draw();
  const double yaw = rng.Normal(0.0, params.mount_bias_yaw);
  geometry::Pose3 X_CE;
  X_CE.rotation = geometry::RotationFromRpy(0.0, 0.0, yaw);
  X_CE.translation = Eigen::Vector3d(x, y, z) + pivot - X_CE.rotation * pivot;
  return X_CE;
}

}  // namespace

SimCameraParams ReadSimCameraParams(ParamReader* in) {
  SimCameraParams params;
  ReadDepthCamera(in->Sub("depth_camera"), &params);
  ReadThermalCamera(in->Sub("thermal_camera"), &params);
  return params;
}

SimRobotCameras::SimRobotCameras(const SimCameraParams& params, const base::Rng& rng,
                                 std::shared_ptr<const simulation::Scene> scene)
    : params_(params),
      depth_rng_(rng.Fork(kDepthStream)),
      heat_rng_(rng.Fork(kHeatStream)),
      scene_(std::move(scene)),
      heat_camera_(
          perception::CameraOf(params.heat_width, params.heat_height, params.heat_field_of_view)) {
  if (!has_depth_camera()) return;
  X_CE_ = DrawMount(params, rng.Fork(kMountStream));
  depth_camera_ = perception::CameraOf(params.depth_width, params.depth_height,
                                       scene_->robot.profile.upper_body->camera_width);
}

SimRobotCameras::~SimRobotCameras() = default;

bool SimRobotCameras::has_thermal_camera() const {
  return scene_->surroundings && !scene_->robot.profile.sensors.thermal_camera_link.empty();
}

bool SimRobotCameras::IsDepthDue(const SimRobotWorld& world) const {
  return has_depth_camera() && IsDue(world, params_.depth_period);
}

bool SimRobotCameras::IsHeatDue(const SimRobotWorld& world) const {
  return has_thermal_camera() && IsDue(world, params_.heat_period);
}

perception::LineOfSight SimRobotCameras::Sight(const SimRobotWorld& world) const {
  return {scene_->surroundings, world.simulator().GetWorldState().objects, RobotIn(world)};
}

geometry::Pose3 SimRobotCameras::TrueEye(const SimRobotWorld& world) const {
  return world.simulator().X_MLink(scene_->robot.profile.upper_body->camera_link) * X_CE_;
}

perception::PointCloud SimRobotCameras::Cloud(const SimRobotWorld& world) const {
  HIRES_CHECK(has_depth_camera(), "the robot has no depth camera");
  const robot::UpperBodyProfile& body = *scene_->robot.profile.upper_body;
  PinholeCamera camera = depth_camera_;
  camera.X_MC = TrueEye(world);
  perception::DepthSensorParams sensor = params_.depth;
  sensor.min_range = body.camera_min_range;
  sensor.max_range = body.camera_max_range;
  base::Rng rng = depth_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  return Measure(Sight(world), camera, sensor, &rng);
}

SeenCloud SimRobotCameras::See(const SimRobotWorld& world, const SensorReadings& readings) const {
  const robot::JointPositions posture = robot::PostureOf(scene_->robot, readings.joints.positions);
  return {Cloud(world), perception::ViewOf(scene_->robot, readings.X_MB, posture).X_MC};
}

perception::Picture SimRobotCameras::Colours(const SimRobotWorld& world) {
  HIRES_CHECK(has_depth_camera(), "the robot has no camera");
  if (!paint_) {
    std::vector<PaintedBody> fixed, movable{{RobotIn(world), {}, kRobot, false}};
    for (const world::StaticBody& body : scene_->world.statics) {
      fixed.push_back({body.collisions, body.X_MB, ColourOf(body.name), false});
    }
    for (const auto& [name, model] : scene_->world.models) {
      movable.push_back({model->collisions, {}, {}, false});
    }
    paint_ = std::make_unique<perception::PictureScene>(std::move(fixed), movable);
  }
  PinholeCamera camera = depth_camera_;
  camera.X_MC = TrueEye(world);
  return paint_->Draw(camera, MovingIn(world));
}

perception::HeatPicture SimRobotCameras::Heat(const SimRobotWorld& world) const {
  HIRES_CHECK(has_thermal_camera(), "the robot has no thermal camera");
  PinholeCamera camera = heat_camera_;
  camera.X_MC = world.simulator().X_MLink(scene_->robot.profile.sensors.thermal_camera_link);
  base::Rng rng = heat_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  return MeasureHeat(Sight(world).Look(camera, kHeatRange), params_.temperatures, params_.heat,
                     &rng);
}

perception::HeatView SimRobotCameras::SeeHeat(const SimRobotWorld& world,
                                              const SensorReadings& readings) const {
  const robot::Robot& robot = scene_->robot;
  const robot::JointPositions posture = robot::PostureOf(robot, readings.joints.positions);
  perception::HeatView view{Heat(world), heat_camera_,
                            perception::ShapesOf(robot, readings.X_MB, posture)};
  view.camera.X_MC =
      perception::X_MLink(robot, readings.X_MB, posture, robot.profile.sensors.thermal_camera_link);
  return view;
}

perception::Picture SimRobotCameras::InColours(const perception::HeatPicture& heat) const {
  return perception::Coloured(heat, params_.coldest, params_.hottest);
}

}  // namespace hires::sim_robot
