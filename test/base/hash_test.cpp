#include "hires/base/hash.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace hires::base::hash_test {
namespace {

template <typename... Values>
std::uint64_t HashOf(Values... values) {
  Hasher hasher;
  (hasher.Add(values), ...);
  return hasher.value();
}

// Golden values from FNV-1a's definition, computed apart from this code; numbers go in with the
// lowest byte first.
TEST(HasherTest, GivesTheValuesOfFnv1a) {
  EXPECT_EQ(HexOf(HashOf()), "cbf29ce484222325");
  EXPECT_EQ(HexOf(HashOf(std::uint64_t{0})), "a8c7f832281a39c5");
  EXPECT_EQ(HexOf(HashOf(std::string_view("a"))), "529a4ddc8ff56bbf");
  EXPECT_EQ(HexOf(HashOf(1.0)), "aab1693229ba1db8");
}

TEST(HasherTest, ALiteralIsHashedAsText) { EXPECT_EQ(HashOf("a"), HashOf(std::string_view("a"))); }

TEST(HasherTest, WhereOneTextEndsMatters) {
  EXPECT_NE(HashOf("ab", "c"), HashOf("a", "bc"));
  EXPECT_NE(HashOf("", "a"), HashOf("a", ""));
  EXPECT_NE(HashOf(""), HashOf());
}

TEST(HasherTest, BothZerosAreOneNumber) {
  EXPECT_EQ(HashOf(-0.0), HashOf(0.0));
  EXPECT_NE(HashOf(std::numeric_limits<double>::denorm_min()), HashOf(0.0));
}

TEST(HasherTest, OrderMatters) { EXPECT_NE(HashOf(1.0, 2.0), HashOf(2.0, 1.0)); }

TEST(HasherTest, NeighbouringNumbersDiffer) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t i = 0; i < 10000; ++i) {
    seen.insert(HashOf(i));
    seen.insert(HashOf(1e-3 * static_cast<double>(i + 1)));
  }
  EXPECT_EQ(seen.size(), 20000u);
}

TEST(HexOfTest, AlwaysWritesSixteenDigits) {
  EXPECT_EQ(HexOf(0), "0000000000000000");
  EXPECT_EQ(HexOf(0xABCULL), "0000000000000abc");
  EXPECT_EQ(HexOf(~0ULL), "ffffffffffffffff");
}

}  // namespace
}  // namespace hires::base::hash_test
