#include "hires/base/resource_use.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace hires::base::resource_use_test {
namespace {

TEST(ResourceUseTest, WorkOfThisThreadUsesItsTime) {
  const double before = ThreadCpuSeconds();
  EXPECT_GE(before, 0.0);
  volatile double sum = 0.0;
  while (ThreadCpuSeconds() <= before) {
    for (int i = 0; i < 1000; ++i) sum = sum + i;
  }
  EXPECT_GT(ThreadCpuSeconds(), before);
}

TEST(ResourceUseTest, ThePeakContainsWhatIsUsed) {
  constexpr std::size_t kBytes = 64'000'000;
  const std::vector<char> used(kBytes, 'x');
  EXPECT_GE(PeakMegabytes(), 1e-6 * static_cast<double>(used.size()));
}

}  // namespace
}  // namespace hires::base::resource_use_test
