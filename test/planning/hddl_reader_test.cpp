#include "planning/language/hddl_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "planning/language/hddl_vocabulary.h"

namespace hires::planning::hddl_reader_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

// ------------------------------------------------------------------------------ formulas as text

std::string Text(const Formula& formula);

std::string Texts(const std::vector<Formula>& parts) {
  std::string text;
  for (const Formula& part : parts) text += (text.empty() ? "" : " ") + Text(part);
  return text;
}

/// "[a b]" is a sequence; "(forall ?x: guard: body)" a quantifier.
std::string Text(const Formula& formula) {
  switch (formula.kind) {
    case Formula::Kind::kSequence:
      return "[" + Texts(formula.parts) + "]";
    case Formula::Kind::kOr:
      return "(or " + Texts(formula.parts) + ")";
    case Formula::Kind::kNot:
      return "(not " + Texts(formula.parts) + ")";
    case Formula::Kind::kImply:
      return "(imply " + Texts(formula.parts) + ")";
    case Formula::Kind::kForall:
    case Formula::Kind::kExists:
      return std::string(formula.kind == Formula::Kind::kForall ? "(forall " : "(exists ") +
             base::Join(formula.variables, " ") + ": " + Text(formula.parts[0]) + ": " +
             Text(formula.parts[1]) + ")";
    case Formula::Kind::kAtom:
    case Formula::Kind::kEqual:
      return ToString(formula.term);
    default:
      return "a kind that HDDL does not have";
  }
}

std::string Text(const Effect& effect) {
  if (effect.kind == Effect::Kind::kAtom) return ToString(effect.term);
  std::string text = "(for " + Text(effect.condition) + ":";
  for (const Effect& inner : effect.effects) text += " " + Text(inner);
  return text + ")";
}

std::vector<std::string> Texts(const std::vector<Effect>& effects) {
  std::vector<std::string> texts;
  for (const Effect& effect : effects) texts.push_back(Text(effect));
  return texts;
}

std::vector<std::string> Texts(const std::vector<Datum>& data) {
  std::vector<std::string> texts;
  for (const Datum& datum : data) texts.push_back(ToString(datum));
  return texts;
}

std::vector<std::string> Tasks(const TaskNetwork& network) {
  std::vector<std::string> texts;
  for (const TaskItem& item : network.items) texts.push_back(ToString(item.task));
  return texts;
}

// ------------------------------------------------------------------------------------- a small
// world

/// A domain with places, two kinds of things, and whatever else a test needs.
Domain World(const std::string& more) {
  return ReadHddlDomain(R"((define (domain world)
    (:requirements :typing :hierarchy)
    (:types place thing - object cup book - thing shelf - place)
    (:constants dock - place)
    (:predicates (at ?p - place) (on ?t - thing ?p - place) (home ?t - thing ?s - shelf)
                 (full) (wet ?t - thing) (clean ?p - place) (path ?from ?to - place))
    (:task go :parameters (?p - place))
    (:task tidy :parameters (?t - thing))
)" + more + ")",
                        "world.hddl");
}

const char kDrive[] = R"(
    (:action drive :parameters (?q ?p - place)
      :precondition (and (not (= ?p ?q)) (at ?q) (path ?q ?p))
      :effect (and (not (at ?q)) (at ?p))))";

Problem Task(const Domain& domain, const std::string& sections) {
  return ReadHddlProblem(
      "(define (problem p) (:domain world) (:objects mug - cup t1 - place s1 - shelf)" + sections +
          ")",
      "p.hddl", domain);
}

std::string MethodCondition(const Domain& domain, std::size_t method = 0) {
  return Text(domain.methods.at(method).branches.at(0).precondition.condition);
}

// ------------------------------------------------------------------------------------------
// actions

TEST(HddlActionTest, AnActionIsAnOperatorWithABang) {
  const Domain domain = World(kDrive);
  ASSERT_THAT(domain.operators, SizeIs(1));
  const Operator& drive = domain.operators[0];
  EXPECT_EQ(ToString(drive.head), "(!drive ?q ?p)");
  EXPECT_THAT(Texts(drive.deletes), ElementsAre("(at ?q)"));
  EXPECT_THAT(Texts(drive.adds), ElementsAre("(at ?p)"));
  EXPECT_EQ(drive.cost, MakeInteger(1));
  EXPECT_EQ(domain.language, Domain::Language::kHddl);
  EXPECT_EQ(domain.name, "world");
}

TEST(HddlActionTest, AtomsComeFirstThenTypesThenTheRest) {
  EXPECT_EQ(Text(World(kDrive).operators.at(0).precondition.condition),
            "[(at ?q) (path ?q ?p) (%type-place ?q) (%type-place ?p) (not (= ?p ?q))]");
}

TEST(HddlActionTest, AnActionMayHaveNoConditionAndNoEffect) {
  const Domain domain = World("(:action wait :parameters ()) (:action idle :precondition ())");
  ASSERT_THAT(domain.operators, SizeIs(2));
  EXPECT_EQ(Text(domain.operators[0].precondition.condition), "[]");
  EXPECT_THAT(domain.operators[1].adds, IsEmpty());
}

TEST(HddlActionTest, EffectsNestInAnyWay) {
  const Domain domain = World(R"((:action wash :parameters (?p - place)
    :effect (and (full)
                 (forall (?t - cup)
                   (when (on ?t ?p) (and (not (wet ?t)) (when (wet ?t) (clean ?p)))))
                 (when (full) (not (at ?p))))))");
  EXPECT_THAT(
      Texts(domain.operators.at(0).adds),
      UnorderedElementsAre("(full)", "(for [(on ?t ?p) (wet ?t) (%type-cup ?t)]: (clean ?p))"));
  EXPECT_THAT(Texts(domain.operators.at(0).deletes),
              UnorderedElementsAre("(for [(on ?t ?p) (%type-cup ?t)]: (wet ?t))",
                                   "(for [(full)]: (at ?p))"));
}

TEST(HddlActionTest, AQuantifiedVariableThatHidesAnotherGetsANameOfItsOwn) {
  const Domain domain = World(R"((:action wash :parameters (?t - thing)
    :precondition (forall (?t - cup) (not (wet ?t)))
    :effect (forall (?t - book) (wet ?t))))");
  EXPECT_EQ(Text(domain.operators.at(0).precondition.condition),
            "[(%type-thing ?t) (forall ?t%1: [(%type-cup ?t%1)]: (not (wet ?t%1)))]");
  EXPECT_THAT(Texts(domain.operators.at(0).adds),
              ElementsAre("(for [(%type-book ?t%2)]: (wet ?t%2))"));
}

TEST(HddlActionTest, EveryKindOfConditionHasItsFormula) {
  const Domain domain = World(R"((:action test :parameters (?a ?b - place)
    :precondition (and (or (at ?a) (at ?b)) (imply (full) (at ?a)) (not (not (clean ?a)))
                       (exists (?t - thing) (and (not (wet ?t)) (on ?t ?a)))
                       (forall (?t - thing) (imply (on ?t ?b) (wet ?t))))))");
  EXPECT_EQ(Text(domain.operators.at(0).precondition.condition),
            "[(clean ?a) (%type-place ?a) (%type-place ?b) (or (at ?a) (at ?b)) "
            "(imply (full) (at ?a)) "
            "(exists ?t: [(on ?t ?a) (%type-thing ?t) (not (wet ?t))]: []) "
            "(forall ?t: [(on ?t ?b) (%type-thing ?t)]: (wet ?t))]");
}

TEST(HddlActionTest, CostsAreSummedUpAndValuesAskedFor) {
  const Domain domain = World(R"((:functions (total-cost) - number (far ?a ?b - place) - number)
    (:action drive :parameters (?q ?p - place) :precondition (at ?q)
      :effect (and (increase (total-cost) (far ?q ?p)) (increase (total-cost) 2.5)))
    (:action rest :parameters () :effect (increase (total-cost) (+ 1 2)))
    (:action load :parameters () :effect (increase (total-cost) 7))
    (:action wait :parameters ()))");
  const auto cost = [&domain](int i) { return ToString(domain.operators.at(i).cost); };
  EXPECT_EQ(cost(0), "(+ ?%far1 2.5)");
  EXPECT_EQ(cost(1), "(+ 1 2)");
  EXPECT_EQ(cost(2), "7");
  EXPECT_EQ(cost(3), "0");
  EXPECT_EQ(Text(domain.operators[0].precondition.condition),
            "[(at ?q) (%type-place ?q) (%type-place ?p) (%value-far ?q ?p ?%far1)]");
}

// ------------------------------------------------------------------------------------------
// methods

TEST(HddlMethodTest, SubtasksMayBePartlyOrdered) {
  const Domain domain = World(std::string(kDrive) + R"((:method m :parameters (?t - thing)
    :task (tidy ?t)
    :subtasks (and (a (go dock)) (b (drive dock dock)) (go dock) (c (tidy ?t)))
    :ordering (and (< a c) (b < c) (< a c))))");
  const TaskNetwork& network = domain.methods.at(0).branches.at(0).subtasks;
  EXPECT_EQ(ToString(domain.methods[0].head), "(tidy ?t)");
  EXPECT_EQ(domain.methods[0].name, "m");
  EXPECT_THAT(Tasks(network),
              ElementsAre("(go dock)", "(!drive dock dock)", "(go dock)", "(tidy ?t)"));
  EXPECT_THAT(network.order, ElementsAre(Pair(0, 3), Pair(1, 3)));
}

TEST(HddlMethodTest, AListOfListsIsAConjunction) {
  const std::string with = R"((:action a :parameters (?p - place)
      :precondition (and (at ?p) (not (full))) :effect (and (not (at ?p)) (full)))
    (:method m :parameters (?p - place) :task (go ?p) :precondition (and (at ?p) (full))
      :subtasks (and (t1 (a ?p)) (t2 (go ?p))) :ordering (and (< t1 t2))
      :constraints (and (not (= ?p dock)))))";
  std::string without = with;
  for (std::size_t at; (at = without.find("(and ")) != std::string::npos;) without.erase(at + 1, 4);
  const Domain meant = World(with), read = World(without);
  EXPECT_EQ(Text(read.operators.at(0).precondition.condition),
            Text(meant.operators.at(0).precondition.condition));
  EXPECT_EQ(Texts(read.operators.at(0).adds), Texts(meant.operators.at(0).adds));
  EXPECT_EQ(Texts(read.operators.at(0).deletes), Texts(meant.operators.at(0).deletes));
  EXPECT_EQ(MethodCondition(read), MethodCondition(meant));
  const TaskNetwork& network = read.methods.at(0).branches.at(0).subtasks;
  EXPECT_THAT(Tasks(network), ElementsAre("(!a ?p)", "(go ?p)"));
  EXPECT_THAT(network.order, ElementsAre(Pair(0, 1)));
}

TEST(HddlMethodTest, OrderedSubtasksFollowOneAnother) {
  const Domain domain = World(R"(
    (:method a :parameters () :task (go dock)
      :ordered-tasks (and (x (go dock)) (go dock) (go dock)))
    (:method b :task (go dock) :ordered-subtasks (go dock))
    (:method c :task (go dock) :tasks ())
    (:method d :task (go dock)))");
  const auto network = [&domain](int i) { return domain.methods.at(i).branches.at(0).subtasks; };
  EXPECT_THAT(network(0).order, ElementsAre(Pair(0, 1), Pair(1, 2)));
  EXPECT_THAT(Tasks(network(1)), ElementsAre("(go dock)"));
  EXPECT_THAT(Tasks(network(2)), IsEmpty());
  EXPECT_THAT(Tasks(network(3)), IsEmpty());
}

TEST(HddlMethodTest, GoalsFollowBoundVariablesAndDenialsWaitForTheirs) {
  const Domain domain = World(R"((:method m :parameters (?t - thing ?p ?q - place ?s - shelf)
    :task (tidy ?t)
    :precondition (and (not (on ?t ?s)) (path ?q ?p) (at dock) (on ?t ?p) (home ?t ?s))
    :constraints (not (= ?p ?q))))");
  EXPECT_EQ(MethodCondition(domain),
            "[(at dock) (%type-thing ?t) (on ?t ?p) (%type-place ?p) (path ?q ?p) (%type-place ?q) "
            "(not (= ?p ?q)) (home ?t ?s) (%type-shelf ?s) (not (on ?t ?s))]");
}

TEST(HddlMethodTest, ParametersThatNothingBindsTryTheirObjects) {
  const Domain domain = World(R"((:method m :parameters (?t - thing ?c - cup ?p - place)
    :task (tidy ?t) :precondition (and (not (on ?c ?p)) (not (= ?c ?t)))))");
  EXPECT_EQ(MethodCondition(domain),
            "[(%type-thing ?t) (%type-cup ?c) (not (= ?c ?t)) (%type-place ?p) (not (on ?c ?p))]");
}

TEST(HddlMethodTest, ConstraintsMayAskForTypes) {
  const Domain domain = World(R"((:method m :parameters (?t - thing) :task (tidy ?t)
    :constraints (and (sortof ?t - cup) (not (sort ?t - (either book cup))) (= ?t ?t))))");
  EXPECT_EQ(MethodCondition(domain),
            "[(%type-cup ?t) (%type-thing ?t) (not (%type-cup/book ?t)) (= ?t ?t)]");
}

TEST(HddlMethodTest, WhatNoActionCanChangeIsAskedBeforeTheActionIsChosen) {
  const Domain domain = World(std::string(kDrive) + R"((:method m :parameters (?p ?q - place)
    :task (go ?p) :precondition (at ?q) :subtasks (drive ?q ?p)))");
  // (path ?q ?p) is of the action; (at ?q) changes, so only the method's own counts.
  EXPECT_EQ(MethodCondition(domain), "[(%type-place ?p) (path ?q ?p) (at ?q) (%type-place ?q)]");
}

TEST(HddlMethodTest, ATaskWithoutAMethodHasOneThatNeverApplies) {
  const Domain domain = World("(:method m :task (go dock))");
  ASSERT_THAT(domain.methods, SizeIs(2));
  EXPECT_EQ(ToString(domain.methods[1].head), "(tidy ?1)");
  EXPECT_EQ(MethodCondition(domain, 1), "(or )");
}

// --------------------------------------------------------------------------------- types and
// problem

TEST(HddlTypesTest, FactsNameTypesAndTheirAncestors) {
  const Domain domain = World("");
  EXPECT_THAT(Texts(domain.facts), ElementsAre("(%type-object dock)", "(%type-place dock)"));
  const Problem problem = Task(domain, "(:htn :tasks ()) (:init (on mug dock))");
  EXPECT_THAT(Texts(problem.facts),
              UnorderedElementsAre("(%type-object mug)", "(%type-object t1)", "(%type-object s1)",
                                   "(%type-place t1)", "(%type-place s1)", "(%type-shelf s1)",
                                   "(%type-thing mug)", "(%type-cup mug)", "(on mug dock)"));
}

TEST(HddlTypesTest, SeveralTypesMayBeAskedForAtOnce) {
  const Domain domain = ReadHddlDomain(R"((define (domain world)
    (:types cup book table) (:constants oak - table)
    (:task use :parameters (?x - (either table cup)))))",
                                       "w.hddl");
  EXPECT_THAT(Texts(domain.facts),
              ElementsAre("(%type-object oak)", "(%type-table oak)", "(%type-cup/table oak)"));
  const Problem problem = ReadHddlProblem(R"((define (problem p) (:domain world)
    (:objects mug - cup novel - book)
    (:htn :parameters (?x - (either book table)) :subtasks (use mug))))",
                                          "p.hddl", domain);
  EXPECT_THAT(Texts(problem.facts),
              ElementsAre("(%type-object mug)", "(%type-object novel)", "(%type-cup mug)",
                          "(%type-book novel)", "(%type-cup/table mug)", "(%type-book/table oak)",
                          "(%type-book/table novel)"));
}

TEST(HddlTypesTest, ATypeThatIsOnlyAParentIsDeclaredByThat) {
  const Domain domain = ReadHddlDomain(
      "(define (domain d) (:types cup - anything) (:constants mug - cup x - anything))", "d.hddl");
  EXPECT_THAT(Texts(domain.facts),
              UnorderedElementsAre("(%type-object mug)", "(%type-object x)", "(%type-cup mug)",
                                   "(%type-anything mug)", "(%type-anything x)"));
}

TEST(HddlDomainTest, TheFaultOfEachActionAndMethodIsToldAtOnce) {
  try {
    ReadHddlDomain(
        "(define (domain d) (:predicates (p)) (:task t)\n"
        "(:action a :effect (q))\n(:action b :parameters () :precondition (r))\n"
        "(:method m :task (t) :subtasks (u))\n(:method n :task (t) :subtasks (a)))",
        "bad.hddl");
    FAIL() << "nothing was wrong";
  } catch (const base::ConfigError& error) {
    for (const std::string line : {"bad.hddl:2:", "bad.hddl:3:", "bad.hddl:4:"}) {
      EXPECT_THAT(error.what(), HasSubstr(line));
    }
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("bad.hddl:5:")));
  }
}

/// What is said of a problem with a goal alone, in a domain with these methods.
std::string GoalAloneError(const std::string& methods) {
  const Domain domain = ReadHddlDomain(
      "(define (domain d) (:predicates (p)) (:task t) (:action a :effect (p))" + methods + ")",
      "d.hddl");
  try {
    ReadHddlProblem("(define (problem x) (:domain d) (:init) (:goal (p)))", "x.pddl", domain);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(HddlProblemTest, TheFaultOfEachSectionAndFactIsToldAtOnce) {
  try {
    Task(World(kDrive), R"(
(:htn :subtasks (go mars))
(:goal (att dock))
(:metric maximize (total-cost))
(:init (at dock)
       (at)
       (full dock)
       (at dock) (not (at dock)) ))");
    FAIL() << "nothing was wrong";
  } catch (const base::ConfigError& error) {
    for (const int line : {2, 3, 4, 6, 7, 8}) {
      EXPECT_THAT(error.what(), HasSubstr("p.hddl:" + std::to_string(line) + ":"));
    }
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("p.hddl:5:")));
  }
}

TEST(HddlProblemTest, WithoutTasksWhereNothingIsDecomposedItIsCalledPddl) {
  EXPECT_THAT(GoalAloneError("(:method m :task (t) :subtasks (a))"),
              AllOf(HasSubstr("(:htn ...) is missing"), ::testing::Not(HasSubstr("PDDL"))));
  const Domain plain =
      ReadHddlDomain("(define (domain d) (:predicates (p)) (:action a :effect (p)))", "d.hddl");
  try {
    ReadHddlProblem("(define (problem x) (:domain d) (:init) (:goal (p)))", "x.pddl", plain);
    FAIL() << "nothing was wrong";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("(:htn ...) is missing"), HasSubstr("PDDL")));
  }
}

TEST(HddlRequirementsTest, SingularsAndMisspellingsOfTheCompetitionAreKnown) {
  EXPECT_NO_THROW(ReadHddlDomain(
      "(define (domain d) (:requirements :hierachie :existential-precondition :Method-Precondition "
      ":htn :universal-preconditions))",
      "d.hddl"));
}

TEST(HddlRequirementsTest, WhatTheFileDoesNotUseIsWarnedOfOnce) {
  const Domain domain = ReadHddlDomain(
      "(define (domain d)\n(:requirements :typing :fluents :durative-actions :preferences))",
      "d.hddl");
  EXPECT_THAT(domain.warnings,
              ElementsAre(AllOf(HasSubstr("d.hddl:2:24: (:requirements ...)"),
                                HasSubstr(":fluents :durative-actions :preferences are not"))));
  const Problem problem = ReadHddlProblem(
      "(define (problem p) (:domain d) (:requirements :fluents) (:htn) (:init))", "p.hddl", domain);
  EXPECT_THAT(problem.warnings, ElementsAre(HasSubstr(":fluents is not supported")));
  EXPECT_THAT(
      ReadHddlDomain("(define (domain d) (:requirements :typing :strips))", "d.hddl").warnings,
      IsEmpty());
}

TEST(HddlTypesTest, WithoutTypesEverythingIsAnObject) {
  const Domain domain = ReadHddlDomain(
      "(define (domain d) (:predicates (p ?x)) (:constants a) (:task t :parameters (?x)))",
      "d.hddl");
  EXPECT_THAT(Texts(domain.facts), ElementsAre("(%type-object a)"));
}

TEST(HddlProblemTest, TasksFactsAndGoalAreRead) {
  const Domain domain = World(kDrive);
  const Problem problem = Task(domain, R"(
    (:htn :parameters (?x - cup) :subtasks (and (a (tidy ?x)) (b (drive dock t1)))
          :ordering (< b a) :constraints (not (= ?x mug)))
    (:init (at dock) (not (full)) (on mug t1) (at dock))
    (:goal (and (on mug s1) (forall (?t - thing) (not (wet ?t)))))
    (:metric minimize (total-cost)))");
  EXPECT_EQ(problem.name, "p");
  EXPECT_EQ(problem.domain, "world");
  EXPECT_THAT(Tasks(problem.tasks), ElementsAre("(tidy ?x)", "(!drive dock t1)"));
  EXPECT_THAT(problem.tasks.order, ElementsAre(Pair(1, 0)));
  EXPECT_EQ(Text(problem.parameters.condition), "[(path dock t1) (%type-cup ?x) (not (= ?x mug))]");
  ASSERT_TRUE(problem.goal.has_value());
  EXPECT_EQ(Text(*problem.goal), "[(on mug s1) (forall ?t: [(%type-thing ?t)]: (not (wet ?t)))]");
  const std::vector<std::string> facts = Texts(problem.facts);
  ASSERT_GE(facts.size(), 3u);
  EXPECT_THAT(std::vector<std::string>(facts.end() - 3, facts.end()),
              ElementsAre("(at dock)", "(on mug t1)", "(at dock)"));
}

TEST(HddlProblemTest, AnEmptyGoalIsNone) {
  EXPECT_FALSE(Task(World(""), "(:htn) (:goal ())").goal.has_value());
  EXPECT_FALSE(Task(World(""), "(:htn-ti) (:goal (and))").goal.has_value());
}

TEST(HddlProblemTest, ValuesOfFunctionsAreFacts) {
  const Domain domain = World("(:functions (total-cost) (far ?a ?b - place))");
  const Problem problem =
      Task(domain, "(:htn) (:init (= (total-cost) 0) (= (far dock t1) 10) (= (far t1 s1) 2.5))");
  EXPECT_THAT(Texts(std::vector<Datum>(problem.facts.end() - 2, problem.facts.end())),
              ElementsAre("(%value-far dock t1 10)", "(%value-far t1 s1 2.5)"));
}

TEST(HddlTypesTest, WhatTheReaderMadeIsShownAsHddlHasIt) {
  const auto as_written = [](const std::string& predicate, const std::vector<Datum>& arguments) {
    std::vector<Datum> items{MakeSymbol(predicate)};
    items.insert(items.end(), arguments.begin(), arguments.end());
    return hddl::AsWritten(MakeList(items));
  };
  const Datum dock = MakeSymbol("dock"), x = MakeVariable("?x");
  EXPECT_EQ(as_written("%type-place", {x}), "(?x - place)");
  EXPECT_EQ(as_written(hddl::ValuePredicate("far"), {dock, x}), "(= (far dock) number)");
  EXPECT_EQ(as_written(hddl::ValuePredicate("fuel"), {x}), "(= (fuel) number)");
  EXPECT_EQ(as_written("at", {dock}), "(at dock)");
}

// Several domains of the competition name directions that only their problems declare.
TEST(HddlProblemTest, ObjectsOfTheDomainMayBeLeftToTheProblem) {
  const Domain domain = World("(:method m :task (go mars) :precondition (at moon))");
  const auto read = [&domain](const std::string& objects) -> std::string {
    try {
      ReadHddlProblem("(define (problem p) (:domain world) (:objects" + objects + ") (:htn))", "p",
                      domain);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(read(" mars moon - place"), "");
  EXPECT_THAT(read(" mars marz - place"), HasSubstr("method 'm': object 'moon' is unknown"));
  EXPECT_THAT(read(" mars - place moon - cup"),
              AllOf(HasSubstr("world.hddl:9:46: method 'm': 'moon' must be of type place"),
                    HasSubstr("problem 'p' declares it as cup")));
}

TEST(HddlProblemTest, ADomainBesideItIsLeftAlone) {
  const std::string both =
      "(define (domain d) (:task t)) (define (problem p) (:domain d) (:htn :tasks (t)))";
  EXPECT_THAT(Tasks(ReadHddlProblem(both, "f", ReadHddlDomain(both, "f")).tasks),
              ElementsAre("(t)"));
}

// -------------------------------------------------------------------------------------------
// errors

struct BadText {
  std::string text;
  std::vector<std::string> message;  ///< what the message must hold
};

std::ostream& operator<<(std::ostream& out, const BadText& bad) { return out << bad.text; }

std::string DomainError(const std::string& text) {
  try {
    ReadHddlDomain(text, "bad.hddl");
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

class BadHddlDomainTest : public testing::TestWithParam<BadText> {};

/// The sections stand in line 2 and after.
TEST_P(BadHddlDomainTest, IsRefusedWithPlaceAndRemedy) {
  const std::string message = DomainError("(define (domain d)\n" + GetParam().text + ")");
  for (const std::string& part : GetParam().message) EXPECT_THAT(message, HasSubstr(part));
}

const char kPredicates[] =
    "(:types cup place) (:constants mug - cup dock - place) (:predicates (at ?p - place) (full)) "
    "(:task go :parameters (?p - place)) (:action drive :parameters (?p - place))\n";

BadText After(const std::string& text, std::vector<std::string> message) {
  return {kPredicates + text, std::move(message)};
}

INSTANTIATE_TEST_SUITE_P(
    Sections, BadHddlDomainTest,
    testing::Values(
        BadText{"(:requirements :typing 7)",
                {"bad.hddl:2:24: (:requirements ...)", "7 came", ":typing"}},
        BadText{"(:predicate (p))", {"bad.hddl:2:1", "':predicate' is unknown", "':predicates'"}},
        BadText{"(:types a) (:types b)", {"bad.hddl:2:12", "stands twice", "line 2"}},
        BadText{"(predicates (p))", {"bad.hddl:2:1", "wanted a section such as"}},
        BadText{"nonsense", {"bad.hddl:2:1", "domain 'd'", "nonsense", "wanted a section"}},
        BadText{"(:types a . b)", {"bad.hddl:2:1", "dot"}},
        BadText{"(:types a -)", {"bad.hddl:2:11", "'-' has no type behind it"}},
        BadText{"(:types - a)", {"bad.hddl:2:9", "'-' has no name before it"}},
        BadText{"(:types a - b b - c c - a)", {"(:types ...)", "contains itself", "break"}},
        BadText{"(:types a - a)", {"type 'a' contains itself (a - a)"}},
        BadText{"(:types a - (one b c))", {"bad.hddl:2:13", "(either a b)"}},
        BadText{"(:types 7)", {"bad.hddl:2:9", "7 stands where a name is wanted"}},
        BadText{"(:types cup) (:constants mug - cupp)",
                {"bad.hddl:2:32: (:constants ...)", "type 'cupp' is unknown", "'cup'"}},
        BadText{"(:types a b) (:constants x - (either a b))",
                {"bad.hddl:2:26", "'x' is of two types", "x - a x - b"}},
        BadText{"(:predicates (p) (p ?x))", {"predicate 'p' is declared twice"}},
        BadText{"(:predicates p)", {"bad.hddl:2:14", "wanted a predicate such as"}},
        BadText{"(:predicates (p x))", {"bad.hddl:2:17", "write a variable such as ?x"}},
        BadText{"(:predicates (p ?x - cup))", {"type 'cup' is unknown"}},
        BadText{"(:functions (f) - place)", {"a function gives a number"}},
        BadText{"(:functions (total-cost ?x))", {"(total-cost) takes no arguments"}},
        BadText{"(:action)", {"(:action) has no name"}},
        BadText{"(:action (a))", {"the name of an action"}},
        BadText{"(:action %a)", {"%a stands where", "names begin with a letter"}},
        BadText{"(:task t) (:action t)", {"action 't'", "there is a task 't' already; rename"}},
        BadText{"(:task t) (:task t)", {"there is a task 't' already"}}));

INSTANTIATE_TEST_SUITE_P(
    Actions, BadHddlDomainTest,
    testing::Values(
        After("(:action a :parameters (?p ?p - place))", {"bad.hddl:3:28", "'?p' stands twice"}),
        After("(:action a :parameters ?p)", {"action 'a'", "?p came, wanted parameters"}),
        After("(:action a :precondition)", {"bad.hddl:3:12", ":precondition has no value"}),
        After("(:action a :condition ())", {"':condition' is unknown", "':precondition'"}),
        After("(:action a :effect () :effect ())", {":effect stands twice"}),
        After("(:action a (at dock))", {"bad.hddl:3:12", "wanted one of", "parenthesis missing"}),
        After("(:action a :precondition (att dock))",
              {"bad.hddl:3:27: action 'a'", "predicate 'att' is unknown", "'at'"}),
        After("(:action a :precondition (at))",
              {"bad.hddl:3:26", "predicate 'at' has 0 arguments", "declaration has 1"}),
        After("(:action a :precondition (at ?x))", {"bad.hddl:3:30", "variable '?x' is unknown"}),
        After("(:action a :precondition (at mug))",
              {"'mug' is of type cup", "predicate 'at' takes place"}),
        After("(:action a :precondition (at (at dock)))", {"an object or a variable is wanted"}),
        After("(:action a :precondition (not))", {"wanted (not condition)"}),
        After("(:action a :precondition (imply (full)))", {"wanted (imply condition condition)"}),
        After("(:action a :precondition (forall ?x (full)))", {"wanted variables such as"}),
        After("(:action a :precondition (exists (?x - cup)))", {"wanted (exists (?x - type)"}),
        After("(:action a :precondition (= mug))", {"wanted (= a b)"}),
        After("(:action a :parameters (?x ?y) :precondition (< (size ?x) 5))",
              {"bad.hddl:3:46: action 'a': (< (size ?x) 5) compares numbers"}),
        After("(:action a :parameters (?x) :precondition (not (>= (size ?x) (size ?x))))",
              {"compares numbers"}),
        After("(:action a :parameters (?x) :precondition (= (size ?x) 0))", {"compares numbers"}),
        After("(:durative-action a :parameters ())", {"(:durative-action ...) of PDDL is not"}),
        After("(:derived (at ?p) (full))", {"(:derived ...) of PDDL is not supported"}),
        After("(:action a :precondition full)", {"full came, wanted a condition"}),
        After("(:action a :effect (when (full)))", {"wanted (when condition effect)"}),
        After("(:action a :effect (not (full) (full)))", {"wanted (not (predicate ...))"}),
        After("(:action a :effect (or (full)))", {"predicate 'or' is unknown"}),
        After("(:action a :effect (increase (fuel) 1))",
              {"changes a number", "(increase (total-cost) amount)"}),
        After("(:action a :effect (increase (total-cost) 1))",
              {"(total-cost) is not declared; add (:functions (total-cost))"}),
        After("(:functions (total-cost)) (:action a :effect (increase (total-cost) -1))",
              {"-1 stands where an amount is wanted"}),
        After("(:functions (total-cost)) (:action a :effect (increase (total-cost) (far mug)))",
              {"function 'far' is unknown; none is defined"}),
        After("(:functions (total-cost)) (:action a :effect (when (full) (increase (total-cost) "
              "1)))",
              {"costs under forall or when are not supported"}),
        After("(:functions (total-cost)) (:action a :effect (decrease (total-cost) 1))",
              {"(decrease (total-cost) 1) changes a number"})));

INSTANTIATE_TEST_SUITE_P(
    Methods, BadHddlDomainTest,
    testing::Values(
        After("(:method m)", {"bad.hddl:3:1: method 'm': :task is missing; add it"}),
        After("(:method m :task (goo dock))", {"task 'goo' is unknown", "'go'"}),
        After("(:method m :task (go))", {"task 'go' has 0 arguments", "declaration has 1"}),
        After("(:method m :task (go ?p - place))", {"(go ?p - place) has types; write them in"}),
        After("(:method m :task (drive dock))", {"'drive' is an action"}),
        After("(:method m :task (go ?p))", {"is unknown; none is defined; declare it"}),
        After("(:method m :task (go dock)) (:method m :task (go dock))",
              {"there is a method of that name already"}),
        After("(:method m :task (go dock) :subtasks (fly dock))", {"task 'fly' is unknown"}),
        After("(:method m :task (go dock) :subtasks (go mug))", {"'mug' is of type cup"}),
        After("(:method m :task (go dock) :subtasks () :tasks ())", {"two of :subtasks, :tasks"}),
        After("(:method m :task (go dock) :subtasks () :ordered-tasks ())",
              {"there are :subtasks and :ordered-subtasks"}),
        After("(:method m :task (go dock) :subtasks (and (a (go dock)) (a (go dock))))",
              {"two subtasks have the id 'a'"}),
        After("(:method m :task (go dock) :subtasks (and (t1 (go dock)) (t2 (go dock)))\n"
              ":ordering (< t1 t3))",
              {"bad.hddl:4:17", "subtask id 't3' is unknown", "'t1'"}),
        After("(:method m :task (go dock) :subtasks (a (go dock)) :ordering (a a))",
              {"(a a) came, wanted (< before after)"}),
        After("(:method m :task (go dock) :subtasks (and (a (go dock)) (b (go dock)))\n"
              ":ordering (and (< a b) (< b a)))",
              {"bad.hddl:4:11", "a circle", "before itself"}),
        After("(:method m :task (go dock) :subtasks (a (go dock)) :ordering (< a a))",
              {"a circle"}),
        After("(:method m :task (go dock) :constraints (full))",
              {"(full) came, wanted (= a b)", "put other conditions into :precondition"}),
        After("(:method m :parameters (?x) :task (go dock) :constraints (sortof ?x))",
              {"wanted (sortof ?x - type)"})));

TEST(BadHddlTextTest, ParenthesesMustFit) {
  EXPECT_THAT(DomainError("(define (domain d)\n(:types a)"), HasSubstr("bad.hddl:"));
  EXPECT_THAT(DomainError("(define (domain d)))"), HasSubstr("bad.hddl:1:20"));
}

TEST(BadHddlTextTest, OneDomainMustBeThere) {
  EXPECT_THAT(DomainError(""), HasSubstr("there is no (define (domain ...) ...) here"));
  EXPECT_THAT(DomainError("(define (problem p))"), HasSubstr("is it the file of a problem?"));
  EXPECT_THAT(DomainError("(define (domain a)) (define (domain b))"), HasSubstr("a second"));
  EXPECT_THAT(DomainError("(define (domain a b))"), HasSubstr("wanted (domain name)"));
  EXPECT_THAT(DomainError("(define (domain 7))"), HasSubstr("7 stands where a name is wanted"));
  EXPECT_THAT(DomainError("(defdomain d ())"), HasSubstr("stands outside of (define (domain"));
}

TEST(BadHddlTextTest, DepthAndNumbersAreBounded) {
  const auto repeat = [](const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  };
  EXPECT_THAT(DomainError(repeat("(", 1'000'000)), HasSubstr("bad.hddl:1:"));
  EXPECT_THAT(DomainError("(define (domain d) (:predicates (p " + repeat("?x ", 2000) + ")))"),
              HasSubstr("2000 variables are declared here, at most 1000"));
  std::string types;
  for (int i = 0; i < 2000; ++i) types += " t" + std::to_string(i) + " - t" + std::to_string(i + 1);
  EXPECT_THAT(DomainError("(define (domain d) (:types" + types + "))"),
              HasSubstr("types are declared, at most 1000"));
}

// Each would take for ever if the work grew with a higher power of the depth or the width.
TEST(HddlSizeTest, DeepQuantifiersAndLongConjunctionsAreRead) {
  std::string deep = "(p ?x ?x)";
  for (int i = 0; i < 480; ++i) deep = "(exists (?x) " + deep + ")";
  std::string parameters;
  std::string wide;
  for (int i = 0; i < 1000; ++i) parameters += " ?v" + std::to_string(i);
  for (int i = 0; i < 20000; ++i) {
    wide += " (p ?v" + std::to_string(i % 1000) + " ?v" + std::to_string(7 * i % 1000) + ")";
  }
  const Domain domain = ReadHddlDomain(
      "(define (domain d) (:predicates (p ?x ?y)) (:task t) (:action a :precondition " + deep +
          ") (:method m :task (t) :parameters (" + parameters + ") :precondition (and" + wide +
          ")))",
      "d.hddl");
  EXPECT_THAT(domain.methods.at(0).branches.at(0).precondition.condition.parts, SizeIs(21000));
  EXPECT_THAT(Text(domain.operators.at(0).precondition.condition), HasSubstr("(p ?x%479 ?x%479)"));
}

class BadHddlProblemTest : public testing::TestWithParam<BadText> {};

TEST_P(BadHddlProblemTest, IsRefusedWithPlaceAndRemedy) {
  const Domain domain = World("(:functions (total-cost) (far ?a - place))" + std::string(kDrive));
  std::string message = "no error";
  try {
    ReadHddlProblem("(define (problem p)\n" + GetParam().text + ")", "bad.hddl", domain);
  } catch (const base::ConfigError& error) {
    message = error.what();
  }
  for (const std::string& part : GetParam().message) EXPECT_THAT(message, HasSubstr(part));
}

BadText In(const std::string& text, std::vector<std::string> message) {
  return {"(:domain world)\n" + text, std::move(message)};
}

INSTANTIATE_TEST_SUITE_P(
    Sections, BadHddlProblemTest,
    testing::Values(
        BadText{"(:htn)", {"bad.hddl:1:1: problem 'p'", "(:domain ...) is missing", "world"}},
        BadText{"(:domain) (:htn)", {"bad.hddl:2:1", "wanted (:domain world)"}},
        BadText{"(:domain 7) (:htn)", {"bad.hddl:2:10", "7 stands where the name of a domain"}},
        In("", {"(:htn ...) is missing", "which tasks"}),
        In("(:htn) (:htn-ti)", {"two (:htn ...) sections"}),
        In("(:htn :subtasks (fly dock))", {"bad.hddl:3:18: (:htn ...)", "task 'fly' is unknown"}),
        In("(:htn :subtasks (go ?x))", {"variable '?x' is unknown"}),
        In("(:htn :subtasks (go mars))", {"object 'mars' is unknown", "'dock'"}),
        In("(:htn (go dock))", {"(go dock) came, wanted one of :parameters"}),
        In("(:htn) (:objects a - planet)", {"type 'planet' is unknown"}),
        In("(:htn) (:init (at ?x))", {"variable '?x' is unknown"}),
        In("(:htn) (:init (at dock dock))", {"predicate 'at' has 2 arguments"}),
        In("(:htn) (:init at)", {"at came, wanted a fact"}),
        In("(:htn) (:init ())", {"() stands where a predicate is wanted"}),
        In("(:htn) (:objects c - cup) (:init (at c))", {"'c' is of type cup"}),
        In("(:htn) (:init (at dock) (not (at dock)))", {"holds and does not hold"}),
        In("(:htn) (:init (= (far dock) dock))", {"an amount is wanted"}),
        In("(:htn) (:init (= far 1))", {"wanted (= (function ...) number)"}),
        In("(:htn) (:init (= (far dock) 1) (= (far dock) 2))", {"has a value already"}),
        In("(:htn) (:init (= (near dock) 1))", {"function 'near' is unknown", "'far'"}),
        In("(:htn) (:init (= (total-cost) 5))", {"begin with a (total-cost) of 0"}),
        In("(:htn) (:goal (at dock) (full))", {"wanted (:goal condition)"}),
        In("(:htn) (:goal (at ?x))", {"variable '?x' is unknown"}),
        In("(:htn) (:metric maximize (total-cost))", {"wanted (:metric minimize (total-cost))"}),
        In("(:htn) (:constraints (always (full)))", {"':constraints' is unknown"})));

TEST(BadHddlProblemTest, AnHddlProblemNeedsAnHddlDomain) {
  EXPECT_THROW(ReadHddlProblem("(define (problem p))", "p.hddl", Domain{}), std::logic_error);
}

// ------------------------------------------------------------------------------------- shared
// files

TEST(SharedHddlFilesTest, EveryFileIsRead) {
  const std::string folder = std::string(HIRES_SHARED_DATA) + "/htn/hddl";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "the folder of example problems is missing (HIRES_SHARED_DATA)";
  }
  int num_problems = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string path = entry.path().string() + "/domain.hddl";
    const Domain domain = ReadHddlDomain(base::ReadTextFile(path), path);
    EXPECT_FALSE(domain.operators.empty());
    for (const auto& file : std::filesystem::directory_iterator(entry.path())) {
      if (file.path().extension() != ".hddl" || file.path().filename() == "domain.hddl") continue;
      const std::string name = file.path().string();
      const Problem problem = ReadHddlProblem(base::ReadTextFile(name), name, domain);
      EXPECT_FALSE(problem.tasks.items.empty()) << name;
      ++num_problems;
    }
  }
  EXPECT_EQ(num_problems, 3);
}

}  // namespace
}  // namespace hires::planning::hddl_reader_test
