#include "planning/proof/instantiator.h"

#include <gtest/gtest.h>

#include "planning/support/proof_bench.h"

namespace hires::planning::instantiator_test {
namespace {

using hires::test_support::ProofBench;

TEST(InstantiatorTest, BuildReplacesBoundVariablesAndLeavesOthers) {
  ProofBench bench("(on ?x (of ?y) ?x)", "()", "()");
  ASSERT_TRUE(bench.bindings.Unify(bench.Variable("?x"), bench.Term("a")));
  const Term instance = bench.instances.Build(bench.head(0), bench.frame);
  EXPECT_FALSE(bench.terms.IsGround(instance));
  ASSERT_TRUE(bench.bindings.Unify(bench.Variable("?y"), bench.Term("(b c)")));
  EXPECT_EQ(bench.terms.ToString(bench.instances.Build(bench.head(0), bench.frame)),
            "(on a (of (b c)) a)");
  EXPECT_EQ(bench.terms.ToString(bench.bindings.Resolve(instance)), "(on a (of (b c)) a)");
}

TEST(InstantiatorTest, BuildIsTheSameInEachFrameOfAClause) {
  ProofBench bench("(p ?x)", "()", "()");
  const std::uint32_t other = bench.bindings.Make(bench.method().num_slots);
  ASSERT_TRUE(bench.bindings.Unify(bench.Variable("?x"), bench.Term("a")));
  ASSERT_TRUE(bench.bindings.Unify(Instantiator::Variable(other, 0), bench.Term("b")));
  EXPECT_EQ(bench.instances.Build(bench.head(0), bench.frame), bench.Term("(p a)"));
  EXPECT_EQ(bench.instances.Build(bench.head(0), other), bench.Term("(p b)"));
}

TEST(InstantiatorTest, MatchBindsWhatMakesBothEqual) {
  ProofBench bench("(on ?x . ?rest)", "()", "()");
  EXPECT_TRUE(bench.instances.Match(bench.head(0), bench.frame, bench.Term("(on a b c)")));
  EXPECT_EQ(bench.Value("?x"), "a");
  EXPECT_EQ(bench.Value("?rest"), "(b c)");
}

TEST(InstantiatorTest, MatchRefusesOneVariableForTwoTerms) {
  ProofBench bench("(on ?x ?x)", "()", "()");
  const Bindings::Mark mark = bench.bindings.Remember();
  EXPECT_FALSE(bench.instances.Match(bench.head(0), bench.frame, bench.Term("(on a b)")));
  bench.bindings.Undo(mark);
  EXPECT_TRUE(bench.instances.Match(bench.head(0), bench.frame, bench.Term("(on b b)")));
}

TEST(InstantiatorTest, CouldMatchComparesConstantsAndShapesAndBindsNothing) {
  ProofBench bench("(on ?x ?x b)", "()", "()");
  const auto could = [&](const std::string& term) {
    return bench.instances.CouldMatch(bench.head(0), bench.Term(term));
  };
  EXPECT_TRUE(could("(on a a b)"));
  EXPECT_TRUE(could("(on a c b)"));  // Match says no
  EXPECT_FALSE(could("(on a a c)"));
  EXPECT_FALSE(could("(on a a)"));
  EXPECT_FALSE(could("on"));
  EXPECT_EQ(bench.bindings.Deref(bench.Variable("?x")), bench.Variable("?x"));
}

}  // namespace
}  // namespace hires::planning::instantiator_test
