#include "lab/src/graph/process_watch.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <memory>

#include "hires/base/process.h"

namespace hires::lab::process_watch_test {
namespace {

using base::ChildProcess;
using base::ProcessOptions;
using base::SteadyNow;
using ::testing::HasSubstr;
using ::testing::Optional;

base::ProcessOptions Shell(const std::string& script) {
  base::ProcessOptions options;
  options.command = {"/bin/sh", "-c", script};
  return options;
}

template <typename Condition>
bool SoonTrue(const Condition& is_true) {
  const double give_up = base::SteadyNow() + 10.0;
  while (!is_true() && base::SteadyNow() < give_up) {
  }
  return is_true();
}

const Descendant* Find(const std::vector<Descendant>& all, const std::string& name) {
  for (const Descendant& each : all) {
    if (each.name == name) return &each;
  }
  return nullptr;
}

/// A shell that stands for roslaunch, with two processes below it, one of them named as a node is.
class BreakdownWatchTest : public ::testing::Test {
 protected:
  BreakdownWatchTest()
      : system_(Shell("/bin/sh -c 'read x; :' sh __name:=planner < /dev/zero & sleep 100; :")) {
    EXPECT_TRUE(SoonTrue([&] {
      const auto all = Descendants();
      return Find(all, "planner") != nullptr && Find(all, "sleep") != nullptr;
    }));
  }
  static int PidOf(const std::string& name) { return Find(Descendants(), name)->pid; }

  base::ChildProcess system_;
};

TEST(DescendantsTest, ProcessesMayComeAndGoMeanwhile) {
  const base::ChildProcess busy(Shell("while :; do /bin/true & /bin/true & wait; done"));
  const double end = base::SteadyNow() + 0.5;
  std::size_t most = 0;
  while (base::SteadyNow() < end) most = std::max(most, Descendants().size());
  EXPECT_GT(most, 1u) << "none of them was ever seen";
}

TEST_F(BreakdownWatchTest, AllIsWellWhileAllLive) {
  BreakdownWatch watch(1.0);
  EXPECT_EQ(watch.Broken(0.0), std::nullopt);
  EXPECT_EQ(watch.Broken(100.0), std::nullopt);
}

TEST_F(BreakdownWatchTest, AKilledNodeIsNamed) {
  BreakdownWatch watch(1.0);
  kill(PidOf("planner"), SIGKILL);
  EXPECT_TRUE(SoonTrue([&] { return watch.Broken(0.0).has_value(); }));
  EXPECT_THAT(watch.Broken(0.0), Optional(HasSubstr("planner (pid ")));
  EXPECT_THAT(watch.Broken(0.0), Optional(HasSubstr("died")));
}

TEST_F(BreakdownWatchTest, ANodeThatComesLaterIsWatchedAndAnyOtherProgramIsNot) {
  BreakdownWatch watch(1.0);
  const base::ChildProcess other(Shell("sleep 0.01"));
  const base::ChildProcess node(Shell("/bin/sh -c 'read x; :' sh __name:=late < /dev/zero; :"));
  ASSERT_TRUE(SoonTrue([&] {
    EXPECT_EQ(watch.Broken(0.0), std::nullopt);
    return Find(Descendants(), "late") != nullptr;
  }));
  EXPECT_TRUE(SoonTrue([&] {
    const auto all = Descendants();
    return std::none_of(all.begin(), all.end(),
                        [&](const auto& each) { return each.pid == other.pid(); });
  }));
  EXPECT_EQ(watch.Broken(0.0), std::nullopt);
  const int late = PidOf("late");
  kill(late, SIGKILL);
  EXPECT_TRUE(SoonTrue([&] { return watch.Broken(0.0).has_value(); }));
  EXPECT_THAT(watch.Broken(0.0), Optional(HasSubstr("late (pid ")));
}

TEST_F(BreakdownWatchTest, AStoppedProcessIsNoticedAfterItsLimitAndOneThatGoesOnIsNot) {
  BreakdownWatch watch(10.0);
  const int pid = PidOf("sleep");
  const auto state_is = [&](char state) {
    return [=] {
      const auto all = Descendants();
      const Descendant* found = Find(all, "sleep");
      return found != nullptr && (found->state == 'T') == (state == 'T');
    };
  };
  kill(pid, SIGSTOP);
  ASSERT_TRUE(SoonTrue(state_is('T')));
  EXPECT_EQ(watch.Broken(100.0), std::nullopt);
  EXPECT_EQ(watch.Broken(109.0), std::nullopt);
  kill(pid, SIGCONT);
  ASSERT_TRUE(SoonTrue(state_is('S')));
  EXPECT_EQ(watch.Broken(115.0), std::nullopt) << "it goes on";
  kill(pid, SIGSTOP);
  ASSERT_TRUE(SoonTrue(state_is('T')));
  EXPECT_EQ(watch.Broken(120.0), std::nullopt);
  EXPECT_THAT(watch.Broken(130.0), Optional(HasSubstr("is stopped since 10 s")));
}

}  // namespace
}  // namespace hires::lab::process_watch_test
