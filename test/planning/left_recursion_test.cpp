#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hires/planning/plan.h"
#include "hires/planning/planner.h"
#include "hires/planning/validator.h"
#include "planning/language/hddl_reader.h"

namespace hires::planning::left_recursion_test {
namespace {

/// A task that is done by doing itself for a place before, as in the competition's transport
/// domain.
constexpr char kRoads[] = R"((define (domain roads)
  (:types place)
  (:predicates (road ?a ?b - place) (at ?p - place))
  (:task get_to :parameters (?p - place))
  (:method there :parameters (?p - place) :task (get_to ?p)
    :precondition (at ?p) :ordered-subtasks ())
  (:method via :parameters (?a ?b - place) :task (get_to ?b)
    :precondition (road ?a ?b) :ordered-subtasks (and (get_to ?a) (drive ?a ?b)))
  (:action drive :parameters (?a ?b - place) :precondition (and (at ?a) (road ?a ?b))
    :effect (and (not (at ?a)) (at ?b))))
)";
constexpr char kFromOneToFour[] = R"((define (problem far) (:domain roads)
  (:objects p1 p2 p3 p4 - place)
  (:htn :ordered-subtasks (and (get_to p4)))
  (:init (at p1) (road p1 p2) (road p2 p1) (road p2 p3) (road p3 p2) (road p3 p4) (road p4 p3))))";

/// A task whose only good decomposition holds the task itself in front, in the same state.
constexpr char kRows[] = R"((define (domain rows)
  (:predicates (first) (second))
  (:task row :parameters ())
  (:method one :parameters () :task (row) :ordered-subtasks (and (a)))
  (:method longer :parameters () :task (row) :ordered-subtasks (and (row) (b)))
  (:action a :parameters () :precondition (not (first)) :effect (first))
  (:action b :parameters () :precondition (not (second)) :effect (second)))
)";
constexpr char kBoth[] = R"((define (problem both) (:domain rows)
  (:htn :ordered-subtasks (and (row))) (:init) (:goal (and (first) (second)))))";

struct Solved {
  PlanResult result;
  std::vector<std::string> violations;
};

Solved Solve(const char* domain_text, const char* problem_text, Which which = Which::kFirst) {
  const Domain domain = ReadHddlDomain(domain_text, "domain.hddl");
  const Problem problem = ReadHddlProblem(problem_text, "problem.hddl", domain);
  PlanRequest request;
  request.which = which;
  request.stop = [](const Progress& progress) {
    return progress.expansions > 100'000 ? Stop::kTime : Stop::kContinue;
  };
  Solved solved{FindPlans(domain, problem, request), {}};
  for (const Plan& plan : solved.result.plans) {
    for (std::string& violation : ValidatePlan(domain, problem, plan)) {
      solved.violations.push_back(std::move(violation));
    }
  }
  return solved;
}

TEST(LeftRecursionTest, EndsWhereTheTaskComesUpAgainBelowItself) {
  const Solved solved = Solve(kRoads, kFromOneToFour);
  ASSERT_EQ(solved.result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(ToShop2Plan(solved.result.plans[0]),
            "(!drive p1 p2)\n(!drive p2 p3)\n(!drive p3 p4)\n");
  EXPECT_THAT(solved.violations, testing::IsEmpty());
  EXPECT_LT(solved.result.progress.expansions, 1000u);
}

TEST(LeftRecursionTest, IsSearchedWhereNothingElseLeadsToAPlan) {
  const Solved solved = Solve(kRows, kBoth);
  ASSERT_EQ(solved.result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(ToShop2Plan(solved.result.plans[0]), "(!a)\n(!b)\n");
  EXPECT_THAT(solved.violations, testing::IsEmpty());
}

/// The same, with the method that comes back to its own task in front.
std::string DownFirst() {
  std::string text = kRoads;
  const std::size_t there = text.find("  (:method there"), via = text.find("  (:method via");
  const std::size_t drive = text.find("  (:action drive");
  return text.substr(0, there) + text.substr(via, drive - via) + text.substr(there, via - there) +
         text.substr(drive);
}

// A search that is not bounded goes down the left recursion and never comes back.
TEST(LeftRecursionTest, TheCheapestAndAllPlansHaveAtLeastWhatIsFoundWithoutIt) {
  const std::string domain = DownFirst();
  for (const Which which : {Which::kFirst, Which::kBest, Which::kAll}) {
    const Solved solved = Solve(domain.c_str(), kFromOneToFour, which);
    // All: with rounds for nothing, of which there is no end.
    ASSERT_EQ(solved.result.plans.size(), which == Which::kAll ? 1000u : 1u);
    EXPECT_EQ(ToShop2Plan(solved.result.plans[0]),
              "(!drive p1 p2)\n(!drive p2 p3)\n(!drive p3 p4)\n");
    EXPECT_THAT(solved.violations, testing::IsEmpty());
    EXPECT_FALSE(solved.result.exhausted) << "there may be others";
    EXPECT_EQ(solved.result.outcome,
              which == Which::kBest ? PlanOutcome::kLimitTime : PlanOutcome::kFound);
  }
}

/// Three beads on a string, written with the recursion first: it has to be gone down three times.
TEST(LeftRecursionTest, IsGoneDownAsFarAsItTakes) {
  const Solved solved = Solve(R"((define (domain beads)
      (:types bead) (:predicates (after ?a ?b - bead) (on ?b - bead)) (:task thread :parameters ())
      (:method more :parameters (?b - bead) :task (thread)
        :ordered-subtasks (and (thread) (add ?b)))
      (:method enough :parameters () :task (thread) :ordered-subtasks ())
      (:action add :parameters (?b - bead)
        :precondition (exists (?a - bead) (and (on ?a) (after ?a ?b))) :effect (on ?b))))",
                              R"((define (problem three) (:domain beads)
      (:objects a b c d - bead) (:htn :ordered-subtasks (and (thread)))
      (:init (on a) (after a b) (after b c) (after c d)) (:goal (and (on b) (on c) (on d)))))");
  ASSERT_EQ(solved.result.outcome, PlanOutcome::kFound);
  EXPECT_THAT(solved.violations, testing::IsEmpty());
  EXPECT_LT(solved.result.progress.expansions, 10'000u);
}

/// Back and forth until the door is open: the same task comes up below itself in a state that was.
TEST(LeftRecursionTest, ATaskBelowItselfInAStateThatWasIsLeftOutToo) {
  const Solved solved = Solve(R"((define (domain door)
      (:predicates (near) (open)) (:task enter :parameters ())
      (:method again :parameters () :task (enter) :ordered-subtasks (and (go) (leave) (enter)))
      (:method in :parameters () :task (enter) :ordered-subtasks (and (go) (push)))
      (:action go :parameters () :precondition (not (near)) :effect (near))
      (:action leave :parameters () :precondition (near) :effect (not (near)))
      (:action push :parameters () :precondition (near) :effect (open))))",
                              "(define (problem p) (:domain door) (:htn :ordered-subtasks (and "
                              "(enter))) (:init) (:goal (open)))");
  ASSERT_EQ(solved.result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(ToShop2Plan(solved.result.plans[0]), "(!go)\n(!push)\n");
  EXPECT_LT(solved.result.progress.expansions, 20u);
}

TEST(LeftRecursionTest, NoPlanIsFoundTwice) {
  // The shorter row is found without left recursion, and all by the whole search.
  const std::string bounded = std::string(kBoth).replace(std::string(kBoth).find("(:goal"),
                                                         std::string::npos, "(:goal (first)))");
  const Solved solved = Solve(kRows, bounded.c_str(), Which::kAll);
  std::vector<std::string> texts;
  for (const Plan& plan : solved.result.plans) texts.push_back(ToShop2Plan(plan));
  ASSERT_FALSE(texts.empty());
  EXPECT_EQ(texts[0], "(!a)\n");
  std::sort(texts.begin(), texts.end());
  EXPECT_EQ(std::adjacent_find(texts.begin(), texts.end()), texts.end());
}

}  // namespace
}  // namespace hires::planning::left_recursion_test
