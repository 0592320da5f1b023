#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

namespace hires::test_support {

/// How many cases of a property are looked at; with HIRES_LONG_TESTS in the environment, as
/// `scripts/test --long` has it, five times as many. Every run looks at the same ones, whatever
/// else runs in the program; RC_PARAMS looks at others, e.g. "seed=77 max_success=3000".
struct PropertyCases {
  int count{100};
  int size{100};  ///< how large the largest one may be, as rapidcheck counts
};

inline rc::detail::TestParams ParamsOf(const PropertyCases& cases) {
  if (std::getenv("RC_PARAMS") != nullptr) return rc::detail::configuration().testParams;
  rc::detail::TestParams params;
  params.seed = 1;
  params.maxSuccess = cases.count * (std::getenv("HIRES_LONG_TESTS") != nullptr ? 5 : 1);
  params.maxSize = cases.size;
  return params;
}

/// Fails the test that runs now, with the smallest case found, if the property does not hold.
template <typename Property>
void CheckProperty(const PropertyCases& cases, Property&& property) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  rc::detail::TestMetadata metadata;
  metadata.id = std::string(test->test_suite_name()) + "/" + test->name();
  metadata.description = test->name();
  const auto result =
      rc::detail::checkTestable(std::forward<Property>(property), metadata, ParamsOf(cases));
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  if (!result.template is<rc::detail::SuccessResult>()) FAIL() << text.str();
  if (!result.template get<rc::detail::SuccessResult>().distribution.empty()) {
    std::printf("%s\n", text.str().c_str());
  }
}

}  // namespace hires::test_support

/// HIRES_PROPERTY(Suite, Name, (arguments)) { body }: a property as a test. The file says before it
/// how many cases it wants: `constexpr test_support::PropertyCases kPropertyCases{300};`.
#define HIRES_PROPERTY(Suite, Name, Arguments)                                        \
  void Property_##Suite##_##Name Arguments;                                           \
  TEST(Suite, Name) {                                                                 \
    ::hires::test_support::CheckProperty(kPropertyCases, &Property_##Suite##_##Name); \
  }                                                                                   \
  void Property_##Suite##_##Name Arguments
