#include "planning/proof/fact_matcher.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planning/support/proof_bench.h"

namespace hires::planning::fact_matcher_test {
namespace {

using hires::test_support::ProofBench;

/// A goal (on ...) over the facts of a bench.
class FactMatcherTest : public ::testing::Test {
 protected:
  AtomView On(const std::vector<Term>& arguments) {
    arguments_ = arguments;
    return {arguments_.data(), bench_.terms.Symbol("on"),
            static_cast<std::uint32_t>(arguments_.size())};
  }
  /// Second arguments of the facts on the walk that unify with (on FIRST ?y), in its order.
  std::string Found(AtomView atom, bool newest_first) {
    std::string text;
    for (auto walk = facts_.Begin(atom, newest_first); !walk.done();
         walk = facts_.Next(atom, walk)) {
      const Bindings::Mark mark = bench_.bindings.Remember();
      if (facts_.Unify(atom, walk.fact)) text += bench_.Value("?x") + bench_.Value("?y") + " ";
      bench_.bindings.Undo(mark);
    }
    return text;
  }

  ProofBench bench_{"?x ?y", "()", "((on a b) (on c d) (on a e) (on f f) (on a))"};
  FactMatcher facts_{&bench_.terms, &bench_.bindings, &bench_.state};
  std::vector<Term> arguments_;
};

TEST_F(FactMatcherTest, WalksFromTheOldestOrTheNewest) {
  const AtomView all = On({bench_.Variable("?x"), bench_.Variable("?y")});
  EXPECT_EQ(Found(all, false), "ab cd ae ff ");
  EXPECT_EQ(Found(all, true), "ff ae cd ab ");
}

TEST_F(FactMatcherTest, PassesOverFactsWithOtherGroundArguments) {
  const AtomView of_a = On({bench_.Term("a"), bench_.Variable("?y")});
  int steps = 0;
  for (auto walk = facts_.Begin(of_a, false); !walk.done(); walk = facts_.Next(of_a, walk)) ++steps;
  EXPECT_EQ(steps, 2);
}

TEST_F(FactMatcherTest, RefusesAFactThatGivesOneVariableTwoValues) {
  EXPECT_EQ(Found(On({bench_.Variable("?x"), bench_.Variable("?x")}), false),
            "f" + bench_.Value("?y") + " ");
}

TEST_F(FactMatcherTest, HoldsSaysWhetherAGroundAtomIsAFact) {
  EXPECT_TRUE(facts_.Holds(On({bench_.Term("c"), bench_.Term("d")})));
  EXPECT_FALSE(facts_.Holds(On({bench_.Term("d"), bench_.Term("c")})));
  EXPECT_FALSE(facts_.Holds(On({bench_.Term("c")})));
  EXPECT_TRUE(facts_.Holds(On({bench_.Term("a")})));
}

TEST_F(FactMatcherTest, HoldsForSomeBindsNothing) {
  EXPECT_TRUE(facts_.HoldsForSome(On({bench_.Variable("?x"), bench_.Variable("?x")})));
  EXPECT_FALSE(facts_.HoldsForSome(On({bench_.Term("c"), bench_.Term("b")})));
  EXPECT_FALSE(facts_.HoldsForSome(On({})));
  EXPECT_EQ(bench_.bindings.Deref(bench_.Variable("?x")), bench_.Variable("?x"));
}

}  // namespace
}  // namespace hires::planning::fact_matcher_test
