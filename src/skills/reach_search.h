#pragma once

#include <string>
#include <vector>

#include "skills/arm_planner.h"

namespace hires::skills {

/// Keeps the failure of the attempt that came farthest: what is told when all fail.
class BestFailure {
 public:
  explicit BestFailure(base::Failure failure) : failure_(std::move(failure)) {}
  void Note(int stage, const base::Failure& failure) {
    if (stage <= stage_) return;
    stage_ = stage;
    failure_ = failure;
  }
  const base::Failure& failure() const { return failure_; }

 private:
  int stage_{0};
  base::Failure failure_;
};

/// The object with that name in a list of objects.
world::ObjectState* FindObject(std::vector<world::ObjectState>* objects, const std::string& name);

/// Moved along W's z axis / back along its own x axis [m].
geometry::Pose3 Raised(geometry::Pose3 X_WT, double height);
geometry::Pose3 DrawnBack(const geometry::Pose3& X_WT, double distance);

/// Where the arm begins, in the map.
Eigen::Vector3d ShoulderOf(const ManipulationContext& context, const std::string& arm,
                           const robot::Observation& observation);

/// [rad] direction of the tool seen from above: of its x axis, or of its z axis where the tool
/// points down.
double HeadingOf(const Eigen::Quaterniond& R_WT);

}  // namespace hires::skills
