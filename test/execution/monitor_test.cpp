#include "hires/execution/monitor.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "hires/base/text.h"
#include "support/scripted_world.h"

// Whole tasks in a scripted world. The expected plans are Listings 6.1 and 6.2 of S. Rockel's
// dissertation (University of Hamburg, 2015) and the plan of the toppling scenario.

namespace hires::execution {
namespace {

using test_support::AllFail;
using test_support::FactsOf;
using test_support::Ranked;
using test_support::ScriptedWorld;
using test_support::StepScript;
using test_support::TaskOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

using Texts = std::vector<std::string>;

/// "(!move_base a)" as "move_base(a)", without `!imagine`.
Texts Golden(const std::string& name) {
  const std::string path = std::string(HIRES_SOURCE_DIR) + "/test/data/planning/" + name + ".plan";
  Texts actions;
  for (std::string line : base::Split(base::ReadTextFile(path), '\n')) {
    if (line.empty() || line.rfind("(!imagine", 0) == 0) continue;
    line = line.substr(2, line.size() - 3);
    Texts words = base::Split(line, ' ');
    const std::string name_of = words.front();
    words.erase(words.begin());
    actions.push_back(name_of + "(" + base::Join(words, ", ") + ")");
  }
  return actions;
}

ScriptedWorld::Options For(const std::string& problem) {
  ScriptedWorld::Options options;
  options.facts = FactsOf(problem);
  return options;
}

std::string LogOf(const ScriptedWorld& world) { return base::Join(world.log(), "\n"); }

void ExpectSound(const ScriptedWorld& world) {
  EXPECT_THAT(world.violations(), IsEmpty()) << LogOf(world);
}

void ExpectSuccess(ScriptedWorld* world, const std::string& problem) {
  const Finish finish = world->Run(TaskOf(problem));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kSucceeded) << finish.reason << "\n" << LogOf(*world);
  ExpectSound(*world);
}

TEST(MonitorTest, ServingCoffeeIsCarriedOutAsInListing61) {
  ScriptedWorld world(For("serve_coffee"));
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("serve_coffee"))) << LogOf(world);
  EXPECT_TRUE(world.Holds({"on", {"mug1", "placingareawestrighttable1"}}));
  EXPECT_THAT(world.warnings(), IsEmpty());
}

}  // namespace
}  // namespace hires::execution
