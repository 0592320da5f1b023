#include "hires/relay/name_filter.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"

namespace hires::relay::name_filter_test {
namespace {

std::string ErrorOf(const std::vector<std::string>& patterns) {
  try {
    const NameFilter filter(patterns, "relay.yaml: foreign_pubs");
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(NameFilterTest, AnExactNameCoversItselfAlone) {
  const NameFilter filter({"/worker_1/scan"}, "x");
  EXPECT_TRUE(filter.Matches("/worker_1/scan"));
  for (const char* other : {"/worker_1/scan2", "/a/worker_1/scan", "/worker_1", "/worker_1/sca"}) {
    EXPECT_FALSE(filter.Matches(other)) << other;
  }
}

TEST(NameFilterTest, AnExpressionMustCoverTheWholeName) {
  const NameFilter filter({"/ping|/worker_1/.*"}, "x");
  EXPECT_TRUE(filter.Matches("/ping"));
  EXPECT_TRUE(filter.Matches("/worker_1/a/b"));
  EXPECT_FALSE(filter.Matches("/ping_4711_1699/get_loggers"));
  EXPECT_FALSE(filter.Matches("/other/worker_1/a"));
  EXPECT_FALSE(filter.Matches("/worker_10/a"));
}

TEST(NameFilterTest, NoExpressionCoversWhatEveryMasterHas) {
  const NameFilter all({"/.*"}, "x");
  for (const char* name : {"/clock", "/tf", "/tf_static", "/rosout", "/rosout_agg"}) {
    EXPECT_TRUE(IsPrivateToMaster(name)) << name;
    EXPECT_FALSE(all.Matches(name)) << name;
    EXPECT_TRUE(NameFilter({name}, "x").Matches(name)) << name;
  }
  EXPECT_TRUE(all.Matches("/clock2"));
  EXPECT_TRUE(all.Matches("/worker_1/tf"));
}

TEST(NameFilterTest, AnEmptyFilterCoversNothing) {
  EXPECT_TRUE(NameFilter().is_empty());
  EXPECT_FALSE(NameFilter().Matches("/a"));
  EXPECT_FALSE(NameFilter().Matches(""));
}

TEST(NameFilterTest, ANameOfManyThousandCharactersIsNoMatchAndNoCrash) {
  EXPECT_FALSE(NameFilter({"/.*"}, "x").Matches("/" + std::string(5'000'000, 'a')));
}

TEST(NameFilterTest, AddCoversWhatEitherCovers) {
  NameFilter filter({"/a"}, "x");
  filter.Add(NameFilter({"/b", "/c/.*"}, "x"));
  for (const char* name : {"/a", "/b", "/c/d"}) EXPECT_TRUE(filter.Matches(name)) << name;
  EXPECT_FALSE(filter.Matches("/d"));
}

TEST(NameFilterTest, BadPatternsAreNamedWithTheirKey) {
  EXPECT_THAT(ErrorOf({"/ok", "scan"}),
              testing::AllOf(testing::HasSubstr("relay.yaml: foreign_pubs"),
                             testing::HasSubstr("'scan' is not absolute")));
  EXPECT_THAT(ErrorOf({""}), testing::HasSubstr("'' is not absolute"));
  EXPECT_THAT(ErrorOf({"/a("}), testing::HasSubstr("'/a(' is no regular expression"));
  EXPECT_THAT(ErrorOf({"/" + std::string(256, 'a')}),
              testing::HasSubstr("has 257 characters, at most 256"));
}

}  // namespace
}  // namespace hires::relay::name_filter_test
