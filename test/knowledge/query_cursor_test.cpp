#include "knowledge/query/query_cursor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/messages.h"

namespace hires::knowledge::query_cursor_test {
namespace {

using temporal::kForever;
using test_support::ConfigErrorOf;
using ::testing::HasSubstr;

TEST(QueryPositionTest, OrderIsByNameWithoutCaseThenWorldStartAndWriting) {
  const QueryPosition mug{"mug1", 0, 5.0, 7};
  EXPECT_TRUE(mug < (QueryPosition{"Mug2", 0, 0.0, 1}));
  EXPECT_TRUE(mug < (QueryPosition{"MUG1", 1, 0.0, 1}));
  EXPECT_TRUE(mug < (QueryPosition{"MUG1", 0, 6.0, 1}));
  EXPECT_TRUE(mug < (QueryPosition{"MUG1", 0, 5.0, 8}));
  EXPECT_FALSE(mug < (QueryPosition{"MUG1", 0, 5.0, 7}));
}

TEST(QueryCursorTest, ComesBackFromItsTextToTheBit) {
  for (const double start : {0.1, -1e-300, kForever, -kForever}) {
    const QueryCursor cursor{12, {"a:b:", 3, start, 9}};
    const QueryCursor read = ReadCursor(ToString(cursor));
    EXPECT_EQ(read.as_of, 12);
    EXPECT_EQ(read.last.name, "a:b:");
    EXPECT_EQ(read.last.world, 3);
    EXPECT_EQ(read.last.start, start);
    EXPECT_EQ(read.last.id, 9);
  }
}

TEST(QueryCursorTest, RefusesWhatIsNone) {
  // The last is a start that is no number.
  for (const char* text : {"", "1:2:3", "x:0:0:1:mug1", "-1:0:0:1:mug1", "1:0:0:1x:mug1",
                           "1:0:7ff8000000000000:1:mug1"}) {
    EXPECT_THAT(ConfigErrorOf([&] { ReadCursor(text); }), HasSubstr("is malformed")) << text;
  }
}

TEST(PageStartTest, TheFirstPageBeginsWithTheLastChange) {
  const PageStart start = StartOfPage("", 40);
  EXPECT_EQ(start.as_of, 40);
  EXPECT_FALSE(start.after);
}

TEST(PageStartTest, LaterPagesKeepTheFirstOnesChangeUnlessTheStoreNeverHadIt) {
  const std::string cursor = ToString(QueryCursor{30, {"mug1", 0, 1.0, 2}});
  EXPECT_EQ(StartOfPage(cursor, 40).as_of, 30);
  EXPECT_EQ(StartOfPage(cursor, 20).as_of, 20);
  ASSERT_TRUE(StartOfPage(cursor, 40).after);
  EXPECT_EQ(StartOfPage(cursor, 40).after->name, "mug1");
}

}  // namespace
}  // namespace hires::knowledge::query_cursor_test
