#include "hires/temporal/interval.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "hires/base/error.h"
#include "hires/base/rng.h"

namespace hires::temporal::interval_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Row {
  Interval a;
  Allen relation;
};

// To [10, 20).
const Row kTable[] = {{{1, 5}, Allen::kBefore},           {{5, 10}, Allen::kMeets},
                      {{5, 15}, Allen::kOverlaps},        {{10, 15}, Allen::kStarts},
                      {{12, 18}, Allen::kDuring},         {{15, 20}, Allen::kFinishes},
                      {{10, 20}, Allen::kEquals},         {{5, 20}, Allen::kFinishedBy},
                      {{5, 25}, Allen::kContains},        {{10, 25}, Allen::kStartedBy},
                      {{15, 25}, Allen::kOverlappedBy},   {{20, 25}, Allen::kMetBy},
                      {{21, 25}, Allen::kAfter},          {{-kForever, kForever}, Allen::kContains},
                      {{10, kForever}, Allen::kStartedBy}};

TEST(AllenTest, ThirteenRelationsAndTheirInverses) {
  const Interval b{10, 20};
  std::set<Allen> seen;
  for (const Row& row : kTable) {
    EXPECT_EQ(Relation(row.a, b), row.relation) << row.a.start << " to " << row.a.finish;
    EXPECT_EQ(Relation(b, row.a), Inverse(row.relation)) << row.a.start << " to " << row.a.finish;
    EXPECT_EQ(Inverse(Inverse(row.relation)), row.relation);
    seen.insert(row.relation);
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(kNumAllen));
}

TEST(AllenTest, WordsAreReadBack) {
  for (int i = 0; i < kNumAllen; ++i) {
    const auto relation = static_cast<Allen>(i);
    EXPECT_EQ(ReadAllen(ToString(relation)), relation);
  }
  EXPECT_EQ(ToString(Allen::kOverlappedBy), "overlapped_by");
  EXPECT_EQ(ToString(Allen::kMetBy), "met_by");
}

TEST(AllenTest, AnUnknownWordNamesTheThirteen) {
  try {
    ReadAllen("befor");
    FAIL() << "was read";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'befor'"));
    for (int i = 0; i < kNumAllen; ++i) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(ToString(static_cast<Allen>(i)))));
    }
  }
}

TEST(AllenTest, AnIntervalWithoutTimeIsTheCallersFault) {
  EXPECT_THROW(Relation({1, 1}, {0, 2}), std::logic_error);
  EXPECT_THROW(Relation({0, 2}, {3, 1}), std::logic_error);
  EXPECT_THROW(PossibleRelations({0, 0}, {1, 1}, {2, 2}), std::logic_error);
}

TEST(PossibleRelationsTest, KnownEndsLeaveOne) {
  for (const Row& row : kTable) {
    EXPECT_THAT(
        PossibleRelations({row.a.start, row.a.start}, {row.a.finish, row.a.finish}, {10, 20}),
        ElementsAre(row.relation));
  }
}

TEST(PossibleRelationsTest, AnUncertainFinishLeavesSeveral) {
  EXPECT_THAT(PossibleRelations({5, 5}, {8, 15}, {10, 20}),
              ElementsAre(Allen::kBefore, Allen::kMeets, Allen::kOverlaps));
}

TEST(PossibleRelationsTest, NothingKnownLeavesAll) {
  const Bounds anything;
  EXPECT_EQ(PossibleRelations(anything, anything, {10, 20}).size(),
            static_cast<std::size_t>(kNumAllen));
}

TEST(PossibleRelationsTest, NoTimeAtAllLeavesNone) {
  EXPECT_THAT(PossibleRelations({5, 5}, {5, 5}, {10, 20}), IsEmpty());
}

TEST(PossibleRelationsTest, AgreesWithEveryIntervalOfAGrid) {
  const base::Rng seed(7);
  for (int round = 0; round < 300; ++round) {
    base::Rng rng = seed.Fork(static_cast<std::uint64_t>(round));
    const int s = rng.Index(12), f = rng.Index(12), b = rng.Index(10);
    const int late_s = s + rng.Index(4), late_f = f + rng.Index(4), end_b = b + 1 + rng.Index(4);
    const Interval other{1.0 * b, 1.0 * end_b};
    std::set<Allen> expected;
    for (double start = s; start <= late_s; start += 0.125) {
      for (double finish = f; finish <= late_f; finish += 0.125) {
        if (start < finish) expected.insert(Relation({start, finish}, other));
      }
    }
    const std::vector<Allen> possible =
        PossibleRelations({1.0 * s, 1.0 * late_s}, {1.0 * f, 1.0 * late_f}, other);
    EXPECT_EQ(std::set<Allen>(possible.begin(), possible.end()), expected)
        << "start " << s << ".." << late_s << " finish " << f << ".." << late_f << " to " << b
        << ".." << end_b;
  }
}

}  // namespace
}  // namespace hires::temporal::interval_test
