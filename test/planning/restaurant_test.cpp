#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/text.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/plan_order.h"
#include "hires/planning/plan_report.h"
#include "hires/planning/planner.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/reasons.h"
#include "hires/planning/replanning.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/validator.h"
#include "hires/world/world.h"
#include "planning/check/known_names.h"

// The domain in config/domains with its problems and its sidecar. The plans in test/data/planning
// are Listings 6.1 and 6.2 of S. Rockel's dissertation, and others worked out by hand.

namespace hires::planning::restaurant_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;
const char* const kProblems[] = {"serve_coffee",
                                 "serve_coffee_imagined",
                                 "serve_coffee_south_failed",
                                 "serve_coffee_spots",
                                 "serve_coffee_looking",
                                 "serve_hot_coffee",
                                 "carry_object",
                                 "clear_table"};

using Steps = std::vector<std::string>;

const Domain& Restaurant() {
  static const Domain domain = LoadDomain(kRoot + "/config/domains/restaurant.lisp");
  return domain;
}

const OperatorData& Sidecar() {
  static const OperatorData data =
      LoadOperatorData(kRoot + "/config/domains/restaurant.yaml", Restaurant());
  return data;
}

const world::World& Room() {
  static const world::World room = world::LoadWorld(kRoot + "/worlds/restaurant.world");
  return room;
}

Problem Load(const std::string& name) {
  const std::string path = kRoot + "/config/domains/problems/" + name + ".lisp";
  return LoadProblems(path, Restaurant()).at(0);
}

/// The steps of a plan as one text each, as in the files.
Steps StepsOf(const Plan& plan) {
  Steps steps;
  for (const PlanStep& step : plan.steps) steps.push_back(ToString(step.task));
  return steps;
}

Steps Golden(const std::string& name) {
  const std::string text = base::ReadTextFile(kRoot + "/test/data/planning/" + name + ".plan");
  Steps steps = base::Split(text, '\n');
  steps.pop_back();  // after the last line's end
  return steps;
}

Steps From(const Steps& steps, std::size_t first) {
  return {steps.begin() + std::min(first, steps.size()), steps.end()};
}

Steps Upto(const Steps& steps, std::size_t count) { return {steps.begin(), steps.begin() + count}; }

Steps Joined(Steps first, const Steps& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<Datum> Facts(const std::string& facts) {
  const std::string text = "(defproblem p restaurant (" + facts + ") ())";
  return ReadShop2Problems(text, "facts").at(0).facts;
}

Problem With(Problem problem, const std::string& facts) {
  for (Datum& fact : Facts(facts)) problem.facts.push_back(std::move(fact));
  return problem;
}

Problem Without(Problem problem, const std::string& facts) {
  for (const Datum& fact : Facts(facts)) {
    const auto found = std::find(problem.facts.begin(), problem.facts.end(), fact);
    EXPECT_NE(found, problem.facts.end()) << ToString(fact);
    if (found != problem.facts.end()) problem.facts.erase(found);
  }
  return problem;
}

Problem WithTask(Problem problem, const std::string& task) {
  problem.tasks =
      ReadShop2Problems("(defproblem p restaurant () (" + task + "))", "task").at(0).tasks;
  return problem;
}

PlanResult Find(const Problem& problem, Which which = Which::kFirst) {
  PlanRequest request;
  request.which = which;
  PlanResult result = FindPlans(Restaurant(), problem, request);
  for (Plan& plan : result.plans) {
    AddReasons(Restaurant(), problem, &plan);
    EXPECT_THAT(ValidatePlan(Restaurant(), problem, plan), IsEmpty()) << ToShop2Plan(plan);
  }
  return result;
}

Plan FirstPlan(const Problem& problem) {
  PlanResult result = Find(problem);
  EXPECT_EQ(ToString(result.outcome), "found");
  return result.plans.empty() ? Plan{} : result.plans.front();
}

Steps FirstSteps(const Problem& problem) { return StepsOf(FirstPlan(problem)); }

void ExpectNoPlan(const Problem& problem) {
  const PlanResult result = Find(problem);
  EXPECT_EQ(ToString(result.outcome), "no_plan");
  EXPECT_TRUE(result.exhausted);
  EXPECT_THAT(result.plans, IsEmpty());
}

/// The problem in the state that the first `count` steps lead to.
Problem After(Problem problem, const Plan& plan, std::size_t count) {
  problem.facts = FactsAfter(Restaurant(), problem, plan, static_cast<int>(count));
  return problem;
}

std::vector<std::string> SortedFacts(const Problem& problem) {
  std::vector<std::string> facts;
  for (const Datum& fact : problem.facts) facts.push_back(ToString(fact));
  std::sort(facts.begin(), facts.end());
  return facts;
}

const char kSouth[] = "(imagined_failure place_object mug1 rightarm1 placingareawestrighttable1)";
const char kNorth[] = "(imagined_failure !place_object mug1 rightarm1 placingareawestlefttable1)";

// ------------------------------------------------------------------------------------- the plans

class ProblemTest : public ::testing::TestWithParam<const char*> {};

TEST_P(ProblemTest, TheFirstPlanIsTheExpectedOne) {
  EXPECT_THAT(FirstSteps(Load(GetParam())), ElementsAreArray(Golden(GetParam())));
}

TEST_P(ProblemTest, EveryPlanIsValid) {
  const PlanResult result = Find(Load(GetParam()), Which::kAll);  // Find() validates
  EXPECT_EQ(ToString(result.outcome), "found");
  EXPECT_TRUE(result.exhausted);
}

INSTANTIATE_TEST_SUITE_P(RestaurantTest, ProblemTest, ::testing::ValuesIn(kProblems),
                         [](const auto& test) { return std::string(test.param); });

TEST(ServeCoffeeTest, ThereAreTwoWaysToServeGuest1) {
  const PlanResult result = Find(Load("serve_coffee"), Which::kAll);
  ASSERT_THAT(result.plans, SizeIs(2));
  const Steps first = Golden("serve_coffee");
  EXPECT_THAT(StepsOf(result.plans[0]), ElementsAreArray(first));
  EXPECT_THAT(StepsOf(result.plans[1]),
              ElementsAreArray(Joined(Upto(first, 10), Golden("serve_coffee_south_failed"))));
}

TEST(ServeCoffeeTest, WithTheSouthExcludedFromTheStartItGoesNorth) {
  const Steps expected =
      Joined(Upto(Golden("serve_coffee"), 10), Golden("serve_coffee_south_failed"));
  EXPECT_THAT(FirstSteps(With(Load("serve_coffee"), kSouth)), ElementsAreArray(expected));
}

TEST(ServeCoffeeTest, TheProblemOfListing62IsTheStateAfterTenSteps) {
  const Problem start = Load("serve_coffee");
  const Problem after = With(After(start, FirstPlan(start), 10), kSouth);
  EXPECT_EQ(SortedFacts(after), SortedFacts(Load("serve_coffee_south_failed")));
}

TEST(ServeCoffeeTest, ReplanningAfterTenStepsGoesNorth) {
  const Problem start = Load("serve_coffee");
  const Plan plan = FirstPlan(start);
  const std::vector<Datum> now = With(After(start, plan, 10), kSouth).facts;
  const Replanned replanned = Replan(Restaurant(), start, plan, 10, now);
  ASSERT_EQ(ToString(replanned.result.outcome), "found");
  EXPECT_EQ(replanned.kept_depth, 2) << "all but the choice of the area stays";
  const Plan& rest = replanned.result.plans.at(0);
  EXPECT_THAT(StepsOf(rest), ElementsAreArray(Golden("serve_coffee_south_failed")));
  EXPECT_THAT(ValidatePlan(Restaurant(), replanned.problem, rest), IsEmpty());
}

TEST(ServeCoffeeTest, WithAllAreasExcludedNoPlanRemains) {
  const Problem start = Load("serve_coffee");
  const Problem excluded = With(With(start, kSouth), kNorth);
  ExpectNoPlan(excluded);
  const Plan plan = FirstPlan(start);
  const std::vector<Datum> now = After(excluded, plan, 10).facts;
  const PlanResult result = Replan(Restaurant(), start, plan, 10, now).result;
  EXPECT_EQ(ToString(result.outcome), "no_plan");
  EXPECT_TRUE(result.exhausted);
}

TEST(ServeCoffeeTest, WithPlacingImaginedAndFailingItGoesNorthToo) {
  Steps expected = FirstSteps(With(Load("serve_coffee"), kSouth));
  expected.insert(expected.begin() + 7,
                  "(!imagine !place_object (mug1) (rightarm1) (placingareawestlefttable1))");
  EXPECT_THAT(FirstSteps(With(Load("serve_coffee_imagined"), kSouth)), ElementsAreArray(expected));
  ExpectNoPlan(With(With(Load("serve_coffee_imagined"), kSouth), kNorth));
}

TEST(ServeCoffeeTest, SpotsThatAreKnownToFailAreNotImaginedAgain) {
  const auto failed = [](const std::string& area, const std::string& spot) {
    return "(imagined_failure place_object_at mug1 rightarm1 " + area + " " + spot + ")";
  };
  const std::string south = "placingareawestrighttable1";
  Problem problem = With(Load("serve_coffee_spots"), failed(south, "any"));
  problem = With(problem, failed(south, "left"));
  const Steps steps = FirstSteps(problem);
  EXPECT_THAT(steps, Contains("(!imagine !place_object_at (mug1) (rightarm1) (" + south +
                              ") (middle right front back))"));
  EXPECT_THAT(steps, Contains("(!place_object_at mug1 rightarm1 " + south + " middle)"));
  for (const char* spot : {"middle", "right", "front", "back"}) {
    problem = With(problem, failed(south, spot));
  }
  EXPECT_THAT(FirstSteps(problem),
              Contains("(!place_object_at mug1 rightarm1 placingareawestlefttable1 any)"));
}

TEST(ServeCoffeeTest,
     PosesThatAreKnownToFailAreNotLookedFromAndWithoutOneItLooksFromWhereItStands) {
  const std::string at = "placingareaeastrightcounter1 manipulationareaeastcounter1 ";
  const auto without = [&](Problem problem, const std::vector<std::string>& torsos,
                           const std::vector<std::string>& places) {
    for (const std::string& torso : torsos) {
      for (const std::string& place : places) {
        problem =
            With(problem, "(imagined_failure observe_objects_at " + at + torso + " " + place + ")");
      }
    }
    return problem;
  };
  const Steps all_places{"default", "left", "right", "behind"};
  Problem problem = without(Load("serve_coffee_looking"), {"torsoupposture"}, all_places);
  problem = without(problem, {"torsomiddleposture"}, {"default"});
  EXPECT_THAT(FirstSteps(problem),
              AllOf(Contains("(!imagine !observe_objects_at (placingareaeastrightcounter1) "
                             "(manipulationareaeastcounter1) (torsomiddleposture torsodownposture) "
                             "(left right behind default))"),
                    Contains("(!observe_objects_at " + at + "torsomiddleposture left)")));
  problem = without(problem, {"torsomiddleposture"}, {"left", "right", "behind"});
  problem = without(problem, {"torsodownposture"}, all_places);
  EXPECT_THAT(FirstSteps(problem),
              ElementsAreArray(FirstSteps(With(Load("serve_coffee"), "(observe pick_up_object)"))));
}

TEST(ServeCoffeeTest, OtherGuestsAreServedAtTheirSeats) {
  const std::map<std::string, std::string> right_of = {{"guest1", "placingareawestrighttable1"},
                                                       {"guest2", "placingareaeastrighttable1"},
                                                       {"guest3", "placingareanorthrighttable2"},
                                                       {"guest4", "placingareasouthrighttable2"}};
  for (const auto& [guest, area] : right_of) {
    const Steps steps =
        FirstSteps(WithTask(Load("serve_coffee"), "(serve_coffee_to_guest " + guest + ")"));
    EXPECT_THAT(steps, SizeIs(16)) << guest;
    EXPECT_THAT(steps, Contains("(!place_object mug1 rightarm1 " + area + ")"));
  }
}

TEST(ServeCoffeeTest, AGuestWhoIsNotThereCannotBeServed) {
  ExpectNoPlan(WithTask(Load("serve_coffee"), "(serve_coffee_to_guest guest5)"));
}

TEST(ServeCoffeeTest, TheCoffeeOfAnotherGuestStaysThere) {
  const Problem problem =
      With(Without(Load("serve_coffee"), "(On mug1 placingareaeastrightcounter1)"),
           "(On mug1 placingareaeastrighttable1)");
  ExpectNoPlan(problem);
}

TEST(ServeCoffeeTest, AnotherCoffeeIsServedWhenTheFirstCannotBeGrasped) {
  const Problem problem = With(Load("serve_coffee"),
                               "(Type coffee mug2) (imagined_failure pick_up_object mug1 rightarm1)"
                               "(imagined_failure pick_up_object mug1 leftarm1)");
  EXPECT_THAT(FirstSteps(problem), Contains("(!pick_up_object mug2 rightarm1)"));
}

TEST(ServeHotCoffeeTest, OfTwoMugsTheHotOneIsServedWhicheverItIs) {
  Problem swapped =
      Without(Load("serve_hot_coffee"), "(HasTemperature mug1 21) (HasTemperature mug2 62.5)");
  swapped = With(swapped, "(HasTemperature mug1 45) (HasTemperature mug2 44.9)");
  EXPECT_THAT(FirstSteps(swapped), ElementsAreArray(Golden("serve_coffee")));
}

TEST(ServeHotCoffeeTest, WhereNoneIsKnownToBeHotTheRobotMeasuresBeforeItTakesOne) {
  const Problem unknown = Without(Load("serve_hot_coffee"), "(HasTemperature mug2 62.5)");
  Steps expected = Golden("serve_hot_coffee");
  expected.insert(expected.begin() + 6,
                  {"(!measure_temperature mug2 placingareaeastrightcounter1)",
                   "(!!temperature_unknown mug2 placingareaeastrightcounter1)"});
  EXPECT_THAT(FirstSteps(unknown), ElementsAreArray(expected));
  const Problem one_is_hot = Without(Load("serve_hot_coffee"), "(HasTemperature mug1 21)");
  EXPECT_THAT(FirstSteps(one_is_hot), ElementsAreArray(Golden("serve_hot_coffee")));
}

TEST(ServeHotCoffeeTest, AColdCoffeeIsNeverServed) {
  Problem cold = Without(Load("serve_hot_coffee"), "(HasTemperature mug2 62.5)");
  cold = With(cold, "(HasTemperature mug2 30)");
  ExpectNoPlan(cold);
}

TEST(ServeCoffeeTest, TheLeftArmWorksWhenTheRightOneCannotGrasp) {
  const Steps steps =
      FirstSteps(With(Load("serve_coffee"), "(imagined_failure !pick_up_object mug1 rightarm1)"));
  EXPECT_THAT(steps, SizeIs(18));
  EXPECT_EQ(steps.at(3), "(!tuck_arms armuntuckedposture armtuckedposture)");
  EXPECT_EQ(steps.at(5), "(!move_arm_to_side rightarm1)");  // folded, it reaches over the counter
  EXPECT_EQ(steps.at(7), "(!pick_up_object mug1 leftarm1)");
  EXPECT_EQ(steps.at(14), "(!move_arm_to_side rightarm1)");  // carrying, over the table
}

TEST(ServeCoffeeTest, TheRobotLooksFirstWhereThatIsAskedFor) {
  Steps expected = Golden("serve_coffee");
  expected.insert(expected.begin() + 6, "(!observe_objects_on_area placingareaeastrightcounter1)");
  EXPECT_THAT(FirstSteps(With(Load("serve_coffee"), "(observe pick_up_object)")),
              ElementsAreArray(expected));
}

TEST(ServeCoffeeTest, AnArmThatHangsInTheWayIsMovedBeforeTheRobotApproaches) {
  Problem problem = With(Without(Load("serve_coffee"), "(RobotAt floorareatamsrestaurant1)"),
                         "(RobotAt premanipulationareaeastcounter1)");
  EXPECT_THAT(Upto(FirstSteps(problem), 4),
              ElementsAre("(!move_torso torsoupposture)", "(!move_arm_to_side rightarm1)",
                          "(!move_arm_to_side leftarm1)",
                          "(!move_base_blind manipulationareaeastcounter1)"));
}

TEST(ServeCoffeeTest, AnArmIsNotMovedCloseToFurniture) {
  Problem problem = With(Without(Load("serve_coffee"), "(RobotAt floorareatamsrestaurant1)"),
                         "(RobotAt manipulationareaeastcounter1)");
  EXPECT_EQ(FirstSteps(problem).front(), "(!move_base_blind premanipulationareaeastcounter1)");
}

// A task can be taken up again at every moment of its plan: what is planned then is what was left.
TEST(RestaurantTest, WhatIsLeftOfATaskIsWhatIsPlannedInBetween) {
  for (const char* name : {"serve_coffee", "carry_object", "clear_table"}) {
    const Problem start = Load(name);
    const Plan plan = FirstPlan(start);
    for (std::size_t done = 0; done <= plan.steps.size(); ++done) {
      // An answer of imagination is not in the state, so the question is asked again.
      const bool imagined = done > 0 && plan.steps[done - 1].task.Head() == "!imagine";
      const Steps left = From(StepsOf(plan), imagined ? done - 1 : done);
      EXPECT_THAT(FirstSteps(After(start, plan, done)), ElementsAreArray(left))
          << name << " after " << done;
    }
  }
}

// ---------------------------------------------------------------------------- tray and imagination

const char kAtNorth[] = "premanipulationareanorthtable1";
const char kAtSouth[] = "premanipulationareasouthtable1";

std::string Failed(const std::string& area, const std::string& set) {
  return "(imagined_failure move_base_param " + area + " " + set + ")";
}

TEST(CarryObjectTest, TheSetThatFailsIsNeitherImaginedNorDriven) {
  const Steps slow = FirstSteps(With(Load("carry_object"), Failed(kAtNorth, "fast")));
  EXPECT_EQ(slow.at(10), "(!imagine !move_base_param (premanipulationareanorthtable1) (slow))");
  EXPECT_EQ(slow.at(11), "(!move_base_param premanipulationareanorthtable1 slow)");
  const Steps fast =
      FirstSteps(With(Load("carry_object"),
                      "(imagined_failure !move_base_param premanipulationareanorthtable1 slow)"));
  EXPECT_EQ(fast.at(10), "(!imagine !move_base_param (premanipulationareanorthtable1) (fast))");
  EXPECT_EQ(fast.at(11), "(!move_base_param premanipulationareanorthtable1 fast)");
}

TEST(CarryObjectTest, WhereNoSetIsLeftTheOtherSideOfTheTableIsChosen) {
  const Steps steps =
      FirstSteps(With(Load("carry_object"), Failed(kAtNorth, "fast") + Failed(kAtNorth, "slow")));
  EXPECT_EQ(steps.at(10),
            "(!imagine !move_base_param (premanipulationareasouthtable1) (slow fast))");
  EXPECT_EQ(steps.at(16), "(!place_object peppermill1 rightarm1 placingareaeastlefttable1)");
}

TEST(CarryObjectTest, WhenAllFailsOnTheWayTheLoadedTrayGoesToTheOtherSide) {
  const Problem start = Load("carry_object");
  const Plan plan = FirstPlan(start);
  const std::string failures = Failed(kAtNorth, "fast") + Failed(kAtNorth, "slow");
  const std::vector<Datum> now = With(After(start, plan, 11), failures).facts;
  const Replanned replanned = Replan(Restaurant(), start, plan, 11, now);
  ASSERT_EQ(ToString(replanned.result.outcome), "found");
  EXPECT_THAT(StepsOf(replanned.result.plans.at(0)),
              ElementsAreArray(From(FirstSteps(With(start, failures)), 10)));
}

TEST(CarryObjectTest, WhereNoSetIsLeftAtAllNoPlanRemains) {
  ExpectNoPlan(With(Load("carry_object"), Failed(kAtNorth, "fast") + Failed(kAtNorth, "slow") +
                                              Failed(kAtSouth, "fast") + Failed(kAtSouth, "slow")));
}

TEST(CarryObjectTest, PlacesMayBeSingleAreas) {
  const Steps steps =
      FirstSteps(WithTask(Load("carry_object"),
                          "(carry_object_on_tray peppermill1 placingareaeastrightcounter1 "
                          "placingareasouthrighttable2)"));
  EXPECT_EQ(steps.at(11), "(!move_base_param premanipulationareaeasttable2 fast)");
  EXPECT_EQ(steps.at(16), "(!place_object peppermill1 rightarm1 placingareasouthrighttable2)");
}

TEST(CarryObjectTest, TheWayBackIsCarriedAndImaginedToo) {
  const Problem start = Load("carry_object");
  const Plan there = FirstPlan(start);
  const Problem back = WithTask(After(start, there, there.steps.size()),
                                "(carry_object_on_tray peppermill1 table1 counter1)");
  const Steps steps = FirstSteps(back);
  EXPECT_THAT(steps, Contains("(!imagine !move_base_param (premanipulationareaeastcounter1) "
                              "(slow fast))"));
  EXPECT_EQ(steps.at(steps.size() - 2),
            "(!place_object peppermill1 rightarm1 placingareaeastrightcounter1)");
}

TEST(CarryObjectTest, WhatIsThereAlreadyIsNotCarried) {
  const Problem start = Load("carry_object");
  EXPECT_THAT(FirstSteps(WithTask(start, "(carry_object_on_tray peppermill1 table1 counter1)")),
              IsEmpty());
}

TEST(CarryObjectTest, ImaginationHoldsUpNothingAndNothingHoldsItUp) {
  const Plan plan = FirstPlan(Load("carry_object"));
  ASSERT_EQ(plan.steps.at(10).task.Head(), "!imagine");
  for (const auto& [before, after] : PartialOrder(plan)) {
    EXPECT_NE(before, 10);
    EXPECT_NE(after, 10);
  }
  EXPECT_EQ(plan.steps[10].cost, 0.0);
  EXPECT_EQ(plan.cost, static_cast<double>(plan.steps.size() - 1));
}

TEST(ClearTableTest, AClearTableNeedsNothing) {
  const Problem problem = WithTask(Load("clear_table"), "(clear_table table2 counter1)");
  EXPECT_THAT(FirstSteps(problem), IsEmpty());
}

TEST(ClearTableTest, WhatCannotBePlacedLeavesNoPlan) {
  ExpectNoPlan(With(Load("clear_table"),
                    "(imagined_failure place_object mug1 rightarm1 placingareaeastrightcounter1)"));
}

// ------------------------------------------------------------------------------- why there is none

std::string WhyNoPlan(const std::string& task) {
  PlanRequest request;
  request.explain = true;
  const PlanResult result = FindPlans(Restaurant(), WithTask(Load("serve_coffee"), task), request);
  EXPECT_EQ(result.outcome, PlanOutcome::kNoPlan) << task;
  return OutcomeSentence(result, Which::kFirst);
}

TEST(WhyNoPlanTest, AnUnknownGuestAnAbsentObjectAndAnUnreachableAreaAreToldApart) {
  EXPECT_THAT(
      WhyNoPlan("(serve_coffee_to_guest guest5)"),
      AllOf(HasSubstr("); neither a fact nor the domain knows 'guest5' (did you mean 'guest"),
            HasSubstr("every way was tried; it got as far as (serve_coffee_to_guest guest5): no "
                      "binding satisfies "
                      "goal 1 (at guest5 ?seat)"),
            HasSubstr("restaurant.lisp:")));
  EXPECT_THAT(WhyNoPlan("(get_object unicorn)"),
              AllOf(HasSubstr("; neither a fact nor the domain knows 'unicorn'"),
                    HasSubstr("(on unicorn ?area)")));
  EXPECT_THAT(WhyNoPlan("(move_object mug1 placingareamoon)"),
              AllOf(HasSubstr("knows 'placingareamoon'"),
                    HasSubstr("(put_object mug1 placingareamoon): no binding satisfies goal 1 "
                              "(place_in placingareamoon ?area ?rank)")));
}

TEST(WhyNoPlanTest, AStepThatImaginationExcludesIsNamedAsSuch) {
  const Problem problem = With(WithTask(Load("serve_coffee"), "(drive_robot floor1)"),
                               "(imagined_failure move_base floor1)");
  PlanRequest request;
  request.explain = true;
  const std::string why = OutcomeSentence(FindPlans(Restaurant(), problem, request), Which::kFirst);
  EXPECT_THAT(why, AllOf(HasSubstr("(!move_base floor1)"), HasSubstr("says imagined_failure")));
}

TEST(WhyNoPlanTest, NothingIsSaidUnlessItIsAskedFor) {
  const PlanResult result =
      FindPlans(Restaurant(), WithTask(Load("serve_coffee"), "(get_object unicorn)"));
  EXPECT_THAT(result.deepest, IsEmpty());
  EXPECT_THAT(result.unknown_names, IsEmpty());
}

TEST(RestaurantNamesTest, NoPredicateIsMisspelt) {
  EXPECT_THAT(MisspeltPredicates(Restaurant(), Load("serve_coffee")), IsEmpty());
}

// ------------------------------------------------------------------------- steps at the same time

/// Whether `before` must come before `after`, by chains of the reduced order.
std::vector<std::vector<bool>> Closure(const Plan& plan) {
  const std::size_t n = plan.steps.size();
  std::vector<std::vector<bool>> before(n, std::vector<bool>(n, false));
  for (const auto& [a, b] : PartialOrder(plan)) before[a][b] = true;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        before[i][j] = before[i][j] || (before[i][k] && before[k][j]);
    }
  }
  return before;
}

TEST(RestaurantOrderTest, TorsoAndArmsMoveAtTheSameTimeAndNothingElseInServingCoffee) {
  const Plan plan = FirstPlan(Load("serve_coffee"));
  const auto before = Closure(plan);
  std::vector<std::pair<int, int>> free;  // as numbered in Listing 6.1
  for (int i = 0; i < static_cast<int>(plan.steps.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(plan.steps.size()); ++j) {
      if (!before[i][j]) free.emplace_back(i + 1, j + 1);
    }
  }
  using Pair = std::pair<int, int>;
  EXPECT_THAT(free, ElementsAre(Pair(3, 4), Pair(3, 5), Pair(9, 10), Pair(12, 13)));
}

TEST(RestaurantOrderTest, TheRobotLooksBeforeItTakesSomethingAway) {
  for (const Problem& problem :
       {With(Load("serve_coffee"), "(observe pick_up_object)"), Load("serve_coffee_looking")}) {
    const Plan plan = FirstPlan(problem);
    const auto before = Closure(plan);
    const auto index_of = [&](const std::string& start) {
      const Steps steps = StepsOf(plan);
      return std::find_if(steps.begin(), steps.end(),
                          [&](const std::string& step) { return step.rfind(start, 0) == 0; }) -
             steps.begin();
    };
    EXPECT_TRUE(before[index_of("(!observe_objects")][index_of("(!pick_up_object")]);
    EXPECT_TRUE(before[index_of("(!move_base_blind")][index_of("(!observe_objects")]);
  }
}

TEST(RestaurantOrderTest, StepsThatMayRunTogetherNeverClaimMoreThanThereIs) {
  for (const char* name : kProblems) {
    const Plan plan = FirstPlan(Load(name));
    const auto before = Closure(plan);
    for (std::size_t i = 0; i < plan.steps.size(); ++i) {
      for (std::size_t j = i + 1; j < plan.steps.size(); ++j) {
        if (before[i][j]) continue;
        std::map<std::string, int> claimed = ResourcesOf(Sidecar(), plan.steps[i]);
        for (const auto& [resource, units] : ResourcesOf(Sidecar(), plan.steps[j])) {
          claimed[resource] += units;
          EXPECT_LE(claimed[resource], Sidecar().capacities.at(resource))
              << name << ": " << ToString(plan.steps[i].task) << " and "
              << ToString(plan.steps[j].task);
        }
      }
    }
  }
}

// ---------------------------------------------------------------------------- files that must
// agree

void CollectSymbols(const Datum& datum, std::set<std::string>* symbols) {
  if (datum.kind == Datum::Kind::kSymbol) symbols->insert(datum.text);
  for (const Datum& item : datum.items) CollectSymbols(item, symbols);
}

/// Names of areas among the facts of the domain's last part and of all problems.
std::set<std::string> NamedAreas() {
  std::set<std::string> symbols;
  for (const Axiom& axiom : Restaurant().axioms) CollectSymbols(axiom.head, &symbols);
  for (const char* name : kProblems) {
    for (const Datum& fact : Load(name).facts) CollectSymbols(fact, &symbols);
  }
  std::set<std::string> areas;
  for (const std::string& symbol : symbols) {
    if (symbol.find("area") != std::string::npos && symbol.substr(0, 3) != "has") {
      areas.insert(symbol);
    }
  }
  return areas;
}

TEST(RestaurantFilesTest, EveryAreaOfTheDomainIsAFrameOfTheWorld) {
  for (const std::string& area : NamedAreas()) {
    EXPECT_TRUE(Room().FindFrame(area).has_value()) << area;
  }
}

TEST(RestaurantFilesTest, EveryPlaceOfTheWorldIsKnownToTheDomain) {
  const std::set<std::string> known = NamedAreas();
  for (const auto& [name, pose] : Room().frames) {
    if (name.find("area") == std::string::npos || name == "nearstartarea1") continue;
    EXPECT_EQ(known.count(name), 1u) << name;
  }
}

std::vector<std::string> FactsOf(const Problem& problem, const std::set<std::string>& predicates) {
  std::vector<std::string> facts;
  for (const Datum& fact : problem.facts) {
    if (predicates.count(std::string(fact.Head())) == 1) facts.push_back(ToString(fact));
  }
  return facts;
}

TEST(RestaurantFilesTest, AllProblemsHaveTheSameGuests) {
  const std::vector<std::string> guests = FactsOf(Load("serve_coffee"), {"at"});
  EXPECT_THAT(guests, SizeIs(4));
  for (const char* name : kProblems) EXPECT_EQ(FactsOf(Load(name), {"at"}), guests) << name;
}

TEST(RestaurantFilesTest, AllProblemsThatBeginAtTheStartHaveTheSameRobot) {
  const std::set<std::string> robot = {"robotat", "hastorsoposture", "hasarmposture", "holding"};
  const std::vector<std::string> start = FactsOf(Load("serve_coffee"), robot);
  EXPECT_THAT(start, SizeIs(6));
  for (const char* name : {"serve_coffee_imagined", "carry_object", "clear_table"}) {
    EXPECT_EQ(FactsOf(Load(name), robot), start) << name;
  }
}

TEST(RestaurantFilesTest, ProblemsAreWrittenForTheDomainAndNamedAsTheirFiles) {
  for (const char* name : kProblems) {
    EXPECT_EQ(Load(name).name, name);
    EXPECT_EQ(Load(name).domain, Restaurant().name);
  }
}

TEST(RestaurantFilesTest, TheImaginedProblemDiffersInItsSwitchAlone) {
  EXPECT_EQ(SortedFacts(With(Load("serve_coffee"), "(imagine place_object)")),
            SortedFacts(Load("serve_coffee_imagined")));
}

TEST(RestaurantSidecarTest, EveryActionThatIsImaginedHasItsDefaults) {
  std::set<std::string> imagined;
  for (const char* name : kProblems) {
    for (const PlanStep& step : FirstPlan(Load(name)).steps) {
      if (step.task.Head() == "!imagine") imagined.insert(step.task.items.at(1).text);
    }
  }
  EXPECT_THAT(imagined, ElementsAre("!move_base_param", "!observe_objects_at", "!place_object",
                                    "!place_object_at"));
  for (const std::string& action : imagined) {
    EXPECT_TRUE(EntryOf(Sidecar(), action).imagine.has_value()) << action;
  }
}

TEST(RestaurantSidecarTest, DefaultOfAnImaginedDriveIsTheMotionSetWithTheLowestLimits) {
  const YAML::Node robot = YAML::LoadFile(kRoot + "/config/robots/pr2.yaml");
  const ImagineData& imagine = EntryOf(Sidecar(), "move_base_param").imagine.value();
  EXPECT_THAT(imagine.parameters, ElementsAre("motion_set"));
  const YAML::Node sets = robot["motion_sets"], lowest = sets[imagine.defaults.at("motion_set")];
  for (const auto& set : sets) {
    for (const auto& limit : lowest) {
      EXPECT_LE(limit.second.as<double>(), set.second[limit.first.as<std::string>()].as<double>());
    }
  }
}

TEST(RestaurantSidecarTest, DriveWithoutMotionSetTakesTheRobotsDefault) {
  const YAML::Node robot = YAML::LoadFile(kRoot + "/config/robots/pr2.yaml");
  const auto set = robot["default_motion_set"].as<std::string>();
  EXPECT_EQ(EntryOf(Sidecar(), "move_base").leg.value().fixed_motion_set, set);
}

TEST(RestaurantSidecarTest, NoLegIsDrivenFasterThanItsStraightLineAllows) {
  const YAML::Node sets = YAML::LoadFile(kRoot + "/config/robots/pr2.yaml")["motion_sets"];
  const YAML::Node local = YAML::LoadFile(kRoot + "/config/scene.yaml")["driving"]["local"];
  const double tolerance = 2.0 * local["xy_goal_tolerance"].as<double>();  // at both ends
  EXPECT_THAT(Sidecar().legs, SizeIs(5 * 4 * 2));
  for (const Leg& leg : Sidecar().legs) {
    const auto from = Room().FindFrame(leg.from);
    const auto to = Room().FindFrame(leg.to);
    ASSERT_TRUE(from && to) << leg.from << " " << leg.to;
    const double distance = (to->translation - from->translation).norm() - tolerance;
    const double shortest = distance / sets[leg.motion_set]["max_linear_velocity"].as<double>();
    EXPECT_LE(leg.duration.min, shortest) << leg.from << " " << leg.to << " " << leg.motion_set;
    EXPECT_GT(leg.duration.min, shortest - 0.1) << leg.from << " " << leg.to;
  }
}

TEST(RestaurantSidecarTest, DrivesOfThePlansAreFoundAmongTheLegs) {
  const Plan plan = FirstPlan(Load("carry_object"));
  const Duration drive = DurationOf(Sidecar(), plan.steps.at(11));
  EXPECT_EQ(drive.expected, 16.59);  // EC1 to NT1, fast, Table 6.2
  EXPECT_EQ(drive.min, 4.4);
  EXPECT_EQ(DurationOf(Sidecar(), plan.steps.at(1)).min, 0.0) << "from anywhere on the floor";
}

}  // namespace
}  // namespace hires::planning::restaurant_test
