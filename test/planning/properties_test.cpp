#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "hires/planning/planner.h"
#include "hires/planning/reasons.h"
#include "hires/planning/validator.h"
#include "planning/support/brute_force.h"
#include "planning/support/plan_text.h"
#include "planning/support/random_networks.h"
#include "support/property.h"

namespace hires::planning::properties_test {
namespace {

using hires::test_support::BruteForceResult;
using hires::test_support::NetworkOptions;
using hires::test_support::PlanByBruteForce;
using hires::test_support::RandomNetwork;
using hires::test_support::RandomNetworks;
using hires::test_support::Solve;
using hires::test_support::Steps;

constexpr hires::test_support::PropertyCases kPropertyCases{60};

constexpr std::size_t kEnough = 100'000;  // plans

PlanRequest AskFor(Which which) {
  PlanRequest request;
  request.which = which;
  request.max_plans = kEnough;
  return request;
}

/// Ends a search that might go on for ever, after the same number of expansions each time.
StopQuestion AfterExpansions(std::uint64_t limit) {
  return [limit](const Progress& progress) {
    return progress.expansions >= limit ? Stop::kTime : Stop::kContinue;
  };
}

PlanResult Plans(const RandomNetwork& network, const PlanRequest& request) {
  return FindPlans(network.domain(), network.problem(), request);
}

/// All plans of a network, or none at all where there are too many to compare.
PlanResult AllPlans(const RandomNetwork& network) {
  PlanRequest request = AskFor(Which::kAll);
  request.stop = AfterExpansions(10'000);
  const PlanResult result = Plans(network, request);
  RC_PRE(result.exhausted);
  return result;
}

std::map<std::string, int> Count(const PlanResult& result) {
  std::map<std::string, int> counts;
  for (const std::string& steps : Steps(result)) ++counts[steps];
  return counts;
}

std::multiset<double> Costs(const PlanResult& result) {
  std::multiset<double> costs;
  for (const Plan& plan : result.plans) costs.insert(plan.cost);
  return costs;
}

/// Decompositions and steps on the way to a plan.
int Depth(const Plan& plan) { return static_cast<int>(plan.nodes.size()) - 1; }

// Multisets of steps, not sets: the same steps by two decompositions are two plans, and sets would
// hide interleavings that are found twice.
void ExpectSameAsBruteForce(const Domain& domain, const Problem& problem) {
  const BruteForceResult expected = PlanByBruteForce(domain, problem);
  RC_PRE(expected.complete);
  RC_CLASSIFY(expected.plans.empty(), "no plan");
  RC_CLASSIFY(expected.plans.size() == 1, "one plan");
  RC_CLASSIFY(expected.plans.size() > 1, "several plans");
  RC_CLASSIFY(expected.num_plans() > static_cast<int>(expected.plans.size()),
              "several decompositions");
  const PlanResult found = FindPlans(domain, problem, AskFor(Which::kAll));
  RC_ASSERT(found.exhausted);
  RC_ASSERT(Count(found) == expected.plans);
  RC_ASSERT(Costs(found) == expected.costs);
  RC_ASSERT((found.outcome == PlanOutcome::kFound) == !expected.plans.empty());
}

// What the yardstick itself says, in cases that SHOP3 was asked for.
TEST(BruteForceTest, CountsTheInterleavingsThatShop3Counts) {
  const std::string steps =
      "(:operator (!s ?x) () () ()) (:method (u) () ((!s 1) (!s 2)))"
      "(:method (v) () ((!s 3) (!s 4)))";
  const auto count = [](const std::string& items, const std::string& facts,
                        const std::string& tasks) {
    return PlanByBruteForce(
               ReadShop2Domain("(defdomain d (" + items + "))", "domain"),
               ReadShop2Problems("(defproblem p d " + facts + " " + tasks + ")", "problem").at(0))
        .num_plans();
  };
  EXPECT_EQ(count(steps, "()", "(:unordered (u) (v))"), 6);
  EXPECT_EQ(count(steps + "(:method (u) () ((!s 2) (!s 1)))", "()", "(:unordered (u) (v))"), 12);
  const std::string foo =
      "(:operator (!a1) () () ((foo))) (:operator (!a2) () ((foo)) ())"
      "(:operator (!b1) (foo) () ()) (:operator (!b2) () () ())";
  const std::string tasks = "(:unordered (:unordered (!a1) (!a2)) (:ordered (!b1) (!b2)))";
  EXPECT_EQ(count(foo, "()", tasks), 3);
  EXPECT_EQ(count(foo, "((foo))", tasks), 9);
}

HIRES_PROPERTY(RandomNetworkTest, AllPlansAreThoseOfBruteForce, ()) {
  const RandomNetwork network = *RandomNetworks();
  ExpectSameAsBruteForce(network.domain(), network.problem());
}

HIRES_PROPERTY(RandomNetworkTest, AllPlansWithProtectionsAreThoseOfBruteForce, ()) {
  NetworkOptions options;
  options.protections = true;
  const RandomNetwork network = *RandomNetworks(options);
  ExpectSameAsBruteForce(network.domain(), network.problem());
}

// HDDL's tasks may be decomposed long before their first step.
HIRES_PROPERTY(RandomNetworkTest, AllPlansByTheRulesOfHddlAreThoseOfBruteForce, ()) {
  NetworkOptions options;
  options.immediate = false;
  options.max_items = 2;
  const RandomNetwork network = *RandomNetworks(options);
  Domain domain = network.domain();
  domain.language = Domain::Language::kHddl;
  ExpectSameAsBruteForce(domain, network.problem());
}

std::set<std::string> TextsOf(const std::vector<Datum>& atoms) {
  std::set<std::string> texts;
  for (const Datum& atom : atoms) texts.insert(ToString(atom));
  return texts;
}

/// The effects that the steps name lead to the state after the plan, and what the steps need holds
/// before them, made so by the steps that their links name.
void ExpectReasonsThatFit(const Domain& domain, const Problem& problem, Plan plan) {
  AddReasons(domain, problem, &plan);
  std::set<std::string> facts = TextsOf(problem.facts);
  for (const PlanStep& step : plan.steps) {
    for (const CausalLink& link : step.links) {
      const std::string atom = ToString(link.literal.atom);
      if (link.literal.holds) RC_ASSERT(facts.count(atom) == 1u);
      if (!link.literal.holds && IsGround(link.literal.atom)) RC_ASSERT(facts.count(atom) == 0u);
      if (!link.literal.holds || link.producer < 0) continue;
      RC_ASSERT(TextsOf(plan.steps[link.producer].adds).count(atom) == 1u);
    }
    for (const Datum& atom : step.deletes) RC_ASSERT(facts.erase(ToString(atom)) == 1u);
    for (const Datum& atom : step.adds) facts.insert(ToString(atom));
  }
  const int num_steps = static_cast<int>(plan.steps.size());
  RC_ASSERT(TextsOf(FactsAfter(domain, problem, plan, num_steps)) == facts);
}

void ExpectValid(const RandomNetwork& network) {
  const Domain domain = network.domain();
  const Problem problem = network.problem();
  PlanRequest request = AskFor(Which::kAll);
  request.max_plans = 50;
  request.stop = AfterExpansions(2'000);
  const PlanResult result = FindPlans(domain, problem, request);
  RC_CLASSIFY(!result.plans.empty(), "has plans");
  for (const Plan& plan : result.plans) {
    RC_ASSERT(ValidatePlan(domain, problem, plan) == std::vector<std::string>{});
    ExpectReasonsThatFit(domain, problem, plan);
  }
}

HIRES_PROPERTY(RandomNetworkTest, EveryPlanIsValid, ()) { ExpectValid(*RandomNetworks()); }

HIRES_PROPERTY(RandomNetworkTest, EveryPlanWithProtectionsIsValid, ()) {
  NetworkOptions options;
  options.protections = true;
  ExpectValid(*RandomNetworks(options));
}

HIRES_PROPERTY(RandomNetworkTest, EveryPlanWhoseEffectsAreVariablesIsValid, ()) {
  NetworkOptions options;
  options.variables = true;
  options.protections = *rc::gen::arbitrary<bool>();
  ExpectValid(*RandomNetworks(options));
}

HIRES_PROPERTY(RandomNetworkTest, EveryPlanOfARecursiveDomainIsValid, ()) {
  NetworkOptions options;
  options.recursion = true;
  const RandomNetwork network = *RandomNetworks(options);
  const Domain domain = network.domain();
  const Problem problem = network.problem();
  PlanRequest request;
  request.max_depth = 200;
  request.stop = AfterExpansions(5'000);
  for (const Plan& plan : FindPlans(domain, problem, request).plans) {
    RC_ASSERT(ValidatePlan(domain, problem, plan) == std::vector<std::string>{});
  }
}

HIRES_PROPERTY(RandomNetworkTest, TheFirstPlanIsTheFirstOfAll, ()) {
  const RandomNetwork network = *RandomNetworks();
  const PlanResult all = AllPlans(network);
  const PlanResult first = Plans(network, AskFor(Which::kFirst));
  RC_ASSERT(first.plans.empty() == all.plans.empty());
  RC_ASSERT(first.plans.size() <= 1u);
  RC_ASSERT(first.outcome == all.outcome);
  if (!all.plans.empty()) RC_ASSERT(Steps(first.plans[0]) == Steps(all.plans[0]));
}

HIRES_PROPERTY(RandomNetworkTest, TheBestPlanIsTheFirstOfTheCheapest, ()) {
  const RandomNetwork network = *RandomNetworks();
  const PlanResult all = AllPlans(network);
  const PlanResult best = Plans(network, AskFor(Which::kBest));
  RC_ASSERT(best.outcome == all.outcome);
  if (all.plans.empty()) return RC_ASSERT(best.plans.empty());
  const auto cheapest =
      std::min_element(all.plans.begin(), all.plans.end(),
                       [](const Plan& a, const Plan& b) { return a.cost < b.cost; });
  RC_ASSERT(best.plans.size() == 1u);
  RC_ASSERT(best.plans[0].cost == cheapest->cost);
  RC_ASSERT(Steps(best.plans[0]) == Steps(*cheapest));
}

HIRES_PROPERTY(RandomNetworkTest, MaxPlansGivesTheFirstOnes, ()) {
  const RandomNetwork network = *RandomNetworks();
  const std::vector<std::string> all = Steps(AllPlans(network));
  PlanRequest request = AskFor(Which::kAll);
  request.max_plans = *rc::gen::inRange<std::size_t>(1, 5);
  const PlanResult some = Plans(network, request);
  const std::size_t wanted = std::min(request.max_plans, all.size());
  RC_ASSERT(Steps(some) == std::vector<std::string>(all.begin(), all.begin() + wanted));
  if (all.size() > request.max_plans) RC_ASSERT(!some.exhausted);
}

HIRES_PROPERTY(RandomNetworkTest, MaxCostKeepsThePlansThatCostNoMore, ()) {
  const RandomNetwork network = *RandomNetworks();
  PlanRequest request = AskFor(Which::kAll);
  request.max_cost = *rc::gen::inRange(0, 8);
  std::vector<std::string> wanted;
  const PlanResult all = AllPlans(network);
  for (const Plan& plan : all.plans) {
    if (plan.cost <= request.max_cost) wanted.push_back(Steps(plan));
  }
  const PlanResult cheap = Plans(network, request);
  RC_ASSERT(Steps(cheap) == wanted);
  if (wanted.empty() && !all.plans.empty()) RC_ASSERT(cheap.outcome == PlanOutcome::kLimitCost);
  if (all.plans.empty()) RC_ASSERT(cheap.outcome != PlanOutcome::kFound);
}

HIRES_PROPERTY(RandomNetworkTest, MaxDepthKeepsThePlansThatAreNoDeeper, ()) {
  const RandomNetwork network = *RandomNetworks();
  PlanRequest request = AskFor(Which::kAll);
  request.max_depth = *rc::gen::inRange(1, 12);
  std::vector<std::string> wanted;
  const PlanResult all = AllPlans(network);
  for (const Plan& plan : all.plans) {
    if (Depth(plan) <= request.max_depth) wanted.push_back(Steps(plan));
  }
  const PlanResult shallow = Plans(network, request);
  RC_ASSERT(Steps(shallow) == wanted);
  if (wanted.empty() && !all.plans.empty()) RC_ASSERT(shallow.outcome == PlanOutcome::kLimitDepth);
}

HIRES_PROPERTY(RandomNetworkTest, TwoRunsAreTheSame, ()) {
  NetworkOptions options;
  options.protections = true;
  const RandomNetwork network = *RandomNetworks(options);
  PlanRequest request = AskFor(Which::kAll);
  request.max_trace = 20;
  request.stop = AfterExpansions(5'000);
  const PlanResult one = Plans(network, request);
  const PlanResult two = Plans(network, request);
  RC_ASSERT(Steps(one) == Steps(two));
  RC_ASSERT(one.outcome == two.outcome);
  RC_ASSERT(one.progress.expansions == two.progress.expansions);
  RC_ASSERT(one.progress.inferences == two.progress.inferences);
  RC_ASSERT(one.progress.bytes == two.progress.bytes);
  RC_ASSERT(one.trace.size() == two.trace.size());
  for (std::size_t i = 0; i < one.trace.size(); ++i) {
    RC_ASSERT(one.trace[i].reason == two.trace[i].reason);
  }
}

// A path that comes back to a state and task network that it has been at can do so for ever. So
// where a search without loop check ends, it has met no such path, and there is nothing to cut.
HIRES_PROPERTY(RandomNetworkTest, TheLoopCheckTakesNoPlanFromASearchThatEnds, ()) {
  NetworkOptions options;
  options.recursion = *rc::gen::arbitrary<bool>();
  options.max_items = 2;
  const RandomNetwork network = *RandomNetworks(options);
  PlanRequest request = AskFor(Which::kAll);
  request.stop = AfterExpansions(5'000);
  request.loop_check = false;
  const PlanResult without = Plans(network, request);
  RC_PRE(without.exhausted);
  request.loop_check = true;
  const PlanResult with = Plans(network, request);
  RC_CLASSIFY(options.recursion, "recursive");
  RC_ASSERT(with.exhausted);
  RC_ASSERT(with.outcome == without.outcome);
  RC_ASSERT(Steps(with) == Steps(without));
  RC_ASSERT(with.progress.expansions == without.progress.expansions);
}

// With the check, plans that turn in circles are left out, and only these. (Not their order: a plan
// may be found first with a circle of tasks that need no step.)
HIRES_PROPERTY(RandomNetworkTest, TheLoopCheckLeavesOutPlansButNotAll, ()) {
  NetworkOptions options;
  options.recursion = true;
  options.max_items = 2;
  const RandomNetwork network = *RandomNetworks(options);
  PlanRequest request = AskFor(Which::kAll);
  request.max_depth = 10;
  request.stop = AfterExpansions(5'000);
  const PlanResult with = Plans(network, request);
  request.loop_check = false;
  const PlanResult without = Plans(network, request);
  RC_PRE(with.outcome != PlanOutcome::kLimitTime && without.outcome != PlanOutcome::kLimitTime);
  const std::map<std::string, int> some = Count(with);
  std::map<std::string, int> all = Count(without);
  RC_CLASSIFY(with.plans.size() < without.plans.size(), "circles left out");
  for (const auto& [steps, count] : some) RC_ASSERT(count <= all[steps]);
  RC_ASSERT(with.plans.empty() == without.plans.empty());
}

// ------------------------------------------------------------------------------- interleavings

/// A network of steps in series and in parallel, in three notations, and in how many orders its
/// steps can come.
struct SeriesParallel {
  int num_steps{0};
  double num_orders{1.0};
  std::string nested;   ///< as one task network
  std::string task;     ///< as a task that methods decompose
  std::string methods;  ///< these
};

double Binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

SeriesParallel MakeStep(int* number) {
  const std::string step = "(!s s" + std::to_string((*number)++) + ")";
  return {1, 1.0, step, step, ""};
}

/// At most `max_steps` steps under at most `depth` levels.
SeriesParallel MakeSeriesParallel(int max_steps, int depth, int* number) {
  if (max_steps == 1 || depth == 0) return MakeStep(number);
  const bool is_parallel = *rc::gen::arbitrary<bool>();
  const int num_parts = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 4));
  SeriesParallel whole;
  std::string tasks;
  for (int i = 0; i < num_parts && whole.num_steps < max_steps; ++i) {
    const SeriesParallel part = MakeSeriesParallel(max_steps - whole.num_steps, depth - 1, number);
    whole.num_steps += part.num_steps;
    whole.num_orders *= part.num_orders;
    if (is_parallel) whole.num_orders *= Binomial(whole.num_steps, part.num_steps);
    whole.nested += " " + part.nested;
    tasks += " " + part.task;
    whole.methods += part.methods;
  }
  const std::string kind = is_parallel ? "(:unordered" : "(:ordered";
  whole.nested = kind + whole.nested + ")";
  whole.task = "(t" + std::to_string((*number)++) + ")";
  whole.methods += "(:method " + whole.task + " () " + kind + tasks + "))\n";
  return whole;
}

HIRES_PROPERTY(InterleavingTest, EveryOrderOfStepsIsFoundOnceHoweverTheTasksAreNested, ()) {
  int number = 0;
  const SeriesParallel network = MakeSeriesParallel(8, 3, &number);
  RC_PRE(network.num_orders <= 3000);
  RC_TAG(network.num_orders);
  const std::string operators = "(:operator (!s ?x) () () ())\n";
  for (const std::string& tasks : {network.nested, network.task}) {
    const PlanResult result = Solve(operators + network.methods, "()", tasks, AskFor(Which::kAll));
    const std::vector<std::string> plans = Steps(result);
    RC_ASSERT(static_cast<double>(plans.size()) == network.num_orders);
    RC_ASSERT(std::set<std::string>(plans.begin(), plans.end()).size() == plans.size());
  }
}

HIRES_PROPERTY(InterleavingTest, IndependentSequencesGiveTheMultinomialCoefficient, ()) {
  const std::vector<int> lengths = *rc::gen::container<std::vector<int>>(
      *rc::gen::inRange(1, 5), rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 4)));
  const int sum = std::accumulate(lengths.begin(), lengths.end(), 0);
  RC_PRE(sum <= 8);
  std::string items = "(:operator (!s ?x) () () ())", tasks = "(:unordered";
  double wanted = 1.0;
  int left = sum;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const std::string name = "(chain" + std::to_string(i) + ")";
    items += "(:method " + name + " () (";
    for (int k = 0; k < lengths[i]; ++k) items += "(!s c" + std::to_string(i) + ")";
    items += "))";
    tasks += name;
    wanted *= Binomial(left, lengths[i]);
    left -= lengths[i];
  }
  const PlanResult result = Solve(items, "()", tasks + ")", AskFor(Which::kAll));
  RC_ASSERT(static_cast<double>(result.plans.size()) == wanted);
}

// --------------------------------------------------------------------------------- stop question

/// 8! = 40320 plans, a long search.
const char kManyPlans[] = "(:unordered (!s 1) (!s 2) (!s 3) (!s 4) (!s 5) (!s 6) (!s 7) (!s 8))";

HIRES_PROPERTY(StopQuestionTest, TheSearchEndsWithTheAnswerAndKeepsThePlansFound, ()) {
  const auto [stop, outcome] =
      *rc::gen::element(std::make_pair(Stop::kTime, PlanOutcome::kLimitTime),
                        std::make_pair(Stop::kMemory, PlanOutcome::kLimitMemory),
                        std::make_pair(Stop::kCancelled, PlanOutcome::kCancelled));
  const int question = *rc::gen::inRange(1, 20);
  PlanRequest request = AskFor(Which::kAll);
  const std::string items = "(:operator (!s ?x) () () ())";
  static const std::vector<std::string> all = Steps(Solve(items, "()", kManyPlans, request));
  int asked = 0, plans_when_stopped = -1;
  const Stop answer = stop;
  request.stop = [&](const Progress& progress) {
    if (++asked < question) return Stop::kContinue;
    plans_when_stopped = progress.plans;
    return answer;
  };
  const PlanResult some = Solve(items, "()", kManyPlans, request);
  RC_ASSERT(some.outcome == outcome);
  RC_ASSERT(!some.exhausted);
  RC_ASSERT(asked == question);
  RC_ASSERT(some.progress.expansions <= 256u * question);
  RC_ASSERT(static_cast<int>(some.plans.size()) == plans_when_stopped);
  RC_ASSERT(some.progress.plans == plans_when_stopped);
  for (std::size_t i = 0; i < some.plans.size(); ++i) {
    RC_ASSERT(Steps(some.plans[i]) == all[i]);
  }
}

}  // namespace
}  // namespace hires::planning::properties_test
