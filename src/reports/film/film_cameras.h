#pragma once

#include <optional>
#include <vector>

#include "hires/imagination/rollout_recording.h"
#include "hires/perception/pinhole_camera.h"

namespace hires::reports {

/// Which object of the recording the eye should follow: one that the action names, else the one
/// nearest to the place on the robot where things are put; nothing if there is none.
std::optional<int> LoadOf(const imagination::RolloutRecording& recording,
                          const geometry::Pose3& X_BO);

/// Beside the load, at each sample: drives along and turns with the robot until the load has left
/// it, then stands still and looks after the load.
/// @param X_BO  where an object is put, in the base frame; looked at where there is no load.
/// @pre the recording has samples.
std::vector<perception::PinholeCamera> CloseCameras(const imagination::RolloutRecording& recording,
                                                    std::optional<int> load,
                                                    const geometry::Pose3& X_BO, int width,
                                                    int height);

/// Looks down on everything that the base drives over.  @pre the recording has samples.
perception::PinholeCamera OverviewCamera(const imagination::RolloutRecording& recording, int width,
                                         int height);

}  // namespace hires::reports
