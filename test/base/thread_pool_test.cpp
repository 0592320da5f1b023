#include "hires/base/thread_pool.h"

#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace hires::base::thread_pool_test {
namespace {

using ::testing::ElementsAre;

TEST(ThreadPoolTest, OneThreadWorksInTheOrderOfPosting) {
  std::vector<int> done;  // of the thread until `end` is ready
  std::promise<void> end;
  ThreadPool thread(1);
  for (int i = 0; i < 3; ++i) thread.Post([&done, i] { done.push_back(i); });
  thread.Post([&] { end.set_value(); });
  end.get_future().wait();
  EXPECT_THAT(done, ElementsAre(0, 1, 2));
}

TEST(ThreadPoolTest, SeveralThreadsWorkAtOnce) {
  constexpr int kThreads = 3;
  std::atomic<int> begun{0};
  std::promise<void> all;
  const std::shared_future<void> all_begun = all.get_future().share();
  std::vector<std::promise<void>> done(kThreads);
  ThreadPool pool(kThreads);
  for (std::promise<void>& each : done) {
    pool.Post([&begun, &all, &each, all_begun] {
      if (++begun == kThreads) all.set_value();
      all_begun.wait();  // for ever, unless all are being done
      each.set_value();
    });
  }
  for (std::promise<void>& each : done) each.get_future().wait();
}

TEST(ThreadPoolTest, ItsEndAwaitsWhatIsBeingDone) {
  std::promise<void> begun, may_end;
  bool is_done = false;
  std::thread opener;
  {
    ThreadPool pool(1);
    pool.Post([&] {
      begun.set_value();
      may_end.get_future().wait();
      is_done = true;
    });
    begun.get_future().wait();
    opener = std::thread([&] { may_end.set_value(); });
  }
  EXPECT_TRUE(is_done);
  opener.join();
}

TEST(ThreadPoolTest, WantsAThread) { EXPECT_THROW(ThreadPool(0), std::logic_error); }

}  // namespace
}  // namespace hires::base::thread_pool_test
