#include "robot/extra_sensors_reader.h"

#include <fmt/format.h>

#include "robot/upper_body_reader.h"

namespace hires::robot {
namespace {

using base::Between;
using base::ParamReader;

TiltingLaser ReadTiltingLaser(ParamReader in) {
  TiltingLaser laser;
  laser.link = in.GetString("link");
  laser.joint = in.GetString("joint");
  laser.from = in.Get("from", Between(-3.1415, 3.1415));
  laser.to = in.Get("to", Between(-3.1415, 3.1415));
  if (laser.from == laser.to) in.Fail("to", "wanted another angle than `from`");
  laser.sweep_time = in.Get("sweep_time", Between(0.1, 60.0));
  laser.return_time = in.Get("return_time", Between(0.1, 60.0));
  return laser;
}

void CheckTiltingLaser(ParamReader in, const TiltingLaser& laser, const RobotModel& model) {
  CheckLink(in, "link", model, laser.link);
  const auto carried = FindLinkOf(model, laser.joint);
  if (!carried || model.links[*carried].joint->type != JointType::kRevolute) {
    in.Fail("joint", "wanted a joint of the robot that turns between limits");
  }
  if (!IsBelow(model, *model.FindLink(laser.link), *carried)) {
    in.Fail("joint", "which does not carry link '" + laser.link + "'");
  }
  const JointLimits& limits = *model.links[*carried].joint->limits;
  for (const auto& [key, angle] : {std::pair("from", laser.from), {"to", laser.to}}) {
    if (angle < limits.lower || angle > limits.upper) {
      in.Fail(key, fmt::format("wanted within the limits of the joint, {} to {} rad", limits.lower,
                               limits.upper));
    }
  }
}

}  // namespace

ExtraSensors ReadExtraSensors(ParamReader in) {
  ExtraSensors sensors;
  if (in.Has("thermal_camera")) sensors.thermal_camera_link = in.GetString("thermal_camera");
  if (in.Has("tray_laser")) sensors.tray_laser_link = in.GetString("tray_laser");
  if (in.Has("tilting_laser")) sensors.tilting_laser = ReadTiltingLaser(in.Sub("tilting_laser"));
  if (in.Has("inertial_unit")) sensors.inertial_unit_link = in.GetString("inertial_unit");
  return sensors;
}

void CheckExtraSensors(ParamReader in, const ExtraSensors& sensors, const RobotModel& model) {
  if (!sensors.thermal_camera_link.empty()) {
    CheckLink(in, "thermal_camera", model, sensors.thermal_camera_link);
  }
  if (!sensors.tray_laser_link.empty()) {
    CheckLink(in, "tray_laser", model, sensors.tray_laser_link);
  }
  if (!sensors.inertial_unit_link.empty()) {
    CheckLink(in, "inertial_unit", model, sensors.inertial_unit_link);
  }
  if (sensors.tilting_laser) {
    CheckTiltingLaser(in.Sub("tilting_laser"), *sensors.tilting_laser, model);
  }
}

}  // namespace hires::robot
