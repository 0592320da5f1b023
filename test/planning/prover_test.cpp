#include "planning/proof/prover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hires/base/error.h"
#include "planning/support/proof_bench.h"

// The order of solutions was asked of SHOP3 4.3; engine_test.cpp holds it in whole plans.
namespace hires::planning::prover_test {
namespace {

using hires::test_support::ProofBench;

const std::string kFacts = "((p a) (p b) (q b) (q c))";

std::string All(const std::string& condition, bool newest_first, const std::string& axioms = "") {
  return ProofBench("?x", condition, kFacts, axioms).Solutions(newest_first);
}

TEST(ProverTest, TakesFactsByAge) {
  EXPECT_EQ(All("((p ?x))", false), "a b");
  EXPECT_EQ(All("((p ?x))", true), "b a");
}

TEST(ProverTest, TakesAxiomsAfterFactsTheLastOneFirstWhereAllAreWanted) {
  const std::string axioms = "(:- (p one) ()) (:- (p two) ())";
  EXPECT_EQ(All("((p ?x))", false, axioms), "a b two one");
  EXPECT_EQ(All("((p ?x))", true, axioms), "b a one two");
}

TEST(ProverTest, TakesTheSolutionsOfAnOrTheOtherWayRoundWhereAllAreWanted) {
  EXPECT_EQ(All("((or (p ?x) (q ?x)))", false), "c b b a");
  EXPECT_EQ(All("((or (p ?x) (q ?x)))", true), "a b b c");
}

TEST(ProverTest, TriesLaterBranchesOfAnAxiomOnlyWhileNoneHolds) {
  const std::string axioms = "(:- (r ?y) ((none ?y)) ((p ?y)) ((q ?y)))";
  EXPECT_EQ(All("((r ?x))", false, axioms), "a b");
}

TEST(ProverTest, ProvesAGroundGoalOnce) {
  EXPECT_EQ(All("((q ?x) (r))", false, "(:- (r) ((p ?y)))"), "b c");
}

TEST(ProverTest, ImplyHoldsWhereItsConditionDoesNot) {
  EXPECT_EQ(All("((q ?x) (imply (p ?x) (none)))", false), "c");
}

TEST(ProverTest, AnImplyThatNothingBindsIsRefusedInASentence) {
  try {
    All("((imply (p ?x) (none)))", false);
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(": the first part of an imply must have"));
  }
}

TEST(ProverTest, SetofGathersEachSolutionOnce) {
  EXPECT_EQ(All("((setof ?y (or (p ?y) (p ?y)) ?x))", true), "(b a)");
  EXPECT_EQ(All("((setof ?y (p ?y) ?x))", false), "(a b)");
}

TEST(ProverTest, CutLeavesNoOtherSolution) {
  ProofBench bench("?x", "((p ?x))", kFacts);
  ASSERT_TRUE(bench.prover.Solve(bench.goals(), bench.frame, false));
  EXPECT_EQ(bench.prover.num_choices(), 1u);
  bench.prover.Cut(0);
  EXPECT_EQ(bench.Value("?x"), "a");
  EXPECT_EQ(bench.prover.num_choices(), 0u);
}

TEST(ProverTest, ProvesLeavesNothingBehind) {
  ProofBench bench("?x", "((p ?x))", kFacts, "(:- (r ?y) ((p ?y)) ((q ?y)))");
  ASSERT_TRUE(bench.prover.Solve(bench.goals(), bench.frame, false));
  const Prover::Mark before = bench.prover.Remember();
  EXPECT_TRUE(bench.prover.Proves(bench.Term("(r c)")));
  EXPECT_FALSE(bench.prover.Proves(bench.Term("(r d)")));
  const Prover::Mark after = bench.prover.Remember();
  EXPECT_EQ(before.continuations, after.continuations);
  EXPECT_EQ(before.arguments, after.arguments);
  EXPECT_EQ(bench.Value("?x"), "a");
  ASSERT_TRUE(bench.prover.Next(0));
  EXPECT_EQ(bench.Value("?x"), "b");
}

TEST(ProverTest, TellsTheFurthestGoalThatItReached) {
  ProofBench bench("?x", "((p ?x) (q ?x) (none ?x))", kFacts);
  bench.prover.set_tracing(&bench.method().variables);
  EXPECT_FALSE(bench.prover.Solve(bench.goals(), bench.frame, false));
  EXPECT_EQ(bench.prover.furthest(), "goal 3 (none b)");
}

TEST(ProverTest, GivesUpWhenItIsInterrupted) {
  ProofBench bench("?x", "((loop ?x))", kFacts, "(:- (loop ?y) ((p ?z) (p ?u) (loop ?y)))");
  int questions = 0;
  bench.prover.set_interrupt([&] { return ++questions == 2; });
  EXPECT_FALSE(bench.prover.Solve(bench.goals(), bench.frame, false));
  EXPECT_TRUE(bench.prover.interrupted());
  EXPECT_EQ(bench.prover.inferences(), 2 * 4096u);
  EXPECT_EQ(bench.prover.num_choices(), 0u);
}

}  // namespace
}  // namespace hires::planning::prover_test
