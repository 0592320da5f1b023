#pragma once

#include "hires/base/hash.h"
#include "hires/base/param_reader.h"
#include "hires/robot/robot_model.h"
#include "hires/robot/upper_body.h"

namespace hires::robot {

/// Reads key `upper_body` of a robot's YAML.  @throws base::ConfigError naming file and key.
UpperBodyProfile ReadUpperBody(base::ParamReader in);

/// Every name against the URDF, every posture against the limits.
/// @throws base::ConfigError naming file and key.
void CheckUpperBody(base::ParamReader in, const UpperBodyProfile& profile, const RobotModel& model);

/// @throws base::ConfigError naming file and key, if the robot has no such link.
void CheckLink(const base::ParamReader& in, const std::string& key, const RobotModel& model,
               const std::string& link);

void AddTo(base::Hasher* hash, const UpperBodyProfile& profile);

}  // namespace hires::robot
