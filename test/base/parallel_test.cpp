#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace hires::base::parallel_test {
namespace {

Crew CrewOf(int threads) {
  Crew crew;
  crew.threads = threads;
  return crew;
}

TEST(DoInParallelTest, DoesEveryTaskOnce) {
  for (const int threads : {1, 2, 7, 200}) {
    std::vector<int> done(100, 0);
    EXPECT_TRUE(
        DoInParallel(100, 100.0, CrewOf(threads), [&](int task, const Advance&) { ++done[task]; }));
    EXPECT_EQ(done, std::vector<int>(100, 1)) << threads << " threads";
  }
}

TEST(DoInParallelTest, NothingToDoIsDoneAtOnce) {
  EXPECT_TRUE(DoInParallel(0, 0.0, CrewOf(3), [](int, const Advance&) { FAIL(); }));
}

TEST(DoInParallelTest, ThrowsWhatATaskThrewAndStartsNoMore) {
  std::atomic<int> begun{0};
  const auto work = [&](int task, const Advance&) {
    ++begun;
    if (task == 3) throw std::runtime_error("task 3");
  };
  try {
    DoInParallel(1000, 1000.0, CrewOf(1), work);
    FAIL() << "swallowed";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "task 3");
  }
  EXPECT_EQ(begun, 4);
}

TEST(DoInParallelTest, SaysWhenItWasCancelled) {
  std::atomic<int> done{0};
  Crew crew = CrewOf(1);
  crew.cancelled = [&] { return done >= 5; };
  EXPECT_FALSE(DoInParallel(1000, 1000.0, crew, [&](int, const Advance&) { ++done; }));
  EXPECT_EQ(done, 5);
}

TEST(DoInParallelTest, ReportsShares) {
  std::vector<double> shares;
  Crew crew = CrewOf(1);
  std::atomic<bool> seen{false};
  crew.on_progress = [&](double fraction, double) {
    shares.push_back(fraction);
    seen = true;
  };
  // The second task ends when progress was reported, so that no clock decides.
  DoInParallel(2, 4.0, crew, [&](int task, const Advance& advance) {
    advance(2.0);
    while (task == 1 && !seen) advance(0.0);
  });
  ASSERT_FALSE(shares.empty());
  for (const double share : shares) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
  }
}

}  // namespace
}  // namespace hires::base::parallel_test
