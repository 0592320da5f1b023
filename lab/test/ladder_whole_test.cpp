#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "lab/src/ladder/ladder.h"

namespace hires::lab::ladder_whole_test {
namespace {

using testing::ElementsAre;

TEST(LadderWholeTest, WholeLadderHasItsFixedOrder) {
  double now = 0.0;
  LadderOrder order;
  order.package_folder = HIRES_SOURCE_DIR;
  order.seconds = 0.1;
  order.repeats = 2;
  order.answer_rollouts = 1;
  order.clocks = {[&] { return now += 1.0; }, [&] { return now; }};
  order.play_task = [](std::uint64_t) { return 4.0; };
  base::Crew crew;
  crew.threads = 2;
  const auto report = ClimbLadder(order, crew);
  ASSERT_TRUE(report);
  const nlohmann::ordered_json json = ToJson(*report);
  EXPECT_EQ(json["schema"], "hires/ladder");
  EXPECT_EQ(json["cores"], 2);
  std::vector<std::string> rungs, own;
  for (const auto& rung : json["rungs"]) rungs.push_back(rung["id"]);
  for (const auto& step : json["own"]) own.push_back(step["id"]);
  EXPECT_THAT(rungs, ElementsAre("chairs_static", "no_display", "primitive_objects",
                                 "fewer_particles", "fewer_particles_with_layer", "primitive_walls",
                                 "own_map", "no_navigation", "bare_robot"));
  EXPECT_THAT(own, ElementsAre("ode_step", "idle_tray", "idle_planar", "drive_layer",
                               "drive_fitted", "drive_filter", "pick", "place", "drive",
                               "drive_all_cores", "parallel_efficiency", "ranked_answer", "task"));
  const auto& system = json["rungs"][8];
  EXPECT_EQ(system["before"]["values"].size(), 2u);
  EXPECT_EQ(system["before"]["mean"], 4.0) << "4 s simulated while the clock went on by one";
  EXPECT_TRUE(json["rungs"][0]["all_cores"].is_object());
  EXPECT_TRUE(system["all_cores"].is_null());
}

}  // namespace
}  // namespace hires::lab::ladder_whole_test
