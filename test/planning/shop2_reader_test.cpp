#include "hires/planning/shop2_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "hires/base/text.h"
#include "support/messages.h"

namespace hires::planning::shop2_reader_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

using Kind = Formula::Kind;

Domain DomainOf(const std::string& items) {
  return ReadShop2Domain("(defdomain test (" + items + "))", "test.lisp");
}

Problem ProblemOf(const std::string& rest) {
  return ReadShop2Problems("(defproblem p " + rest + ")", "test.lisp").at(0);
}

/// Operators that the tasks in these tests need.
const char* const kOperators =
    "(:operator (!a ?x) () ()) (:operator (!b ?x) () ()) (:operator (!c . ?x) () ()) ";

/// The only branch of a method with this precondition and these tasks.
Branch BranchOf(const std::string& precondition, const std::string& tasks) {
  const Domain domain =
      DomainOf(kOperators + ("(:method (m ?x ?y) " + precondition + " " + tasks + ")"));
  return domain.methods.at(0).branches.at(0);
}

Precondition PreconditionOf(const std::string& text) { return BranchOf(text, "nil").precondition; }

const char* NameOf(Kind kind) {
  constexpr const char* kNames[] = {"seq",    "and",     "or",   "not",   "imply",
                                    "forall", "exists",  "atom", "goal",  "equal",
                                    "assign", "assign*", "eval", "setof", "bagof"};
  return kNames[static_cast<int>(kind)];
}

/// A formula in prefix form, with the kinds' names: "seq[atom(p ?x) not[goal?g]]".
std::string Outline(const Formula& formula) {
  std::string text = NameOf(formula.kind);
  for (const std::string& variable : formula.variables) text += variable;
  if (!formula.term.IsNil()) text += ToString(formula.term);
  if (!formula.expression.IsNil()) text += "=" + ToString(formula.expression);
  if (formula.parts.empty()) return text;
  std::vector<std::string> parts;
  for (const Formula& part : formula.parts) parts.push_back(Outline(part));
  return text + "[" + base::Join(parts, " ") + "]";
}

std::string OutlineOf(const std::string& precondition) {
  return Outline(PreconditionOf(precondition).condition);
}

/// A network as text: "<" before what must come first, "!" for immediate.
std::string Outline(const TaskNetwork& network) {
  std::vector<std::string> parts;
  for (const TaskItem& item : network.items) {
    const std::string inner =
        item.network.empty() ? ToString(item.task) : Outline(item.network.front());
    parts.push_back((item.immediate ? "immediate" : "") + inner);
  }
  std::string order;
  for (const auto& [before, after] : network.order) {
    order += " " + std::to_string(before) + "<" + std::to_string(after);
  }
  return "{" + base::Join(parts, " ") + order + "}";
}

std::string NetworkOf(const std::string& tasks) { return Outline(BranchOf("nil", tasks).subtasks); }

std::string Outline(const std::vector<Effect>& effects) {
  std::vector<std::string> parts;
  for (const Effect& effect : effects) {
    switch (effect.kind) {
      case Effect::Kind::kAtom:
        parts.push_back(ToString(effect.term));
        break;
      case Effect::Kind::kList:
        parts.push_back("list" + ToString(effect.term));
        break;
      case Effect::Kind::kProtection:
        parts.push_back("protect" + ToString(effect.term));
        break;
      case Effect::Kind::kForall:
        parts.push_back("forall[" + Outline(effect.condition) + " " + Outline(effect.effects) +
                        "]");
        break;
    }
  }
  return "{" + base::Join(parts, " ") + "}";
}

/// Precondition, deletes, adds and cost of an operator.
std::string OperatorOf(const std::string& parts) {
  const Operator op = DomainOf("(:operator (!o ?x ?y) " + parts + ")").operators.at(0);
  return Outline(op.precondition.condition) + " " + Outline(op.deletes) + " " + Outline(op.adds) +
         " " + ToString(op.cost);
}

// ----------------------------------------------------------------------------------- preconditions

TEST(PreconditionTest, NilAlwaysHolds) {
  EXPECT_EQ(OutlineOf("nil"), "seq");
  EXPECT_EQ(OutlineOf("()"), "seq");
}

TEST(PreconditionTest, OneAtomNeedsNoList) { EXPECT_EQ(OutlineOf("(p ?x)"), "atom(p ?x)"); }

TEST(PreconditionTest, AListIsASequenceAndListsWithinAreConjunctions) {
  EXPECT_EQ(OutlineOf("((p ?x) (q))"), "seq[atom(p ?x) atom(q)]");
  EXPECT_EQ(OutlineOf("((p))"), "seq[atom(p)]");
  EXPECT_EQ(OutlineOf("(((p) (q)) ((r)) nil)"), "seq[and[atom(p) atom(q)] seq[atom(r)] seq]");
}

TEST(PreconditionTest, WordsAreRead) {
  EXPECT_EQ(OutlineOf("(and (p) (or (q) (r)))"), "and[atom(p) or[atom(q) atom(r)]]");
  EXPECT_EQ(OutlineOf("((not (p)))"), "seq[not[atom(p)]]");
  EXPECT_EQ(OutlineOf("(imply (p) ((q) (r)))"), "imply[atom(p) and[atom(q) atom(r)]]");
  EXPECT_EQ(OutlineOf("(assign ?z (+ ?x (call * 2 ?y)))"), "assign?z=(+ ?x (* 2 ?y))");
  EXPECT_EQ(OutlineOf("(assign* ?z '(1 2))"), "assign*?z=(quote (1 2))");
  EXPECT_EQ(OutlineOf("(eval (not (eq '?x '?y)))"), "eval=(not (eq (quote ?x) (quote ?y)))");
  EXPECT_EQ(OutlineOf("(call #'< ?x 3)"), "eval=(< ?x 3)");
  EXPECT_EQ(OutlineOf("(setof ?g (goal ?g) ?gs)"), "setof?g=?gs[atom(goal ?g)]");
  EXPECT_EQ(OutlineOf("(bagof (?a ?b) ((p ?a) (q ?b)) ?l)"),
            "bagof(?a ?b)=?l[and[atom(p ?a) atom(q ?b)]]");
}

TEST(PreconditionTest, QuantifiedVariablesHaveNamesOfTheirOwn) {
  EXPECT_EQ(OutlineOf("(forall (?x ?z) (p ?x ?z) ((q ?x) (r ?y)))"),
            "forall?x#1?z#2[atom(p ?x#1 ?z#2) and[atom(q ?x#1) atom(r ?y)]]");
  EXPECT_EQ(OutlineOf("((forall ?x ((p ?x)) (exists (?x) (q ?x))) (r ?x))"),
            "seq[forall?x#1[seq[atom(p ?x#1)] exists?x#2[atom(q ?x#2) seq]] atom(r ?x)]");
  EXPECT_EQ(OutlineOf("(shop-forall (?z) (p ?z) (q ?z))"), "forall?z#1[atom(p ?z#1) atom(q ?z#1)]");
}

TEST(PreconditionTest, VariablesStandForGoals) {
  EXPECT_EQ(OutlineOf("?x"), "goal?x");
  EXPECT_EQ(OutlineOf("(and ?x (p))"), "and[goal?x atom(p)]");
  EXPECT_EQ(OutlineOf("(?x (p) ?y)"), "seq[goal?x atom(p) goal?y]");
}

TEST(PreconditionTest, EqualityIsAnOrdinaryAtom) {
  EXPECT_EQ(OutlineOf("(= ?x ?y)"), "atom(= ?x ?y)");
}

TEST(PreconditionTest, FirstAndSortByGiveTheOrder) {
  const Precondition first = PreconditionOf("(:first (p ?x) (q))");
  EXPECT_EQ(first.order, Precondition::Order::kFirst);
  EXPECT_EQ(Outline(first.condition), "seq[atom(p ?x) atom(q)]");

  const Precondition sorted = PreconditionOf("(:sort-by ?c ((p ?x ?c)))");
  EXPECT_EQ(sorted.order, Precondition::Order::kSortBy);
  EXPECT_EQ(sorted.sort_key, MakeVariable("?c"));
  EXPECT_EQ(sorted.comparison, "<");
  EXPECT_EQ(Outline(sorted.condition), "seq[atom(p ?x ?c)]");
  for (const char* comparison : {">", "'>", "#'>"}) {
    const std::string text = std::string("(:sort-by (call - ?c 1) ") + comparison + " (p ?c))";
    EXPECT_EQ(PreconditionOf(text).comparison, ">") << comparison;
    EXPECT_EQ(ToString(PreconditionOf(text).sort_key), "(- ?c 1)");
  }
}

TEST(PreconditionTest, AnonymousVariablesDiffer) {
  EXPECT_EQ(OutlineOf("((p ? ?) (q ?_a ?_a))"), "seq[atom(p ?_#1 ?_#2) atom(q ?_#3 ?_#4)]");
}

// ----------------------------------------------------------------------------------------
// operators

TEST(OperatorReaderTest, FormsAreToldByTheirNumberOfParts) {
  EXPECT_EQ(OperatorOf("((d ?x)) ((a ?x))"), "seq {(d ?x)} {(a ?x)} 1");
  EXPECT_EQ(OperatorOf("((d ?x)) ((a ?x)) 2.5"), "seq {(d ?x)} {(a ?x)} 2.5");
  EXPECT_EQ(OperatorOf("((p ?x)) ((d ?x)) ((a ?x))"), "seq[atom(p ?x)] {(d ?x)} {(a ?x)} 1");
  EXPECT_EQ(OperatorOf("(p ?x) () ((a ?x)) (call * .1 ?y)"), "atom(p ?x) {} {(a ?x)} (* 0.1 ?y)");
}

TEST(OperatorReaderTest, EffectsMayBeVariablesProtectionsAndForalls) {
  EXPECT_EQ(OperatorOf("?x ((:protection (p ?x)) (:protection ?y) ?x) 0"),
            "seq {list?x} {protect(p ?x) protect?y list?x} 0");
  EXPECT_EQ(OperatorOf("((forall (?u) (last ?u) ((last ?u) (q ?u ?x)))) ()"),
            "seq {forall[atom(last ?u#1) {(last ?u#1) (q ?u#1 ?x)}]} {} 1");
}

TEST(OperatorReaderTest, DeletesMayStayUnbound) {
  EXPECT_EQ(OperatorOf("((at ?anywhere)) ()"), "seq {(at ?anywhere)} {} 1");
}

TEST(OperatorReaderTest, KeywordsComeInAnyOrder) {
  const Operator op =
      DomainOf("(:op (!o ?x) :cost 3 :add ((a ?x)) :precond ((p ?x) (q)) :delete ((d ?x)))")
          .operators.at(0);
  EXPECT_EQ(Outline(op.precondition.condition), "and[atom(p ?x) atom(q)]");
  EXPECT_EQ(Outline(op.deletes), "{(d ?x)}");
  EXPECT_EQ(Outline(op.adds), "{(a ?x)}");
  EXPECT_EQ(op.cost, MakeInteger(3));
  EXPECT_EQ(DomainOf("(:op (!o))").operators.at(0).cost, MakeInteger(1));
}

// ------------------------------------------------------------------------------------------
// methods

std::vector<std::string> WarningsOf(const std::string& op) {
  return DomainOf("(:operator (!unplug ?lamp ?x)\n" + op + ")").warnings;
}

TEST(OperatorReaderTest, ADeleteWhoseVariableNothingBindsIsWarnedOf) {
  EXPECT_THAT(WarningsOf("() ((plugged ?lamp ?socket)) ()"),
              ElementsAre(AllOf(HasSubstr("test.lisp:2:5: operator '!unplug'"),
                                HasSubstr("?socket in the delete (plugged ?lamp ?socket)"),
                                HasSubstr("never bound"), HasSubstr("deletes nothing"))));
  for (const char* text :
       {"() (?socket) ()", "() ?socket ()", "() ((:protection (plugged ?lamp ?socket))) ()",
        "((not (plugged ?lamp ?socket))) ((plugged ?lamp ?socket)) ()",
        "((forall (?s) ((plugged ?lamp ?s)) ((dead ?s ?socket)))) ((plugged ?lamp ?socket)) ()",
        "((setof ?socket ((plugged ?lamp ?socket)) ?all)) ((plugged ?lamp ?socket)) ()",
        "() ((forall (?s) ((plugged ?lamp ?s)) ((plugged ?lamp ?socket)))) ()",
        "() ((plugged ?lamp (in . ?socket))) ()"}) {
    EXPECT_THAT(WarningsOf(text), ElementsAre(HasSubstr("?socket in the delete"))) << text;
  }
  EXPECT_THAT(WarningsOf("() ((plugged ?lamp ?)) ()"), ElementsAre(HasSubstr(": ? in the delete")));
  EXPECT_THAT(DomainOf("(:op (!o) :delete ((p ?x ?y)))").warnings, SizeIs(2));
}

TEST(OperatorReaderTest, ALogicalWordAmongDeletesDeletesNothingAndIsWarnedOf) {
  for (const std::string word : {"(or (p ?x) (q))", "(not (p ?x))", "(and)", "(imply (p) (q))"}) {
    const std::string deletes = "((q ?lamp) " + word + " (forall (?v) ((p ?v)) ((p ?v))))";
    EXPECT_THAT(WarningsOf("() " + deletes + " ()"),
                ElementsAre(AllOf(HasSubstr("test.lisp:2:15: operator '!unplug'"), HasSubstr(word),
                                  HasSubstr("deletes nothing"))));
    EXPECT_EQ(OperatorOf("((q ?x) " + word + ") ()"), OperatorOf("((q ?x)) ()"));
    EXPECT_THAT(DomainOf("(:op (!o ?x) :delete (" + word + "))").warnings, SizeIs(1));
  }
}

TEST(OperatorReaderTest, ADeleteWhoseVariablesAreBoundIsNotWarnedOf) {
  for (const char* text :
       {"((plugged ?lamp ?s)) ((plugged ?lamp ?s)) ()", "((?goal ?s) ?x) ((p ?s) ?x) ()",
        "((assign ?s (+ 1 2))) ((p ?s)) ()", "((or (p ?s) (q ?s))) ((p ?s)) ()",
        "((setof ?a ((p ?a)) ?s)) ?s ()", "() ((forall (?v) ((p ?v ?w)) ((p ?v ?w)))) ()"}) {
    EXPECT_THAT(WarningsOf(text), IsEmpty()) << text;
  }
}

TEST(MethodReaderTest, BranchesMayHaveLabels) {
  const Domain domain =
      DomainOf(std::string(kOperators) +
               "(:method swap-them (swap ?x) first-way ((p)) ((!a ?x)) nil nil ?x ((!b ?x)))");
  const Method& method = domain.methods.at(0);
  EXPECT_EQ(method.name, "swap-them");
  EXPECT_EQ(ToString(method.head), "(swap ?x)");
  ASSERT_THAT(method.branches, SizeIs(3));
  EXPECT_EQ(method.branches[0].label, "first-way");
  EXPECT_EQ(method.branches[1].label, "");
  EXPECT_EQ(Outline(method.branches[1].precondition.condition), "seq");
  EXPECT_EQ(Outline(method.branches[2].precondition.condition), "goal?x");
  EXPECT_EQ(Outline(method.branches[2].subtasks), "{(!b ?x)}");
}

TEST(MethodReaderTest, HeadsMayHoldLists) {
  const Domain domain = DomainOf("(:method (m (?g . ?gs) nil) () ((m ?gs ((goal ?g) . ?gs))))");
  EXPECT_EQ(ToString(domain.methods[0].head), "(m (?g . ?gs) nil)");
  EXPECT_EQ(Outline(domain.methods[0].branches[0].subtasks), "{(m ?gs ((goal ?g) . ?gs))}");
}

TEST(MethodReaderTest, MethodsStayInTheirOrder) {
  const Domain domain = DomainOf("(:method (m) () ()) (:method (n) () ()) (:method (m) (p) ())");
  ASSERT_THAT(domain.methods, SizeIs(3));
  EXPECT_EQ(ToString(domain.methods[1].head), "(n)");
  EXPECT_EQ(Outline(domain.methods[2].branches[0].precondition.condition), "atom(p)");
}

// -----------------------------------------------------------------------------------------
// networks

TEST(NetworkTest, ListsAreOrdered) {
  EXPECT_EQ(NetworkOf("nil"), "{}");
  EXPECT_EQ(NetworkOf("(!a ?x)"), "{(!a ?x)}");
  EXPECT_EQ(NetworkOf("((!a ?x))"), "{(!a ?x)}");
  EXPECT_EQ(NetworkOf("((!a ?x) (!b ?x) (!a ?y))"), "{(!a ?x) (!b ?x) (!a ?y) 0<1 1<2}");
  EXPECT_EQ(NetworkOf("(:ordered (!a ?x) (!b ?x))"), "{(!a ?x) (!b ?x) 0<1}");
}

TEST(NetworkTest, UnorderedTasksHaveNoOrder) {
  EXPECT_EQ(NetworkOf("(:unordered (!a ?x) (!b ?x))"), "{(!a ?x) (!b ?x)}");
}

TEST(NetworkTest, NetworksNest) {
  EXPECT_EQ(NetworkOf("(:unordered (:ordered (!a ?x) (!b ?x)) ((!a ?y) (!b ?y)) nil)"),
            "{{(!a ?x) (!b ?x) 0<1} {(!a ?y) (!b ?y) 0<1} {}}");
}

TEST(NetworkTest, TasksMayBeMarked) {
  EXPECT_EQ(NetworkOf("(:task !a ?x)"), "{(!a ?x)}");
  for (const char* text :
       {"(:task :immediate !a ?x)", "(:immediate !a ?x)", "(:immediate (!a ?x))"}) {
    EXPECT_EQ(NetworkOf(text), "{immediate(!a ?x)}") << text;
  }
}

TEST(NetworkTest, InopIsNoStep) { EXPECT_EQ(NetworkOf("((!!inop) (!a ?x))"), "{{} (!a ?x) 0<1}"); }

TEST(NetworkTest, QuotesOfTheTailAreTakenAway) {
  EXPECT_EQ(NetworkOf("'((!a ?x))"), "{(!a ?x)}");
  EXPECT_EQ(NetworkOf("`((!a ,(+ ?x 1)) (!b ,?y))"), "{(!a (call + ?x 1)) (!b ?y) 0<1}");
  EXPECT_EQ(NetworkOf("((!a (call + ?x 1)))"), "{(!a (call + ?x 1))}");
}

TEST(NetworkTest, TasksMayBeDotted) {
  EXPECT_EQ(NetworkOf("((!c . ?x) (!a . ?y))"), "{(!c . ?x) (!a . ?y) 0<1}");
}

// -------------------------------------------------------------------------------------------
// axioms

TEST(AxiomReaderTest, TailsAreBranches) {
  const Axiom axiom = DomainOf("(:- (p ?x) ((q ?x) (r ?x)) ((s ?x)) (t ?x))").axioms.at(0);
  EXPECT_EQ(ToString(axiom.head), "(p ?x)");
  ASSERT_THAT(axiom.branches, SizeIs(3));
  EXPECT_EQ(Outline(axiom.branches[0].condition), "and[atom(q ?x) atom(r ?x)]");
  EXPECT_EQ(Outline(axiom.branches[1].condition), "atom(s ?x)");
  EXPECT_EQ(Outline(axiom.branches[2].condition), "atom(t ?x)");
}

TEST(AxiomReaderTest, TailsMayHaveLabelsAndFirst) {
  const Axiom axiom =
      DomainOf("(:- (p ?x) one ((q ?x)) two (:first (r ?x) (s ?x)) nil ?x)").axioms.at(0);
  ASSERT_THAT(axiom.branches, SizeIs(4));
  EXPECT_EQ(axiom.branches[0].label, "one");
  EXPECT_FALSE(axiom.branches[0].first);
  EXPECT_EQ(axiom.branches[1].label, "two");
  EXPECT_TRUE(axiom.branches[1].first);
  EXPECT_EQ(Outline(axiom.branches[1].condition), "and[atom(r ?x) atom(s ?x)]");
  EXPECT_EQ(Outline(axiom.branches[2].condition), "seq");
  EXPECT_EQ(Outline(axiom.branches[3].condition), "goal?x");
}

// -------------------------------------------------------------------------------- domains,
// problems

TEST(Shop2DomainTest, NamesMayHaveOptions) {
  EXPECT_EQ(ReadShop2Domain("(in-package :shop-user) (defdomain (Rover :type x) ())", "f").name,
            "rover");
  const Domain domain = ReadShop2Domain("(defdomain d nil) (defproblem p d () ())", "f.lisp");
  EXPECT_EQ(domain.name, "d");
  EXPECT_EQ(domain.source, "f.lisp");
  EXPECT_EQ(domain.language, Domain::Language::kShop2);
}

TEST(Shop2DomainTest, PlacesAreKept) {
  const Domain domain =
      ReadShop2Domain("(defdomain d (\n (:method (m)\n  ((p) (q)) ((m)))))", "f.lisp");
  const Branch& branch = domain.methods.at(0).branches.at(0);
  EXPECT_EQ(domain.methods[0].place.line, 2);
  EXPECT_EQ(branch.precondition.condition.parts.at(1).place.column, 8);
  EXPECT_EQ(branch.subtasks.items.at(0).place.line, 3);
}

TEST(Shop2ProblemTest, ThereAreSeveralForms) {
  for (const char* text :
       {"(defproblem p d ((f 1)) ((t1)))", "(defproblem (p :domain d) ((f 1)) (t1))",
        "(make-problem 'p 'd '((f 1)) '((t1)))", "(defproblem (p) d ((f 1)) (:ordered (t1)))"}) {
    const std::vector<Problem> problems = ReadShop2Problems(text, "f.lisp");
    ASSERT_THAT(problems, SizeIs(1)) << text;
    EXPECT_EQ(problems[0].name, "p") << text;
    EXPECT_EQ(problems[0].domain, "d") << text;
    EXPECT_EQ(problems[0].facts, std::vector<Datum>{MakeList({MakeSymbol("f"), MakeInteger(1)})});
    EXPECT_EQ(Outline(problems[0].tasks), "{(t1)}") << text;
  }
  EXPECT_EQ(ProblemOf("nil nil").domain, "");
}

TEST(Shop2ProblemTest, FactsAreInTheirOrderAndMayHoldListsAndNumbers) {
  const Problem problem = ProblemOf("d ((on a b) (goals ((x 1) \"Y\")) (cost -2.5) (on a b)) ()");
  std::vector<std::string> facts;
  for (const Datum& fact : problem.facts) facts.push_back(ToString(fact));
  EXPECT_THAT(facts, ElementsAre("(on a b)", "(goals ((x 1) \"Y\"))", "(cost -2.5)", "(on a b)"));
  EXPECT_THAT(problem.tasks.items, IsEmpty());
  EXPECT_FALSE(problem.goal.has_value());
}

TEST(Shop2ProblemTest, WhatCannotBeAskedForAmongFactsIsPassedOver) {
  const Problem problem = ProblemOf("d (nil (on a b) () (not (p x)) (or (q) (r)) (f 1)) ()");
  EXPECT_THAT(problem.facts, SizeIs(2));
  EXPECT_THAT(problem.warnings,
              ElementsAre(AllOf(HasSubstr("test.lisp:1:34: problem 'p'"), HasSubstr("(not (p x))"),
                                HasSubstr("(2 such)"), HasSubstr("passed over"))));
  EXPECT_THAT(ProblemOf("d (nil () (on a b)) ()").warnings, IsEmpty());
}

TEST(Shop2ProblemTest, SeveralPairsOfFactsAndTasksAreSeveralProblems) {
  for (const std::string head : {"(defproblem p d ", "(defproblem (p :domain d) "}) {
    const auto problems =
        ReadShop2Problems(head + "((f 1)) ((t1)) () ((t2)) nil nil ((f 2)) (t1))", "f.lisp");
    ASSERT_THAT(problems, SizeIs(4)) << head;
    const std::vector<std::string> names{"p", "p-2", "p-3", "p-4"};
    for (std::size_t i = 0; i < problems.size(); ++i) {
      EXPECT_EQ(problems[i].name, names[i]);
      EXPECT_EQ(problems[i].domain, "d");
    }
    EXPECT_EQ(Outline(problems[1].tasks), "{(t2)}");
    EXPECT_THAT(problems[2].tasks.items, IsEmpty());
    EXPECT_EQ(ToString(problems[3].facts.at(0)), "(f 2)");
  }
}

TEST(Shop2ProblemTest, OneThatIsWrongIsNoHarmToTheOthers) {
  const auto problems = ReadShop2Problems(
      "(defproblem p1 d ((at ?x)) ((t1)))\n(defproblem p2 d () ((t1)))\n"
      "(defproblem)\n(defproblem p4 d () (:task))",
      "f.lisp");
  ASSERT_THAT(problems, SizeIs(4));
  EXPECT_THAT(problems[0].fault, AllOf(HasSubstr("f.lisp:1:19"), HasSubstr("problem 'p1'")));
  EXPECT_EQ(problems[1].fault, "");
  EXPECT_THAT(problems[2].fault, HasSubstr("f.lisp:3:1"));
  EXPECT_THAT(problems[3].fault, HasSubstr("f.lisp:4:21"));
}

TEST(Shop2ProblemTest, WhereAllAreWrongAllAreTold) {
  const auto error = hires::test_support::ConfigErrorOf([] {
    ReadShop2Problems("(defproblem p1 d ((at ?x)) ())\n(defproblem p2 d (at) ())", "f.lisp");
  });
  EXPECT_THAT(error, AllOf(HasSubstr("f.lisp:1:19"), HasSubstr("f.lisp:2:18")));
}

TEST(Shop2ProblemTest, AFileMayHoldDomainAndProblems) {
  const char* const text =
      "(defdomain d ((:method (t1 ?x) () ())))\n"
      "(defproblem p1 d () ((t1 a)))\n(defproblem p2 d () (:unordered (t1 a) (t1 b)))";
  const Domain domain = ReadShop2Domain(text, "f.lisp");
  const std::vector<Problem> problems = ReadShop2Problems(text, "f.lisp");
  ASSERT_THAT(problems, SizeIs(2));
  EXPECT_EQ(problems[1].name, "p2");
  EXPECT_THAT(problems[1].tasks.order, IsEmpty());
  for (const Problem& problem : problems) EXPECT_NO_THROW(CheckTasks(problem, domain));
}

// ------------------------------------------------------------------------------ JSHOP2's terms

TEST(BareTermsTest, StandForThemselvesWhereCallAloneComputes) {
  const std::string call = "(call < ?x 3)";
  const auto outline = [&](const std::string& goal) { return OutlineOf("(" + call + goal + ")"); };
  const std::string begin = "seq[eval=(< ?x 3) ";
  EXPECT_EQ(outline("(call Member ?y (red green blue))"),
            begin + "eval=(member ?y (list (quote red) (quote green) (quote blue)))]");
  EXPECT_EQ(outline("(assign ?p (home ?y))"), begin + "assign?p=(list (quote home) ?y)]");
  EXPECT_EQ(outline("(assign ?p fragile)"), begin + "assign?p=(quote fragile)]");
  EXPECT_EQ(outline("(assign ?p (12 (call / 12 (call + 5 1)) (?x . (a . ?r)) \"s\" nil))"),
            begin + "assign?p=(list 12 (/ 12 (+ 5 1)) (list* ?x (quote a) ?r) \"s\" nil)]");
  EXPECT_EQ(outline("(not (call Member (call * 2 2) (2 (call + 1 3) 5)))"),
            begin + "not[eval=(member (* 2 2) (list 2 (+ 1 3) 5))]]");
}

TEST(BareTermsTest, WhereLispComputesNothingChanges) {
  for (const std::string goal :
       {"(assign ?p (- ?x 1))", "(call > (length ?x) 3)", "(call member ?x '(red))",
        "(eval (< ?x 3))", "(assign ?p (f (first ?x)))", "(call #'f ?x)"}) {
    const std::string expected = OutlineOf("((assign ?q (home ?y)) " + goal + ")");
    EXPECT_THAT(expected, HasSubstr("assign?q=(home ?y)")) << goal;
  }
  EXPECT_EQ(OutlineOf("((assign ?q (home ?y)))"), "seq[assign?q=(home ?y)]") << "nothing is called";
  const std::string domain =
      "(defdomain d ((:method (m ?x) ((call < ?x 3) (assign ?q (home ?x))) ())))";
  for (const std::string form : {"(defun home (x) x)", "(in-package :x)", "(progn)"}) {
    const Domain read = ReadShop2Domain(form + domain, "f.lisp");
    EXPECT_THAT(Outline(read.methods[0].branches[0].precondition.condition),
                HasSubstr("assign?q=(home ?x)"))
        << form;
  }
}

TEST(BareTermsTest, AListThatLooksLikeACallIsWarnedOfOnce) {
  const auto warnings = [](const std::string& goals) {
    return DomainOf("(:method (m ?x)\n((call < ?x 3) " + goals + ") ())").warnings;
  };
  EXPECT_THAT(warnings("(assign ?p (home ?x)) (assign ?q (shop ?x))"),
              ElementsAre(AllOf(HasSubstr("test.lisp:2:27: "), HasSubstr("(home ?x)"),
                                HasSubstr("JSHOP2"), HasSubstr("write (call home ...)"))));
  EXPECT_THAT(warnings("(assign ?p red) (assign ?q (1 ?x))"), IsEmpty());
}

// ------------------------------------------------------------------------------ other forms

constexpr const char* kWholeDomain = "(defdomain d ((:method (t1 ?x) () ())))\n";
constexpr const char* kWholeProblem = "(defproblem p d ((f 1)) ((t1 a)))\n";

void ExpectWhole(const std::string& text) {
  EXPECT_THAT(ReadShop2Domain(text, "f.lisp").methods, SizeIs(1)) << text;
  const std::vector<Problem> problems = ReadShop2Problems(text, "f.lisp");
  ASSERT_THAT(problems, SizeIs(1)) << text;
  EXPECT_THAT(problems[0].facts, SizeIs(1)) << text;
  EXPECT_TRUE(IsShop2File(text, "f.lisp")) << text;
}

TEST(OtherFormsTest, FormsOfLispAroundDomainAndProblemArePassedOverWithOneWarning) {
  for (const std::string form :
       {"(find-plans 'p :which :first :verbose :plans)", "(progn (ql:quickload :shop3))",
        "(declaim (optimize (speed 3)))", "(defun cost (a &optional b) `(list ,a ,@b))",
        "(defun f (c) (member c '(#\\( #\\Space #\\; #\\\")))", "(defvar *v* #(1 2 #x1F))",
        "(setf *p* #p\"a/b\" *q* #.(list 1))", "(eval-when (:load-toplevel) (load \"x\"))",
        "(defmacro m (&body body) #+sbcl nil #-sbcl `(progn ,@body))"}) {
    for (const std::string& text :
         {form + "\n" + kWholeDomain + kWholeProblem, kWholeDomain + form + "\n" + kWholeProblem,
          std::string(kWholeDomain) + kWholeProblem + form}) {
      ExpectWhole(text);
      EXPECT_THAT(ReadShop2Domain(text, "f.lisp").warnings,
                  Contains(AllOf(HasSubstr("f.lisp:"), HasSubstr("passed over"))))
          << text;
    }
  }
}

TEST(OtherFormsTest, TheWarningTellsNamesAndLines) {
  const std::string text =
      std::string("(ql:quickload :shop)\n") + kWholeDomain + "(find-plans 'p)\n(find-plans 'q)";
  EXPECT_THAT(
      ReadShop2Domain(text, "f.lisp").warnings,
      ElementsAre(AllOf(HasSubstr("f.lisp:1:1: "), HasSubstr("(ql:quickload ...) in line 1"),
                        HasSubstr("(find-plans ...) in lines 3, 4"))));
  std::string many;
  for (int i = 0; i < 100; ++i) many += "(f" + std::to_string(i) + ") ";
  const Domain domain = ReadShop2Domain(many + kWholeDomain, "f.lisp");
  ASSERT_THAT(domain.warnings, SizeIs(1));
  EXPECT_LT(domain.warnings[0].size(), 500u);
  EXPECT_THAT(domain.warnings[0], HasSubstr("92 more"));
}

TEST(OtherFormsTest, DefinitionsMayStandInAFormAndHavePackages) {
  const std::string both = std::string(kWholeDomain) + kWholeProblem;
  for (const std::string& text :
       {"(progn\n" + both + ")", "(let ((x 1)) " + both + ")", "(let* () (progn " + both + "))",
        "(eval-when (:compile-toplevel :load-toplevel :execute) " + both + ")",
        "(locally (declare (ignore x)) " + both + ")",
        std::string("(cl:in-package #:shop-user) (shop2:") + (kWholeDomain + 1) +
            "(shop2::" + (kWholeProblem + 1)}) {
    ExpectWhole(text);
  }
  EXPECT_THAT(ReadShop2Domain("(cl:in-package :x)" + both, "f.lisp").warnings, IsEmpty());
}

TEST(OtherFormsTest, MarksOfTheReaderAreHeeded) {
  const std::string both = std::string(kWholeDomain) + kWholeProblem;
  for (const std::string mark :
       {"#+ignore", "#+(or)", "#+(or sbcl ccl)", "#-(not x)", "#+(and shop)", "#+#.x"}) {
    for (const std::string form :
         {"(defproblem q d () ())", "((:method (x) () ()))", "'a", "(#\\( ,@x)"}) {
      const std::string text = mark + " " + form + "\n" + both;
      ExpectWhole(text);
      EXPECT_THAT(ReadShop2Domain(text, "f.lisp").warnings,
                  ElementsAre(AllOf(HasSubstr("f.lisp:1:1: left out"), HasSubstr("line 1"))));
    }
  }
  for (const std::string mark : {"#-x", "#-(or)", "#+(not x)", "#+(and)"}) {
    const std::string text = mark + " " + both;
    ExpectWhole(text);
    EXPECT_THAT(ReadShop2Domain(text, "f.lisp").warnings, ElementsAre(HasSubstr("read, as no")));
  }
  const Problem problem = ProblemOf("d ((f #:One) #+x (g 2) #+x #+y (h 3) (i 4) (f 5)) ()");
  EXPECT_THAT(problem.facts, SizeIs(2)) << "#+x #+y leaves out both";
  EXPECT_EQ(ToString(problem.facts[0]), "(f one)");
}

// ------------------------------------------------------------------------------------ original
// files

class OriginalFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(folder_)) GTEST_SKIP() << folder_ << " is missing";
  }

  std::string TextOf(const std::string& name) const {
    return base::ReadTextFile((folder_ / name).string());
  }

  const std::filesystem::path folder_{std::filesystem::path(HIRES_SHARED_DATA) / "htn" / "shop2"};
};

TEST_F(OriginalFilesTest, EveryFileReads) {
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() != ".lisp") continue;
    const std::string name = entry.path().filename().string();
    const std::string text = TextOf(name);
    if (text.find("(defdomain") != std::string::npos) ReadShop2Domain(text, name);
    if (text.find("(defproblem") != std::string::npos) ReadShop2Problems(text, name);
    ++num_files;
  }
  EXPECT_GE(num_files, 11);
}

TEST_F(OriginalFilesTest, ItemsAreAllThere) {
  const Domain logistics = ReadShop2Domain(TextOf("logistics.lisp"), "logistics.lisp");
  EXPECT_THAT(logistics.operators, SizeIs(8));
  EXPECT_THAT(logistics.methods, SizeIs(5));
  EXPECT_THAT(logistics.axioms, SizeIs(2));
  EXPECT_EQ(logistics.methods[0].branches.at(1).label, "different-city-deliver");
  const Domain blocks = ReadShop2Domain(TextOf("blocks.lisp"), "blocks.lisp");
  EXPECT_THAT(blocks.axioms.back().branches, SizeIs(6));
}

TEST_F(OriginalFilesTest, TasksOfProblemsBelongToTheirDomains) {
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {"logistics.lisp", "logistics_15_1.lisp"}, {"logistics.lisp", "logistics_30_1.lisp"},
      {"depots.lisp", "depots_01.lisp"},         {"depots.lisp", "depots_07.lisp"},
      {"blocks.lisp", "blocks_100.lisp"},        {"toy_ordering.lisp", "toy_ordering.lisp"}};
  for (const auto& [domain_name, problem_name] : pairs) {
    const Domain domain = ReadShop2Domain(TextOf(domain_name), domain_name);
    for (const Problem& problem : ReadShop2Problems(TextOf(problem_name), problem_name)) {
      EXPECT_NO_THROW(CheckTasks(problem, domain)) << problem_name;
      EXPECT_EQ(problem.domain, domain.name);
    }
  }
}

}  // namespace
}  // namespace hires::planning::shop2_reader_test
