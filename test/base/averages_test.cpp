#include "base/averages.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace hires::base::averages_test {
namespace {

TEST(AveragesTest, TheMeanOfNoValuesIsZero) {
  EXPECT_EQ(Mean({}), 0.0);
  EXPECT_EQ(Mean({1.0, 2.0, 6.0}), 3.0);
}

TEST(AveragesTest, TheMedianIsTheUpperOfTwoMiddles) {
  EXPECT_EQ(Median(std::vector<double>{5.0}), 5.0);
  EXPECT_EQ(Median(std::vector<double>{9.0, 1.0, 4.0}), 4.0);
  EXPECT_EQ(Median(std::vector<int>{4, 1, 9, 3}), 4);
}

TEST(AveragesTest, NoValuesHaveNoMedian) {
  EXPECT_THROW(Median(std::vector<double>{}), std::logic_error);
}

}  // namespace
}  // namespace hires::base::averages_test
