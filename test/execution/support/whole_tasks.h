// What tests of whole tasks in a scripted world share. The expected plans are Listings 6.1 and 6.2
// of S. Rockel's dissertation (University of Hamburg, 2015) and the plan of the toppling scenario.
#pragma once

#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/base/text.h"
#include "support/scripted_world.h"

namespace hires::test_support {

using Texts = std::vector<std::string>;

/// "(!move_base a)" as "move_base(a)", without `!imagine`.
inline Texts Golden(const std::string& name) {
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

inline ScriptedWorld::Options For(const std::string& problem) {
  ScriptedWorld::Options options;
  options.facts = FactsOf(problem);
  return options;
}

inline std::string LogOf(const ScriptedWorld& world) { return base::Join(world.log(), "\n"); }

inline void ExpectSound(const ScriptedWorld& world) {
  EXPECT_THAT(world.violations(), ::testing::IsEmpty()) << LogOf(world);
}

inline void ExpectSuccess(ScriptedWorld* world, const std::string& problem) {
  const execution::Finish finish = world->Run(TaskOf(problem));
  EXPECT_EQ(finish.outcome, execution::Finish::Outcome::kSucceeded) << finish.reason << "\n"
                                                                    << LogOf(*world);
  ExpectSound(*world);
}

/// Placing at the south of the table is imagined to fail, elsewhere to succeed.
inline std::optional<execution::ImagineAnswered> SouthFails(
    const execution::StartImagination& request, int) {
  if (request.action.alternatives.back().front() == "placingareawestrighttable1") {
    execution::ImagineAnswered answer =
        AllFail(request, {base::FailureCode::kAreaOccupied, {"book1"}});
    answer.depends_on = {"book1"};
    return answer;
  }
  return Ranked({request.action.name, {"mug1", "rightarm1", "placingareawestlefttable1"}}, 12.0);
}

inline execution::ImagineAnswered Slow() {
  return Ranked({"move_base_param", {"premanipulationareanorthtable1", "slow"}}, 24.0);
}

/// The first `times` attempts of actions of that name fail.
inline auto Failing(const std::string& name, int times, const base::Failure& failure) {
  return [=](const base::ActionCall& action, int count) {
    StepScript script;
    if (action.name == name && count < times) {
      script.result = execution::StepFinished::Result::kFailed;
      script.failure = failure;
    }
    return script;
  };
}

}  // namespace hires::test_support
