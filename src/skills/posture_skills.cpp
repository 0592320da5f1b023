#include "skills/posture_skills.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/manipulation/arm_path.h"
#include "hires/robot/posture.h"
#include "skills/joint_motion.h"

namespace hires::skills {
namespace {

using robot::Observation;
using Context = std::shared_ptr<const ManipulationContext>;

const char kLeft[] = "leftarm1";
const char kRight[] = "rightarm1";
const char kTucked[] = "armtuckedposture";
const char kUnTucked[] = "armuntuckedposture";
const char kToSide[] = "armtosideposture";
const char kCarry[] = "armcarryposture";

// [rad] sums over an arm's joints below which it counts as folded or opened, as the PR2's tuck_arms
// counts.
constexpr double kTuckedError = 0.1;
constexpr double kUnTuckedError = 0.3;
constexpr double kInPosture = 0.3;  // [rad] the same sum, for any posture

template <typename T>
const T& Named(const std::map<std::string, T>& known, const char* kind, const std::string& name) {
  const auto found = known.find(base::ToLower(name));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : known) names.push_back(entry.first);
  throw base::ConfigError(base::UnknownName(kind, name, names));
}

void RequireArm(const ManipulationContext& context, const std::string& arm,
                const std::vector<std::string>& postures,
                const std::vector<std::string>& way_points) {
  const robot::ArmProfile& profile = Named(context.upper_body().arms, "arm", arm);
  for (const std::string& posture : postures) Named(profile.postures, "posture", posture);
  for (const std::string& point : way_points) Named(profile.way_points, "way point", point);
}

Stage ArmStage(const Context& context, const std::string& name, const ArmMove& move) {
  return {name, [=](const Observation& seen) { return MoveArmTo(context, move, seen); }, {}};
}

/// [rad] sum of the joints' distances.
double ErrorTo(const robot::Robot& robot, const robot::ArmProfile& arm,
               const std::vector<double>& wanted, const std::vector<double>& now) {
  const std::vector<double> goal = NearestTurn(robot.model, arm.joints, wanted, now);
  double sum = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) sum += std::abs(goal[i] - now[i]);
  return sum;
}

bool IsIn(const ManipulationContext& context, const std::string& arm, const std::string& posture,
          const Observation& seen) {
  const double largest = posture == kTucked ? kTuckedError : kUnTuckedError;
  return PostureError(*context.robot, context.arm(arm), posture, seen.joints) <= largest;
}

/// One motion of a folding sequence.
struct Fold {
  const char* arm;
  const char* to;  ///< way point or posture
};

/// The order in which arms get from what they are in to their goals.
std::vector<Fold> FoldingSequence(const ManipulationContext& context, const Observation& seen,
                                  const std::string& left_goal, const std::string& right_goal) {
  const bool left_stays = IsIn(context, kLeft, left_goal, seen);
  const bool right_stays = IsIn(context, kRight, right_goal, seen);
  if (left_stays && right_stays) return {};
  std::vector<Fold> folds;
  const bool right_is_tucked = IsIn(context, kRight, kTucked, seen);
  if (!left_stays || right_is_tucked) folds.push_back({kRight, "up"});
  if (!left_stays) {
    if (left_goal == kTucked && !IsIn(context, kLeft, kUnTucked, seen)) {
      folds.push_back({kLeft, "clear"});
    }
    folds.push_back({kLeft, left_goal == kTucked ? kTucked : kUnTucked});
  }
  if (right_goal == kTucked) {
    folds.push_back({kRight, "clear"});
    folds.push_back({kRight, "approach"});
  }
  folds.push_back({kRight, right_goal == kTucked ? kTucked : kUnTucked});
  return folds;
}

const std::vector<double>& FoldGoal(const ManipulationContext& context, const Fold& fold,
                                    bool holds) {
  const robot::ArmProfile& arm = context.arm(fold.arm);
  const auto way_point = arm.way_points.find(fold.to);
  return way_point == arm.way_points.end() ? PosturePositions(arm, fold.to, holds)
                                           : way_point->second;
}

/// Whether an arm is where folding and opening pass: from there to there the straight way is free.
bool IsFolding(const ManipulationContext& context, const std::string& arm,
               const Observation& seen) {
  const robot::ArmProfile& profile = context.arm(arm);
  const std::vector<double> now = JointsOf(profile.joints, seen.joints);
  for (const auto& [name, positions] : profile.way_points) {
    if (ErrorTo(*context.robot, profile, positions, now) <= kTuckedError) return true;
  }
  return IsIn(context, arm, kTucked, seen) || IsIn(context, arm, kUnTucked, seen);
}

/// The first motion of an arm begins where the arm is now, the later ones where it was led.
std::vector<Stage> FoldingStages(const Context& context, const std::vector<Fold>& folds,
                                 const Observation& seen, std::uint64_t seed) {
  std::map<std::string, bool> is_folding{{kLeft, IsFolding(*context, kLeft, seen)},
                                         {kRight, IsFolding(*context, kRight, seen)}};
  std::vector<Stage> stages;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const bool holds = HeldBy(context->arm(folds[i].arm), seen) != nullptr;
    const bool is_last = i + 1 == folds.size();
    const ArmMove move{
        folds[i].arm, FoldGoal(*context, folds[i], holds), AttemptSeed(seed, static_cast<int>(i)),
        is_last ? MotionEnd::kSettled : MotionEnd::kPassing, is_folding[folds[i].arm]};
    is_folding[folds[i].arm] = true;
    stages.push_back(ArmStage(context, fmt::format("{}_{}", folds[i].arm, folds[i].to), move));
  }
  return stages;
}

/// Columns `first` .. `first + count - 1` of a trajectory of several arms.
robot::JointTrajectory Columns(const robot::JointTrajectory& both, std::size_t first,
                               std::size_t count) {
  const auto cut = [&](const std::vector<double>& row) {
    if (row.empty()) return row;
    const auto begin = row.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  robot::JointTrajectory part;
  const auto begin = both.joints.begin() + static_cast<std::ptrdiff_t>(first);
  part.joints.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
  for (const robot::TrajectoryPoint& point : both.points) {
    part.points.push_back({point.time, cut(point.positions), cut(point.velocities)});
  }
  return part;
}

const std::vector<double>& CarryGoal(const ManipulationContext& context, const std::string& arm,
                                     const Observation& seen) {
  const robot::ArmProfile& profile = context.arm(arm);
  return PosturePositions(profile, kCarry, HeldBy(profile, seen) != nullptr);
}

std::vector<double> Joined(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Both arms to the carry posture at once, if nothing is in the way.
Beginning CarryTogether(const Context& context, const Observation& seen) {
  if (base::Failure unknown = WhyNotKnown(*context, seen); unknown) {
    return CannotBegin(unknown);
  }
  const std::vector<std::string>& left = context->arm(kLeft).joints;
  std::vector<std::string> joints = left;
  const std::vector<std::string>& right = context->arm(kRight).joints;
  joints.insert(joints.end(), right.begin(), right.end());
  const robot::JointPositions now = PostureOf(*context->robot, seen.joints);
  const std::vector<double> start = JointsOf(joints, now);
  const std::vector<double> goal = NearestTurn(
      context->robot->model, joints,
      Joined(CarryGoal(*context, kLeft, seen), CarryGoal(*context, kRight, seen)), start);
  const ArmPlanner planner(*context, kRight, seen);
  if (const auto touch = planner.TouchAlong(joints, {start, goal})) {
    return CannotBegin(NoPath(*touch));
  }
  const robot::JointTrajectory both =
      manipulation::TimePath(*context->robot, joints, {start, goal}, context->params.speed);
  return Begin(std::make_unique<JointMotion>(
      context, GroupTrajectories{{kLeft, Columns(both, 0, left.size())},
                                 {kRight, Columns(both, left.size(), right.size())}}));
}

/// The variant of a posture that an arm is in, holding or not.
std::optional<std::vector<double>> VariantOf(const robot::Robot& robot,
                                             const robot::ArmProfile& arm,
                                             const std::vector<double>& now) {
  std::optional<std::vector<double>> nearest;
  double least = kInPosture;
  const auto look_at = [&](const std::vector<double>& variant) {
    const double error = ErrorTo(robot, arm, variant, now);
    if (error > least) return;
    least = error;
    nearest = variant;
  };
  for (const auto& [name, variants] : arm.postures) {
    for (const std::vector<double>& variant : variants) look_at(variant);
  }
  for (const auto& [name, variant] : arm.holding_postures) look_at(variant);
  return nearest;
}

}  // namespace

robot::JointPositions DrivingJoints(const robot::Robot& robot,
                                    const robot::JointPositions& measured) {
  robot::JointPositions joints = robot.profile.joints;
  const robot::JointPositions posture = PostureOf(robot, measured);
  for (const auto& [name, arm] : robot.profile.upper_body->arms) {
    const std::vector<double> now = JointsOf(arm.joints, posture);
    SetJoints(arm.joints, VariantOf(robot, arm, now).value_or(now), &joints);
  }
  return joints;
}

const std::vector<double>& PosturePositions(const robot::ArmProfile& arm,
                                            const std::string& posture, bool holds) {
  if (holds) {
    const auto holding = arm.holding_postures.find(base::ToLower(posture));
    if (holding != arm.holding_postures.end()) return holding->second;
  }
  return Named(arm.postures, "posture", posture).front();
}

double PostureError(const robot::Robot& robot, const robot::ArmProfile& arm,
                    const std::string& posture, const robot::JointPositions& joints) {
  const std::vector<double> now = JointsOf(arm.joints, joints);
  double least = 1e9;
  for (const std::vector<double>& variant : Named(arm.postures, "posture", posture)) {
    least = std::min(least, ErrorTo(robot, arm, variant, now));
  }
  return least;
}

Beginning MoveArmTo(Context context, const ArmMove& move, const Observation& observation) {
  if (base::Failure unknown = WhyNotKnown(*context, observation); unknown) {
    return CannotBegin(unknown);
  }
  ArmPlanner planner(*context, move.arm, observation);
  planner.AllowSelfTouches(planner.start());
  planner.AllowSelfTouches(move.goal);
  if (move.is_makers_way) planner.AllowSelfTouchesAlong(planner.start(), move.goal);
  const manipulation::ArmPathResult way = planner.Way(planner.start(), move.goal, move.seed);
  if (way.status != manipulation::ArmPathStatus::kFound) return CannotBegin(FailureOf(way));
  robot::JointTrajectory trajectory = TrajectoryFrom(
      *context, observation, context->arm(move.arm).joints, way.path, context->params.speed);
  return Begin(
      std::make_unique<JointMotion>(context, GroupTrajectories{{move.arm, trajectory}}, move.end));
}

double TorsoHeight(const ManipulationContext& context, const std::string& posture) {
  return Named(context.upper_body().torso_postures, "torso posture", posture);
}

Stage TorsoStage(Context context, const std::string& name, double height) {
  return {
      name,
      [context, height](const Observation& seen) {
        const std::string& joint = context->upper_body().torso_joint;
        return Begin(std::make_unique<JointMotion>(
            context, GroupTrajectories{{"torso", TrajectoryFrom(*context, seen, {joint}, {{height}},
                                                                context->params.speed)}}));
      },
      {}};
}

MoveTorso::MoveTorso(Context context, const base::ActionCall& /*action*/,
                     const std::string& posture)
    : StagedSkill(context->params.period) {
  Append(TorsoStage(context, "move_torso", TorsoHeight(*context, posture)));
}

TuckArms::TuckArms(Context context, const base::ActionCall& action, const std::string& left_goal,
                   const std::string& right_goal)
    : StagedSkill(context->params.period) {
  const std::map<std::string, int> goals{{kTucked, 0}, {kUnTucked, 0}};
  Named(goals, "goal of an arm", left_goal);
  Named(goals, "goal of an arm", right_goal);
  RequireArm(*context, kLeft, {kTucked, kUnTucked}, {"clear"});
  RequireArm(*context, kRight, {kTucked, kUnTucked}, {"up", "clear", "approach"});
  const std::uint64_t seed = SeedOf(context->params, action);
  const std::string left = base::ToLower(left_goal), right = base::ToLower(right_goal);
  Append({"choose_order",
          [this, context, seed, left, right](const Observation& seen) {
            Insert(
                FoldingStages(context, FoldingSequence(*context, seen, left, right), seen, seed));
            return NothingToDo();
          },
          {}});
}

MoveArmToSide::MoveArmToSide(Context context, const base::ActionCall& action,
                             const std::string& arm)
    : StagedSkill(context->params.period) {
  RequireArm(*context, arm, {kToSide}, {});
  const std::string name = base::ToLower(arm);
  const std::uint64_t seed = SeedOf(context->params, action);
  Append(
      {"to_side",
       [context, name, seed](const Observation& seen) {
         const robot::ArmProfile& profile = context->arm(name);
         const bool holds = HeldBy(profile, seen) != nullptr;
         return MoveArmTo(context, {name, PosturePositions(profile, kToSide, holds), seed}, seen);
       },
       {}});
}

MoveArmsToCarryPosture::MoveArmsToCarryPosture(Context context, const base::ActionCall& action)
    : StagedSkill(context->params.period) {
  RequireArm(*context, kLeft, {kCarry}, {});
  RequireArm(*context, kRight, {kCarry}, {"above"});
  const std::uint64_t seed = SeedOf(context->params, action);
  Append(ArmStage(context, "above",
                  {kRight, context->arm(kRight).way_points.at("above"), AttemptSeed(seed, 0),
                   MotionEnd::kPassing}));
  Append({"carry",
          [this, context, seed](const Observation& seen) {
            Beginning together = CarryTogether(context, seen);
            if (!together.failure) return together;
            Insert({ArmStage(context, "carry_left",
                             {kLeft, CarryGoal(*context, kLeft, seen), AttemptSeed(seed, 1),
                              MotionEnd::kPassing}),
                    ArmStage(context, "carry_right",
                             {kRight, CarryGoal(*context, kRight, seen), AttemptSeed(seed, 2)})});
            return NothingToDo();
          },
          {}});
}

}  // namespace hires::skills
