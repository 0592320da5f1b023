#include "hires/base/check.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"

namespace hires::base::check_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

int Half(int even) {
  HIRES_CHECK(even % 2 == 0, "an odd number has no whole half");
  return even / 2;
}

TEST(CheckTest, AKeptPromiseCostsNothing) { EXPECT_EQ(Half(4), 2); }

TEST(CheckTest, ABrokenPromiseNamesFileLineTextAndCondition) {
  EXPECT_THAT([] { Half(3); },
              ThrowsMessage<std::logic_error>(AllOf(HasSubstr("check_test.cpp:15: "),
                                                    HasSubstr("an odd number has no whole half"),
                                                    HasSubstr("(broken: even % 2 == 0)"))));
}

TEST(CheckTest, TheConditionIsLookedAtOnce) {
  int looks = 0;
  HIRES_CHECK(++looks == 1, "looked at twice");
  EXPECT_EQ(looks, 1);
}

TEST(CheckTest, TheTextIsBuiltOnlyWhenItIsNeeded) {
  bool built = false;
  const auto text = [&built] {
    built = true;
    return std::string("text");
  };
  HIRES_CHECK(true, text());
  EXPECT_FALSE(built);
}

TEST(ConfigErrorTest, IsNoFaultOfTheCaller) {
  const ConfigError error("a.yaml: mass is -1 kg");
  EXPECT_STREQ(error.what(), "a.yaml: mass is -1 kg");
  EXPECT_EQ(dynamic_cast<const std::logic_error*>(static_cast<const std::exception*>(&error)),
            nullptr);
}

}  // namespace
}  // namespace hires::base::check_test
