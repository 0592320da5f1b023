#include "sim_robot/sim_robot_lasers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "hires/robot/posture.h"
#include "sim_robot/sensor_period.h"

namespace hires::sim_robot {
namespace {

using base::Between;
using base::ParamReader;
using geometry::Pose3;

constexpr std::uint64_t kTrayStream = 0, kTiltStream = 1;

// As a PR2's driver filters its nodding laser (laser_filters, ScanShadowsFilter).
constexpr double kVeilAngle = 0.1745;  // [rad] between a beam and the way to the next point
constexpr int kVeiled = 20;            // [beams] to each side of such a pair, behind its nearer end

/// Takes out what may be no surface: where a beam was split between an edge and what is behind it,
/// points lie along the beam. Infinite: nothing was measured.
void TakeOutVeils(double beam_step, std::vector<double>* ranges) {
  const std::vector<double> measured = *ranges;
  const int n = static_cast<int>(measured.size());
  for (int i = 0; i + 1 < n; ++i) {
    const double a = measured[i], b = measured[i + 1];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    const double angle = std::atan2(b * std::sin(beam_step), a - b * std::cos(beam_step));
    if (angle > kVeilAngle && angle < geometry::kPi - kVeilAngle) continue;
    const double nearer = std::min(a, b);
    for (int k = std::max(0, i - kVeiled); k <= std::min(n - 1, i + 1 + kVeiled); ++k)
      if (measured[k] > nearer) (*ranges)[k] = INFINITY;
  }
}

simulation::LaserParams ReadMixingLaser(ParamReader* in) {
  simulation::LaserParams params = simulation::ReadLaser(in);
  params.beam_width = in->Get("beam_width", Between(0.0, 0.1));
  params.mixing_depth = in->Get("mixing_depth", Between(0.0, 100.0));
  params.sees_robot = true;
  return params;
}

}  // namespace

SimLaserParams ReadSimLaserParams(ParamReader* in) {
  SimLaserParams params;
  ParamReader tray = in->Sub("tray_laser"), tilting = in->Sub("tilting_laser");
  params.tray = ReadMixingLaser(&tray);
  params.tilting = ReadMixingLaser(&tilting);
  params.tilt_period = ReadPeriod("period", kLookTick, &tilting);
  return params;
}

SimRobotLasers::SimRobotLasers(const SimLaserParams& params, const base::Rng& rng,
                               std::shared_ptr<const simulation::Scene> scene)
    : params_(params),
      tray_rng_(rng.Fork(kTrayStream)),
      tilt_rng_(rng.Fork(kTiltStream)),
      scene_(std::move(scene)) {
  const robot::ExtraSensors& sensors = scene_->robot.profile.sensors;
  params_.tray.link = sensors.tray_laser_link;
  if (sensors.tilting_laser) params_.tilting.link = sensors.tilting_laser->link;
}

bool SimRobotLasers::has_tray_laser() const {
  return scene_->surroundings && !scene_->robot.profile.sensors.tray_laser_link.empty();
}

bool SimRobotLasers::has_tilting_laser() const {
  return scene_->surroundings && scene_->robot.profile.sensors.tilting_laser;
}

std::vector<double> SimRobotLasers::TrayScan(const SimRobotWorld& world) const {
  HIRES_CHECK(has_tray_laser(), "the robot has no laser at its tray");
  base::Rng rng = tray_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  return simulation::ScanLaser(world.simulator(), params_.tray, &rng);
}

bool SimRobotLasers::IsTiltDue(const SimRobotWorld& world) const {
  return has_tilting_laser() &&
         world.milliseconds() % std::lround(1000.0 * params_.tilt_period) == 0;
}

int SimRobotLasers::num_scans_of_a_sweep() const {
  return static_cast<int>(std::floor(nodding().sweep_time / params_.tilt_period + 1e-6));
}

robot::TiltPhase SimRobotLasers::TiltPhase(const SimRobotWorld& world) const {
  HIRES_CHECK(has_tilting_laser(), "the robot has no laser that nods");
  return robot::PhaseAt(nodding(), 0.001 * static_cast<double>(world.milliseconds()));
}

std::vector<double> SimRobotLasers::TiltScan(const SimRobotWorld& world) const {
  const double angle = TiltPhase(world).angle;
  const robot::RobotModel& model = scene_->robot.model;
  const Pose3 X_ML = world.simulator().X_MLink(ParentOf(model, nodding())) *
                     X_ParentLaser(model, nodding(), angle);
  base::Rng rng = tilt_rng_.Fork(static_cast<std::uint64_t>(world.milliseconds()));
  return simulation::ScanLaserFrom(X_ML, world.simulator(), params_.tilting, &rng);
}

Pose3 SimRobotLasers::X_OTilt(const SimRobotWorld& world, const SensorReadings& readings) const {
  const robot::RobotModel& model = scene_->robot.model;
  robot::JointPositions joints = readings.joints.positions;
  joints[nodding().joint] = TiltPhase(world).angle;
  const auto X_R = robot::ForwardKinematics(model, robot::PostureOf(scene_->robot, joints));
  const Pose3 X_BL = X_R[*model.FindLink(scene_->robot.profile.base_link)].Inverse() *
                     X_R[*model.FindLink(nodding().link)];
  return geometry::Lift(world.X_OB()) * X_BL;
}

std::optional<perception::PointCloud> SweepCloud::Add(const robot::TiltPhase& phase,
                                                      const simulation::LaserParams& laser,
                                                      const std::vector<double>& ranges,
                                                      const Pose3& X_OL) {
  if (phase.sweep != sweep_) {
    sweep_ = phase.sweep;
    num_scans_ = 0;
    gathered_ = {};
  }
  if (!phase.is_sweeping) {
    if (std::exchange(num_scans_, 0) < num_needed_) return std::nullopt;
    gathered_.width = static_cast<int>(gathered_.points.size());
    return std::exchange(gathered_, {});
  }
  ++num_scans_;
  std::vector<double> sure = ranges;
  TakeOutVeils(AngleOf(laser, 1) - AngleOf(laser, 0), &sure);
  for (std::size_t i = 0; i < sure.size(); ++i) {
    if (!std::isfinite(sure[i])) continue;
    const double angle = AngleOf(laser, static_cast<int>(i));
    const Eigen::Vector3d p_L(sure[i] * std::cos(angle), sure[i] * std::sin(angle), 0.0);
    gathered_.points.emplace_back((X_OL * p_L).cast<float>());
  }
  return std::nullopt;
}

}  // namespace hires::sim_robot
