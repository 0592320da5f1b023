#include "sim_robot/sim_robot_sensors.h"

#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/simulation/scan_ghosts.h"
#include "sim_robot/sensor_period.h"

namespace hires::sim_robot {
namespace {

using base::Between;
using base::ParamReader;

constexpr double kStillHead = 0.02;  // [rad/s]
enum SensorStreams : std::uint64_t {
  kScanStream = 100,
  kDetectorStream,
  kMissedStream,
  kBiasStream,
  kCameraStream,
  kLaserStream
};

void ReadDetector(ParamReader in, SimSensorParams* params) {
  params->detection_period = ReadPeriod("period", kSensorTick, &in);
  params->min_visible_share = in.Get("min_visible_share", Between(0.0, 1.0));
}

}  // namespace

void PlayJointTick(SimRobotWorld* world, simulation::TruthRecord* truth,
                   const std::function<void()>& at_look) {
  for (long looked = 0; looked < kJointTick; looked += kLookTick) {
    world->Advance(kLookTick);
    truth->Look(world->simulator());
    if (at_look) at_look();
  }
}

SimSensorParams ReadSimSensorParams(ParamReader in) {
  SimSensorParams params;
  ParamReader laser = in.Sub("laser");
  params.laser = simulation::ReadLaser(&laser);
  ReadDetector(in.Sub("detector"), &params);
  params.cameras = ReadSimCameraParams(&in);
  params.lasers = ReadSimLaserParams(&in);
  return params;
}

void DropNoise(SimSensorParams* params) {
  params->laser.noise = 0.0;
  for (simulation::LaserParams* laser : {&params->lasers.tray, &params->lasers.tilting}) {
    laser->noise = laser->beam_width = 0.0;
  }
  params->cameras.depth.depth_noise = params->cameras.depth.lateral_noise = 0.0;
  params->cameras.heat.noise = 0.0;
}

SimSensorParams SensorsOf(const Truth& truth, SimSensorParams params) {
  params.sees_pictures = truth.sensing == Sensing::kPictures;
  if (truth.sensing == Sensing::kIdeal) DropNoise(&params);
  params.recogniser = truth.recogniser;
  params.cameras.mount_bias = truth.recogniser.bias;
  params.cameras.mount_bias_yaw = truth.recogniser.bias_yaw;
  return params;
}

SimRobotSensors::SimRobotSensors(const SimSensorParams& params, std::uint64_t seed,
                                 std::shared_ptr<const simulation::Scene> scene)
    : params_(params),
      scene_(std::move(scene)),
      laser_(params.laser),
      scan_rng_(base::Rng(seed).Fork(kScanStream)),
      detector_rng_(base::Rng(seed).Fork(kDetectorStream)),
      missed_rng_(base::Rng(seed).Fork(kMissedStream)),
      bias_rng_(base::Rng(seed).Fork(kBiasStream)),
      cameras_(params.cameras, base::Rng(seed).Fork(kCameraStream), scene_),
      lasers_(params.lasers, base::Rng(seed).Fork(kLaserStream), scene_) {
  laser_.link = scene_->robot.profile.laser_link;
  if (params.sees_pictures && params.eye) eye_.emplace(params.eye, perception::SelfFilterParams());
}

std::vector<double> SimRobotSensors::Scan(const SimRobotWorld& world,
                                          const SensorReadings& readings) const {
  base::Rng rng = scan_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  std::vector<double> ranges = simulation::ScanLaser(world.simulator(), laser_, &rng);
  simulation::AddGhosts(readings.ghosts_M, laser_,
                        geometry::Flatten(world.simulator().X_MLink(laser_.link)), &ranges);
  return ranges;
}

/// A camera that turns sees nothing sharp.
bool SimRobotSensors::IsLookDue(const SimRobotWorld& world, const SensorReadings& readings) const {
  if (!scene_->has_camera()) return false;
  const long period = std::lround(1000.0 * params_.detection_period);
  if (last_look_ && world.milliseconds() != *last_look_ &&
      world.milliseconds() < *last_look_ + period) {
    return false;
  }
  const robot::UpperBodyProfile& body = *scene_->robot.profile.upper_body;
  for (const std::string& joint : {body.head_pan_joint, body.head_tilt_joint}) {
    const auto velocity = readings.joints.velocities.find(joint);
    if (velocity != readings.joints.velocities.end() && std::abs(velocity->second) > kStillHead) {
      return false;
    }
  }
  return true;
}

bool SimRobotSensors::BeginLook(const SimRobotWorld& world, const SensorReadings& readings) {
  if (!IsLookDue(world, readings)) return false;
  last_look_ = world.milliseconds();
  return true;
}

std::optional<perception::Sighting> SimRobotSensors::Look(const SimRobotWorld& world,
                                                          const SensorReadings& readings) {
  if (!BeginLook(world, readings)) return std::nullopt;
  if (params_.sees_pictures) return eye_ ? Recognise(world, readings) : std::nullopt;
  auto seen = Detect(world);
  Misjudge(&seen, missed_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds())));
  return perception::Sighting{std::move(seen), {}};
}

/// The camera is where the robot really is; what it sees is told in its own frame.
std::vector<perception::Detection> SimRobotSensors::Detect(const SimRobotWorld& world) const {
  const simulation::RobotSimulator& simulator = world.simulator();
  const robot::Robot& robot = scene_->robot;
  const auto objects = simulator.GetWorldState().objects;
  const robot::RobotState truth = simulator.GetRobotState();
  const perception::LineOfSight sight(scene_->surroundings, objects,
                                      perception::ShapesOf(robot, truth.X_MB, truth.joints));
  const auto view =
      perception::ViewFrom(robot, simulator.X_MLink(robot.profile.upper_body->camera_link));
  const perception::DetectorParams detector{params_.min_visible_share,   world.detection_noise(),
                                            world.detection_noise_yaw(), scene_->sight.errors,
                                            world.recognition_errors(),  detector_rng_.seed()};
  base::Rng rng = detector_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  return perception::Detect(sight, view, objects, detector, &rng);
}

/// The robot knows its own place, in the middle of its map, by what it believes alone.
std::optional<perception::Sighting> SimRobotSensors::Recognise(const SimRobotWorld& world,
                                                               const SensorReadings& readings) {
  const SeenCloud seen = cameras_.See(world, readings);
  const robot::JointPositions posture = robot::PostureOf(scene_->robot, readings.joints.positions);
  const robot::Robot& robot = scene_->robot;
  const auto shapes_M = perception::ShapesOf(robot, readings.X_MB, posture);
  const base::Rng rng = detector_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  auto view = eye_->Look(seen.cloud, seen.X_MC * perception::OpticalFrame(), shapes_M,
                         robot.profile.tray_link, rng);
  if (!view) return std::nullopt;
  return perception::SeenFrom(perception::OpticalFrame(), std::move(view->sighting));
}

std::shared_ptr<const perception::HeatView> SimRobotSensors::LookForHeat(
    const SimRobotWorld& world, const SensorReadings& readings) const {
  if (!sees_pictures() || !cameras_.has_thermal_camera()) return nullptr;
  return std::make_shared<const perception::HeatView>(cameras_.SeeHeat(world, readings));
}

/// Some are missed; the others are all off, each in its own way.
void SimRobotSensors::Misjudge(std::vector<perception::Detection>* seen, base::Rng rng) const {
  const Recogniser& recogniser = params_.recogniser;
  std::vector<perception::Detection> told;
  for (perception::Detection& detection : *seen) {
    if (rng.Bernoulli(recogniser.missed)) continue;
    base::Hasher object;
    object.Add(detection.instance.value_or(detection.label));
    base::Rng own = bias_rng_.Fork(object.value());
    const double x = own.Normal(0.0, recogniser.bias), y = own.Normal(0.0, recogniser.bias);
    const double yaw = own.Normal(0.0, recogniser.bias_yaw);
    if (recogniser.bias > 0.0 || recogniser.bias_yaw > 0.0) {
      detection.X_CO = detection.X_CO * geometry::Lift(geometry::Pose2{x, y, yaw});
    }
    told.push_back(std::move(detection));
  }
  *seen = std::move(told);
}

}  // namespace hires::sim_robot
