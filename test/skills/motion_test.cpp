// Stages, motions of joints and of grippers, against a robot that does exactly what a test says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/geometry/angles.h"
#include "hires/robot/posture.h"
#include "hires/skills/activity.h"
#include "restaurant.h"
#include "skills/joint_motion.h"

namespace hires::skills::motion_test {
namespace {

using test_support::TheRestaurant;
using test_support::UpperBody;
using Code = base::FailureCode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::shared_ptr<const ManipulationContext>& Context() {
  return TheRestaurant().skills.manipulation;
}

/// Succeeds at its n-th update, or fails there.
class Countdown : public Activity {
 public:
  Countdown(int updates, base::Failure failure) : left_(updates), failure_(std::move(failure)) {}
  Status Update(const robot::Observation&, robot::Command*) override {
    if (--left_ > 0) return {};
    return failure_ ? Failed(failure_) : Succeeded();
  }

 private:
  int left_;
  base::Failure failure_;
};

Stage Counting(const std::string& name, int updates, const base::Failure& failure = {}) {
  return {name,
          [=](const robot::Observation&) {
            return Begin(std::make_unique<Countdown>(updates, failure));
          },
          {}};
}

class Staged : public StagedSkill {
 public:
  Staged() : StagedSkill(0.1) {}
  using StagedSkill::Append;
  std::vector<Stage> tidying;
  std::string failed_stage;

 protected:
  std::vector<Stage> AfterFailure(const std::string& stage, const robot::Observation&) override {
    failed_stage = stage;
    return tidying;
  }
};

/// Phases by cycle, the status of the last one.
std::vector<std::string> PhasesOf(Staged* skill, Status* status) {
  std::vector<std::string> phases;
  for (int i = 0; i < 20 && status->progress == Progress::kRunning; ++i) {
    robot::Command command;
    *status = skill->Update({}, &command);
    phases.push_back(skill->phase());
  }
  return phases;
}

TEST(StagedSkillTest, StagesFollowEachOtherWithinACycle) {
  Staged skill;
  skill.Append(Counting("first", 2));
  skill.Append({"nothing", [](const robot::Observation&) { return NothingToDo(); }, {}});
  skill.Append(Counting("second", 2));
  Status status;
  EXPECT_THAT(PhasesOf(&skill, &status), ElementsAre("first", "second", "second"));
  EXPECT_EQ(status.progress, Progress::kSucceeded);
}

TEST(StagedSkillTest, FailsWithTheReasonOfTheFirstStageThatFailedAfterTidyingUp) {
  Staged skill;
  skill.Append(Counting("first", 1, Code::kObjectSlipped));
  skill.Append(Counting("never", 1));
  skill.tidying = {Counting("tidy", 2), Counting("tidy_too", 1, Code::kTimedOut)};
  Status status;
  EXPECT_THAT(PhasesOf(&skill, &status), ElementsAre("tidy", "tidy_too"));
  EXPECT_EQ(status.progress, Progress::kFailed);
  EXPECT_EQ(ToString(status.failure), "object_slipped");
  EXPECT_EQ(skill.failed_stage, "first");
}

TEST(StagedSkillTest, AStageThatCannotBeginFails) {
  Staged skill;
  skill.Append(
      {"plan", [](const robot::Observation&) { return CannotBegin(Code::kUnreachable); }, {}});
  Status status;
  PhasesOf(&skill, &status);
  EXPECT_EQ(ToString(status.failure), "unreachable");
}

TEST(StagedSkillTest, AWatchedStageFailsAsSoonAsItsWatchSaysSo) {
  Staged skill;
  Stage stage = Counting("carry", 100);
  int looks = 0;
  stage.watch = [&](const robot::Observation&) -> base::Failure {
    return ++looks < 3 ? base::Failure() : Code::kObjectSlipped;
  };
  skill.Append(stage);
  Status status;
  EXPECT_EQ(PhasesOf(&skill, &status).size(), 3u);
  EXPECT_EQ(ToString(status.failure), "object_slipped");
}

// ---------------------------------------------------------------------------------------- joints

robot::Observation Standing(double time = 0.0) {
  robot::Observation seen;
  seen.time = time;
  seen.joints = PostureOf(*Context()->robot, Context()->robot->profile.joints);
  return seen;
}

robot::JointTrajectory HeadTo(double pan) {
  return TrajectoryFrom(*Context(), Standing(), {UpperBody().head_pan_joint}, {{pan}}, 1.0);
}

TEST(JointMotionTest, SendsItsTrajectoryOnceAndSucceedsWhenItsEndHasSettled) {
  JointMotion motion(Context(), {{"head", HeadTo(1.0)}});
  const double duration = HeadTo(1.0).duration();
  ASSERT_GT(duration, 0.5);
  int sent = 0;
  double ended = -1.0;
  for (int cycle = 0; cycle < 200 && ended < 0.0; ++cycle) {
    robot::Observation seen = Standing(0.05 * cycle);
    if (seen.time >= duration) seen.joints[UpperBody().head_pan_joint] = 1.0;
    robot::Command command;
    const Status status = motion.Update(seen, &command);
    sent += static_cast<int>(command.trajectories.size());
    if (status.progress == Progress::kSucceeded) ended = seen.time;
  }
  EXPECT_EQ(sent, 1);
  const double settling = Context()->params.goal.settling_time;
  EXPECT_GE(ended, duration + settling);
  EXPECT_LE(ended, duration + settling + 0.1);
}

/// What looks around while no action needs the head may turn it before it has heard of one.
TEST(JointMotionTest, AHeadThatAnotherHasTurnedMeanwhileIsTurnedAgain) {
  JointMotion motion(Context(), {{"head", HeadTo(1.0)}});
  const std::string& pan = UpperBody().head_pan_joint;
  double head = Standing().joints.at(pan);
  std::vector<double> sent;  // [s]
  Status status;
  for (int cycle = 0; cycle < 200 && status.progress == Progress::kRunning; ++cycle) {
    robot::Observation seen = Standing(0.05 * cycle);
    seen.joints[pan] = head;
    robot::Command command;
    status = motion.Update(seen, &command);
    if (command.trajectories.empty()) continue;
    sent.push_back(seen.time);
    const auto& trajectory = command.trajectories.at("head");
    EXPECT_NEAR(trajectory.points.front().positions.at(0), head, 1e-9) << "from where it is";
    head = sent.size() == 1 ? -0.5 : trajectory.points.back().positions.at(0);
  }
  EXPECT_EQ(ToString(status.failure), "");
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_NEAR(sent[1], HeadTo(1.0).duration() + 1.0, 0.1);
}

TEST(JointMotionTest, TimesOutWhenTheJointsDoNotCome) {
  JointMotion motion(Context(), {{"head", HeadTo(1.0)}});
  Status status;
  double time = 0.0;
  for (; status.progress == Progress::kRunning && time < 100.0; time += 0.05) {
    robot::Command command;
    status = motion.Update(Standing(time), &command);
  }
  EXPECT_EQ(ToString(status.failure), "timed_out");
  const JointGoalParams& goal = Context()->params.goal;
  EXPECT_NEAR(time, goal.time_limit_factor * HeadTo(1.0).duration() + goal.time_limit_surplus,
              0.15);
}

TEST(JointMotionTest, AFullTurnOfAnEndlessJointIsNoError) {
  const std::string joint = "r_wrist_roll_joint";
  robot::Observation seen = Standing();
  const double now = seen.joints.at(joint);
  JointMotion motion(Context(), {{"rightarm1", {{joint}, {{0.0, {now + 2 * geometry::kPi}, {}}}}}},
                     MotionEnd::kPassing);
  robot::Command command;
  EXPECT_EQ(motion.Update(seen, &command).progress, Progress::kSucceeded);
}

TEST(TrajectoryFromTest, BeginsWhereTheJointsAre) {
  robot::Observation seen = Standing();
  seen.joints[UpperBody().head_pan_joint] = 0.7;
  const robot::JointTrajectory trajectory =
      TrajectoryFrom(*Context(), seen, {UpperBody().head_pan_joint}, {{0.69}, {0.2}, {-0.5}}, 1.0);
  EXPECT_NEAR(trajectory.points.front().positions.front(), 0.7, 1e-9);
  EXPECT_NEAR(trajectory.points.back().positions.front(), -0.5, 1e-9);
}

// -------------------------------------------------------------------------------------- grippers

/// Runs a gripper's motion, the gap as `gap_at` says.
Status RunGripper(Activity* motion, const std::function<double(double)>& gap_at, double* ended,
                  robot::Command* first) {
  Status status;
  for (int cycle = 0; cycle < 200 && status.progress == Progress::kRunning; ++cycle) {
    robot::Observation seen = Standing(0.05 * cycle);
    seen.joints["r_gripper_joint"] = gap_at(seen.time);
    robot::Command command;
    status = motion->Update(seen, &command);
    if (cycle == 0) *first = command;
    *ended = seen.time;
  }
  return status;
}

TEST(GripperMotionTest, ClosingEndsWhereTheFingersComeToRest) {
  const auto motion = GripperMotion::Close(Context(), "rightarm1");
  double ended = 0.0;
  robot::Command first;
  const auto on_a_mug = [](double time) { return std::max(0.08, 0.09 - 0.05 * time); };
  EXPECT_EQ(RunGripper(motion.get(), on_a_mug, &ended, &first).progress, Progress::kSucceeded);
  EXPECT_EQ(first.grippers.at("rightarm1").gap, 0.0);
  EXPECT_EQ(first.grippers.at("rightarm1").max_effort, UpperBody().gripper.force);
  EXPECT_NEAR(ended, 0.2 + Context()->params.gripper.rest_time, 0.1);
}

TEST(GripperMotionTest, FingersThatHaveNotHeardYetAreNotTakenForClosed) {
  const auto motion = GripperMotion::Close(Context(), "rightarm1");
  double ended = 0.0;
  robot::Command first;
  const auto late = [](double time) {
    return time < 0.5 ? 0.09 : std::max(0.0, 0.115 - 0.05 * time);
  };
  EXPECT_EQ(RunGripper(motion.get(), late, &ended, &first).progress, Progress::kSucceeded);
  EXPECT_GT(ended, 2.0);
}

TEST(GripperMotionTest, OpeningEndsWhenTheGapIsWide) {
  const auto motion = GripperMotion::Open(Context(), "rightarm1");
  double ended = 0.0;
  robot::Command first;
  const auto opens = [](double time) { return std::min(0.09, 0.05 * time); };
  EXPECT_EQ(RunGripper(motion.get(), opens, &ended, &first).progress, Progress::kSucceeded);
  EXPECT_EQ(first.grippers.at("rightarm1").gap, 0.09);
  EXPECT_NEAR(ended, 1.75, 0.1);
}

TEST(GripperMotionTest, AGripperThatJamsTimesOut) {
  const auto motion = GripperMotion::Open(Context(), "rightarm1");
  double ended = 0.0;
  robot::Command first;
  const Status status = RunGripper(
      motion.get(), [](double) { return 0.02; }, &ended, &first);
  EXPECT_EQ(ToString(status.failure), "timed_out");
  EXPECT_NEAR(ended, Context()->params.gripper.time_limit, 0.1);
}

// ------------------------------------------------------------------------------------------ halt

TEST(HaltTest, BrakesWhatMovesAndNothingElse) {
  robot::Observation seen = Standing();
  seen.V_B.vx = 0.3;
  seen.joint_velocities["r_shoulder_pan_joint"] = 1.0;
  const robot::Command halt = Halt(*Context()->robot, seen);
  ASSERT_TRUE(halt.base_velocity.has_value());
  EXPECT_EQ(halt.base_velocity->vx, 0.0);
  ASSERT_EQ(halt.trajectories.size(), 1u);
  const robot::JointTrajectory& braking = halt.trajectories.at("rightarm1");
  EXPECT_NEAR(braking.duration(), 1.0 / 2.0, 1e-9);  // 1 rad/s at 2 rad/s^2
  EXPECT_NEAR(braking.points.back().positions.front(),
              seen.joints.at("r_shoulder_pan_joint") + 0.25, 1e-9);
  EXPECT_EQ(braking.points.back().velocities.front(), 0.0);
}

TEST(HaltTest, AtRestOnlyTheBaseIsTold) {
  const robot::Command halt = Halt(*Context()->robot, Standing());
  EXPECT_TRUE(halt.base_velocity.has_value());
  EXPECT_THAT(halt.trajectories, IsEmpty());
}

}  // namespace
}  // namespace hires::skills::motion_test
