#include "hires/base/work_thread.h"

#include <gmock/gmock.h>

#include <future>
#include <vector>

namespace hires::base::work_thread_test {
namespace {

using ::testing::ElementsAre;

TEST(WorkThreadTest, WorksInTheOrderOfPosting) {
  std::vector<int> done;  // of the thread until `end` is ready
  std::promise<void> end;
  WorkThread thread;
  for (int i = 0; i < 3; ++i) thread.Post([&done, i] { done.push_back(i); });
  thread.Post([&] { end.set_value(); });
  end.get_future().wait();
  EXPECT_THAT(done, ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace hires::base::work_thread_test
