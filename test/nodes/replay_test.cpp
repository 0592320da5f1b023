#include "nodes/hires/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hires/ImagineActionGoal.h>
#include <hires/ImagineActionResult.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "nodes/hires/imagine_recording.h"
#include "support/messages.h"

namespace hires_ros::replay_test {
namespace {

namespace fs = std::filesystem;
using hires::ImagineGoal;
using hires::ImagineResult;
using hires::test_support::ConfigErrorOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const ros::Time kTime(100.0);

ImagineGoal Goal(const std::string& request_id = "r", std::uint64_t seed = 7) {
  ImagineGoal goal;
  goal.steps.resize(1);
  goal.steps[0].name = "move_base_blind";
  goal.rollouts = 8;
  goal.seed = seed;
  goal.request_id = request_id;
  return goal;
}

hires::Prediction MakePrediction(const std::string& area) {
  hires::Prediction prediction;
  prediction.action.name = "move_base_blind";
  prediction.action.arguments = {area};
  prediction.confidence_mean = 0.9;
  prediction.success_share = 0.75;
  prediction.duration_mean = 12.5;
  prediction.rollouts = 8;
  return prediction;
}

ImagineResult Ranked(std::uint64_t seed = 7) {
  ImagineResult result;
  result.outcome = ImagineResult::RANKED;
  result.predictions = {MakePrediction("table1"), MakePrediction("table2")};
  result.recommended = 0;
  result.why = "table1 is better";
  result.seed = seed;
  result.wall_seconds = 3.0;
  return result;
}

hires::ImagineActionGoal ActionGoal(const std::string& id, const ImagineGoal& goal) {
  hires::ImagineActionGoal message;
  message.goal_id.id = id;
  message.goal = goal;
  return message;
}

hires::ImagineActionResult ActionResult(const std::string& id, const ImagineResult& result) {
  hires::ImagineActionResult message;
  message.status.goal_id.id = id;
  message.result = result;
  return message;
}

/// A message with any type, md5sum and bytes.
topic_tools::ShapeShifter Raw(const std::string& type, const std::string& md5sum,
                              std::vector<std::uint8_t> bytes) {
  topic_tools::ShapeShifter raw;
  raw.morph(md5sum, type, "", "");
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  raw.read(stream);
  return raw;
}

// ---------------------------------------------------------------- reading bags

class ImagineRecordingTest : public testing::Test {
 protected:
  ImagineRecordingTest() {
    std::string name = (fs::temp_directory_path() / "hires_bag_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    path_ = (folder_ / "a.bag").string();
  }
  ~ImagineRecordingTest() override { fs::remove_all(folder_); }

  template <typename... Messages>
  void Write(const std::pair<const char*, Messages>&... messages) {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    (bag.write(messages.first, kTime, messages.second), ...);
  }
  void WriteGoodBag() {
    Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal())},
          std::pair{"/imagine/result", ActionResult("g1", Ranked())});
  }
  /// The bag's bytes with `change` made to them.
  template <typename Change>
  void Damage(Change change) {
    std::ifstream in(path_, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    change(&bytes);
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  std::string Error(const std::string& action = "") const {
    return ConfigErrorOf([&] { ReadImagineRecording(path_, action); });
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(ImagineRecordingTest, GoalsAndResultsAreMatchedByGoalIdInAnyNamespace) {
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal("one", 1))},
        std::pair{"/imagine/goal", ActionGoal("g2", Goal("two", 2))},
        std::pair{"/pr2/imagine/goal", ActionGoal("g1", Goal("three", 3))},
        std::pair{"/pr2/imagine/result", ActionResult("g1", Ranked(3))},
        std::pair{"/imagine/result", ActionResult("g2", Ranked(2))},
        std::pair{"/imagine/result", ActionResult("g1", Ranked(1))},
        std::pair{"/imagine/result", ActionResult("g0", Ranked(0))});
  const ImagineRecording recording = ReadImagineRecording(path_, "");
  ASSERT_EQ(recording.requests.size(), 3u);
  EXPECT_EQ(recording.results_without_goal, 1);
  for (const RecordedRequest& request : recording.requests) {
    EXPECT_EQ(request.goal.seed, request.result.seed);
  }
  EXPECT_EQ(recording.requests[0].goal.request_id, "one");
  EXPECT_EQ(recording.requests[1].goal_id, "g2");
  EXPECT_EQ(recording.requests[2].action, "/pr2/imagine");
}

TEST_F(ImagineRecordingTest, OneActionIsChosenByItsNameOrByOneOfItsTopics) {
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal("one"))},
        std::pair{"/imagine/result", ActionResult("g1", Ranked())},
        std::pair{"/pr2/imagine/goal", ActionGoal("g2", Goal("two"))});
  for (const char* name : {"/imagine", "imagine", "/imagine/goal", "imagine/result"}) {
    EXPECT_EQ(ReadImagineRecording(path_, name).requests.size(), 1u) << name;
  }
  EXPECT_THAT(Error("/imagin"), AllOf(HasSubstr("action '/imagin' is unknown"),
                                      HasSubstr("/pr2/imagine/goal (hires/ImagineActionGoal)")));
}

TEST_F(ImagineRecordingTest, AGoalThatCameTwiceCountsOnce) {
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal("one"))},
        std::pair{"/imagine/goal", ActionGoal("g1", Goal("one"))},
        std::pair{"/imagine/result", ActionResult("g1", Ranked())});
  EXPECT_EQ(ReadImagineRecording(path_, "").requests.size(), 1u);
}

TEST_F(ImagineRecordingTest, OtherTopicsMayLieInTheBag) {
  Write(std::pair{"/chat", std_msgs::String()},
        std::pair{"/imagine/goal", ActionGoal("g1", Goal("one"))},
        std::pair{"/imagine/result", ActionResult("g1", Ranked())});
  EXPECT_EQ(ReadImagineRecording(path_, "").requests.size(), 1u);
}

TEST_F(ImagineRecordingTest, AMissingBagIsNamed) {
  EXPECT_THAT(Error(),
              AllOf(HasSubstr(path_), HasSubstr("no such bag"), HasSubstr("rosbag record")));
}

TEST_F(ImagineRecordingTest, WhatIsNoBagIsNamed) {
  std::ofstream(path_) << "hello, world";
  EXPECT_THAT(Error(), HasSubstr("is no ROS bag"));
  std::ofstream(path_, std::ios::trunc) << "";
  EXPECT_THAT(Error(), HasSubstr("is no ROS bag"));
  path_ = folder_.string();
  EXPECT_THAT(Error(), HasSubstr("is no ROS bag"));
}

TEST_F(ImagineRecordingTest, ABagWithoutImagineTopicsListsWhatIsThere) {
  Write(std::pair{"/chat", std_msgs::String()});
  EXPECT_THAT(Error(), AllOf(HasSubstr("holds no goals of an `imagine` action"),
                             HasSubstr("/chat (std_msgs/String)")));
  Write();
  EXPECT_THAT(Error(), HasSubstr("it is empty"));
}

TEST_F(ImagineRecordingTest, ABagWithoutIndexIsRead) {
  WriteGoodBag();
  Damage([](std::string* bytes) {  // as a recording that was killed leaves it
    const std::string key = "index_pos=";
    bytes->replace(bytes->find(key) + key.size(), 8, std::string(8, '\0'));
  });
  EXPECT_NO_THROW(ReadImagineRecording(path_, ""));
}

TEST_F(ImagineRecordingTest, OfABagThatIsCutOffWhatIsWholeIsRead) {
  WriteGoodBag();
  const std::uintmax_t size = fs::file_size(path_);
  fs::resize_file(path_, size - 1);
  EXPECT_NO_THROW(ReadImagineRecording(path_, ""));
  for (const std::uintmax_t kept :
       {std::uintmax_t{4200}, std::uintmax_t{100}, std::uintmax_t{13}}) {
    fs::resize_file(path_, kept);
    EXPECT_THAT(Error(), HasSubstr("no whole message is in it")) << kept << " bytes";
  }
}

TEST_F(ImagineRecordingTest, AGoalWithoutResultIsNamed) {
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal("serve"))},
        std::pair{"/imagine/result", ActionResult("g2", Ranked())});
  EXPECT_THAT(Error(), HasSubstr("goal g1 of /imagine (request 'serve') has no result, because the "
                                 "recording ended before it"));
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal("serve"))});
  EXPECT_THAT(Error(), HasSubstr("because /imagine/result is missing; record /imagine/goal and "));
}

TEST_F(ImagineRecordingTest, AGoalWithoutIdIsNamed) {
  Write(std::pair{"/imagine/goal", ActionGoal("", Goal())});
  EXPECT_THAT(Error(), HasSubstr("a goal of /imagine has no goal id"));
}

TEST_F(ImagineRecordingTest, OneBadGoalDoesNotSpoilTheOthers) {
  Write(std::pair{"/imagine/goal", ActionGoal("", Goal("typed"))},
        std::pair{"/imagine/goal", ActionGoal("g1", Goal("serve"))},
        std::pair{"/imagine/goal", ActionGoal("g2", Goal("cut off"))},
        std::pair{"/imagine/result", ActionResult("g1", Ranked())});
  const ImagineRecording recording = ReadImagineRecording(path_, "");
  ASSERT_EQ(recording.requests.size(), 1u);
  EXPECT_EQ(recording.requests[0].goal.request_id, "serve");
  EXPECT_THAT(recording.left_out,
              testing::ElementsAre(HasSubstr("a goal of /imagine has no goal id"),
                                   HasSubstr("goal g2 of /imagine (request 'cut off')")));
}

TEST_F(ImagineRecordingTest, ABagOfVersion030IsRead) {
  const ImagineRecording recording =
      ReadImagineRecording(HIRES_SOURCE_DIR "/test/data/replay/imagine_0.3.0.bag", "");
  ASSERT_EQ(recording.requests.size(), 1u);
  const RecordedRequest& request = recording.requests.front();
  EXPECT_EQ(request.goal_id, "g1");
  EXPECT_EQ(request.goal.steps.at(0).name, "move_base_param");
  EXPECT_EQ(request.goal.rollouts, 64u);
  EXPECT_EQ(request.goal.request_id, "recorded with 0.3.0");
  EXPECT_TRUE(request.goal.play_afresh);
  EXPECT_EQ(request.goal.max_regret, 0.0) << "the client's default";
  EXPECT_EQ(request.result.outcome, ImagineResult::RANKED);
  ASSERT_EQ(request.result.predictions.size(), 2u);
  EXPECT_EQ(request.result.predictions[0].durations, (std::vector<double>{15.0, 16.4}));
  ASSERT_EQ(request.result.by_cost.size(), 1u);
  EXPECT_EQ(request.result.by_cost[0].probability, 0.81);
  EXPECT_EQ(request.result.simulated_seconds_kept, 47.0);
  EXPECT_EQ(request.result.expected_regret, 0.0);
}

TEST_F(ImagineRecordingTest, MessagesOfAnotherVersionAreNamed) {
  const std::string md5sum(32, '7');
  Write(std::pair{"/imagine/goal", Raw("hires/ImagineActionGoal", md5sum, {1, 2, 3})});
  EXPECT_THAT(Error(), AllOf(HasSubstr("topic /imagine/goal has messages of type "
                                       "hires/ImagineActionGoal with md5sum " +
                                       md5sum),
                             HasSubstr(ros::message_traits::md5sum<hires::ImagineActionGoal>()),
                             HasSubstr("rosbag check")));
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal())},
        std::pair{"/imagine/result", Raw("hires/ImagineActionResult", md5sum, {})});
  EXPECT_THAT(Error(), HasSubstr("topic /imagine/result has messages of type"));
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal())},
        std::pair{"/imagine/result", std_msgs::String()});
  EXPECT_THAT(Error(), HasSubstr("has messages of type std_msgs/String"));
}

std::vector<std::uint8_t> BytesOf(const hires::ImagineActionResult& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

TEST_F(ImagineRecordingTest, AMessageThatEndsTooEarlyIsNamed) {
  std::vector<std::uint8_t> bytes = BytesOf(ActionResult("g1", Ranked()));
  bytes.resize(bytes.size() / 2);
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal())},
        std::pair{"/imagine/result",
                  Raw("hires/ImagineActionResult",
                      ros::message_traits::md5sum<hires::ImagineActionResult>(), bytes)});
  EXPECT_THAT(Error(), HasSubstr("is broken ("));
}

TEST_F(ImagineRecordingTest, AMessageThatClaimsToBeHugeIsRefused) {
  const hires::ImagineActionResult result = ActionResult("g1", Ranked());
  std::vector<std::uint8_t> bytes = BytesOf(result);
  const std::size_t list = ros::serialization::serializationLength(result.header) +
                           ros::serialization::serializationLength(result.status) +
                           sizeof(result.result.outcome);
  const std::uint32_t length = (3u << 30) / sizeof(hires::Prediction);  // 3 GB of predictions
  std::memcpy(bytes.data() + list, &length, sizeof(length));
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal())},
        std::pair{"/imagine/result",
                  Raw("hires/ImagineActionResult",
                      ros::message_traits::md5sum<hires::ImagineActionResult>(), bytes)});
  EXPECT_THAT(Error(), HasSubstr("something in it claims to be larger than 2 GB"));
}

TEST_F(ImagineRecordingTest, WhatItsClientCancelledWasCancelledWhateverWasFound) {
  auto result = ActionResult("g1", Ranked());
  result.status.status = actionlib_msgs::GoalStatus::PREEMPTED;
  result.result.outcome = ImagineResult::ALL_FAILED;
  Write(std::pair{"/imagine/goal", ActionGoal("g1", Goal())}, std::pair{"/imagine/result", result});
  EXPECT_EQ(ReadImagineRecording(path_, "").requests.at(0).result.outcome,
            ImagineResult::CANCELLED);
}

// ---------------------------------------------------------------- comparing

TEST(CompareAnswersTest, OnlyTheWallTimeMayDiffer) {
  ImagineResult now = Ranked();
  now.wall_seconds = 99.0;
  const ReplayComparison comparison = CompareAnswers(Goal(), Ranked(), now);
  EXPECT_TRUE(comparison.identical);
  EXPECT_FALSE(comparison.depended_on_moment);
  EXPECT_THAT(comparison.differences, IsEmpty());
}

TEST(CompareAnswersTest, TheLastBitOfANumberCounts) {
  ImagineResult now = Ranked();
  now.predictions[1].confidence_mean = std::nextafter(0.9, 1.0);
  const ReplayComparison comparison = CompareAnswers(Goal(), Ranked(), now);
  EXPECT_FALSE(comparison.identical);
  EXPECT_THAT(comparison.differences,
              ElementsAre("place 2, confidence_mean: 0.90000000000000002 then, "
                          "0.90000000000000013 now"));
}

TEST(CompareAnswersTest, NumbersThatAreNoneCompareByTheirBits) {
  ImagineResult then = Ranked(), now = Ranked();
  then.predictions[0].duration_mean = now.predictions[0].duration_mean =
      std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(CompareAnswers(Goal(), then, now).identical);
  then.predictions[0].duration_mean = 0.0;
  now.predictions[0].duration_mean = -0.0;
  EXPECT_FALSE(CompareAnswers(Goal(), then, now).identical);
}

/// A change of one field, and how the difference begins.
struct Change {
  std::function<void(ImagineResult*)> make;
  std::string line;
};

TEST(CompareAnswersTest, EveryFieldIsComparedAndNamed) {
  const std::vector<Change> changes{
      {[](auto* r) { r->outcome = ImagineResult::ALL_FAILED; }, "outcome: ranked then, all_failed"},
      {[](auto* r) { r->predictions.pop_back(); }, "number of predictions: 2 then, 1 now"},
      {[](auto* r) { r->recommended = 1; }, "recommended: 0 then, 1 now"},
      {[](auto* r) { r->why = "x"; }, "why: 'table1 is better' then, 'x' now"},
      {[](auto* r) { r->by_cost.resize(1); }, "by_cost differs"},
      {[](auto* r) { r->depends_on.resize(1); }, "depends_on differs"},
      {[](auto* r) { r->seed = 8; }, "seed: 7 then, 8 now"},
      {[](auto* r) { r->simulated_seconds = 1; }, "simulated_seconds: 0 then, 1 now"},
      {[](auto* r) { r->predictions[0].action.arguments = {"x"}; },
       "place 1, action: move_base_blind(table1) then, move_base_blind(x) now"},
      {[](auto* r) { r->predictions[0].confidence_pooled = 1; }, "place 1, confidence_pooled: "},
      {[](auto* r) { r->predictions[0].success_share = 1; }, "place 1, success_share: 0.75 then"},
      {[](auto* r) { r->predictions[0].success_lower = 1; }, "place 1, success_lower: "},
      {[](auto* r) { r->predictions[0].success_upper = 1; }, "place 1, success_upper: "},
      {[](auto* r) { r->predictions[0].fall_share = 1; }, "place 1, fall_share: "},
      {[](auto* r) { r->predictions[0].action_failed_share = 1; },
       "place 1, action_failed_share: "},
      {[](auto* r) { r->predictions[0].counts.shaking = 1; }, "place 1, counts differs"},
      {[](auto* r) { r->predictions[0].falls = 1; }, "place 1, falls: 0 then, 1 now"},
      {[](auto* r) { r->predictions[0].duration_mean = 1; }, "place 1, duration_mean: "},
      {[](auto* r) { r->predictions[0].duration_sd = 1; }, "place 1, duration_sd: "},
      {[](auto* r) { r->predictions[0].duration_p50 = 1; }, "place 1, duration_p50: "},
      {[](auto* r) { r->predictions[0].duration_p95 = 1; }, "place 1, duration_p95: "},
      {[](auto* r) { r->predictions[0].durations = {1}; }, "place 1, durations differs"},
      {[](auto* r) { r->predictions[0].max_tilts = {1}; }, "place 1, max_tilts differs"},
      {[](auto* r) { r->predictions[0].max_tilt_p50 = 1; }, "place 1, max_tilt_p50: "},
      {[](auto* r) { r->predictions[0].max_tilt_p95 = 1; }, "place 1, max_tilt_p95: "},
      {[](auto* r) { r->predictions[0].rollouts = 1; }, "place 1, rollouts: 8 then, 1 now"},
      {[](auto* r) { r->caveats = {"x"}; }, "caveats differs"},
      {[](auto* r) { r->predictions[0].interval_kind = 1; }, "place 1, kind of interval differs"},
      {[](auto* r) { r->predictions[0].expected_cost = 1; }, "place 1, expected_cost: "},
      {[](auto* r) { r->predictions[0].cost_lower = 1; }, "place 1, cost_lower: "},
      {[](auto* r) { r->predictions[0].cost_upper = 1; }, "place 1, cost_upper: "},
      {[](auto* r) { r->predictions[0].first_causes.resize(1); }, "place 1, first_causes differs"},
      {[](auto* r) { r->predictions[0].worst.index = 1; }, "place 1, worst rollout differs"},
      {[](auto* r) { r->predictions[0].median.index = 1; }, "place 1, median rollout differs"},
      {[](auto* r) { r->predictions[0].first_failed.index = 1; },
       "place 1, first failed rollout differs"},
      {[](auto* r) { r->predictions[0].failures.resize(1); }, "place 1, failures differs"},
      {[](auto* r) { r->predictions[0].final_world.objects.resize(1); },
       "place 1, final_world differs"},
      {[](auto* r) { r->predictions[0].final_robot.yaw = 1; }, "place 1, final_robot differs"}};
  for (const Change& change : changes) {
    ImagineResult now = Ranked();
    change.make(&now);
    const ReplayComparison comparison = CompareAnswers(Goal(), Ranked(), now);
    EXPECT_FALSE(comparison.identical) << change.line;
    EXPECT_THAT(comparison.differences, ElementsAre(testing::StartsWith(change.line)));
  }
}

TEST(DependsOnMomentTest, CompleteAnswersDoNot) {
  EXPECT_FALSE(DependsOnMoment(Goal(), Ranked()));
  ImagineResult result = Ranked();
  result.outcome = ImagineResult::ALL_FAILED;
  EXPECT_FALSE(DependsOnMoment(Goal(), result));
  result.outcome = ImagineResult::INVALID;
  EXPECT_FALSE(DependsOnMoment(Goal(), result));
}

TEST(DependsOnMomentTest, AnswersThatWereCutShortDo) {
  ImagineResult result = Ranked();
  for (const auto outcome : {ImagineResult::RANKED_AT_DEADLINE, ImagineResult::NO_WORKER,
                             ImagineResult::NOTHING_FINISHED, ImagineResult::CANCELLED}) {
    result.outcome = outcome;
    EXPECT_TRUE(DependsOnMoment(Goal(), result)) << int{outcome};
  }
  result.outcome = ImagineResult::ALL_FAILED;
  ImagineGoal goal = Goal();
  goal.deadline = ros::Duration(5.0);
  EXPECT_FALSE(DependsOnMoment(goal, result)) << "all 8 rollouts were played";
  result.predictions[0].rollouts = 7;
  EXPECT_TRUE(DependsOnMoment(goal, result));
}

TEST(DependsOnMomentTest, UndecidedDoesWhereItWasCutShort) {
  ImagineResult result = Ranked();
  result.outcome = ImagineResult::UNDECIDED;
  EXPECT_FALSE(DependsOnMoment(Goal(), result)) << "all 8 rollouts were played";
  result.predictions[0].rollouts = 7;
  EXPECT_TRUE(DependsOnMoment(Goal(), result));
}

TEST(DependsOnMomentTest, RolloutsThatTookTheirWorkersDownDo) {
  ImagineResult result = Ranked();
  result.predictions[1].failures.resize(1);
  result.predictions[1].failures[0].failure.code = hires::Failure::UNPLAYABLE;
  EXPECT_TRUE(DependsOnMoment(Goal(), result));
}

TEST(GoalToReplayTest, TheDeadlineIsLeftOutWhereItPlayedNoPart) {
  RecordedRequest recorded{"/imagine", "g1", Goal(), Ranked()};
  recorded.goal.deadline = ros::Duration(5.0);
  EXPECT_EQ(GoalToReplay(recorded).deadline, ros::Duration(0.0));
  recorded.result.outcome = ImagineResult::RANKED_AT_DEADLINE;
  EXPECT_EQ(GoalToReplay(recorded).deadline, ros::Duration(5.0));
  recorded.result.outcome = ImagineResult::INVALID;
  EXPECT_EQ(GoalToReplay(recorded).deadline, ros::Duration(5.0));
}

// ---------------------------------------------------------------- replaying

TEST(MakeLocalImaginationTest, LibrariesOfActionsAreLoaded) {
  const ImagineAgain imagine =
      MakeLocalImagination(HIRES_SOURCE_DIR, {"/nowhere/lib.so"}, 1, {}, [] { return false; });
  EXPECT_THAT(ConfigErrorOf([&] { imagine(Goal()); }),
              HasSubstr("library of actions '/nowhere/lib.so'"));
}

/// Three requests of which `imagine_again` is asked; the texts and the results.
struct Session {
  std::vector<ReplayedRequest> replayed;
  std::string text;
};

Session Replay(const std::vector<RecordedRequest>& requests, const ImagineAgain& imagine_again) {
  std::ostringstream out;
  Session session;
  session.replayed = ReplayAll(
      requests, imagine_again, [] { return false; }, out);
  session.text = out.str();
  return session;
}

ImagineResult AnswerBySeed(const ImagineGoal& goal) { return Ranked(goal.seed); }

TEST(ReplayAllTest, EqualAnswersGiveExitCodeZero) {
  const Session session = Replay({{"/imagine", "g1", Goal("one", 7), Ranked(7)},
                                  {"/imagine", "g2", Goal("two", 9), Ranked(9)}},
                                 AnswerBySeed);
  EXPECT_EQ(ReplayExitCode(session.replayed), 0);
  EXPECT_THAT(session.text, AllOf(HasSubstr("request 'one' (/imagine, goal id g1)"),
                                  HasSubstr("outcome: ranked then, ranked now"),
                                  HasSubstr("identical, bit by bit, but for the wall time")));
}

TEST(ReplayAllTest, OneDifferentAnswerGivesExitCodeTwo) {
  const Session session = Replay({{"/imagine", "g1", Goal("one", 7), Ranked(7)},
                                  {"/imagine", "g2", Goal("two", 9), Ranked(8)}},
                                 AnswerBySeed);
  EXPECT_EQ(ReplayExitCode(session.replayed), kExitDiffers);
  EXPECT_THAT(session.text, AllOf(HasSubstr("DIFFERS"), HasSubstr("seed: 8 then, 9 now")));
}

TEST(ReplayAllTest, AnAnswerOfTheMomentMayDiffer) {
  ImagineResult then = Ranked();
  then.outcome = ImagineResult::RANKED_AT_DEADLINE;
  const Session session = Replay({{"/imagine", "g1", Goal(), then}}, AnswerBySeed);
  EXPECT_EQ(ReplayExitCode(session.replayed), 0);
  EXPECT_FALSE(session.replayed[0].comparison.identical);
  EXPECT_THAT(session.text,
              AllOf(HasSubstr("not identical, and not expected to be: the answer then was "
                              "ranked_at_deadline"),
                    HasSubstr("outcome: ranked_at_deadline then, ranked now")));
}

TEST(ReplayAllTest, NobodyToAskIsADifference) {
  ImagineResult nobody;
  nobody.outcome = ImagineResult::NO_WORKER;
  const Session session =
      Replay({{"/imagine", "g1", Goal(), Ranked()}}, [&](const ImagineGoal&) { return nobody; });
  EXPECT_EQ(ReplayExitCode(session.replayed), kExitDiffers);
  EXPECT_THAT(session.text, AllOf(HasSubstr("outcome: ranked then, no_worker now"),
                                  HasSubstr("(no such place)")));
}

TEST(ReplayAllTest, WhatWasInterruptedIsLeftOut) {
  std::ostringstream out;
  int asked = 0;
  const auto imagine_again = [&](const ImagineGoal& goal) {
    ++asked;
    return AnswerBySeed(goal);
  };
  const RecordedRequest recorded{"/imagine", "g1", Goal(), Ranked()};
  const auto replayed = ReplayAll(
      {recorded, recorded, recorded}, imagine_again, [&] { return asked == 2; }, out);
  EXPECT_EQ(replayed.size(), 1u);
  EXPECT_EQ(asked, 2);
}

TEST(ReplayTextTest, ALongRequestIdIsCut) {
  const std::string id(100000, 'i');
  const Session session = Replay({{"/imagine", "g1", Goal(id), Ranked(8)}}, AnswerBySeed);
  EXPECT_LT(ReplayText(session.replayed[0]).size(), 10000u);
}

TEST(ReplayJsonTest, HoldsBothAnswersAndTheVerdict) {
  const Session session = Replay({{"/imagine", "g1", Goal("one"), Ranked(8)}}, AnswerBySeed);
  const auto json = ReplayJson(session.replayed[0]);
  EXPECT_EQ(json["request_id"], "one");
  EXPECT_EQ(json["outcome_then"], "ranked");
  EXPECT_EQ(json["outcome_now"], "ranked");
  EXPECT_EQ(json["identical"], false);
  EXPECT_EQ(json["then"]["seed"], 8);
  EXPECT_EQ(json["now"]["seed"], 7);
  EXPECT_EQ(json["now"]["ranking"].size(), 2u);
  EXPECT_EQ(json["differences"].size(), 1u);
}

TEST(ReplayJsonTest, ARefusedRequestHasAReasonAndNoRanking) {
  ImagineResult refused;
  refused.outcome = ImagineResult::INVALID;
  refused.recommended = -1;
  refused.why = "area 'x' is unknown";
  const Session session =
      Replay({{"/imagine", "g1", Goal(), refused}}, [&](const ImagineGoal&) { return refused; });
  const auto json = ReplayJson(session.replayed[0]);
  EXPECT_EQ(json["identical"], true);
  EXPECT_EQ(json["then"]["outcome"], "invalid");
  EXPECT_EQ(json["then"]["why"], "area 'x' is unknown");
  EXPECT_THAT(json["now"]["ranking"], IsEmpty());
}

TEST(RunReplayTest, WrongArgumentsGiveExitCodeOne) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"a.bag", "b.bag"},
                                                    {"a.bag", "--loca"},
                                                    {"a.bag", "--threads", "2"},
                                                    {"a.bag", "--local", "--threads", "0"}}) {
    EXPECT_EQ(RunReplay(arguments, ""), 1);
  }
  EXPECT_EQ(RunReplay({"--help"}, ""), 0);
}

}  // namespace
}  // namespace hires_ros::replay_test
