#pragma once

#include <memory>
#include <string>

#include "hires/imagination/rollout_recording.h"

namespace hires_ros {

/// Writes one rollout to a bag as a robot's topics would carry it, by the names of a PR2: `/tf`,
/// `/tf_static`, `/joint_states`, `/base_odometry/odom`; beside them `/rollout/markers`,
/// `/world_markers`, `/rollout/{speed,acceleration,jerk}`, `/rollout/tilt/<object>` and
/// `/rollout/events`. Stamps are the recording's times. No master is needed. The file gets its name
/// when it is complete.
std::unique_ptr<hires::imagination::RolloutSaver> MakeRolloutBag(
    const std::string& path, const hires::imagination::RolloutSetup& setup);

}  // namespace hires_ros
