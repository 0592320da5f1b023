#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/skills/grasp_quality.h"
#include "skills/posture_skills.h"
#include "skills/reach.h"
#include "skills/reach_search.h"

namespace hires::skills {
namespace {

using geometry::Pose3;
using manipulation::ArmPathResult;
using manipulation::ArmPathStatus;
using manipulation::Grasp;
using robot::Observation;

constexpr double kHeadingWeight = 0.3;  // quality that a grasp from behind loses
constexpr int kMaxInverses = 3;         // joint positions tried for one grasp
// How far an attempt came.
enum Came { kNowhere, kInverse, kFree, kApproach, kLift };

/// [rad] Tilt of an object with this grasp, the arm beside the body.
double TiltBesideBody(const ArmPlanner& planner, const Grasp& grasp) {
  const std::vector<double>& beside = PosturePositions(planner.profile(), "armtosideposture", true);
  return geometry::TiltOf(planner.X_BT(beside).rotation * grasp.X_OT.rotation.inverse());
}

/// Those that keep the object upright, best first.
std::vector<Grasp> UsefulGrasps(const ArmPlanner& planner, const world::ObjectState& object,
                                const Eigen::Vector3d& p_MShoulder) {
  const ManipulationContext& context = planner.context();
  const Eigen::Vector3d way = object.X_MO.translation - p_MShoulder;
  const double straight_ahead = std::atan2(way.y(), way.x());
  std::vector<std::pair<double, Grasp>> scored;
  const auto model = context.world->RequireModel(object.model);
  for (const Grasp& grasp : manipulation::GraspsFor(*model, context.upper_body().gripper)) {
    if (TiltBesideBody(planner, grasp) > context.params.path.max_held_tilt) continue;
    const double heading = HeadingOf((object.X_MO * grasp.X_OT).rotation);
    const double turn = std::abs(geometry::WrapToPi(heading - straight_ahead)) / geometry::kPi;
    scored.emplace_back(grasp.quality - kHeadingWeight * turn, grasp);
  }
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Grasp> grasps;
  for (auto& [score, grasp] : scored) grasps.push_back(std::move(grasp));
  return grasps;
}

/// The search for one object; each planner knows one state of hand and object.
class GraspSearch {
 public:
  GraspSearch(const ManipulationContext& context, const std::string& arm,
              const Observation& observation, const world::ObjectState& object, std::uint64_t seed)
      : context_(context),
        object_(object),
        seed_(seed),
        free_(context, arm, observation),
        touching_(context, arm, observation),
        lifting_(context, arm, observation) {
    std::vector<world::ObjectState> objects = free_.objects();
    if (world::ObjectState* known = FindObject(&objects, object.name)) *known = object;
    for (ArmPlanner* planner : {&free_, &touching_}) {
      planner->SetGap(context.upper_body().gripper.max_gap);
      planner->SetObjects(objects);
    }
    touching_.AllowFingers(object.name);
  }

  GraspPlan Find(const Eigen::Vector3d& p_MShoulder) {
    const std::vector<Grasp> grasps = UsefulGrasps(free_, object_, p_MShoulder);
    const int count = std::min(static_cast<int>(grasps.size()), context_.params.pick.max_grasps);
    for (int i = 0; i < count; ++i) {
      GraspPlan plan;
      plan.grasp = grasps[static_cast<std::size_t>(i)];
      if (Try(AttemptSeed(seed_, i), &plan)) return plan;
    }
    GraspPlan none;
    none.failure = failure_.failure();
    return none;
  }

 private:
  bool Try(std::uint64_t seed, GraspPlan* plan) {
    const Pose3 X_MT = object_.X_MO * plan->grasp.X_OT;
    const auto solutions =
        free_.Inverse(DrawnBack(X_MT, plan->grasp.approach), free_.start(), seed);
    for (std::size_t i = 0; i < solutions.size() && i < kMaxInverses; ++i) {
      if (TryFrom(solutions[i], X_MT, seed, plan)) return true;
    }
    return false;
  }

  bool TryFrom(const std::vector<double>& before, const Pose3& X_MT, std::uint64_t seed,
               GraspPlan* plan) {
    if (const auto touch = free_.TouchAt(before)) {
      failure_.Note(kInverse, NoPath(*touch));
      return false;
    }
    return Keep(touching_.Straight(before, X_MT), kFree, &plan->approach) &&
           Keep(Lift(plan->approach.back(), X_MT), kApproach, &plan->lift) &&
           Keep(free_.Way(free_.start(), before, seed), kLift, &plan->reach);
  }

  ArmPathResult Lift(const std::vector<double>& grasping, const Pose3& X_MT) {
    lifting_.SetGap(context_.upper_body().gripper.max_gap);
    lifting_.SetArm(grasping);
    std::vector<world::ObjectState> objects = free_.objects();
    if (world::ObjectState* held = FindObject(&objects, object_.name)) {
      held->attached_to = lifting_.profile().palm_link;
    }
    lifting_.SetObjects(std::move(objects));
    lifting_.AllowSupport(object_.name);
    return lifting_.Straight(grasping, Raised(X_MT, context_.params.pick.lift));
  }

  bool Keep(ArmPathResult result, Came came, JointPath* path) {
    if (result.status != ArmPathStatus::kFound) {
      failure_.Note(came, FailureOf(result));
      return false;
    }
    *path = std::move(result.path);
    return true;
  }

  const ManipulationContext& context_;
  world::ObjectState object_;
  std::uint64_t seed_;
  ArmPlanner free_;      // hand open, object standing
  ArmPlanner touching_;  // the same, fingers may touch it
  ArmPlanner lifting_;   // object in the hand
  BestFailure failure_{base::FailureCode::kUnreachable};
};

}  // namespace

GraspPlan PlanGrasp(const ManipulationContext& context, const std::string& arm,
                    const Observation& observation, const world::ObjectState& object,
                    std::uint64_t seed) {
  return GraspSearch(context, arm, observation, object, seed)
      .Find(ShoulderOf(context, arm, observation));
}

std::optional<double> GraspQuality(const ManipulationContext& context, const std::string& arm,
                                   const Observation& observation, const world::ObjectState& object,
                                   std::uint64_t seed) {
  Observation seen = observation;
  if (FindSeen(seen, object.name) == nullptr)
    seen.objects.push_back({object.name, object.model, object.X_MO, seen.time, ""});
  const GraspPlan plan = PlanGrasp(context, arm, seen, object, seed);
  if (plan.failure) return std::nullopt;
  return plan.grasp.quality;
}

}  // namespace hires::skills
