#include "planning/search/state_update.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "planning/support/path_bench.h"

namespace hires::planning::state_update_test {
namespace {

using hires::test_support::PathBench;

/// Steps that have only effects, applied one after the other to the facts (p) and (q).
class StateUpdateTest : public ::testing::Test {
 protected:
  /// Whether (!step) with these deletes and adds is carried out.
  bool Apply(const std::string& deletes, const std::string& adds, const std::string& more = "") {
    bench_ = std::make_unique<PathBench>(
        more + "(:operator (!step ?x) () " + deletes + " " + adds + ")", "((p) (q))");
    bench_->path.protections().Add(bench_->Term("(p)"));
    const CompiledOperator& applied = bench_->Operator("!step");
    StepEffects effects(&bench_->path);
    effects.Read(applied, bench_->path.bindings().Make(applied.num_slots));
    StateUpdate update(bench_->program, &bench_->path);
    const bool applies = update.Apply(effects, applied);
    lost_ = applies ? "" : bench_->terms.ToString(update.lost());
    return applies;
  }
  bool Holds(const std::string& atom) { return bench_->Holds(atom); }

  std::unique_ptr<PathBench> bench_;
  std::string lost_;
};

TEST_F(StateUpdateTest, DeletesThenAdds) {
  EXPECT_TRUE(Apply("((q) (r))", "((r) (s))"));
  EXPECT_FALSE(Holds("(q)"));
  EXPECT_TRUE(Holds("(r)"));
  EXPECT_TRUE(Holds("(s)"));
}

TEST_F(StateUpdateTest, RefusesToTakeAwayAProtectedFactBeforeItChangesAnything) {
  EXPECT_FALSE(Apply("((q) (p))", "((r))"));
  EXPECT_EQ(lost_, "(p)");
  EXPECT_TRUE(Holds("(q)"));
  EXPECT_FALSE(Holds("(r)"));
}

TEST_F(StateUpdateTest, AProtectedFactMayGoWhereItIsAddedAgainOrProtectedNoMore) {
  EXPECT_TRUE(Apply("((p))", "((p))"));
  EXPECT_TRUE(Apply("((p) (:protection (p)))", "()"));
  EXPECT_FALSE(Holds("(p)"));
}

TEST_F(StateUpdateTest, AProtectedAtomMayFollowFromAnAxiomInstead) {
  EXPECT_TRUE(Apply("((p))", "()", "(:- (p) ((q)))"));
  EXPECT_FALSE(Apply("((p) (q))", "()", "(:- (p) ((q)))"));
  EXPECT_EQ(lost_, "(p)");
}

TEST_F(StateUpdateTest, WhatIsToBeProtectedHasToHold) {
  EXPECT_TRUE(Apply("()", "((r) (:protection (r)))"));
  EXPECT_EQ(bench_->path.protections().Count(bench_->Term("(r)")), 1);
  EXPECT_FALSE(Apply("()", "((:protection (r)))"));
  EXPECT_EQ(lost_, "(r)");
}

TEST_F(StateUpdateTest, AnAtomWithAVariableIsNoFact) {
  try {
    Apply("()", "((r ?x))");
    FAIL() << "was added";
  } catch (const base::ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "d.lisp:1: operator !step adds (r ?0), which is no fact without variables; bind "
                 "them in its precondition");
  }
}

TEST(StepEffectsTest, ForallCollectsOncePerSolutionInTheOrderOfFacts) {
  PathBench bench("(:operator (!step) () ((forall (?x) ((in ?x)) ((in ?x)))) ((out)))",
                  "((in a) (in b))");
  const CompiledOperator& applied = bench.Operator("!step");
  StepEffects effects(&bench.path);
  const std::uint32_t variables = bench.path.bindings().Make(applied.num_slots);
  effects.Read(applied, variables);
  EXPECT_EQ(effects.deletes(), (std::vector<Term>{bench.Term("(in a)"), bench.Term("(in b)")}));
  EXPECT_EQ(effects.adds(), (std::vector<Term>{bench.Term("(out)")}));
  effects.Read(applied, variables);  // replaces what was read before
  EXPECT_EQ(effects.deletes().size(), 2u);
}

}  // namespace
}  // namespace hires::planning::state_update_test
