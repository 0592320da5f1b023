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

/// Means over the scans that both of two ways have poses for; 0 where there are none.
struct MeanShares {
  double a{0.0}, b{0.0};
};
/// @pre both are of the same scans
MeanShares MeanExplained(const ExplainedShares& a, const ExplainedShares& b);

/// The first pose of a path, and each one that is `distance` [m] or `turn` [rad] from the last that
/// was taken: views of their own, however long the robot stood somewhere.
TimedPath PosesApart(const TimedPath& path, double distance, double turn);

/// Which of two ways is the more likely one: that which explains more beams of the scans that both
/// have poses for; but none that has poses for less than half as many scans as the other.
/// @pre both are of the same scans
bool IsBetter(const ExplainedShares& a, const ExplainedShares& b);

/// Whether one way is so much better than the other that chance is no reason. Of the scans that
/// both have poses for it explains more beams, at least 0.5 % and more than 3 standard errors of
/// the mean; of fewer than 10 scans never. Or the other has poses for less than half as many scans:
/// a way that is right may lack some, too. Where each is the better one by one of these, neither
/// is. Scans of one view err alike and must not be counted as several.
/// @pre both are of the same scans
bool IsSignificantlyBetter(const ExplainedShares& a, const ExplainedShares& b);

/// Whether both ways say much the same, wherever both say something: in the median within 1 m and
/// 0.5 rad. In the middle of a room, what is turned by half is near, and heads elsewhere.
bool IsSameWay(const TimedPath& a, const TimedPath& b);

}  // namespace hires::localisation
