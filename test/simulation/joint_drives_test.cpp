#include "simulation/joint_drives.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/robot/gripper.h"
#include "hires/robot/posture.h"
#include "hires/simulation/scene.h"
#include "support/messages.h"

namespace hires::simulation::joint_drives_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kDt = 0.001;

const robot::Robot& Pr2() {
  static const robot::Robot robot =
      robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  return robot;
}

/// Drives with a clock that watches over the limits of every step.
class Drives {
 public:
  explicit Drives(const robot::JointPositions& joints = {})
      : drives_(Pr2(), PostureOf(Pr2(), joints)) {}

  void Send(const std::string& group, const robot::JointTrajectory& trajectory) {
    drives_.Send(group, trajectory, time_);
  }

  void Step() {
    std::vector<double> positions, velocities;
    for (int i = 0; i < drives_.num_joints(); ++i) {
      positions.push_back(drives_.position(i));
      velocities.push_back(drives_.velocity(i));
    }
    time_ = ++steps_ * kDt;
    drives_.Step(time_, kDt);
    for (int i = 0; i < drives_.num_joints(); ++i) Watch(i, positions[i], velocities[i]);
  }
  void StepFor(double duration) {
    for (long n = std::lround(duration / kDt); n > 0; --n) Step();
  }
  /// Time until the joint comes within `tolerance` of `goal` for good; -1 if not within `limit`.
  double TimeTo(const std::string& joint, double goal, double tolerance, double limit) {
    const double start = time_;
    while (time_ - start < limit) {
      Step();
      if (std::abs(At(joint) - goal) <= tolerance) return time_ - start;
    }
    return -1.0;
  }
  double At(const std::string& joint) const { return drives_.position(drives_.Find(joint)); }
  double Speed(const std::string& joint) const { return drives_.velocity(drives_.Find(joint)); }
  JointDrives& drives() { return drives_; }

 private:
  void Watch(int i, double before, double speed_before) {
    const DriveLimits& can = drives_.limits(i);
    const double speed = drives_.velocity(i);
    ASSERT_LE(std::abs(speed), can.max_velocity * (1.0 + 1e-12)) << drives_.name(i);
    ASSERT_LE(std::abs(speed - speed_before), can.max_acceleration * kDt * (1.0 + 1e-9))
        << drives_.name(i) << " at " << time_;
    ASSERT_NEAR(drives_.position(i) - before, speed * kDt, 1e-12) << drives_.name(i);
    if (can.is_continuous) return;
    ASSERT_GE(drives_.position(i), can.lower);
    ASSERT_LE(drives_.position(i), can.upper);
  }

  JointDrives drives_;
  long steps_{0};
  double time_{0.0};
};

robot::JointTrajectory To(const std::string& joint, double time, double position) {
  return {{joint}, {{time, {position}, {}}}};
}

TEST(JointDrivesTest, TheTorsoTakesAsLongAsThePr2s) {
  // (0.295 - 0.0115 - 0.01) / 0.013 = 21.04 s, and v / (2 a) = 0.065 s for getting up to speed.
  Drives drives({{"torso_lift_joint", 0.0115}});
  drives.Send("torso", To("torso_lift_joint", 2.0, 0.295));
  const double up_to_speed = 0.013 / (2.0 * 0.1);
  EXPECT_NEAR(drives.TimeTo("torso_lift_joint", 0.295, 0.01, 30.0),
              (0.295 - 0.0115 - 0.01) / 0.013 + up_to_speed, 0.002);
  drives.StepFor(2.0);
  EXPECT_EQ(drives.At("torso_lift_joint"), 0.295);
  EXPECT_EQ(drives.Speed("torso_lift_joint"), 0.0);
}

TEST(JointDrivesTest, AFarGoalMakesATrapezoid) {
  // Shoulder pan: 2.088 rad/s, 2 rad/s^2: T = d / v + v / a.
  Drives drives({{"l_shoulder_pan_joint", -0.7}});
  drives.Send("leftarm1", To("l_shoulder_pan_joint", 0.1, 2.2));
  EXPECT_NEAR(drives.TimeTo("l_shoulder_pan_joint", 2.2, 1e-6, 10.0), 2.9 / 2.088 + 2.088 / 2.0,
              0.003);
}

TEST(JointDrivesTest, ANearGoalMakesATriangle) {
  Drives drives({{"l_shoulder_pan_joint", 0.0}});
  drives.Send("leftarm1", To("l_shoulder_pan_joint", 0.01, 0.5));
  EXPECT_NEAR(drives.TimeTo("l_shoulder_pan_joint", 0.5, 1e-6, 10.0), 2.0 * std::sqrt(0.5 / 2.0),
              0.003);
}

TEST(JointDrivesTest, AStraightLineIsFollowedAndNotOverrun) {
  Drives drives({{"l_shoulder_pan_joint", 0.0}});
  drives.Send("leftarm1", To("l_shoulder_pan_joint", 2.0, 1.0));  // 0.5 rad/s
  drives.StepFor(1.0);
  EXPECT_NEAR(drives.Speed("l_shoulder_pan_joint"), 0.5, 1e-6);
  EXPECT_NEAR(drives.At("l_shoulder_pan_joint"), 0.5, 0.001);  // the start's lag is made up
  for (int i = 0; i < 3000; ++i) {
    drives.Step();
    ASSERT_LE(drives.At("l_shoulder_pan_joint"), 1.0 + 1e-12);
  }
  EXPECT_EQ(drives.At("l_shoulder_pan_joint"), 1.0);
}

/// Points along p(t) = 0.4 (1 - cos(pi t / T)): velocity 0 at both ends.
robot::JointTrajectory Wave(const std::string& joint, double T, int num_points) {
  robot::JointTrajectory wave{{joint}, {}};
  for (int i = 0; i <= num_points; ++i) {
    const double t = T * i / num_points, w = M_PI / T;
    wave.points.push_back({t, {0.4 * (1.0 - std::cos(w * t))}, {0.4 * w * std::sin(w * t)}});
  }
  return wave;
}

TEST(JointDrivesTest, WithinTheLimitsACubicIsFollowedExactly) {
  Drives drives({{"l_shoulder_pan_joint", 0.0}});
  const double T = 3.0;  // largest acceleration 0.4 (pi / 3)^2 = 0.44 rad/s^2
  drives.Send("leftarm1", Wave("l_shoulder_pan_joint", T, 30));
  for (int i = 1; i <= 3000; ++i) {
    drives.Step();
    const double wanted = 0.4 * (1.0 - std::cos(M_PI * i * kDt / T));
    ASSERT_NEAR(drives.At("l_shoulder_pan_joint"), wanted, 1e-5) << i;
  }
}

TEST(JointDrivesTest, WhatIsTooFastLagsAndArrives) {
  Drives drives({{"l_shoulder_pan_joint", 0.0}});
  drives.Send("leftarm1", Wave("l_shoulder_pan_joint", 0.5, 10));  // 16 rad/s^2
  drives.StepFor(0.5);
  EXPECT_LT(drives.At("l_shoulder_pan_joint"), 0.5);
  drives.StepFor(3.0);
  EXPECT_NEAR(drives.At("l_shoulder_pan_joint"), 0.8, 1e-9);
}

TEST(JointDrivesTest, ANewTrajectoryTakesOverWithoutAJump) {
  // Watched in every step: position follows velocity, velocity follows acceleration.
  Drives drives({{"l_shoulder_pan_joint", 0.0}});
  base::Rng rng(3);
  for (int i = 0; i < 60; ++i) {
    const double goal = rng.Uniform(-0.7, 2.2);
    if (rng.Bernoulli(0.3)) {
      drives.Send("leftarm1", {{"l_shoulder_pan_joint"},
                               {{rng.Uniform(0.0, 1.0), {goal}, {rng.Uniform(-2.0, 2.0)}}}});
    } else {
      drives.Send("leftarm1", To("l_shoulder_pan_joint", rng.Uniform(0.0, 1.0), goal));
    }
    drives.StepFor(rng.Uniform(0.05, 0.8));
  }
  drives.Send("leftarm1", To("l_shoulder_pan_joint", 1.0, 0.3));
  drives.StepFor(6.0);
  EXPECT_EQ(drives.At("l_shoulder_pan_joint"), 0.3);
}

TEST(JointDrivesTest, WithoutPointsTheGroupBrakes) {
  Drives drives({{"l_shoulder_pan_joint", 0.0}});
  drives.Send("leftarm1", To("l_shoulder_pan_joint", 2.0, 2.0));
  drives.StepFor(1.0);
  const double at = drives.At("l_shoulder_pan_joint"), speed = drives.Speed("l_shoulder_pan_joint");
  drives.Send("leftarm1", {});
  drives.StepFor(2.0);
  EXPECT_NEAR(drives.At("l_shoulder_pan_joint"), at + speed * speed / (2.0 * 2.0), 0.001);
  EXPECT_EQ(drives.Speed("l_shoulder_pan_joint"), 0.0);
}

TEST(JointDrivesTest, ContinuousJointsTakeTheNearestTurn) {
  Drives drives({{"l_wrist_roll_joint", 3.0}});
  drives.Send("leftarm1", To("l_wrist_roll_joint", 0.5, -3.0));
  drives.StepFor(2.0);
  EXPECT_NEAR(drives.At("l_wrist_roll_joint"), 2.0 * M_PI - 3.0, 1e-12);
}

TEST(JointDrivesTest, GoalsBeyondALimitCountAsTheLimit) {
  Drives drives({{"torso_lift_joint", 0.3}});
  drives.Send("torso", To("torso_lift_joint", 1.0, 5.0));
  drives.StepFor(5.0);
  EXPECT_EQ(drives.At("torso_lift_joint"), 0.33);
}

TEST(JointDrivesTest, GroupsDoNotDisturbEachOther) {
  Drives drives;
  drives.Send("head", {{"head_pan_joint", "head_tilt_joint"}, {{0.5, {0.4, 0.3}, {}}}});
  drives.Send("torso", To("torso_lift_joint", 1.0, 0.25));
  drives.StepFor(5.0);
  EXPECT_EQ(drives.At("head_pan_joint"), 0.4);
  EXPECT_EQ(drives.At("head_tilt_joint"), 0.3);
  EXPECT_EQ(drives.At("torso_lift_joint"), 0.25);
  EXPECT_EQ(drives.At("l_shoulder_pan_joint"), 0.06024);
}

TEST(JointDrivesTest, GapsMoveAtTheProfilesSpeed) {
  Drives drives;
  const int gap = drives.drives().Find("r_gripper_joint");
  drives.drives().SendTo(gap, 0.09);
  EXPECT_NEAR(drives.TimeTo("r_gripper_joint", 0.09, 1e-9, 5.0), 0.09 / 0.05 + 0.05 / 0.5, 0.005);
}

TEST(JointDrivesTest, RefusesWhatIsNoTrajectory) {
  const auto refusal = [](const std::string& group, const robot::JointTrajectory& trajectory) {
    return test_support::ConfigErrorOf([&] { Drives().Send(group, trajectory); });
  };
  EXPECT_THAT(refusal("leftarm", To("l_shoulder_pan_joint", 1.0, 0.0)),
              AllOf(HasSubstr("'leftarm' is unknown"), HasSubstr("did you mean 'leftarm1'")));
  EXPECT_THAT(refusal("leftarm1", To("r_shoulder_pan_joint", 1.0, 0.0)),
              AllOf(HasSubstr("'leftarm1'"), HasSubstr("joint 'r_shoulder_pan_joint' is unknown")));
  EXPECT_THAT(refusal("torso", {{"torso_lift_joint"}, {{1.0, {0.1, 0.2}, {}}}}),
              AllOf(HasSubstr("point 0"), HasSubstr("2 positions"), HasSubstr("1 joints")));
  EXPECT_THAT(refusal("torso", {{"torso_lift_joint"}, {{1.0, {0.1}, {0.1, 0.1}}}}),
              HasSubstr("2 velocities"));
  EXPECT_THAT(refusal("torso", To("torso_lift_joint", 1.0, NAN)), HasSubstr("not finite"));
  EXPECT_THAT(refusal("torso", To("torso_lift_joint", -1.0, 0.1)), HasSubstr("at least 0 s"));
  EXPECT_THAT(refusal("torso", {{"torso_lift_joint"}, {{1.0, {0.1}, {}}, {1.0, {0.2}, {}}}}),
              AllOf(HasSubstr("point 1"), HasSubstr("later than 1 s")));
  EXPECT_THAT(refusal("torso", To("torso_lift_joint", 1.0, 0.1)), HasSubstr("no ConfigError"));
}

}  // namespace
}  // namespace hires::simulation::joint_drives_test
