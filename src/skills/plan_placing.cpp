#include <algorithm>
#include <cmath>
#include <set>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "skills/reach.h"
#include "skills/reach_search.h"

namespace hires::skills {
namespace {

using geometry::Pose3;
using manipulation::ArmPathResult;
using manipulation::ArmPathStatus;
using robot::Observation;

constexpr int kMaxPlacingInverses = 2;  // joint positions tried for one pose
// How far an attempt came.
enum PlacingStage {
  kPlacingNowhere,
  kPlacingInverse,
  kPlacingFree,
  kPlacingLower,
  kPlacingRetreat
};

/// Turns 0, +1, -1, +2, ... steps of a full circle in `count` steps [rad].
std::vector<double> TurnsFromMiddle(int count) {
  std::vector<double> turns;
  for (int i = 0; i < count; ++i) {
    const int steps = i % 2 == 0 ? -(i / 2) : (i + 1) / 2;
    turns.push_back(2.0 * geometry::kPi * steps / count);
  }
  return turns;
}

class PlacingSearch {
 public:
  PlacingSearch(const ManipulationContext& context, const std::string& arm,
                const Observation& observation, const robot::SeenObject& held, std::uint64_t seed)
      : context_(context),
        arm_(arm),
        observation_(observation),
        name_(held.name),
        seed_(seed),
        p_MShoulder_(ShoulderOf(context, arm, observation)),
        holding_(context, arm, observation),
        lowering_(context, arm, observation),
        leaving_(context, arm, observation),
        X_OT_(held.X_MO.Inverse() * holding_.X_MT(holding_.start())) {
    leaving_.SetGap(context.upper_body().gripper.max_gap);
    leaving_.AllowFingers(name_);
  }

  PlacePlan Find(const Pose3& X_MA, const FreeSpots& spots) {
    const int count =
        std::min(static_cast<int>(spots.spots_A.size()), context_.params.place.max_spots);
    for (int i = 0; i < count; ++i) {
      PlacePlan plan;
      const Eigen::Vector3d p_MO = X_MA * SpreadSpot(spots, i, count);
      if (TrySpot(p_MO, AttemptSeed(seed_, i), &plan)) return plan;
    }
    PlacePlan none;
    none.failure = WhyNone();
    return none;
  }

 private:
  /// The nearest spot first, then ones from the whole list: neighbours fail alike.
  static const Eigen::Vector3d& SpreadSpot(const FreeSpots& spots, int i, int count) {
    return spots.spots_A[spots.spots_A.size() * static_cast<std::size_t>(i) /
                         static_cast<std::size_t>(count)];
  }

  bool TrySpot(const Eigen::Vector3d& p_MO, std::uint64_t seed, PlacePlan* plan) {
    const Eigen::Vector3d way = p_MO - p_MShoulder_;
    const double ahead = std::atan2(way.y(), way.x());
    const double heading = HeadingOf(X_OT_.rotation);  // with the object at yaw 0
    for (const double turn : TurnsFromMiddle(context_.params.place.headings)) {
      const Pose3 X_MO{p_MO, geometry::RotationFromRpy(0.0, 0.0, ahead + turn - heading)};
      if (TryPose(X_MO, seed, plan)) return true;
    }
    return false;
  }

  bool TryPose(const Pose3& X_MO, std::uint64_t seed, PlacePlan* plan) {
    const PlaceParams& params = context_.params.place;
    const Pose3 X_MT = Raised(X_MO * X_OT_, params.release_height);
    const auto solutions = holding_.Inverse(Raised(X_MT, params.above), holding_.start(), seed);
    for (std::size_t i = 0; i < solutions.size() && i < kMaxPlacingInverses; ++i) {
      if (TryFrom(solutions[i], X_MO, X_MT, seed, plan)) return true;
    }
    return false;
  }

  bool TryFrom(const std::vector<double>& above, const Pose3& X_MO, const Pose3& X_MT,
               std::uint64_t seed, PlacePlan* plan) {
    if (const auto touch = holding_.TouchAt(above)) {
      NoteParts({touch->a, touch->b});
      failure_.Note(kPlacingInverse, NoPath(*touch));
      return false;
    }
    if (!Keep(Lower(above, X_MT, seed), kPlacingFree, &plan->lower) ||
        !Keep(Retreat(plan->lower.back(), X_MO, X_MT), kPlacingLower, &plan->retreat) ||
        !Keep(holding_.Way(holding_.start(), above, seed), kPlacingRetreat, &plan->reach)) {
      return false;
    }
    plan->X_BO = geometry::Lift(observation_.X_MB).Inverse() * X_MO;
    return true;
  }

  /// Down to the support, which the object may touch at the end.
  ArmPathResult Lower(const std::vector<double>& above, const Pose3& X_MT, std::uint64_t seed) {
    const auto low = lowering_.Inverse(X_MT, above, seed);
    if (low.empty()) return {ArmPathStatus::kUnreachable, {}, {}};
    lowering_.SetArm(low.front());
    lowering_.AllowSupport(name_);
    lowering_.SetArm(lowering_.start());
    return lowering_.Straight(above, X_MT);
  }

  ArmPathResult Retreat(const std::vector<double>& low, const Pose3& X_MO, const Pose3& X_MT) {
    std::vector<world::ObjectState> objects = holding_.objects();
    if (world::ObjectState* placed = FindObject(&objects, name_)) {
      placed->attached_to.clear();
      placed->X_MO = X_MO;
    }
    leaving_.SetObjects(std::move(objects));
    return leaving_.Straight(low, DrawnBack(X_MT, context_.params.place.retreat));
  }

  bool Keep(ArmPathResult result, PlacingStage came, JointPath* path) {
    if (result.status == ArmPathStatus::kFound) {
      *path = std::move(result.path);
      return true;
    }
    failure_.Note(came, FailureOf(result));
    NoteParts(result.obstruction.parts);
    return false;
  }

  /// Notes which loose object was in the way, or that something else was.
  void NoteParts(const std::vector<std::string>& parts) {
    std::vector<world::ObjectState> objects = holding_.objects();
    bool is_object = false;
    for (const std::string& name : parts) {
      if (base::ToLower(name) == base::ToLower(name_)) continue;
      if (FindObject(&objects, name) == nullptr) continue;
      in_the_way_.insert(base::ToLower(name));
      is_object = true;
    }
    only_objects_ = only_objects_ && is_object;
  }

  base::Failure WhyNone() const {
    if (in_the_way_.empty() || !only_objects_) return failure_.failure();
    return {base::FailureCode::kAreaOccupied, {in_the_way_.begin(), in_the_way_.end()}};
  }

  const ManipulationContext& context_;
  std::string arm_;
  const Observation& observation_;
  std::string name_;  // of what is held
  std::uint64_t seed_;
  Eigen::Vector3d p_MShoulder_;
  ArmPlanner holding_;   // object in the hand
  ArmPlanner lowering_;  // the same, the object may touch what it will stand on
  ArmPlanner leaving_;   // hand open, object standing
  Pose3 X_OT_;           // how the object lies in the hand
  BestFailure failure_{base::FailureCode::kUnreachable};
  std::set<std::string> in_the_way_;
  bool only_objects_{true};
};

}  // namespace

PlacePlan PlanPlacing(const ManipulationContext& context, const std::string& arm,
                      const Observation& observation, const robot::SeenObject& held,
                      const Pose3& X_MA, const FreeSpots& spots, std::uint64_t seed) {
  if (spots.spots_A.empty()) {
    PlacePlan none;
    none.failure = {base::FailureCode::kAreaOccupied, spots.occupants};
    return none;
  }
  return PlacingSearch(context, arm, observation, held, seed).Find(X_MA, spots);
}

}  // namespace hires::skills
