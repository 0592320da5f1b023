#include "hires/robot/extra_sensors.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::robot {
namespace {

constexpr double kSlack = 1e-9;  // [s] a stamp may lie before the moment that it stands for

int CarrierOf(const RobotModel& model, const TiltingLaser& laser) {
  const Joint* joint = FindJoint(model, laser.joint);
  HIRES_CHECK(joint != nullptr, "the robot has no joint '" + laser.joint + "'");
  return joint->parent;
}

}  // namespace

TiltPhase PhaseAt(const TiltingLaser& laser, double time) {
  HIRES_CHECK(time >= 0.0, "a laser nods from its beginning on");
  const double cycle = laser.sweep_time + laser.return_time;
  TiltPhase phase;
  phase.sweep = static_cast<long>(std::floor((time + kSlack) / cycle));
  const double within = std::max(0.0, time - static_cast<double>(phase.sweep) * cycle);
  phase.is_sweeping = within <= laser.sweep_time + kSlack;
  const double share = phase.is_sweeping ? std::min(within / laser.sweep_time, 1.0)
                                         : 1.0 - (within - laser.sweep_time) / laser.return_time;
  phase.angle = laser.from + share * (laser.to - laser.from);
  return phase;
}

geometry::Pose3 X_ParentLaser(const RobotModel& model, const TiltingLaser& laser, double angle) {
  const auto X_R = ForwardKinematics(model, {{laser.joint, angle}});
  return X_R[CarrierOf(model, laser)].Inverse() * X_R[*model.FindLink(laser.link)];
}

std::string ParentOf(const RobotModel& model, const TiltingLaser& laser) {
  return model.links[CarrierOf(model, laser)].name;
}

}  // namespace hires::robot
