#pragma once

#include <optional>
#include <vector>

#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// Of each scan that is compared, the share in [0, 1] of its beams that a way explains; nothing:
/// the way has no pose for that scan.
using ExplainedShares = std::vector<std::optional<double>>;

/// The pose for exactly that time; null: there is none.
const TimedPose* PoseAt(const TimedPath& path, double time);

double MeanExplained(const ExplainedShares& shares);

/// The first pose of a path, and each one that is `distance` [m] or `turn` [rad] from the last that
/// was taken: views of their own, however long the robot stood somewhere.
TimedPath PosesApart(const TimedPath& path, double distance, double turn);

/// Whether one way explains so many more beams than the other that chance is no reason: at least
/// 1 %, and more than 3 standard errors of the mean over the scans; of fewer than 10 scans never.
/// Scans of one view err alike and must not be counted as several.
/// @pre both are of the same scans
bool IsSignificantlyBetter(const ExplainedShares& a, const ExplainedShares& b);

/// Whether both ways say much the same, wherever both say something: in the median within 1 m and
/// 0.5 rad. In the middle of a room, what is turned by half is near, and heads elsewhere.
bool IsSameWay(const TimedPath& a, const TimedPath& b);

}  // namespace hires::localisation
