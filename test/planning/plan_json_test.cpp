#include "hires/planning/plan_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hires/planning/datum_reader.h"

namespace hires::planning::plan_json_test {
namespace {

using nlohmann::ordered_json;

Datum Term(const std::string& text) { return ReadData(text, "test").at(0); }

/// travel(!go (home 2)), with a negative precondition and a link to the start.
PlanResult Result() {
  PlanResult result;
  result.outcome = PlanOutcome::kFound;
  result.progress.expansions = 2;
  result.progress.inferences = 5;
  Plan plan;
  plan.cost = 2.5;
  plan.nodes.resize(3);
  plan.nodes[1].task = Term("(travel)");
  plan.nodes[1].parent = 0;
  plan.nodes[2].task = Term("(!go (home 2) 1.5)");
  plan.nodes[2].parent = 1;
  PlanStep step;
  step.task = Term("(!go (home 2) 1.5)");
  step.cost = 2.5;
  step.node = 2;
  step.preconditions = {{Term("(free ?x)"), false}};
  step.deletes = {Term("(at park)")};
  step.adds = {Term("(at home)")};
  step.links = {{CausalLink::kInitial, step.preconditions[0]}};
  plan.steps = {step};
  result.plans = {plan};
  return result;
}

constexpr char kWanted[] = R"json({
  "outcome": "found",
  "exhausted": false,
  "plans": [
    {
      "cost": 2.5,
      "steps": [
        {
          "operator": "!go",
          "arguments": [
            "(home 2)",
            "1.5"
          ],
          "cost": 2.5,
          "preconditions": [
            "(not (free ?x))"
          ],
          "deletes": [
            "(at park)"
          ],
          "adds": [
            "(at home)"
          ],
          "links": [
            {
              "producer": -1,
              "precondition": "(not (free ?x))"
            }
          ],
          "path": "travel"
        }
      ],
      "order": []
    }
  ],
  "statistics": {
    "expansions": 2,
    "inferences": 5,
    "cpu_seconds": 0.25,
    "peak_mb": 12.0
  }
})json";

TEST(PlanJsonTest, TheWholeAnswerInAFixedOrder) {
  EXPECT_EQ(ToJson(Result(), {0.25, 12.0}).dump(2), kWanted);
}

TEST(PlanJsonTest, WithoutPlansTheFieldsAreThere) {
  PlanResult result;
  result.exhausted = true;
  const ordered_json json = ToJson(result, {});
  EXPECT_EQ(json["outcome"], "no_plan");
  EXPECT_EQ(json["exhausted"], true);
  EXPECT_EQ(json["plans"], ordered_json::array());
  EXPECT_FALSE(json.contains("trace"));
}

TEST(PlanJsonTest, ATraceIsToldWhereThereIsOne) {
  PlanResult result;
  result.trace = {{3, "(travel island)", "method travel, line 9", "no fact matches"}};
  EXPECT_EQ(ToJson(result, {})["trace"].dump(),
            R"json([{"depth":3,"task":"(travel island)","where":"method travel, line 9",)json"
            R"json("reason":"no fact matches"}])json");
}

}  // namespace
}  // namespace hires::planning::plan_json_test
