#include "planning/search/sorted_solutions.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planning/support/path_bench.h"

namespace hires::planning::sorted_solutions_test {
namespace {

using hires::test_support::PathBench;

/// The values of ?a, the only variable besides the sorted ?n, in order; "none" where there are
/// none.
std::string Sorted(const std::string& sort_by, const std::string& facts) {
  PathBench bench("(:method (t ?a ?n) " + sort_by + " ())", facts);
  Bindings& bindings = bench.path.bindings();
  const std::vector<std::string>& names =
      bench.program.Methods(bench.terms.Symbol("t")).at(0)->variables;
  const std::uint32_t variables = bindings.Make(2);
  const Bindings::Mark open = bindings.Remember();
  SortedSolutions sorted;
  if (!sorted.Gather(bench.Precondition("t"), variables, 2, &bench.path)) return "none";
  std::string text;
  while (sorted.has_next()) {
    bindings.Undo(open);
    sorted.BindNext(&bindings);
    const Term a = Instantiator::Variable(variables, names[0] == "?a" ? 0 : 1);
    text += bench.terms.ToString(bindings.Resolve(a));
  }
  return text;
}

TEST(SortedSolutionsTest, AreInTheOrderOfTheirKeysAndEqualOnesAsFound) {
  const std::string facts = "((size a 2) (size b 1) (size c 2))";
  EXPECT_EQ(Sorted("(:sort-by ?n ((size ?a ?n)))", facts), "bac");
  EXPECT_EQ(Sorted("(:sort-by ?n #'> ((size ?a ?n)))", facts), "acb");
}

TEST(SortedSolutionsTest, GatherSaysWhereThereIsNone) {
  EXPECT_EQ(Sorted("(:sort-by ?n ((size ?a ?n)))", "()"), "none");
}

TEST(SortedSolutionsTest, ClearForgetsThem) {
  PathBench bench("(:method (t) (:sort-by 1 ((p))) ())", "((p))");
  SortedSolutions sorted;
  EXPECT_FALSE(sorted.gathered());
  ASSERT_TRUE(sorted.Gather(bench.Precondition("t"), 0, 0, &bench.path));
  EXPECT_TRUE(sorted.gathered());
  EXPECT_TRUE(sorted.has_next());  // a solution, though it binds nothing
  sorted.Clear();
  EXPECT_FALSE(sorted.gathered());
  EXPECT_FALSE(sorted.has_next());
}

}  // namespace
}  // namespace hires::planning::sorted_solutions_test
