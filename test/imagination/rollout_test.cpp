#include "hires/imagination/rollout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

#include "hires/imagination/evidence.h"
#include "hires/simulation/fall_watch.h"
#include "imagination/room_rollouts.h"
#include "imagination/same_bits.h"
#include "support/messages.h"
#include "support/rounds.h"

namespace hires::imagination::rollout_test {
namespace {

using Code = base::FailureCode;
using hires::test_support::Block;
using hires::test_support::ConfigErrorOf;
using hires::test_support::ExpectSameBits;
using hires::test_support::OnTray;
using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::SomeUncertainty;
using hires::test_support::TrayRobot;
using ::testing::AllOf;
using ::testing::HasSubstr;

const base::ActionCall kFast{"move_base_param", {"east", "fast"}};
const base::ActionCall kSlow{"move_base_param", {"east", "slow"}};
const base::ActionCall kBlind{"move_base_blind", {"east"}};

RolloutResult Play(const RolloutSetup& setup, const base::ActionCall& action, int index = 0) {
  const auto result = PlayRollout(setup, action, index);
  EXPECT_TRUE(result) << "nobody cancelled it";
  return result.value_or(RolloutResult());
}

// ---------------------------------------------------------------------------- what comes out

TEST(RolloutTest, AnUneventfulDriveSucceeds) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const RolloutResult result = Play(setup, kSlow);
  EXPECT_EQ(result.outcome, Outcome::kSucceeded);
  EXPECT_EQ(ToString(result.failure), "");
  EXPECT_TRUE(result.action_finished);
  EXPECT_EQ(result.falls, 0);
  EXPECT_LT(result.max_tilt, 0.01);
  EXPECT_EQ(result.first_cause, "");
  EXPECT_GT(result.duration, 3.5 / 0.30 - 1.0);  // 3.5 m less the tolerance of 0.2 m
  EXPECT_NEAR(result.simulated, result.duration + setup.params.settling_time, 0.01);
}

TEST(RolloutTest, FinalStatesAreWhereTheActionEnds) {
  const RolloutResult result = Play(RoomRollouts(Room(), "mill"), kFast);
  EXPECT_NEAR(result.final_robot.X_MB.x, 4.5, 0.21);
  EXPECT_NEAR(result.final_robot.X_MB.y, 2.0, 0.21);
  ASSERT_EQ(result.final_world.objects.size(), 1u);
  const auto& load = result.final_world.objects[0];
  EXPECT_EQ(load.name, "load");
  const Eigen::Vector2d p_BO =
      result.final_robot.X_MB.Inverse() * Eigen::Vector2d(load.X_MO.translation.head<2>());
  EXPECT_NEAR(p_BO.x(), hires::test_support::kTrayX, 0.005);
  EXPECT_NEAR(load.X_MO.translation.z(), hires::test_support::kTrayTop, 0.003);
}

TEST(RolloutTest, CountsTwentySamplesASecond) {
  const RolloutSetup setup = RoomRollouts(Room(), "tower", SomeUncertainty());
  for (int index = 0; index < 6; ++index) {
    const RolloutResult result = Play(setup, index % 2 == 0 ? kFast : kSlow, index);
    EXPECT_NEAR(result.counts.total(), 20.0 * result.duration, 1.0) << "index " << index;
  }
}

TEST(RolloutTest, AFallIsOneEventHoweverManySamples) {
  const RolloutResult result = Play(RoomRollouts(Room(), "tower"), kFast);
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_TRUE(result.action_finished) << "the drive goes on";
  EXPECT_EQ(result.falls, 1);
  EXPECT_GT(result.counts.topple, 1);
  EXPECT_GT(result.max_tilt, 0.5);
  EXPECT_EQ(result.first_cause, "accelerating");
  EXPECT_TRUE(result.failure.code == Code::kObjectFell || result.failure.code == Code::kObjectSlid)
      << ToString(result.failure);
}

TEST(RolloutTest, PutBackItMayFallAgain) {
  RolloutSetup setup = RoomRollouts(Room(), "tower", SomeUncertainty());
  int falls_once = 0, falls_put_back = 0;
  for (int index = 0; index < 8; ++index) {
    setup.params.put_back = false;
    falls_once += Play(setup, kFast, index).falls;
    setup.params.put_back = true;
    falls_put_back += Play(setup, kFast, index).falls;
  }
  EXPECT_LE(falls_once, 8);
  EXPECT_GT(falls_put_back, falls_once);
}

TEST(RolloutTest, WhoHasNoLaserIsToldThatWhatHeKnockedOverIsInNoMap) {
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  world::ObjectState post;
  post.name = "post";
  post.model = "tower";
  post.X_MO = geometry::Lift({3.0, 2.0, 0.0});
  setup.world_state.objects.push_back(post);
  const RolloutResult result = Play(setup, kSlow);
  EXPECT_EQ(result.failure, base::Failure(Code::kKnockedOver, {"post"}));
  EXPECT_THAT(result.failure.detail, AllOf(HasSubstr("'post' is loose"), HasSubstr("laser_link")));
  EXPECT_THAT(result.failure.detail, ::testing::Not(HasSubstr("static")))
      << "no world's file has it";
}

TEST(RolloutTest, EveryLoadThatFallsCounts) {
  RolloutSetup setup = RoomRollouts(Room(), "tower");
  setup.world_state.objects.push_back(
      OnTray("second", "tower", setup.robot_state.X_MB, {0.0, 0.15}));
  EXPECT_EQ(Play(setup, kFast).falls, 2);
}

/// Objects in the path of a drive that does not look, and hardly lower than its belly: it knocks
/// them over and runs over them. With friction bounded by the normal force of the same step they
/// gain no energy from that.
TEST(RolloutTest, ObjectsThatAreRunOverDoNotBreakPhysics) {
  base::Rng rng(21);
  int num_down = 0;
  for (int round = 0; round < hires::test_support::Rounds(240); ++round) {
    world::World room = Room();
    const double radius = rng.Uniform(0.025, 0.05);
    hires::test_support::AddModel(
        &room, hires::test_support::Mill("thing", rng.Uniform(0.15, 0.4), radius));
    robot::Robot robot = TrayRobot();
    const double belly = 2.0 * radius - rng.Uniform(0.0, 0.06);
    robot.model.links[0].collisions[0] = hires::test_support::Shape(
        "base", geometry::Box{{0.6, 0.5, 0.3 - belly}}, {0.0, 0.0, 0.5 * (0.3 + belly)});
    RolloutSetup setup = RoomRollouts(room, "", "none", robot);
    world::ObjectState thing;
    thing.name = "Thing1";
    thing.model = "thing";
    thing.X_MO.translation = {2.2, 2.0 + rng.Uniform(-0.3, 0.3), 0.0002};
    setup.world_state.objects = {thing};
    bool is_down = false, is_broken = false;
    simulation::FallWatch watch(setup.standing);
    RolloutHooks hooks;
    hooks.on_begin = [&](const simulation::RobotSimulator&) {
      watch = simulation::FallWatch(setup.standing);
      is_down = is_broken = false;
    };
    hooks.on_look = [&](const simulation::RobotSimulator& simulator) {
      if (simulator.GetWorldState().objects.empty()) return;
      is_broken = is_broken || simulator.broken_object();
      watch.Look(simulator, 0);
      is_down = watch.detector().is_down();
    };
    ASSERT_TRUE(PlayRollout(setup, kBlind, 0, hooks));
    EXPECT_FALSE(is_broken) << "round " << round;
    num_down += is_down ? 1 : 0;
  }
  EXPECT_GT(num_down, 0) << "nothing was shown";
}

TEST(RolloutTest, TimeIsUp) {
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  setup.params.time_limit = 3.0;
  const RolloutResult result = Play(setup, kSlow);
  EXPECT_EQ(result.outcome, Outcome::kTimedOut);
  EXPECT_THAT(ToString(result.failure), HasSubstr("timed_out: it was still under way"));
  EXPECT_FALSE(result.action_finished);
  EXPECT_NEAR(result.duration, 3.0, 0.0011);
  EXPECT_TRUE(ActionFailed(result));
}

TEST(RolloutTest, DrivingBlindIntoACrateIsACollision) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 0.5, 0.8}, {2.75, 2.0, 0.4}));
  const RolloutResult result = Play(RoomRollouts(room, "mill"), kBlind);
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_THAT(ToString(result.failure),
              HasSubstr("robot_collision: tray/plate touches crate at x "));
  EXPECT_FALSE(result.action_finished);
  EXPECT_NEAR(result.final_robot.X_MB.x, 2.5 - 0.325, 0.02);
}

TEST(RolloutTest, ASkillThatGivesUpSaysWhy) {
  world::World room = Room();
  room.statics.push_back(Block("fence", {0.1, 4.0, 0.8}, {2.75, 2.0, 0.4}));
  const RolloutResult result = Play(RoomRollouts(room, "mill"), kFast);
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_THAT(ToString(result.failure), HasSubstr("no_path: the way ends at x "));
  EXPECT_TRUE(ActionFailed(result));
}

TEST(RolloutTest, AnActionThatIsOverAtOnceHasTheSampleOfItsEnd) {
  const RolloutResult result = Play(RoomRollouts(Room(), "mill"), {"move_base_blind", {"west"}});
  EXPECT_EQ(result.outcome, Outcome::kSucceeded);
  EXPECT_EQ(ToString(result.failure), "");
  EXPECT_EQ(result.counts.notopple, 1);
  EXPECT_EQ(result.counts.total(), 1);
}

TEST(RolloutTest, ATruthThatCannotBeIsABadStart) {
  // The nominal start is sound; 0.3 m further ahead the robot would stand in the tower.
  RolloutSetup setup = RoomRollouts(
      Room(), "mill", "start_x: {distribution: fixed, value: 0.3, unit: m, source: a}");
  world::ObjectState in_the_way = OnTray("in_the_way", "tower", setup.robot_state.X_MB);
  in_the_way.X_MO.translation = {1.5, 2.0, 0.0};
  setup.world_state.objects.push_back(in_the_way);
  EXPECT_NO_THROW(CheckSetup(setup, kFast));
  const RolloutResult result = Play(setup, kFast);
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_THAT(ToString(result.failure), AllOf(HasSubstr("bad_start: "), HasSubstr("in_the_way")));
  EXPECT_TRUE(ActionFailed(result));
}

TEST(RolloutTest, AStartOffsetIntoAWallIsDrawnIn) {
  const RolloutSetup setup = RoomRollouts(
      Room(), "mill", "start_x: {distribution: fixed, value: -0.9, unit: m, source: a}");
  EXPECT_EQ(Play(setup, kFast).outcome, Outcome::kSucceeded);
}

TEST(RolloutTest, WithoutALoadTheDriveAloneIsPlayed) {
  const RolloutResult result = Play(RoomRollouts(Room(), ""), kFast);
  EXPECT_EQ(result.outcome, Outcome::kSucceeded);
  EXPECT_TRUE(result.nothing_watched);
  EXPECT_EQ(result.counts.total(), 0);
  EXPECT_FALSE(ActionFailed(result));
  EXPECT_EQ(RolloutConfidence(result), 1.0) << "its success is all the evidence there is";
}

TEST(RolloutTest, CancelledItGivesUpWithNothingAtTheNextSample) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  int samples = 0;
  const auto result = PlayRollout(setup, kFast, 0,
                                  {[&] { return samples == 3; },
                                   [&](const simulation::RobotSimulator&, double) { ++samples; }});
  EXPECT_FALSE(result);
  EXPECT_EQ(samples, 3);
}

TEST(RolloutTest, CancelledWhileTheLoadSettlesItPlaysNoSample) {
  int asked = 0, samples = 0;
  const auto result = PlayRollout(RoomRollouts(Room(), "mill"), kFast, 0,
                                  {[&] { return ++asked == 3; },
                                   [&](const simulation::RobotSimulator&, double) { ++samples; }});
  EXPECT_FALSE(result);
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(samples, 0);
}

TEST(RolloutTest, SamplesAreShownWithTheirTilt) {
  const RolloutSetup setup = RoomRollouts(Room(), "tower");
  std::vector<double> tilts, times;
  const auto result = PlayRollout(
      setup, kFast, 0, {{}, [&](const simulation::RobotSimulator& simulator, double tilt) {
                          times.push_back(simulator.time());
                          tilts.push_back(tilt);
                        }});
  ASSERT_TRUE(result);
  ASSERT_EQ(static_cast<int>(tilts.size()), result->counts.total());
  const auto toppled = std::count_if(tilts.begin(), tilts.end(), [](double t) { return t >= 0.5; });
  EXPECT_EQ(toppled, result->counts.topple);
  for (std::size_t i = 0; i < times.size(); ++i) {
    ASSERT_NEAR(times[i], 0.5 + 0.05 * static_cast<double>(i + 1), 1e-9);
  }
}

// -------------------------------------------------------------------------- seeds and chance

TEST(RolloutTest, TheSameSeedGivesTheSameBitsInAnyThread) {
  const RolloutSetup setup = RoomRollouts(Room(), "tower", SomeUncertainty());
  std::vector<RolloutResult> here;
  for (int index = 0; index < 3; ++index) here.push_back(Play(setup, kFast, index));
  std::vector<RolloutResult> there(3);
  std::vector<std::thread> threads;
  for (int index = 0; index < 3; ++index) {
    threads.emplace_back([&, index] { there[index] = *PlayRollout(setup, kFast, index); });
  }
  for (std::thread& thread : threads) thread.join();
  for (int index = 0; index < 3; ++index) ExpectSameBits(here[index], there[index]);
}

TEST(RolloutTest, SeedAndIndexBothMatter) {
  RolloutSetup setup = RoomRollouts(Room(), "mill", SomeUncertainty());
  const RolloutResult first = Play(setup, kFast, 0);
  EXPECT_FALSE(SameOutcome(first, Play(setup, kFast, 1)));
  setup.seed = 2;
  EXPECT_FALSE(SameOutcome(first, Play(setup, kFast, 0)));
}

TEST(RolloutTest, WithoutUncertaintyAllRolloutsAreEqual) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  ExpectSameBits(Play(setup, kFast, 0), Play(setup, kFast, 17));
}

TEST(RolloutTest, OneIndexIsOneTruthForAllActions) {
  // With this lag nothing moves before the first sample: it shows where robot and load really are.
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.command_lag = 0.3;
  robot.profile.base_controller.command_timeout = 0.5;
  const RolloutSetup setup = RoomRollouts(Room(), "mill", SomeUncertainty(), robot);
  const auto first_pose = [&](const base::ActionCall& action, int index) {
    Eigen::Vector3d p_MO(0.0, 0.0, 0.0);
    bool seen = false;
    PlayRollout(setup, action, index,
                {[&] { return seen; },
                 [&](const simulation::RobotSimulator& simulator, double) {
                   p_MO = simulator.PoseOf(0).translation;
                   seen = true;
                 }});
    return p_MO;
  };
  for (int index = 0; index < 5; ++index) {
    EXPECT_EQ(first_pose(kFast, index), first_pose(kSlow, index));
    EXPECT_EQ(first_pose(kFast, index), first_pose(kBlind, index));
    EXPECT_NE(first_pose(kFast, index), first_pose(kFast, index + 1));
  }
  ExpectSameBits(Play(setup, kFast, 3), Play(setup, {"move_base", {"East"}}, 3));
}

// ---------------------------------------------------------------------------- state matters

int FallsOf(const std::string& model, const base::ActionCall& action) {
  const RolloutSetup setup = RoomRollouts(Room(), model, SomeUncertainty());
  int falls = 0;
  for (int index = 0; index < 8; ++index) falls += Play(setup, action, index).falls;
  return falls;
}

TEST(RolloutTest, TwiceAsHighItFallsMore) {
  EXPECT_GT(FallsOf("tower", kFast), FallsOf("mill", kFast) + 3);
  EXPECT_GT(FallsOf("tower", kFast), FallsOf("tower", kSlow));
}

TEST(RolloutTest, AnObstacleAcrossTheWayMakesItLonger) {
  world::World room = Room();
  room.statics.push_back(Block("crate", {0.5, 1.6, 0.8}, {2.75, 1.6, 0.4}));
  EXPECT_GT(Play(RoomRollouts(room, "mill"), kSlow).duration,
            Play(RoomRollouts(Room(), "mill"), kSlow).duration + 1.0);
}

TEST(RolloutTest, AnotherStartGivesAnotherDuration) {
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  const double duration = Play(setup, kSlow).duration;
  setup.robot_state.X_MB.x -= 0.2;
  setup.world_state.objects[0] = OnTray("load", "mill", setup.robot_state.X_MB);
  EXPECT_NEAR(Play(setup, kSlow).duration, duration + 0.2 / 0.30, 0.35);
}

TEST(RolloutTest, FastIsFasterThanSlow) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill", SomeUncertainty());
  for (int index = 0; index < 3; ++index) {
    EXPECT_GT(Play(setup, kSlow, index).duration, Play(setup, kFast, index).duration + 2.0);
  }
}

// ------------------------------------------------------------------------------ bad requests

TEST(CheckSetupTest, AcceptsWhatCanBePlayed) {
  EXPECT_NO_THROW(CheckSetup(RoomRollouts(Room(), "mill"), kFast));
}

TEST(CheckSetupTest, RefusesUnknownActionsAreasAndModels) {
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  const auto why_not = [&](const base::ActionCall& action) {
    return ConfigErrorOf([&] { CheckSetup(setup, action); });
  };
  EXPECT_THAT(why_not({"fly", {"east"}}), HasSubstr("action 'fly' is unknown"));
  EXPECT_THAT(why_not({"move_base", {"moon"}}), HasSubstr("area 'moon' is unknown"));
  setup.world_state.objects[0].model = "vase";
  EXPECT_THAT(why_not(kFast), HasSubstr("model 'vase' is unknown"));
}

TEST(CheckSetupTest, RefusesStartsThatCannotBe) {
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  setup.robot_state.X_MB = {6.0, 2.0, 0.0};
  EXPECT_THAT(ConfigErrorOf([&] { CheckSetup(setup, kFast); }),
              AllOf(HasSubstr("robot starts in collision"), HasSubstr("east_wall")));
}

// -------------------------------------------------------------------------------- parameters

constexpr char kParams[] =
    "settling_time: 0.5\ntime_limit: 300.0\nsample_period: 0.05\nshaking_tilt: 0.01\n"
    "topple_tilt: 0.5\naftermath: 2.0\nput_back: true\nput_back_tilt: 1.56\n";

TEST(RolloutParamsTest, ReadsEveryKey) {
  base::ParamReader in = base::ParamReader::FromString(kParams, "r.yaml");
  const RolloutParams params = ReadRolloutParams(in);
  in.RejectUnknownKeys();
  EXPECT_EQ(params.settling_time, 0.5);
  EXPECT_EQ(params.time_limit, 300.0);
  EXPECT_EQ(params.sample_period, 0.05);
  EXPECT_EQ(params.shaking_tilt, 0.01);
  EXPECT_EQ(params.topple_tilt, 0.5);
  EXPECT_EQ(params.aftermath, 2.0);
  EXPECT_TRUE(params.put_back);
  EXPECT_EQ(params.put_back_tilt, 1.56);
}

TEST(RolloutParamsTest, NamesWhatIsWrong) {
  const auto why_refused = [](const std::string& key, const std::string& value) {
    std::string yaml = kParams;
    const std::size_t begin = yaml.find(key + ": ");
    yaml.replace(begin, yaml.find('\n', begin) - begin, value.empty() ? "" : key + ": " + value);
    return ConfigErrorOf([&] { ReadRolloutParams(base::ParamReader::FromString(yaml, "r.yaml")); });
  };
  EXPECT_THAT(why_refused("aftermath", ""), HasSubstr("r.yaml: aftermath is missing"));
  EXPECT_THAT(why_refused("time_limit", "0"),
              AllOf(HasSubstr("time_limit is '0'"), HasSubstr("between"), HasSubstr("line 2")));
  EXPECT_THAT(why_refused("sample_period", ".nan"), HasSubstr("sample_period is '.nan'"));
  EXPECT_THAT(why_refused("put_back", "sometimes"), HasSubstr("true or false"));
}

TEST(RolloutParamsTest, AShakeIsLessThanATopple) {
  std::string yaml = kParams;
  yaml.replace(yaml.find("shaking_tilt: 0.01"), 18, "shaking_tilt: 0.60");
  EXPECT_THAT(
      ConfigErrorOf([&] { ReadRolloutParams(base::ParamReader::FromString(yaml, "r.yaml")); }),
      AllOf(HasSubstr("shaking_tilt is '0.60'"), HasSubstr("topple_tilt")));
}

}  // namespace
}  // namespace hires::imagination::rollout_test
