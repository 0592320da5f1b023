#include "hires/planning/reference_prover.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/planning/planner.h"
#include "planning/support/conditions.h"
#include "planning/support/plan_text.h"

namespace hires::planning::reference_prover_test {
namespace {

using hires::test_support::Condition;
using hires::test_support::Read;
using hires::test_support::Text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

// ------------------------------------------------------------------------------------- bindings

TEST(ReferenceProverTest, FindsEveryBindingOldestFactFirst) {
  const Condition condition("((p ?x) (q ?x ?y))", "((p b) (p a) (q a 1) (q b 2) (q b 3))");
  EXPECT_THAT(condition.Values("?y"), ElementsAre("2", "3", "1"));
}

TEST(ReferenceProverTest, TakesTheNewestFactFirstWhereAsked) {
  const Condition condition("((p ?x))", "((p a) (p b) (p c))");
  ProofQuestion question = condition.Question();
  question.newest_first = true;
  ReferenceProver prover = condition.Prover();
  EXPECT_EQ(ToString(prover.FirstProof(question)->values.at("?x")), "c");
}

TEST(ReferenceProverTest, KnownValuesHoldFromTheBeginning) {
  const Condition condition("((not (p ?x)) (q ?x))", "((p a) (q a) (q b))");
  ProofQuestion question = condition.Question();
  ReferenceProver prover = condition.Prover();
  EXPECT_FALSE(prover.Holds(question));  // (p ?x) matches something
  question.known = {{"?x", MakeSymbol("b")}};
  EXPECT_TRUE(prover.Holds(question));
  question.known = {{"?x", MakeSymbol("a")}};
  EXPECT_FALSE(prover.Holds(question));
}

TEST(ReferenceProverTest, ExpectedValuesAreOnlySeenWhereAGoalBindsThem) {
  const Condition blind("((not (p ?x)) (q ?x))", "((p a) (q a) (q b))");
  ProofQuestion question = blind.Question();
  question.expected = {{"?x", MakeSymbol("b")}};
  ReferenceProver prover = blind.Prover();
  EXPECT_FALSE(prover.Holds(question));
  const Condition seeing("((q ?x) (not (p ?x)))", "((p a) (q a) (q b))");
  ReferenceProver other = seeing.Prover();
  ProofQuestion second = seeing.Question();
  second.expected = {{"?x", MakeSymbol("b")}};
  EXPECT_TRUE(other.Holds(second));
  second.expected = {{"?x", MakeSymbol("a")}};
  EXPECT_FALSE(other.Holds(second));
}

TEST(ReferenceProverTest, AnUnexpectedValueOfAnAssignmentIsNoProof) {
  const Condition condition("((p ?x) (assign ?y (+ ?x 1)))", "((p 1) (p 2))");
  ProofQuestion question = condition.Question();
  question.expected = {{"?y", MakeInteger(3)}};
  ReferenceProver prover = condition.Prover();
  const std::vector<Proof> proofs = prover.AllProofs(question);
  ASSERT_EQ(proofs.size(), 1u);
  EXPECT_EQ(ToString(proofs[0].values.at("?x")), "2");
}

// --------------------------------------------------------------------------------- connectives

TEST(ReferenceProverTest, AnEmptyConditionHoldsOnce) {
  EXPECT_EQ(Condition("()", "()").All().size(), 1u);
}

TEST(ReferenceProverTest, OrTriesItsPartsInTurn) {
  const Condition condition("((or (p ?x) (q ?x)))", "((q 1) (p 2))");
  EXPECT_THAT(condition.Values("?x"), ElementsAre("2", "1"));
}

TEST(ReferenceProverTest, NotHoldsWhereNothingMatches) {
  EXPECT_TRUE(Condition("((not (p ?x)))", "((q a))").Holds());
  EXPECT_FALSE(Condition("((not (p ?x)))", "((p a))").Holds());
  EXPECT_TRUE(Condition("((not (and (p ?x) (q ?x))))", "((p a) (q b))").Holds());
}

TEST(ReferenceProverTest, ImplyHoldsWithoutItsConditionOrBindsByItsConclusion) {
  EXPECT_TRUE(Condition("((imply (p a) (q b)))", "()").Holds());
  EXPECT_TRUE(Condition("((imply (p a) (q b)))", "((p a) (q b))").Holds());
  EXPECT_FALSE(Condition("((imply (p a) (q b)))", "((p a))").Holds());
  EXPECT_THAT(Condition("((imply (p a) (q ?x)))", "((p a) (q b) (q c))").Values("?x"),
              ElementsAre("b", "c"));
}

TEST(ReferenceProverTest, ExistsIsATestThatBindsNothing) {
  EXPECT_THAT(Condition("((exists (?y) (q ?y ?x)) (p ?x))", "((p a) (q b c))").Values("?x"),
              ElementsAre("a"));
  EXPECT_FALSE(Condition("((p ?x) (exists (?y) (q ?y ?x)))", "((p a) (q b c))").Holds());
}

TEST(ReferenceProverTest, ForallAsksOfEveryInstance) {
  const std::string forall = "((forall (?x) (p ?x) (q ?x)))";
  EXPECT_TRUE(Condition(forall, "()").Holds());
  EXPECT_TRUE(Condition(forall, "((p a) (p b) (q b) (q a))").Holds());
  EXPECT_FALSE(Condition(forall, "((p a) (p b) (q b))").Holds());
}

TEST(ReferenceProverTest, AQuantifiedVariableIsItsOwn) {
  const Condition condition("((p ?x) (forall (?x) (q ?x) (r ?x)))", "((p a) (q b) (r b))");
  EXPECT_THAT(condition.Values("?x"), ElementsAre("a"));
}

TEST(ReferenceProverTest, SetofCollectsEachOnceAndFailsWhereThereIsNothing) {
  EXPECT_THAT(Condition("((setof ?x (p ?x ?y) ?all))", "((p a 1) (p b 1) (p a 2))").Values("?all"),
              ElementsAre("(a b)"));
  EXPECT_FALSE(Condition("((setof ?x (p ?x ?y) ?all))", "()").Holds());
  EXPECT_THAT(Condition("((bagof ?x (p ?x ?y) ?all))", "((p a 1) (p b 1) (p a 2))").Values("?all"),
              ElementsAre("(a b a)"));
}

TEST(ReferenceProverTest, AnExpectedSetMayHaveAnyOrder) {
  const Condition condition("((setof ?x (p ?x) ?all))", "((p a) (p b))");
  ReferenceProver prover = condition.Prover();
  ProofQuestion question = condition.Question();
  question.expected = {{"?all", Read("(b a)")}};
  EXPECT_TRUE(prover.Holds(question));
  question.expected = {{"?all", Read("(b)")}};
  EXPECT_FALSE(prover.Holds(question));
  question.expected = {{"?all", Read("(b a a)")}};
  EXPECT_FALSE(prover.Holds(question));
}

TEST(ReferenceProverTest, AssignAndEvalCompute) {
  EXPECT_THAT(
      Condition("((p ?x) (assign ?y (* 2 ?x)) (eval (> ?y 3)))", "((p 1) (p 2))").Values("?y"),
      ElementsAre("4"));
  EXPECT_THAT(Condition("((assign* ?x '(a b c)) (not (p ?x)))", "((p b))").Values("?x"),
              ElementsAre("a", "c"));
  EXPECT_THAT(Condition("((p ?x) (call eq '?x 'b))", "((p a) (p b))").Values("?x"),
              ElementsAre("b"));
}

TEST(ReferenceProverTest, AVariableThatIsAGoalStandsForAnAtom) {
  EXPECT_THAT(Condition("((want ?g) ?g)", "((want (p a)) (want (p b)) (p b))").Values("?g"),
              ElementsAre("(p b)"));
}

// --------------------------------------------------------------------------------------- axioms

TEST(ReferenceProverAxiomTest, FactsComeBeforeAxioms) {
  const Condition condition("((p ?x))", "((q 1) (p 2))", "(:- (p ?x) ((q ?x)))");
  EXPECT_THAT(condition.Values("?x"), ElementsAre("2", "1"));
}

TEST(ReferenceProverAxiomTest, TheFirstBranchWithAProofIsTheOnlyOneUsed) {
  const std::string axiom = "(:- (p ?x) first ((q ?x)) second ((r ?x)))";
  EXPECT_THAT(Condition("((p ?x))", "((q 1) (q 2) (r 3))", axiom).Values("?x"),
              ElementsAre("1", "2"));
  EXPECT_THAT(Condition("((p ?x))", "((r 3))", axiom).Values("?x"), ElementsAre("3"));
  // The branch stays chosen although what comes after it fails.
  EXPECT_FALSE(Condition("((p ?x) (s ?x))", "((q 1) (r 3) (s 3))", axiom).Holds());
}

TEST(ReferenceProverAxiomTest, SeveralAxiomsOfAPredicateAreAllTried) {
  const Condition condition("((p ?x))", "((q 1) (r 2))",
                            "(:- (p ?x) ((q ?x))) (:- (p ?x) ((r ?x)))");
  EXPECT_THAT(condition.Values("?x"), ElementsAre("1", "2"));
}

TEST(ReferenceProverAxiomTest, AFirstBranchHasOneProof) {
  const Condition condition("((p ?x))", "((q 1) (q 2))", "(:- (p ?x) (:first (q ?x)))");
  EXPECT_THAT(condition.Values("?x"), ElementsAre("2"));
}

TEST(ReferenceProverAxiomTest, ReachesThroughItself) {
  const std::string above =
      "(:- (above ?x ?y) ((on ?x ?y))) (:- (above ?x ?y) ((on ?x ?z) (above ?z ?y)))";
  EXPECT_THAT(Condition("((above a ?y))", "((on a b) (on b c) (on c d))", above).Values("?y"),
              ElementsAre("b", "c", "d"));
}

TEST(ReferenceProverAxiomTest, TakesListsApart) {
  const std::string all_true =
      "(:- (all-true nil) ()) (:- (all-true (?g . ?gs)) (?g (all-true ?gs)))";
  EXPECT_TRUE(Condition("((all-true ((p a) (q b))))", "((p a) (q b))", all_true).Holds());
  EXPECT_FALSE(Condition("((all-true ((p a) (q b))))", "((p a))", all_true).Holds());
}

TEST(ReferenceProverAxiomTest, ALongChainIsNoMatterOfTheStack) {
  std::string facts = "(";
  for (int i = 0; i < 5000; ++i) {
    facts += "(next " + std::to_string(i) + " " + std::to_string(i + 1) + ")";
  }
  const Condition condition(
      "((reach 0 5000))", facts + ")",
      "(:- (reach ?x ?x) ()) (:- (reach ?x ?y) ((next ?x ?z) (reach ?z ?y)))");
  EXPECT_TRUE(condition.Holds());
}

TEST(ReferenceProverAxiomTest, CallingItselfWithoutEndIsAnError) {
  const Condition condition("((p a))", "()", "(:- (p ?x) ((p ?x)))");
  EXPECT_THAT([&] { condition.Holds(); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("d.lisp:1:"), HasSubstr("more than 10000 levels deep"),
                        HasSubstr("(p a)"), HasSubstr("a branch that ends"))));
}

TEST(ReferenceProverAxiomTest, CallingItselfUnderANotWithoutEndIsAnError) {
  const Condition condition("((p a))", "()", "(:- (p ?x) ((not (p ?x))))");
  EXPECT_THAT([&] { condition.Holds(); },
              ThrowsMessage<base::ConfigError>(HasSubstr("more than 250 levels deep")));
}

TEST(ReferenceProverTest, AnUnboundGoalIsAnError) {
  EXPECT_THAT([] { Condition("(?g (p ?g))", "((p a))").Holds(); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("d.lisp:1:"), HasSubstr("the goal ?g is not bound"))));
}

TEST(ReferenceProverTest, AssignEachNeedsAList) {
  EXPECT_THAT([] { Condition("((assign* ?x (+ 1 2)))", "()").Holds(); },
              ThrowsMessage<base::ConfigError>(HasSubstr("needs a list, (+ 1 2) has the value 3")));
}

// -------------------------------------------------------------------------------------- reasons

std::string Support(const Condition& condition) { return Text(condition.All().at(0).support); }
std::string Reads(const Condition& condition) { return Text(condition.All().at(0).reads); }

TEST(SupportTest, NamesFactsUsedDirectlyAndThroughAxioms) {
  const std::string axiom = "(:- (ready ?x) ((clean ?x) (dry ?x)))";
  EXPECT_EQ(Support(Condition("((cup ?x) (ready ?x))", "((cup c) (dry c) (clean c))", axiom)),
            "(cup c) (clean c) (dry c)");
}

TEST(SupportTest, OfTwoProofsTheFirstInTheOrderOfFactsCounts) {
  EXPECT_EQ(Support(Condition("((or (p ?x) (q ?y)))", "((q 1) (p 2) (p 3))")), "(p 2)");
}

TEST(SupportTest, WhatFailedOnTheWayIsNoReason) {
  EXPECT_EQ(Support(Condition("((p ?x) (q ?x))", "((p 1) (p 2) (q 2))")), "(p 2) (q 2)");
}

TEST(SupportTest, ANegatedAtomKeepsTheVariablesThatAreLeft) {
  const Condition condition("((p ?x) (not (on ?y ?x)))", "((p a) (on a b))");
  EXPECT_EQ(Support(condition), "(p a) not(on ?y a)");
  EXPECT_EQ(Reads(condition), "(on ?y a)");
}

TEST(SupportTest, OfANegatedConjunctionTheAtomThatFailsCounts) {
  EXPECT_EQ(Support(Condition("((not (and (p a) (q a) (r a))))", "((p a) (r a))")), "not(q a)");
}

TEST(SupportTest, ANegatedNegationRestsOnTheFact) {
  EXPECT_EQ(Support(Condition("((not (not (p a))))", "((p a))")), "(p a)");
}

TEST(SupportTest, ANegatedAxiomRestsOnWhatItLacked) {
  const std::string axiom = "(:- (dirty ?x) ((wet ?x)) ((used ?x)))";
  EXPECT_EQ(Support(Condition("((not (dirty c)))", "()", axiom)), "not(wet c) not(used c)");
  EXPECT_EQ(Support(Condition("((not (same a b)))", "()", "(:- (same ?x ?x) ())")), "");
}

TEST(SupportTest, ForallRestsOnItsInstances) {
  const std::string forall = "((forall (?x) (p ?x) (q ?x)))";
  const Condition some(forall, "((p a) (p b) (q b) (q a))");
  EXPECT_EQ(Support(some), "(p a) (q a) (p b) (q b)");
  EXPECT_THAT(Reads(some), HasSubstr("(p ?x"));
  const Condition none(forall, "((q a))");
  EXPECT_THAT(Support(none), ::testing::StartsWith("not(p ?x"));
}

TEST(SupportTest, ImplyRestsOnBothSidesOrOnTheMissingOne) {
  EXPECT_EQ(Support(Condition("((imply (p a) (q b)))", "((p a) (q b))")), "(p a) (q b)");
  EXPECT_EQ(Support(Condition("((imply (p a) (q b)))", "()")), "not(p a)");
}

TEST(SupportTest, EachFactIsNamedOnce) {
  EXPECT_EQ(Support(Condition("((p a) (p ?x) (p a))", "((p a))")), "(p a)");
}

// ---------------------------------------------------------------------------------- two roads

/// A goal over p/1, q/2, r/1 (an axiom of two branches) and ?x, ?y, the symbols a, b, c.
std::string RandomGoal(base::Rng* rng, int depth) {
  const auto argument = [&] {
    static const char* const kArguments[] = {"?x", "?y", "a", "b", "c"};
    return std::string(kArguments[rng->Index(5)]);
  };
  switch (rng->Index(depth == 0 ? 3 : 8)) {
    case 0:
      return "(p " + argument() + ")";
    case 1:
      return "(q " + argument() + " " + argument() + ")";
    case 2:
      return "(r " + argument() + ")";
    case 3:
      return "(not " + RandomGoal(rng, depth - 1) + ")";
    case 4:
      return "(or " + RandomGoal(rng, depth - 1) + " " + RandomGoal(rng, depth - 1) + ")";
    case 5:
      return "(and " + RandomGoal(rng, depth - 1) + " " + RandomGoal(rng, depth - 1) + ")";
    case 6:
      return "(forall (?z) ((q ?z " + argument() + ")) (" + RandomGoal(rng, depth - 1) + "))";
    default:
      return "(imply (p a) (q b " + std::string(rng->Index(2) == 0 ? "a" : "b") + "))";
  }
}

std::string RandomFacts(base::Rng* rng) {
  std::string facts = "((s a) (s b) (s c)";
  for (const char* x : {"a", "b", "c"}) {
    if (rng->Index(2) == 0) facts += std::string(" (p ") + x + ")";
    for (const char* y : {"a", "b", "c"}) {
      if (rng->Index(3) == 0) facts += std::string(" (q ") + x + " " + y + ")";
    }
  }
  return facts + ")";
}

TEST(TwoRoadsTest, TheSearchFindsTheSameBindings) {
  const std::string axiom = "(:- (r ?v) ((q ?v ?w) (p ?w)) ((q ?w ?v) (not (p ?w))))";
  const std::string show = "(:operator (!show ?x ?y) () () ())";
  int num_found = 0;
  for (int seed = 0; seed < 400; ++seed) {
    base::Rng rng(seed);
    const std::string facts = RandomFacts(&rng);
    const std::string condition =
        "(" + RandomGoal(&rng, 2) + " " + RandomGoal(&rng, 2) + " (s ?x) (s ?y))";
    std::set<std::string> slow;
    for (const Proof& proof : Condition(condition, facts, axiom).All()) {
      slow.insert("(!show " + ToString(proof.values.at("?x")) + " " +
                  ToString(proof.values.at("?y")) + ")");
    }
    const std::vector<std::string> fast = hires::test_support::AllPlans(
        show + axiom + "(:method (t) " + condition + " ((!show ?x ?y)))", facts, "((t))");
    EXPECT_EQ(std::set<std::string>(fast.begin(), fast.end()), slow)
        << "seed " << seed << ": " << condition << " in " << facts;
    num_found += slow.empty() ? 0 : 1;
  }
  EXPECT_GT(num_found, 100);
}

}  // namespace
}  // namespace hires::planning::reference_prover_test
