#include "hires/evaluation/sim_robot_sensors.h"

#include <cmath>
#include <utility>

#include "hires/base/hash.h"
#include "hires/simulation/scan_ghosts.h"
#include "hires/world/standing.h"

namespace hires::evaluation {
namespace {

using base::Between;
using base::ParamReader;

constexpr double kStillHead = 0.02;                                                 // [rad/s]
constexpr long kLook = static_cast<long>(1000.0 * world::kFallLookInterval + 0.5);  // [ms]
static_assert(kJointTick % kLook == 0, "what sensors say is the end of a look");
enum SensorStreams : std::uint64_t {
  kScanStream = 100,
  kDetectorStream,
  kMissedStream,
  kBiasStream
};

simulation::LaserParams ReadLaser(ParamReader in) {
  simulation::LaserParams params;
  params.num_beams = in.Get("beams", Between(2, 10000));
  params.angle_min = in.Get("angle_min", Between(-3.1415, 3.1415));
  params.angle_max = in.Get("angle_max", Between(-3.1415, 3.1415));
  if (params.angle_max <= params.angle_min) in.Fail("angle_max", "wanted more than angle_min");
  params.range_min = in.Get("range_min", Between(0.0, 10.0));
  params.range_max = in.Get("range_max", Between(0.1, 100.0));
  params.noise = in.Get("noise", Between(0.0, 1.0));
  return params;
}

void ReadDetector(ParamReader in, SimSensorParams* params) {
  constexpr double kTickSeconds = 0.001 * kSensorTick;
  params->detection_period = in.Get("period", Between(kTickSeconds, 60.0));
  const double ticks = params->detection_period / kTickSeconds;
  if (std::abs(ticks - std::round(ticks)) > 1e-6) in.Fail("period", "wanted a multiple of 0.05 s");
  params->min_visible_share = in.Get("min_visible_share", Between(0.0, 1.0));
}

}  // namespace

void PlayJointTick(SimRobotWorld* world, simulation::TruthRecord* truth) {
  for (long looked = 0; looked < kJointTick; looked += kLook) {
    world->Advance(kLook);
    truth->Look(world->simulator());
  }
}

SimSensorParams ReadSimSensorParams(ParamReader in) {
  SimSensorParams params;
  params.laser = ReadLaser(in.Sub("laser"));
  ReadDetector(in.Sub("detector"), &params);
  return params;
}

SimSensorParams SensorsOf(const Truth& truth, SimSensorParams params) {
  if (truth.senses_ideally) params.laser.noise = 0.0;
  params.recogniser = truth.recogniser;
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
      bias_rng_(base::Rng(seed).Fork(kBiasStream)) {
  laser_.link = scene_->robot.profile.laser_link;
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
  if (!scene_->surroundings) return false;
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

std::optional<std::vector<perception::Detection>> SimRobotSensors::Look(
    const SimRobotWorld& world, const SensorReadings& readings) {
  if (!IsLookDue(world, readings)) return std::nullopt;
  last_look_ = world.milliseconds();
  // The camera is where the robot really is; what it sees is told in its own frame.
  const simulation::RobotSimulator& simulator = world.simulator();
  const robot::Robot& robot = scene_->robot;
  const auto objects = simulator.GetWorldState().objects;
  const robot::RobotState truth = simulator.GetRobotState();
  const perception::LineOfSight sight(scene_->surroundings, objects,
                                      perception::ShapesOf(robot, truth.X_MB, truth.joints));
  const auto view =
      perception::ViewFrom(robot, simulator.X_MLink(robot.profile.upper_body->camera_link));
  const perception::DetectorParams detector{params_.min_visible_share, world.detection_noise(),
                                            world.detection_noise_yaw()};
  base::Rng rng = detector_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  auto seen = perception::Detect(sight, view, objects, detector, &rng);
  Misjudge(&seen, missed_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds())));
  return seen;
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

}  // namespace hires::evaluation
