#include "nodes/planner/plan_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <map>

namespace hires_ros::plan_pool_test {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kLimit = 60.0;  // [s] ends a broken test, measures nothing

std::shared_ptr<PlanJob> Job(int id) {
  auto job = std::make_shared<PlanJob>();
  job->id = id;
  return job;
}

hires::PlanResult ResultOf(const PlanJob& job) {
  hires::PlanResult result;
  result.expansions = static_cast<std::uint64_t>(job.id);
  return result;
}

/// Jobs that run until they are told to go on, or are cancelled.
class Gate {
 public:
  hires::PlanResult Hold(PlanJob* job) {
    begun_.Post(job->id);
    std::unique_lock<std::mutex> lock(mutex_);
    while (!open_[job->id] && !job->is_cancelled) changed_.wait_for(lock, kPoll);
    hires::PlanResult result = ResultOf(*job);
    result.outcome = job->is_cancelled ? hires::PlanResult::CANCELLED : hires::PlanResult::FOUND;
    return result;
  }
  void Open(int id) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      open_[id] = true;
    }
    changed_.notify_all();
  }
  /// The job that began next.
  int Begun() { return begun_.WaitAndTake(std::chrono::duration<double>(kLimit)).value_or(-1); }
  bool HasMoreBegun() { return begun_.Take().has_value(); }

 private:
  static constexpr std::chrono::milliseconds kPoll{1};
  hires::base::Mailbox<int> begun_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int, bool> open_;
};

class PlanPoolTest : public ::testing::Test {
 protected:
  void Start(int num_threads) {
    pool_ = std::make_unique<PlanPool>(
        num_threads, [this](PlanJob* job) { return gate_.Hold(job); }, &answered_);
  }
  PlanAnswered Answered() {
    const auto answered = answered_.WaitAndTake(std::chrono::duration<double>(kLimit));
    return answered.value_or(PlanAnswered{-1, {}});
  }

  Gate gate_;
  hires::base::Mailbox<PlanAnswered> answered_;
  std::unique_ptr<PlanPool> pool_;
};

TEST_F(PlanPoolTest, AsManyRunAsThereAreThreadsAndTheRestWaitsInItsOrder) {
  Start(2);
  for (int id = 1; id <= 4; ++id) pool_->Submit(Job(id));
  EXPECT_THAT((std::vector<int>{gate_.Begun(), gate_.Begun()}), UnorderedElementsAre(1, 2));
  EXPECT_EQ(pool_->num_running(), 2);
  EXPECT_EQ(pool_->num_waiting(), 2);
  EXPECT_FALSE(gate_.HasMoreBegun());
  gate_.Open(2);
  EXPECT_EQ(Answered().id, 2);
  EXPECT_EQ(gate_.Begun(), 3);
  gate_.Open(3);
  EXPECT_EQ(Answered().id, 3);
  EXPECT_EQ(gate_.Begun(), 4);
}

TEST_F(PlanPoolTest, EachAnswerIsThatOfItsJob) {
  Start(4);
  for (int id = 0; id < 100; ++id) {
    gate_.Open(id);
    pool_->Submit(Job(id));
  }
  std::vector<bool> seen(100, false);
  for (int i = 0; i < 100; ++i) {
    const PlanAnswered answered = Answered();
    ASSERT_GE(answered.id, 0);
    EXPECT_EQ(answered.result.expansions, static_cast<std::uint64_t>(answered.id));
    EXPECT_EQ(answered.result.outcome, hires::PlanResult::FOUND);
    EXPECT_FALSE(seen[answered.id]);
    seen[answered.id] = true;
  }
}

TEST_F(PlanPoolTest, AJobThatWaitsCanBeTakenBack) {
  Start(1);
  for (int id = 1; id <= 3; ++id) pool_->Submit(Job(id));
  EXPECT_EQ(gate_.Begun(), 1);
  EXPECT_TRUE(pool_->Withdraw(2));
  EXPECT_FALSE(pool_->Withdraw(2));
  EXPECT_FALSE(pool_->Withdraw(1));
  EXPECT_FALSE(pool_->Withdraw(7));
  gate_.Open(1);
  EXPECT_EQ(Answered().id, 1);
  EXPECT_EQ(gate_.Begun(), 3);
}

TEST_F(PlanPoolTest, AJobTellsThatItHasBegun) {
  Start(1);
  const auto first = Job(1);
  const auto second = Job(2);
  pool_->Submit(first);
  pool_->Submit(second);
  EXPECT_EQ(gate_.Begun(), 1);
  EXPECT_GE(first->begun, 0.0);
  EXPECT_LT(second->begun, 0.0);
}

TEST_F(PlanPoolTest, TheEndCancelsWhatRunsAndForgetsWhatWaits) {
  Start(2);
  for (int id = 1; id <= 4; ++id) pool_->Submit(Job(id));
  gate_.Begun();
  gate_.Begun();
  pool_.reset();
  std::vector<int> ids;
  while (const auto answered = answered_.Take()) {
    ids.push_back(answered->id);
    EXPECT_EQ(answered->result.outcome, hires::PlanResult::CANCELLED);
  }
  EXPECT_THAT(ids, UnorderedElementsAre(1, 2));
  EXPECT_FALSE(gate_.HasMoreBegun());
}

}  // namespace
}  // namespace hires_ros::plan_pool_test
