#include "planning/proof/proof_stack.h"

#include <gtest/gtest.h>

#include "hires/planning/term.h"
#include "planning/proof/bindings.h"

namespace hires::planning::proof_stack_test {
namespace {

using Continuation = ProofStack::Continuation;
using Choice = ProofStack::Choice;

class ProofStackTest : public ::testing::Test {
 protected:
  TermTable terms_;
  Bindings bindings_{&terms_};
  ProofStack stack_{&terms_, &bindings_};
  Goal first_, then_, last_;
};

TEST_F(ProofStackTest, RestoreBringsBackEverythingSinceThePush) {
  stack_.Begin(&first_, bindings_.Make(1), true);
  const Term variable(Term::Kind::kVariable, 0);
  stack_.arguments().push_back(terms_.Symbol("a"));
  stack_.PushReturn(&last_);
  stack_.Push(Choice::Kind::kNot, &then_);
  const ProofStack::Position before = stack_.at();

  bindings_.Unify(variable, terms_.Symbol("b"));
  bindings_.Make(5);
  stack_.arguments().push_back(terms_.Symbol("c"));
  stack_.tuples().push_back(terms_.Symbol("d"));
  stack_.PushReturn(&then_);
  stack_.at().depth = 3;
  stack_.at().newest_first = false;
  stack_.Restore();

  EXPECT_EQ(stack_.num_choices(), 1u);
  EXPECT_EQ(stack_.at().continuation, before.continuation);
  EXPECT_EQ(stack_.at().depth, 0u);
  EXPECT_TRUE(stack_.at().newest_first);
  EXPECT_EQ(stack_.num_arguments(), 1u);
  EXPECT_TRUE(stack_.tuples().empty());
  EXPECT_EQ(bindings_.size(), 1u);
  EXPECT_EQ(bindings_.Deref(variable), variable);
}

TEST_F(ProofStackTest, RestoreForgetsPairsUnlessTheyAreHeld) {
  stack_.Begin(&first_, 0, false);
  stack_.Push(Choice::Kind::kNot, &first_);
  const std::size_t before = terms_.Mark();
  stack_.HoldPairs(true);
  terms_.Pair(terms_.Symbol("a"), Term());
  stack_.Restore();
  EXPECT_EQ(terms_.Mark(), before + 1);
  stack_.HoldPairs(false);
  stack_.Restore();
  EXPECT_EQ(terms_.Mark(), before);
}

TEST_F(ProofStackTest, ContinuationsAreLeftNewestFirst) {
  stack_.Begin(&first_, 7, true);
  stack_.PushReturn(&last_);
  stack_.at().frame = 8;
  stack_.PushReturn(&then_);
  stack_.at().frame = 9;
  stack_.Leave();
  EXPECT_EQ(stack_.at().goal, &then_);
  EXPECT_EQ(stack_.at().frame, 8u);
  stack_.Leave();
  EXPECT_EQ(stack_.at().goal, &last_);
  EXPECT_EQ(stack_.at().frame, 7u);
  EXPECT_EQ(stack_.at().continuation, ProofStack::kNone);
}

TEST_F(ProofStackTest, NothingComesAfterTheLastGoalOfAChain) {
  stack_.Begin(&first_, 0, true);
  stack_.PushReturn(nullptr);
  EXPECT_EQ(stack_.at().continuation, ProofStack::kNone);
}

TEST_F(ProofStackTest, ACutDropsChoicesVariablesAndArgumentsOfTheProof) {
  stack_.Begin(&first_, bindings_.Make(2), true);
  stack_.Push(Choice::Kind::kFacts, &last_);
  stack_.PushCut(&then_);
  bindings_.Make(4);
  stack_.arguments().push_back(terms_.Symbol("a"));
  stack_.Push(Choice::Kind::kFacts, &first_);
  EXPECT_EQ(stack_.Leave().kind, Continuation::Kind::kCut);
  EXPECT_EQ(stack_.at().goal, &then_);
  EXPECT_EQ(stack_.num_choices(), 1u);
  EXPECT_EQ(bindings_.size(), 2u);
  EXPECT_EQ(stack_.num_arguments(), 0u);
}

TEST_F(ProofStackTest, ACommitLeavesItsChoiceWithoutAnotherBranch) {
  stack_.Begin(&first_, 0, true);
  stack_.Push(Choice::Kind::kBranches, nullptr).next = 1;
  stack_.PushContinuation(Continuation::Kind::kCommit, &then_, 0);
  stack_.Push(Choice::Kind::kFacts, &first_);
  stack_.Leave();
  EXPECT_EQ(stack_.num_choices(), 2u);
  EXPECT_EQ(stack_.choice(0).next, ProofStack::kNone);
}

TEST_F(ProofStackTest, ARefutationDropsTheChoiceOfTheNegationToo) {
  stack_.Begin(&first_, 0, true);
  stack_.Push(Choice::Kind::kNot, &then_);
  stack_.PushContinuation(Continuation::Kind::kRefute, nullptr, 0);
  stack_.Push(Choice::Kind::kFacts, &first_);
  EXPECT_EQ(stack_.Leave().kind, Continuation::Kind::kRefute);
  EXPECT_EQ(stack_.num_choices(), 0u);
}

}  // namespace
}  // namespace hires::planning::proof_stack_test
