#include "hires/skills/head_aim.h"

#include <algorithm>
#include <cmath>

#include "hires/manipulation/arm_path.h"
#include "hires/robot/posture.h"
#include "skills/joint_motion.h"

namespace hires::skills {
namespace {

using Eigen::Vector3d;
using robot::Observation;

constexpr int kMaxTurns = 20;
constexpr double kAimed = 1e-4;  // [rad]

double Limited(const robot::RobotModel& model, const std::string& name, double position) {
  const robot::Joint* joint = robot::FindJoint(model, name);
  if (joint->type == robot::JointType::kContinuous) return position;
  return std::clamp(position, joint->limits->lower, joint->limits->upper);
}

/// [rad] by which the camera would have to turn left and down to have the point on its axis.
Eigen::Vector2d MissingTurn(const perception::CameraView& view, const Vector3d& p_M) {
  const Vector3d p_C = view.X_MC.Inverse() * p_M;
  return {std::atan2(p_C.y(), p_C.x()), -std::atan2(p_C.z(), std::hypot(p_C.x(), p_C.y()))};
}

/// From `lowest` to `highest`, both there and 0 between them, evenly on each side of it.
std::vector<double> Steps(double lowest, double highest, double spacing) {
  const auto number = [spacing](double length) {
    return std::max(1, static_cast<int>(std::ceil(length / spacing)));
  };
  std::vector<double> steps;
  const int below = number(-lowest), above = number(highest);
  for (int i = -below; i < 0; ++i) steps.push_back(-i * lowest / below);
  for (int i = 0; i <= above; ++i) steps.push_back(i * highest / above);
  return steps;
}

/// Rests for `dwell` after a motion.
class LookAndRest : public Activity {
 public:
  LookAndRest(std::unique_ptr<Activity> motion, double dwell)
      : motion_(std::move(motion)), dwell_(dwell) {}

  Status Update(const Observation& observation, robot::Command* command) override {
    if (motion_ != nullptr) {
      const Status status = motion_->Update(observation, command);
      if (status.progress != Progress::kSucceeded) return status;
      motion_.reset();
      rests_since_ = observation.time;
    }
    const bool is_over = observation.time - rests_since_ >= dwell_;
    return is_over ? Succeeded() : Status{};
  }

 private:
  std::unique_ptr<Activity> motion_;
  double dwell_;             // [s]
  double rests_since_{0.0};  // [s]
};

}  // namespace

std::optional<std::vector<double>> AimHead(const robot::Robot& robot, const geometry::Pose2& X_MB,
                                           const robot::JointPositions& posture,
                                           const Vector3d& p_M) {
  const robot::UpperBodyProfile& profile = *robot.profile.upper_body;
  const std::vector<std::string> joints{profile.head_pan_joint, profile.head_tilt_joint};
  robot::JointPositions aimed = posture;
  for (int turn = 0; turn < kMaxTurns; ++turn) {
    const Eigen::Vector2d missing = MissingTurn(perception::ViewOf(robot, X_MB, aimed), p_M);
    if (missing.norm() < kAimed) break;
    for (int i = 0; i < 2; ++i) {
      aimed[joints[i]] = Limited(robot.model, joints[i], aimed[joints[i]] + missing[i]);
    }
  }
  const Eigen::Vector2d missing = MissingTurn(perception::ViewOf(robot, X_MB, aimed), p_M);
  const bool is_in_view = std::abs(missing.x()) < profile.camera_width / 2 &&
                          std::abs(missing.y()) < profile.camera_height / 2;
  if (!is_in_view) return std::nullopt;
  return JointsOf(joints, aimed);
}

Beginning LookAtPoint(std::shared_ptr<const ManipulationContext> context,
                      const Observation& observation, const Vector3d& p_M) {
  const robot::UpperBodyProfile& profile = context->upper_body();
  const auto aim = AimHead(*context->robot, observation.X_MB,
                           PostureOf(*context->robot, observation.joints), p_M);
  if (!aim) return CannotBegin(base::FailureCode::kOutOfView);
  GroupTrajectories head{{"head", TrajectoryFrom(*context, observation,
                                                 {profile.head_pan_joint, profile.head_tilt_joint},
                                                 {*aim}, context->params.speed)}};
  const double dwell = context->params.look.dwell;
  return Begin(std::make_unique<LookAndRest>(
      std::make_unique<JointMotion>(std::move(context), std::move(head)), dwell));
}

bool IsLookedAt(const perception::CameraView& view, const Vector3d& p_M, double margin) {
  perception::CameraView inner = view;
  inner.width -= 2 * margin;
  inner.height -= 2 * margin;
  return inner.Contains(p_M);
}

std::vector<Vector3d> PointsOn(const geometry::Pose3& X_MF, const Eigen::AlignedBox2d& extent_F,
                               double spacing) {
  std::vector<Vector3d> points;
  for (const double x : Steps(extent_F.min().x(), extent_F.max().x(), spacing)) {
    for (const double y : Steps(extent_F.min().y(), extent_F.max().y(), spacing)) {
      points.push_back(X_MF * Vector3d(x, y, 0.0));
    }
  }
  // The middle first, then outwards: one look often does.
  std::stable_sort(points.begin(), points.end(), [&](const Vector3d& a, const Vector3d& b) {
    return (a - X_MF.translation).norm() < (b - X_MF.translation).norm() - 1e-9;
  });
  return points;
}

SweepPoints::SweepPoints(std::shared_ptr<const ManipulationContext> context,
                         std::vector<Vector3d> points_M)
    : context_(std::move(context)), left_M_(std::move(points_M)) {}

void SweepPoints::CrossOff(const Observation& observation) {
  const perception::CameraView view = perception::ViewOf(
      *context_->robot, observation.X_MB, PostureOf(*context_->robot, observation.joints));
  const double margin = context_->params.look.margin;
  left_M_.erase(std::remove_if(left_M_.begin(), left_M_.end(),
                               [&](const Vector3d& p_M) { return IsLookedAt(view, p_M, margin); }),
                left_M_.end());
}

Status SweepPoints::Update(const Observation& observation, robot::Command* command) {
  while (!left_M_.empty()) {
    if (look_ == nullptr) {
      Beginning look = LookAtPoint(context_, observation, left_M_.front());
      if (look.failure) return Failed(look.failure);
      look_ = std::move(look.activity);
    }
    const Status status = look_->Update(observation, command);
    if (status.progress != Progress::kSucceeded) return status;
    look_.reset();
    const std::size_t before = left_M_.size();
    CrossOff(observation);
    if (left_M_.size() == before) return Failed(base::FailureCode::kOutOfView);  // too near or far
  }
  return Succeeded();
}

}  // namespace hires::skills
