#include "hires/relay/relay.h"

#include <gmock/gmock.h>

#include "hires/base/log.h"
#include "relay/fake_master.h"

namespace hires::relay::relay_test {
namespace {

using test_support::FakeMaster;
using test_support::FakePinger;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr char kSim[] = "http://127.0.0.1:4001/";
constexpr char kClient[] = "http://127.0.0.1:3001/";
constexpr char kScan[] = "/worker_1/scan";

RelayParams Params() {
  return ReadRelayParams(
      base::ParamReader::FromFile(std::string(HIRES_SOURCE_DIR) + "/config/relay.yaml"));
}

class RelayTest : public testing::Test {
 protected:
  RelayTest() {
    params_.foreign.services.Add(NameFilter({"/reset"}, "x"));
    relay_.emplace(params_, HostNames{"station"}, &main_, &foreign_, &pinger_);
    base::SetLogSink([this](base::LogLevel, const std::string& line) { log_.push_back(line); });
  }
  ~RelayTest() override { base::SetLogSink({}); }

  void Tick() { relay_->Tick(now_ += 0.05); }
  void TickFor(double seconds) {
    for (const double end = now_ + seconds; now_ < end;) Tick();
  }
  void AddScan() { foreign_.AddPublisher("/sim_worker", kScan, "sensor_msgs/LaserScan", kSim); }
  std::set<std::string> Publishers(const FakeMaster& master, const std::string& topic) {
    const auto it = master.graph().publishers.find(topic);
    return it == master.graph().publishers.end() ? std::set<std::string>{} : it->second;
  }

  FakeMaster main_{"http://localhost:11311/"};
  FakeMaster foreign_{"http://127.0.0.1:11411/"};
  FakePinger pinger_;
  RelayParams params_ = Params();
  std::optional<Relay> relay_;
  std::vector<std::string> log_;
  double now_{100.0};
};

TEST_F(RelayTest, MirrorsAListedPublisherUnderAnAliasWithItsOwnAddress) {
  AddScan();
  foreign_.AddPublisher("/sim_worker", "/odom", "nav_msgs/Odometry", kSim);
  foreign_.AddPublisher("/sim_worker", "/clock", "rosgraph_msgs/Clock", kSim);
  Tick();
  const auto publishers = Publishers(main_, kScan);
  ASSERT_EQ(publishers.size(), 1u);
  EXPECT_THAT(*publishers.begin(), StartsWith("/mirrored/worker_1/sim_worker_"));
  EXPECT_EQ(main_.NodeUri(*publishers.begin()), kSim);
  EXPECT_EQ(main_.GetTopicTypes()->at(kScan), "sensor_msgs/LaserScan");
  EXPECT_EQ(main_.graph().publishers.size(), 1u);
}

TEST_F(RelayTest, GoalsCrossOneWayAndResultsTheOther) {
  main_.AddPublisher("/client", "/worker_1/rollout/goal", "hires/RolloutActionGoal", kClient);
  main_.AddPublisher("/client", "/worker_1/other", "std_msgs/Empty", kClient);
  foreign_.AddPublisher("/sim", "/worker_1/rollout/result", "hires/RolloutActionResult", kSim);
  Tick();
  EXPECT_EQ(Publishers(foreign_, "/worker_1/rollout/goal").size(), 1u);
  EXPECT_EQ(Publishers(main_, "/worker_1/rollout/result").size(), 1u);
  EXPECT_THAT(Publishers(foreign_, "/worker_1/other"), IsEmpty());
}

TEST_F(RelayTest, NeverMirrorsAliasesBack) {
  params_.local.topics.Add(NameFilter({"/.*"}, "x"));
  params_.foreign.topics.Add(NameFilter({"/.*"}, "x"));
  relay_.emplace(params_, HostNames{}, &main_, &foreign_, &pinger_);
  AddScan();
  main_.AddPublisher("/client", kScan, "sensor_msgs/LaserScan", kClient);
  for (int i = 0; i < 5; ++i) Tick();
  EXPECT_EQ(Publishers(main_, kScan).size(), 2u);
  EXPECT_EQ(Publishers(foreign_, kScan).size(), 2u);
  EXPECT_EQ(main_.num_changes + foreign_.num_changes, 2);
}

TEST_F(RelayTest, EqualNodeNamesOnBothSidesShutNobodyDown) {
  main_.AddPublisher("/node", "/worker_1/rollout/goal", "t/T", kClient);
  foreign_.AddPublisher("/node", kScan, "t/T", kSim);
  Tick();
  EXPECT_THAT(main_.shutdowns, IsEmpty());
  EXPECT_THAT(foreign_.shutdowns, IsEmpty());
  EXPECT_EQ(main_.NodeUri("/node"), kClient);
}

TEST_F(RelayTest, ANodeThatCameBackElsewhereIsFollowedWithoutAShutdown) {
  AddScan();
  Tick();
  foreign_.AddPublisher("/sim_worker", kScan, "sensor_msgs/LaserScan", "http://127.0.0.1:4009/");
  Tick();
  const auto publishers = Publishers(main_, kScan);
  ASSERT_EQ(publishers.size(), 1u);
  EXPECT_EQ(main_.NodeUri(*publishers.begin()), "http://127.0.0.1:4009/");
  EXPECT_THAT(main_.shutdowns, IsEmpty());
}

TEST_F(RelayTest, ASettledGraphCausesNoMoreChanges) {
  AddScan();
  foreign_.AddService("/sim_worker", "/reset", "rosrpc://127.0.0.1:5001", kSim);
  Tick();
  const int num_changes = main_.num_changes;
  TickFor(10.0);
  EXPECT_EQ(main_.num_changes, num_changes);
  EXPECT_EQ(foreign_.num_changes, 0);
}

TEST_F(RelayTest, WhatIsNoLongerPublishedIsWithdrawn) {
  AddScan();
  Tick();
  foreign_.RemovePublisher("/sim_worker", kScan);
  Tick();
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
}

TEST_F(RelayTest, AKilledPublisherIsWithdrawnWithinAPingPeriod) {
  AddScan();
  Tick();
  pinger_.Kill(kSim);
  TickFor(params_.ping_period + 0.1);
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
  EXPECT_THAT(Publishers(foreign_, kScan), ElementsAre("/sim_worker"));
  pinger_.Answer(kSim, 77);
  TickFor(params_.ping_period + 0.1);
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
}

TEST_F(RelayTest, ADeadRegistrationIsNeverMirrored) {
  pinger_.Kill(kSim);
  AddScan();
  TickFor(5.0);
  EXPECT_EQ(main_.num_changes, 0);
}

TEST_F(RelayTest, AServiceFollowsItsProvider) {
  foreign_.AddService("/sim_worker", "/reset", "rosrpc://127.0.0.1:5001", kSim);
  Tick();
  EXPECT_EQ(main_.ServiceUri("/reset"), "rosrpc://127.0.0.1:5001");
  foreign_.AddService("/sim_worker", "/reset", "rosrpc://127.0.0.1:5002", "http://127.0.0.1:4009/");
  Tick();
  EXPECT_EQ(main_.ServiceUri("/reset"), "rosrpc://127.0.0.1:5002");
  foreign_.RemoveService("/reset");
  Tick();
  EXPECT_EQ(main_.ServiceUri("/reset"), "");
}

TEST_F(RelayTest, AServiceThatExistsOnBothSidesStaysWithItsOwner) {
  main_.AddService("/real", "/reset", "rosrpc://127.0.0.1:6001", kClient);
  foreign_.AddService("/sim_worker", "/reset", "rosrpc://127.0.0.1:5001", kSim);
  TickFor(1.0);
  EXPECT_EQ(main_.ServiceUri("/reset"), "rosrpc://127.0.0.1:6001");
  ASSERT_EQ(relay_->status().refused.size(), 1u);
  ASSERT_EQ(log_.size(), 1u) << "a refusal is logged once";
  EXPECT_THAT(log_[0], HasSubstr("refused service=/reset node=/sim_worker"));
}

TEST_F(RelayTest, ALoopbackAddressIsRefusedAtAMasterElsewhere) {
  FakeMaster robot("http://robot:11311/");
  Relay relay(params_, HostNames{"station"}, &robot, &foreign_, &pinger_);
  AddScan();
  foreign_.AddPublisher("/near", "/worker_1/map", "t/T", "http://station:4005/");
  relay.Tick(1.0);
  EXPECT_THAT(Publishers(robot, kScan), IsEmpty());
  EXPECT_EQ(Publishers(robot, "/worker_1/map").size(), 1u);
  EXPECT_THAT(log_, Contains(HasSubstr("refused topic=/worker_1/scan")));
}

TEST_F(RelayTest, ANodeWhoseHostNobodyKnowsIsRefusedUntilItsNameIsKnown) {
  const char kNamed[] = "http://imaginer:4001/";
  foreign_.AddPublisher("/sim_worker", kScan, "sensor_msgs/LaserScan", kNamed);
  pinger_.Forget(kNamed);
  TickFor(3.0);
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
  ASSERT_EQ(log_.size(), 1u) << "a refusal is logged once";
  EXPECT_THAT(log_[0], HasSubstr("refused topic=/worker_1/scan node=/sim_worker"));
  EXPECT_THAT(log_[0], HasSubstr("'ADDRESS imaginer' to /etc/hosts"));
  pinger_.Answer(kNamed, 5);
  TickFor(1.1);
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
  EXPECT_THAT(relay_->status().refused, IsEmpty());
}

TEST_F(RelayTest, ALoopbackServiceIsRefusedAtAMasterElsewhere) {
  FakeMaster robot("http://robot:11311/");
  Relay relay(params_, HostNames{"station"}, &robot, &foreign_, &pinger_);
  foreign_.AddService("/sim_worker", "/reset", "rosrpc://localhost:5001", "http://station:4001/");
  relay.Tick(1.0);
  relay.Tick(2.0);
  EXPECT_EQ(robot.ServiceUri("/reset"), "");
  EXPECT_EQ(robot.num_changes, 0);
}

TEST_F(RelayTest, ARestartedMasterGetsItsMirrorsBack) {
  AddScan();
  Tick();
  main_.Restart();
  Tick();
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
}

TEST_F(RelayTest, ARestartedSourceLosesItsMirrors) {
  AddScan();
  Tick();
  foreign_.Restart();
  Tick();
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
}

TEST_F(RelayTest, ASilentSourceKeepsItsMirrorsAsLongAsTheirNodesLive) {
  AddScan();
  foreign_.AddPublisher("/other", "/worker_1/map", "t/T", "http://127.0.0.1:4002/");
  Tick();
  foreign_.is_silent = true;
  TickFor(5.0);
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
  pinger_.Kill(kSim);
  TickFor(params_.ping_period + 0.1);
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
  EXPECT_EQ(Publishers(main_, "/worker_1/map").size(), 1u);
  EXPECT_FALSE(relay_->status().foreign_answers);
  EXPECT_TRUE(relay_->status().local_answers);
}

TEST_F(RelayTest, ASilentTargetIsServedWhenItAnswersAgain) {
  main_.is_silent = true;
  AddScan();
  TickFor(2.0);
  EXPECT_EQ(main_.num_changes, 0);
  main_.is_silent = false;
  Tick();
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
}

TEST_F(RelayTest, SilenceIsLoggedOnceAndItsEndToo) {
  Tick();
  foreign_.is_silent = true;
  TickFor(3.0);
  foreign_.is_silent = false;
  TickFor(3.0);
  EXPECT_THAT(log_, ElementsAre(HasSubstr("master=foreign uri=http://127.0.0.1:11411/ "
                                          "state=silent"),
                                HasSubstr("state=answering")));
}

TEST_F(RelayTest, AnEarlierRunsMirrorsAreKeptWhereRightAndWithdrawnWhereNot) {
  AddScan();
  Tick();
  main_.AddPublisher("/mirrored/worker_1/ghost_00000000", "/worker_1/map", "t/T",
                     "http://127.0.0.1:4002/");
  main_.AddPublisher("/mirrored/worker_2/scan_00000000", "/worker_2/scan", "t/T",
                     "http://127.0.0.1:4003/");
  const int num_changes = main_.num_changes;
  Relay next(params_, HostNames{}, &main_, &foreign_, &pinger_);
  next.Tick(now_);
  EXPECT_EQ(main_.num_changes, num_changes + 1);
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
  EXPECT_THAT(Publishers(main_, "/worker_1/map"), IsEmpty());
  EXPECT_EQ(Publishers(main_, "/worker_2/scan").size(), 1u);
}

TEST_F(RelayTest, AnEarlierRunsMirrorOfADeadNodeGoesEvenWhileItsMasterIsSilent) {
  AddScan();
  Tick();
  foreign_.is_silent = true;
  pinger_.Kill(kSim);
  Relay next(params_, HostNames{}, &main_, &foreign_, &pinger_);
  next.Tick(now_);
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
}

TEST_F(RelayTest, WithdrawAllLeavesOthersAlone) {
  AddScan();
  foreign_.AddService("/sim_worker", "/reset", "rosrpc://127.0.0.1:5001", kSim);
  main_.AddPublisher("/client", "/worker_1/rollout/goal", "t/T", kClient);
  main_.AddPublisher("/mirrored/worker_2/x_00000000", "/worker_2/scan", "t/T", kClient);
  Tick();
  relay_->WithdrawAll();
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
  EXPECT_EQ(main_.ServiceUri("/reset"), "");
  EXPECT_THAT(Publishers(foreign_, "/worker_1/rollout/goal"), IsEmpty());
  EXPECT_EQ(Publishers(main_, "/worker_2/scan").size(), 1u);
  EXPECT_THAT(relay_->status().at_local, IsEmpty());
}

TEST_F(RelayTest, WithdrawAllServesTheOtherMasterWhenOneIsSilent) {
  AddScan();
  main_.AddPublisher("/client", "/worker_1/rollout/goal", "t/T", kClient);
  Tick();
  foreign_.is_silent = true;
  relay_->WithdrawAll();
  EXPECT_THAT(Publishers(main_, kScan), IsEmpty());
}

TEST_F(RelayTest, ATopicOfUnknownTypeWaitsUntilItIsKnown) {
  foreign_.AddPublisher("/sim_worker", kScan, "*", kSim);
  Tick();
  EXPECT_EQ(main_.num_changes, 0);
  AddScan();
  Tick();
  EXPECT_EQ(Publishers(main_, kScan).size(), 1u);
}

TEST_F(RelayTest, WhatAMasterRejectsIsAskedOnceAndHoldsUpNothingElse) {
  main_.rejects = {"/worker_1/a"};
  foreign_.AddPublisher("/sim_worker", "/worker_1/a", "t/T", kSim);
  foreign_.AddPublisher("/sim_worker", "/worker_1/b", "t/T", kSim);
  TickFor(2.0);
  EXPECT_EQ(Publishers(main_, "/worker_1/b").size(), 1u);
  EXPECT_EQ(main_.num_changes, 2);
  EXPECT_THAT(log_, Contains(HasSubstr("rejected by the master: topic=/worker_1/a")));
}

TEST_F(RelayTest, ManyMirrorsOfOneNodeCostOnePingEach) {
  for (int i = 0; i < 10; ++i) {
    foreign_.AddPublisher("/sim_worker", "/worker_1/t" + std::to_string(i), "t/T", kSim);
  }
  Tick();
  EXPECT_THAT(pinger_.pinged, ElementsAre(kSim));
}

TEST_F(RelayTest, SameInputGivesTheSameCallsInTheSameOrder) {
  const auto play = [this] {
    FakeMaster main(main_.uri()), foreign(foreign_.uri());
    FakePinger pinger;
    Relay relay(params_, HostNames{}, &main, &foreign, &pinger);
    log_.clear();
    for (int i = 0; i < 30; ++i) {
      foreign.AddPublisher("/n" + std::to_string(i % 7), "/worker_1/t" + std::to_string(i), "t/T",
                           "http://127.0.0.1:" + std::to_string(4000 + i % 7));
      if (i == 20) foreign.Restart();
      relay.Tick(0.05 * i);
    }
    return log_;
  };
  const auto first = play();
  EXPECT_GT(first.size(), 20u);
  EXPECT_EQ(first, play());
}

}  // namespace
}  // namespace hires::relay::relay_test
