// Steps that do not touch each other: only the order of subtasks keeps them apart.
#include <gmock/gmock.h>

#include "hires/execution/monitor.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/planning_files.h"
#include "support/temporary_folder.h"
#include "support/whole_tasks.h"

namespace hires::execution::monitor_order_test {
namespace {

using test_support::ExpectSound;
using test_support::LogOf;
using test_support::ScriptedWorld;
using test_support::StepScript;
using ::testing::ElementsAre;

constexpr const char* kShop2 = R"((defdomain house (
  (:operator (!switch_off_light) () () ((dark)))
  (:operator (!close_door) () () ((closed)))
  (:operator (!ring_bell) () () ((rung)))
  (:method (tidy) () ((!switch_off_light) (!close_door)))
  (:method (tidy_in_any_order) () (:unordered (!switch_off_light) (!close_door)))
  (:method (leave) () ((tidy) (!ring_bell))))))";

constexpr const char* kHddl = R"((define (domain house)
  (:requirements :hierarchy)
  (:predicates (dark) (closed) (rung))
  (:task tidy :parameters ())
  (:task tidy_in_any_order :parameters ())
  (:task leave :parameters ())
  (:method m-tidy :parameters () :task (tidy)
    :ordered-subtasks (and (switch_off_light) (close_door)))
  (:method m-any :parameters () :task (tidy_in_any_order)
    :subtasks (and (switch_off_light) (close_door)))
  (:method m-leave :parameters () :task (leave)
    :subtasks (and (t1 (tidy)) (t2 (ring_bell))) :ordering (< t1 t2))
  (:action switch_off_light :parameters () :precondition () :effect (dark))
  (:action close_door :parameters () :precondition () :effect (closed))
  (:action ring_bell :parameters () :precondition () :effect (rung))))";

constexpr const char* kSidecar = R"(
capacities: {hand: 3}
operators:
  switch_off_light: {duration: [0.0, .inf], resources: {hand: 1}}
  close_door: {duration: [0.0, .inf], resources: {hand: 1}}
  ring_bell: {duration: [0.0, .inf], resources: {hand: 1}}
legs: []
)";

/// A house in one of the languages, as its files say.
class House {
 public:
  House(const std::string& file, const std::string& text, const std::string& sidecar) {
    folder_.Write("house.yaml", sidecar);
    knowledge_.domain = planning::LoadDomain(folder_.Write(file, text));
    operators_ = planning::LoadOperatorData(folder_.path() / "house.yaml", knowledge_.domain);
  }

  ScriptedWorld::Options Options() const {
    ScriptedWorld::Options options;
    options.planning = &knowledge_;
    options.operators = &operators_;
    options.facts = {{"inside", {}}};
    return options;
  }

 private:
  const test_support::TemporaryFolder folder_;
  planning::PlanningKnowledge knowledge_;
  planning::OperatorData operators_;
};

void ExpectDone(ScriptedWorld* world, const std::string& task) {
  const Finish finish = world->Run(task);
  EXPECT_EQ(finish.outcome, Finish::Outcome::kSucceeded) << finish.reason << LogOf(*world);
  ExpectSound(*world);
}

/// Each step begins when the one before has ended: they last 5 s.
void ExpectInOrder(const House& house) {
  ScriptedWorld world(house.Options());
  ExpectDone(&world, "leave");
  EXPECT_THAT(world.Begun(), ElementsAre("switch_off_light()", "close_door()", "ring_bell()"));
  EXPECT_GE(world.StartOf("close_door()"), world.StartOf("switch_off_light()") + 5.0);
  EXPECT_GE(world.StartOf("ring_bell()"), world.StartOf("close_door()") + 5.0);
}

TEST(MonitorOrderTest, OrderedSubtasksOfShop2RunOneAfterTheOther) {
  ExpectInOrder(House("house.lisp", kShop2, kSidecar));
}

TEST(MonitorOrderTest, OrderedSubtasksOfHddlRunOneAfterTheOther) {
  ExpectInOrder(House("house.hddl", kHddl, kSidecar));
}

TEST(MonitorOrderTest, UnorderedSubtasksRunAtTheSameTime) {
  const House shop2("house.lisp", kShop2, kSidecar), hddl("house.hddl", kHddl, kSidecar);
  for (const House* house : {&shop2, &hddl}) {
    ScriptedWorld world(house->Options());
    ExpectDone(&world, "tidy_in_any_order");
    EXPECT_EQ(world.StartOf("close_door()"), world.StartOf("switch_off_light()"));
  }
}

TEST(MonitorOrderTest, ASidecarMayLeaveTheOrderToCausalLinks) {
  const House house("house.lisp", kShop2, std::string("subtask_order: causal_links") + kSidecar);
  ScriptedWorld world(house.Options());
  ExpectDone(&world, "leave");
  EXPECT_EQ(world.StartOf("close_door()"), world.StartOf("switch_off_light()"));
  EXPECT_EQ(world.StartOf("ring_bell()"), world.StartOf("switch_off_light()"));
}

TEST(MonitorOrderTest, TheOrderIsKeptWhenThePlanIsMended) {
  const House house("house.lisp", kShop2, kSidecar);
  auto options = house.Options();
  options.step = test_support::Failing("close_door", 1, base::FailureCode::kStuck);
  ScriptedWorld world(options);
  ExpectDone(&world, "leave");
  EXPECT_THAT(world.Begun(),
              ElementsAre("switch_off_light()", "close_door()", "close_door()", "ring_bell()"));
}

TEST(MonitorOrderTest, APlanOfStepsAloneRunsInItsOrder) {
  const House house("house.hddl", kHddl, kSidecar);
  auto options = house.Options();
  options.plans = ScriptedWorld::Options::PlanForm::kSteps;
  ScriptedWorld world(options);
  ExpectDone(&world, "leave");
  EXPECT_GE(world.StartOf("close_door()"), world.StartOf("switch_off_light()") + 5.0);
}

}  // namespace
}  // namespace hires::execution::monitor_order_test
