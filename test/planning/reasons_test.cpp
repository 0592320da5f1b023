#include "hires/planning/reasons.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "hires/base/error.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/substitution.h"
#include "planning/support/conditions.h"
#include "planning/support/plans.h"

namespace hires::planning::reasons_test {
namespace {

using hires::test_support::DomainOf;
using hires::test_support::FlatPlan;
using hires::test_support::FlatProblem;
using hires::test_support::Text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// A plan of these steps with its reasons.
Plan Explained(const std::string& items, const std::string& facts,
               const std::vector<std::string>& steps) {
  Plan plan = FlatPlan(steps);
  AddReasons(DomainOf(items), FlatProblem(facts, steps), &plan);
  return plan;
}

/// "0:(p a) -1:not(q)": who made it so, and what.
std::string Links(const PlanStep& step) {
  std::string text;
  for (const CausalLink& link : step.links) {
    text += (text.empty() ? "" : " ") + std::to_string(link.producer) + ":" + Text({link.literal});
  }
  return text;
}

const std::string kCups =
    "(:operator (!pick ?c) ((on ?c ?t) (not (held ?any))) ((on ?c ?t)) ((held ?c)))"
    "(:operator (!put ?c ?t) ((held ?c)) ((held ?c)) ((on ?c ?t)))"
    "(:operator (!wash ?c) ((held ?c)) () ((clean ?c)))"
    "(:operator (!serve ?c) ((clean ?c) (on ?c table)) () ((served ?c)))";

TEST(AddReasonsTest, NamesWhatAStepRestsOnAndDoes) {
  const Plan plan = Explained(kCups, "((on cup counter))", {"(!pick cup)", "(!put cup table)"});
  EXPECT_EQ(Text(plan.steps[0].preconditions), "(on cup counter) not(held ?any)");
  EXPECT_EQ(Text(plan.steps[0].deletes), "(on cup counter)");
  EXPECT_EQ(Text(plan.steps[0].adds), "(held cup)");
  EXPECT_EQ(Text(plan.steps[1].preconditions), "(held cup)");
  EXPECT_EQ(Text(plan.steps[1].deletes), "(held cup)");
  EXPECT_EQ(Text(plan.steps[1].adds), "(on cup table)");
}

TEST(AddReasonsTest, LinksNameTheStepThatMadeItSo) {
  const Plan plan =
      Explained(kCups, "((on cup counter) (on pot counter))",
                {"(!pick cup)", "(!wash cup)", "(!put cup table)", "(!pick pot)", "(!serve cup)"});
  EXPECT_EQ(Links(plan.steps[0]), "-1:(on cup counter) -1:not(held ?any)");
  EXPECT_EQ(Links(plan.steps[1]), "0:(held cup)");
  EXPECT_EQ(Links(plan.steps[3]), "-1:(on pot counter) 2:not(held ?any)");
  EXPECT_EQ(Links(plan.steps[4]), "1:(clean cup) 2:(on cup table)");
}

TEST(AddReasonsTest, WhoeverAddsWhatIsThereProducesNothing) {
  const Plan plan = Explained("(:operator (!make) () () ((p))) (:operator (!use) ((p)) () ())",
                              "()", {"(!make)", "(!make)", "(!use)"});
  EXPECT_EQ(Text(plan.steps[1].adds), "(p)");
  EXPECT_EQ(Links(plan.steps[2]), "0:(p)");
}

TEST(AddReasonsTest, AnAtomThatAStepDeletesAndAddsIsKept) {
  const Plan plan = Explained("(:operator (!renew) ((p)) ((p)) ((p)))", "((p))", {"(!renew)"});
  EXPECT_THAT(plan.steps[0].deletes, IsEmpty());
  EXPECT_EQ(Text(plan.steps[0].adds), "(p)");
}

TEST(AddReasonsTest, ADeleteThatFindsNothingIsRead) {
  const Plan plan = Explained("(:operator (!clear) () ((p) (q)) ())", "((q))", {"(!clear)"});
  EXPECT_EQ(Text(plan.steps[0].deletes), "(q)");
  EXPECT_EQ(Text(plan.steps[0].reads), "(p)");
}

TEST(AddReasonsTest, ConditionalEffectsAreFoundInTheStateTheStepComesTo) {
  const Plan plan =
      Explained("(:operator (!sweep) () ((forall (?x) ((dirty ?x)) ((dirty ?x)))) ((dirty broom)))",
                "((dirty a) (dirty b))", {"(!sweep)", "(!sweep)"});
  EXPECT_EQ(Text(plan.steps[0].deletes), "(dirty a) (dirty b)");
  EXPECT_EQ(Text(plan.steps[0].adds), "(dirty broom)");
  EXPECT_THAT(plan.steps[1].deletes, IsEmpty());  // (dirty broom) is deleted and added
  EXPECT_EQ(Text(plan.steps[1].reads), "(dirty ?x)");
}

TEST(AddReasonsTest, ListsOfAtomsAreChangedAsTheyWere) {
  const Plan plan =
      Explained("(:operator (!!assert ?g) () () ?g 0) (:operator (!!remove ?g) () ?g () 0)", "()",
                {"(!!assert ((p a) (p b)))", "(!!remove ((p a)))"});
  EXPECT_EQ(Text(plan.steps[0].adds), "(p a) (p b)");
  EXPECT_EQ(Text(plan.steps[1].deletes), "(p a)");
}

TEST(AddReasonsTest, CallsInEffectsAreEvaluated) {
  const Plan plan = Explained("(:operator (!count) ((n ?n)) ((n ?n)) ((n (call + ?n 1))))",
                              "((n 1))", {"(!count)", "(!count)"});
  EXPECT_EQ(Text(plan.steps[1].adds), "(n 3)");
  EXPECT_EQ(Links(plan.steps[1]), "0:(n 2)");
}

TEST(AddReasonsTest, BindingsDecideBetweenProofs) {
  const std::string items = "(:operator (!take) ((p ?x)) ((p ?x)) ((taken ?x)))";
  Plan plan = FlatPlan({"(!take)"});
  plan.steps[0].bindings = {{"?x", MakeSymbol("a")}};
  const Problem problem = FlatProblem("((p a) (p b))", {"(!take)"});
  AddReasons(DomainOf(items), problem, &plan);
  EXPECT_EQ(Text(plan.steps[0].adds), "(taken a)");
  plan.steps[0].bindings.clear();  // then as SHOP does: the newest fact
  AddReasons(DomainOf(items), problem, &plan);
  EXPECT_EQ(Text(plan.steps[0].adds), "(taken b)");
}

TEST(AddReasonsTest, ProtectionsAreRead) {
  const Plan plan = Explained(
      "(:operator (!hold ?x) () () ((:protection (at ?x))))"
      "(:operator (!release ?x) () ((:protection (at ?x))) ())",
      "((at a))", {"(!hold a)", "(!release a)"});
  EXPECT_EQ(Text(plan.steps[0].reads), "(at a) (:protection (at a))");
  EXPECT_EQ(Text(plan.steps[1].reads), "(at a) (:unprotection (at a))");
}

TEST(AddReasonsTest, FactsOfTheDomainHoldFromTheBeginning) {
  Domain domain = DomainOf("(:operator (!a ?x) ((kind ?x)) () ())");
  domain.facts.push_back(hires::test_support::TaskOf("(kind cup)"));
  Plan plan = FlatPlan({"(!a cup)"});
  AddReasons(domain, FlatProblem("()", {"(!a cup)"}), &plan);
  EXPECT_EQ(Links(plan.steps[0]), "-1:(kind cup)");
}

TEST(AddReasonsTest, SaysWhichStepCannotBeTaken) {
  EXPECT_THAT(
      [] {
        Explained(kCups, "((on cup counter))", {"(!pick cup)", "(!serve cup)"});
      },
      ThrowsMessage<base::ConfigError>(
          AllOf(HasSubstr("p.lisp: step 1 (!serve cup) cannot be taken"), HasSubstr("d.lisp:1:"),
                HasSubstr("precondition"))));
  EXPECT_THAT([] { Explained(kCups, "()", {"(!throw cup)"}); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("step 0 (!throw cup)"), HasSubstr("no operator"))));
}

TEST(AddReasonsTest, MayBeAskedTwice) {
  const std::vector<std::string> steps = {"(!pick cup)", "(!put cup table)"};
  Plan plan = Explained(kCups, "((on cup counter))", steps);
  AddReasons(DomainOf(kCups), FlatProblem("((on cup counter))", steps), &plan);
  EXPECT_EQ(plan.steps[1].links.size(), 1u);
  EXPECT_EQ(plan.steps[1].preconditions.size(), 1u);
}

TEST(FactsAfterTest, GivesTheExpectedStateOfEveryMoment) {
  const std::vector<std::string> steps = {"(!pick cup)", "(!put cup table)"};
  const Plan plan = FlatPlan(steps);
  const Domain domain = DomainOf(kCups);
  const Problem problem = FlatProblem("((on cup counter) (open))", steps);
  EXPECT_EQ(Text(FactsAfter(domain, problem, plan, 0)), "(on cup counter) (open)");
  EXPECT_EQ(Text(FactsAfter(domain, problem, plan, 1)), "(open) (held cup)");
  EXPECT_EQ(Text(FactsAfter(domain, problem, plan, 2)), "(open) (on cup table)");
  EXPECT_THROW(FactsAfter(domain, problem, plan, 3), std::logic_error);
}

TEST(FactsAfterTest, TheFirstAddOfAListIsTheNewestFact) {
  const std::vector<std::string> steps = {"(!a)"};
  EXPECT_EQ(Text(FactsAfter(DomainOf("(:operator (!a) () () ((p) (q)))"),
                            FlatProblem("((q0))", steps), FlatPlan(steps), 1)),
            "(q0) (q) (p)");
}

// ----------------------------------------------------------------------------------- shared data

using State = std::set<std::string>;

/// The slow road: states as sets of text, by the plan's own deletes and adds.
std::vector<State> StatesOf(const Domain& domain, const Problem& problem, const Plan& plan) {
  State state;
  for (const Datum& fact : domain.facts) state.insert(ToString(fact));
  for (const Datum& fact : problem.facts) state.insert(ToString(fact));
  std::vector<State> states = {state};
  for (const PlanStep& step : plan.steps) {
    for (const Datum& atom : step.deletes) {
      EXPECT_EQ(state.erase(ToString(atom)), 1u) << ToString(atom);
    }
    for (const Datum& atom : step.adds) state.insert(ToString(atom));
    states.push_back(state);
  }
  return states;
}

bool Matches(const Literal& literal, const State& state) {
  if (IsGround(literal.atom)) return state.count(ToString(literal.atom)) > 0;
  for (const std::string& text : state) {
    if (Substitution().Unify(literal.atom, hires::test_support::Read(text))) return true;
  }
  return false;
}

/// A link's literal holds from its producer to its consumer, and not before its producer.
void ExpectTrueLinks(const Plan& plan, const std::vector<State>& states) {
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    EXPECT_EQ(plan.steps[i].links.size(), plan.steps[i].preconditions.size());
    for (const CausalLink& link : plan.steps[i].links) {
      for (int moment = link.producer + 1; moment <= static_cast<int>(i); ++moment) {
        EXPECT_EQ(Matches(link.literal, states[moment]), link.literal.holds)
            << Text({link.literal}) << " of step " << i << " after " << moment << " steps";
      }
      if (link.producer == CausalLink::kInitial) continue;
      EXPECT_NE(Matches(link.literal, states[link.producer]), link.literal.holds)
          << Text({link.literal}) << " of step " << i << ", produced by " << link.producer;
    }
  }
}

void ExpectTrueReasons(const std::string& domain_file, const std::string& problem_file) {
  const std::filesystem::path folder = std::filesystem::path(HIRES_SHARED_DATA) / "htn";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no example problems in " << folder;
  const Domain domain = LoadDomain(folder / domain_file);
  const Problem problem = LoadProblems(folder / problem_file, domain).at(0);
  Plan plan = hires::test_support::FirstPlan(domain, problem);
  AddReasons(domain, problem, &plan);
  const std::vector<State> states = StatesOf(domain, problem, plan);
  ExpectTrueLinks(plan, states);
  const int num_steps = static_cast<int>(plan.steps.size());
  State end;
  for (const Datum& fact : domain.facts) end.insert(ToString(fact));
  for (const Datum& fact : FactsAfter(domain, problem, plan, num_steps)) end.insert(ToString(fact));
  EXPECT_EQ(end, states.back());
}

TEST(ReasonsOfSharedPlansTest, Blocks) {
  ExpectTrueReasons("shop2/blocks.lisp", "shop2/blocks_100.lisp");
}
TEST(ReasonsOfSharedPlansTest, Depots) {
  ExpectTrueReasons("shop2/depots.lisp", "shop2/depots_07.lisp");
}
TEST(ReasonsOfSharedPlansTest, Logistics) {
  ExpectTrueReasons("shop2/logistics.lisp", "shop2/logistics_30_1.lisp");
}
TEST(ReasonsOfSharedPlansTest, Tidy) {
  ExpectTrueReasons("hddl/tidy/domain.hddl", "hddl/tidy/tidy01.hddl");
}
TEST(ReasonsOfSharedPlansTest, Snake) {
  ExpectTrueReasons("hddl/snake/domain.hddl", "hddl/snake/pb05.snake.hddl");
}

}  // namespace
}  // namespace hires::planning::reasons_test
