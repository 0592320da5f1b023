#include "skills/arm_planner.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "hires/robot/gripper.h"
#include "hires/robot/posture.h"

namespace hires::skills {
namespace {

using manipulation::ArmPathResult;
using manipulation::ArmPathStatus;
using manipulation::Touch;
using robot::Observation;

constexpr int kMaxTouches = 50;  // of one posture

bool IsNamed(const std::string& a, const std::string& b) {
  return base::ToLower(a) == base::ToLower(b);
}

/// What the object touches in this touch; empty if it takes no part.
std::string OtherOf(const Touch& touch, const std::string& object) {
  if (IsNamed(touch.a, object)) return touch.b;
  return IsNamed(touch.b, object) ? touch.a : "";
}

/// Joint positions on the straight way, both ends included, no joint moving more than `resolution`
/// from one to the next.
JointPath PointsBetween(const std::vector<double>& from, const std::vector<double>& to,
                        double resolution) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    farthest = std::max(farthest, std::abs(to[i] - from[i]));
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(farthest / resolution)));
  JointPath points;
  for (int step = 0; step <= steps; ++step) {
    const double share = static_cast<double>(step) / steps;
    std::vector<double> point;
    for (std::size_t i = 0; i < from.size(); ++i) {
      point.push_back((1.0 - share) * from[i] + share * to[i]);
    }
    points.push_back(std::move(point));
  }
  return points;
}

/// An arm's goal that is blocked is one of many postures: no way, rather than a blocked goal.
base::FailureCode CodeOf(ArmPathStatus status) {
  switch (status) {
    case ArmPathStatus::kStartBlocked:
      return base::FailureCode::kStartBlocked;
    case ArmPathStatus::kUnreachable:
      return base::FailureCode::kUnreachable;
    case ArmPathStatus::kGoalBlocked:
    case ArmPathStatus::kNoPath:
      return base::FailureCode::kNoPath;
    case ArmPathStatus::kFound:
      break;
  }
  HIRES_CHECK(false, "a way that was found is no failure");
}

}  // namespace

base::Failure FailureOf(const ArmPathResult& result) {
  return {CodeOf(result.status), result.obstruction.parts, result.obstruction.words};
}

base::Failure NoPath(const Touch& touch) {
  return {base::FailureCode::kNoPath, {touch.a, touch.b}, ToString(touch)};
}

std::vector<world::ObjectState> ObjectsOf(const Observation& observation) {
  std::vector<world::ObjectState> objects;
  for (const robot::SeenObject& seen : observation.objects) {
    world::ObjectState object;
    object.name = seen.name;
    object.model = seen.model;
    object.X_MO = seen.X_MO;
    object.attached_to = seen.attached_to;
    objects.push_back(std::move(object));
  }
  return objects;
}

ArmPlanner::ArmPlanner(const ManipulationContext& context, const std::string& arm,
                       const Observation& observation)
    : context_(context),
      arm_(arm),
      kinematics_(*context.arms.at(arm)),
      scene_(context.empty_scene->Clone()),
      links_(scene_.MovedBy(context.arm(arm).joints)),
      upper_body_(scene_.MovedBy({context.upper_body().torso_joint})),
      X_MB_(observation.X_MB),
      posture_(PostureOf(*context.robot, observation.joints)),
      start_(JointsOf(context.arm(arm).joints, posture_)) {
  SetObjects(ObjectsOf(observation));
}

void ArmPlanner::SetObjects(std::vector<world::ObjectState> objects) {
  objects_ = std::move(objects);
  scene_.SetObjects(objects_, X_MB_, posture_);
  upright_T_.reset();
  for (const world::ObjectState& object : objects_) {
    if (object.attached_to != profile().palm_link) continue;
    const geometry::Pose3 X_TM = X_MT(JointsOf(profile().joints, posture_)).Inverse();
    upright_T_ = X_TM.rotation * object.X_MO.rotation * Eigen::Vector3d::UnitZ();
  }
}

void ArmPlanner::SetGap(double gap) {
  robot::SetGap(context_.upper_body().gripper, profile(), gap, &posture_);
}

void ArmPlanner::SetArm(const std::vector<double>& joints) {
  SetJoints(profile().joints, joints, &posture_);
}

void ArmPlanner::AllowFingers(const std::string& object) {
  for (const auto& links : {profile().left_finger_links, profile().right_finger_links}) {
    for (const std::string& link : links) scene_.Allow(link, object);
  }
}

void ArmPlanner::AllowSupport(const std::string& object) {
  for (int i = 0; i < kMaxTouches; ++i) {
    const auto touch = scene_.FindTouch(X_MB_, posture_, links_);
    const std::string other = touch ? OtherOf(*touch, object) : "";
    const bool is_loose =
        std::any_of(objects_.begin(), objects_.end(),
                    [&](const world::ObjectState& loose) { return IsNamed(loose.name, other); });
    const std::optional<int> link = context_.robot->model.FindLink(other);
    const bool moves = link && upper_body_[static_cast<std::size_t>(*link)];
    if (other.empty() || is_loose || moves) return;
    scene_.Allow(object, other);
  }
}

void ArmPlanner::AllowSelfTouches(const std::vector<double>& joints) {
  const robot::RobotModel& model = context_.robot->model;
  for (int i = 0; i < kMaxTouches; ++i) {
    const auto touch = TouchAt(joints);
    if (!touch || !model.FindLink(touch->a) || !model.FindLink(touch->b)) return;
    scene_.Allow(touch->a, touch->b);
  }
}

void ArmPlanner::AllowSelfTouchesAlong(const std::vector<double>& from,
                                       const std::vector<double>& to) {
  const std::vector<double> goal = NearestTurn(context_.robot->model, profile().joints, to, from);
  for (const std::vector<double>& joints :
       PointsBetween(from, goal, context_.params.path.resolution)) {
    AllowSelfTouches(joints);
  }
}

geometry::Pose3 ArmPlanner::X_BT(const std::vector<double>& joints) const {
  return kinematics_.ToolPose(posture_, joints);
}

geometry::Pose3 ArmPlanner::X_MT(const std::vector<double>& joints) const {
  return geometry::Lift(X_MB_) * X_BT(joints);
}

std::vector<std::vector<double>> ArmPlanner::Inverse(const geometry::Pose3& X_MT,
                                                     const std::vector<double>& near,
                                                     std::uint64_t seed) const {
  return kinematics_.Solve(posture_, geometry::Lift(X_MB_).Inverse() * X_MT, near, seed,
                           context_.params.inverse);
}

manipulation::ArmScene ArmPlanner::SceneFrom(const std::vector<double>& joints) const {
  manipulation::ArmScene scene{&kinematics_, &scene_, X_MB_, posture_, upright_T_};
  SetJoints(profile().joints, joints, &scene.posture);
  return scene;
}

std::optional<Touch> ArmPlanner::TouchAt(const std::vector<double>& joints) const {
  return scene_.FindTouch(X_MB_, SceneFrom(joints).posture, links_);
}

ArmPathResult ArmPlanner::Way(const std::vector<double>& from, const std::vector<double>& to,
                              std::uint64_t seed) const {
  const std::vector<double> goal = NearestTurn(context_.robot->model, profile().joints, to, from);
  return manipulation::PlanArmPath(SceneFrom(from), {goal}, seed, context_.params.path);
}

ArmPathResult ArmPlanner::Straight(const std::vector<double>& from,
                                   const geometry::Pose3& X_MT) const {
  return manipulation::PlanStraight(SceneFrom(from), geometry::Lift(X_MB_).Inverse() * X_MT,
                                    context_.params.straight_step, context_.params.path);
}

std::optional<Touch> ArmPlanner::TouchAlong(const std::vector<std::string>& joints,
                                            const JointPath& path) const {
  const manipulation::LinkMask links = scene_.MovedBy(joints);
  robot::JointPositions posture = posture_;
  for (std::size_t leg = 1; leg < path.size(); ++leg) {
    for (const std::vector<double>& between :
         PointsBetween(path[leg - 1], path[leg], context_.params.path.resolution)) {
      SetJoints(joints, between, &posture);
      if (const auto touch = scene_.FindTouch(X_MB_, posture, links)) return touch;
    }
  }
  return std::nullopt;
}

}  // namespace hires::skills
