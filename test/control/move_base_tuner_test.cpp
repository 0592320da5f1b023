#include "hires/control/move_base_tuner.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "support/move_base_fakes.h"

namespace hires::control::move_base_tuner_test {
namespace {

using Phase = TunerState::Phase;
using test_support::FakePlanner;
using test_support::kFast;
using test_support::kSlow;
using ::testing::HasSubstr;

constexpr auto kLimit = std::chrono::seconds(60);  // ends a broken test; measures nothing

/// A planner on whose answers its caller may have to wait.
class GatedPlanner {
 public:
  Reconfigure Calls() {
    return [this](const std::string& server, const PlannerValues& changes) {
      std::unique_lock<std::mutex> lock(mutex_);
      ++num_calls_;
      changed_.notify_all();
      changed_.wait(lock, [this] { return is_open_; });
      return planner_.Call(server, changes);
    };
  }

  /// Does something with the planner while nobody else does.
  template <typename Function>
  auto With(Function function) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return function(planner_);
  }

  void Shut() {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_open_ = false;
    num_calls_ = 0;
  }
  void Open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void AwaitCall() {
    std::unique_lock<std::mutex> lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, kLimit, [this] { return num_calls_ > 0; }));
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  FakePlanner planner_;
  bool is_open_{true};
  int num_calls_{0};
};

class MoveBaseTunerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = ::testing::TempDir() + "tuner_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override {
    tuner_.reset();
    std::filesystem::remove_all(folder_);
  }

  MotionSetKeeper Keeper() {
    return MotionSetKeeper(test_support::NamesOfDwa(), folder_ + "/originals.yaml",
                           planner_.Calls());
  }

  void Start() {
    tuner_ = std::make_unique<MoveBaseTuner>(Keeper(), std::chrono::milliseconds(1),
                                             std::chrono::seconds(30));
  }

  /// Waits until the tuner is so far; what it says then.
  TunerState Await(Phase phase, std::uint64_t request) {
    const auto end = std::chrono::steady_clock::now() + kLimit;
    TunerState state = tuner_->state();
    while (state.phase != phase || state.request != request) {
      if (std::chrono::steady_clock::now() > end) {
        ADD_FAILURE() << "it stays in phase " << static_cast<int>(state.phase) << " of request "
                      << state.request << ": " << state.reason;
        break;
      }
      std::this_thread::yield();
      state = tuner_->state();
    }
    return state;
  }

  PlannerValues Values() {
    return planner_.With([](FakePlanner& planner) { return planner.values; });
  }

  std::string folder_;
  GatedPlanner planner_;
  const PlannerValues before_ = test_support::OldDwa();
  std::unique_ptr<MoveBaseTuner> tuner_;
};

TEST_F(MoveBaseTunerTest, ASetIsInForceForItsRequestAndThenPutBack) {
  Start();
  tuner_->Apply(7, "slow", kSlow);
  EXPECT_EQ(Await(Phase::kInForce, 7).reason, "");
  EXPECT_EQ(Values().at("max_vel_x"), 0.30);
  tuner_->Restore();
  Await(Phase::kAtRest, 0);
  EXPECT_EQ(Values(), before_);
}

TEST_F(MoveBaseTunerTest, WhatAKilledOneLeftIsPutBackAtTheStart) {
  Keeper().Apply("slow", kSlow);
  ASSERT_NE(Values(), before_);
  Start();
  Await(Phase::kAtRest, 0);
  EXPECT_EQ(Values(), before_);
}

TEST_F(MoveBaseTunerTest, NobodyDrivesBeforeTheRestOfAKilledOneIsPutBack) {
  Keeper().Apply("slow", kSlow);
  planner_.Shut();
  Start();
  planner_.AwaitCall();
  EXPECT_EQ(tuner_->state().phase, Phase::kRestoring);
  planner_.Open();
  Await(Phase::kAtRest, 0);
}

TEST_F(MoveBaseTunerTest, TheEndPutsBack) {
  Start();
  tuner_->Apply(7, "slow", kSlow);
  Await(Phase::kInForce, 7);
  tuner_.reset();
  EXPECT_EQ(Values(), before_);
}

TEST_F(MoveBaseTunerTest, NobodyWaitsForAPlannerThatHangsAndTheLastWishCounts) {
  Start();
  Await(Phase::kAtRest, 0);
  planner_.Shut();
  tuner_->Apply(1, "slow", kSlow);
  planner_.AwaitCall();
  EXPECT_EQ(tuner_->state().phase, Phase::kApplying);
  tuner_->Restore();
  EXPECT_EQ(tuner_->state().phase, Phase::kRestoring);
  tuner_->Apply(2, "fast", kFast);
  EXPECT_EQ(tuner_->state().request, 2u);
  planner_.Open();
  Await(Phase::kInForce, 2);
  EXPECT_EQ(Values().at("acc_lim_th"), 3.2);
  tuner_->Restore();
  Await(Phase::kAtRest, 0);
  EXPECT_EQ(Values(), before_);
}

TEST_F(MoveBaseTunerTest, ASetThatThePlannerDoesNotTakeFailsForItsRequest) {
  planner_.With([](FakePlanner& planner) { planner.lower["max_vel_x"] = 0.4; });
  Start();
  tuner_->Apply(7, "slow", kSlow);
  EXPECT_THAT(Await(Phase::kFailed, 7).reason, HasSubstr("max_vel_x is 0.4, wanted 0.3"));
  EXPECT_EQ(Values(), before_);
  tuner_->Apply(8, "fast", kFast);
  Await(Phase::kInForce, 8);
}

TEST_F(MoveBaseTunerTest, WhatCannotBePutBackIsTriedUntilItCan) {
  Start();
  tuner_->Apply(7, "slow", kSlow);
  Await(Phase::kInForce, 7);
  planner_.With([](FakePlanner& planner) { planner.is_missing = true; });
  tuner_->Restore();
  EXPECT_THAT(Await(Phase::kFailed, 0).reason, HasSubstr("no service"));
  planner_.With([](FakePlanner& planner) { planner.is_missing = false; });
  Await(Phase::kAtRest, 0);
  EXPECT_EQ(Values(), before_);
}

TEST_F(MoveBaseTunerTest, AnOldUpdateIsNoNewsButSomebodyElsesIs) {
  Start();
  tuner_->Apply(7, "slow", kSlow);
  Await(Phase::kInForce, 7);
  planner_.Shut();
  tuner_->OnUpdate(before_);  // from before the set was applied
  planner_.AwaitCall();       // so the planner is asked, and has the set
  planner_.Open();
  planner_.With([](FakePlanner& planner) { planner.values["max_vel_x"] = 0.5; });
  tuner_->OnUpdate(Values());
  EXPECT_THAT(Await(Phase::kFailed, 7).reason,
              HasSubstr("changed by another program: max_vel_x is 0.5, wanted 0.3"));
}

TEST_F(MoveBaseTunerTest, AnUpdateThatIsTheSetAsksNobody) {
  Start();
  tuner_->Apply(7, "slow", kSlow);
  Await(Phase::kInForce, 7);
  planner_.Shut();
  tuner_->OnUpdate(Values());
  tuner_->Restore();
  planner_.AwaitCall();
  EXPECT_EQ(tuner_->state().phase, Phase::kRestoring);
  planner_.Open();
  Await(Phase::kAtRest, 0);
}

}  // namespace
}  // namespace hires::control::move_base_tuner_test
