#include "lab/src/series/scenario_variant.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/world/world.h"
#include "sim_robot/scenario.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::scenario_variant_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kRoot = HIRES_SOURCE_DIR;

std::string Move(const std::string& pose, const std::string& deltas,
                 const std::string& attachments = "[]") {
  return "!FluentPoseModification\nInstance: " + pose +
         "\nGroup: g\nChoices: 1\nModifications: " + deltas + "\nAttachments: " + attachments +
         "\n";
}

/// Where the parts of the restaurant are, as files say.
struct Places {
  world::World world;
  sim_robot::Scenario scenario;
  std::vector<knowledge::Fluent> fluents;

  explicit Places(const VariantFiles& files)
      : world(world::LoadWorld(files.world)), scenario(sim_robot::ReadScenario(files.scenario)) {
    for (const std::string& path : scenario.knowledge) {
      const auto file = knowledge::LoadKnowledge(path);
      fluents.insert(fluents.end(), file.fluents.begin(), file.fluents.end());
    }
  }

  geometry::Pose3 Known(const std::string& pose) const {
    for (const auto& fluent : fluents) {
      if (fluent.instance != pose) continue;
      double n[4];
      for (std::size_t i = 0; i < 4; ++i) n[i] = std::get<double>(fluent.properties[i].filler);
      return geometry::Lift({n[0], n[1], n[3]}, n[2]);
    }
    throw std::runtime_error("no " + pose);
  }
  geometry::Pose3 Body(const std::string& name) const {
    const auto found = std::find_if(world.statics.begin(), world.statics.end(),
                                    [&](const auto& body) { return body.name == name; });
    if (found == world.statics.end()) throw std::runtime_error("no " + name);
    return found->X_MB;
  }
  geometry::Pose3 Object(const std::string& name) const {
    for (const sim_robot::ScenarioObject& object : scenario.objects) {
      if (object.name == name) return object.X_MO;
    }
    throw std::runtime_error("no " + name);
  }
};

class ScenarioVariantTest : public ::testing::Test {
 protected:
  VariantFiles Write(const std::string& series, const std::string& scenario = "serve_coffee",
                     const std::string& world = kRoot + "/worlds/restaurant.world") {
    const ScenarioSeries read = ReadScenarioSeries(folder_.Write("some.yaml", series));
    const std::vector<int> choices(read.groups.size(), 0);
    return WriteVariant(read, choices,
                        {sim_robot::ScenarioPath(scenario, kRoot + "/config/scenarios"), "", world,
                         folder_.path().string()});
  }
  std::string ErrorOf(const std::string& series, const std::string& scenario = "serve_coffee",
                      const std::string& world = kRoot + "/worlds/restaurant.world") {
    return ConfigErrorOf([&] { Write(series, scenario, world); });
  }

  test_support::TemporaryFolder folder_;
};

/// What a quarter turn to the right about table 1, and then a shift, makes of a point.
Eigen::Vector3d Turned(const Eigen::Vector3d& p) {
  const double dx = p.x() - 7.73, dy = p.y() - 11.49;
  return {7.73 + dy + 0.5, 11.49 - dx - 0.25, p.z()};
}

void ExpectTurned(const geometry::Pose3& before, const geometry::Pose3& after,
                  const std::string& what) {
  EXPECT_LT((after.translation - Turned(before.translation)).norm(), 1e-9) << what;
  const auto turn = geometry::RotationFromRpy(0.0, 0.0, -M_PI_2);
  EXPECT_LT(after.rotation.angularDistance(turn * before.rotation), 1e-7) << what;
}

TEST_F(ScenarioVariantTest, TheWorldAndWhatIsKnownOfItAreMovedAlike) {
  const Places before(Write(Move("poseTable1", "[]")));
  const Places after(
      Write(Move("poseTable1", "[[hasX, [0.5]], [hasY, [-0.25]], [hasYaw, [-1.5707963267948966]]]",
                 "[poseChair1]")));
  ExpectTurned(before.Body("table1"), after.Body("table1"), "table1");
  ExpectTurned(before.Body("chair1"), after.Body("chair1"), "chair1");
  for (const std::string pose :
       {"poseTable1", "poseChair1", "posePlacingAreaWestRightTable1",
        "poseBoundingBoxPlacingAreaWestRightTable1", "poseManipulationAreaSouthTable1",
        "posePreManipulationAreaNorthTable1", "poseSittingAreaEastTable1"}) {
    ExpectTurned(before.Known(pose), after.Known(pose), pose);
  }
  for (const std::string area : {"placingareawestrighttable1", "manipulationareasouthtable1",
                                 "premanipulationareanorthtable1", "sittingareaeasttable1"}) {
    ExpectTurned(before.world.frames.at(area), after.world.frames.at(area), area);
  }
  ExpectTurned(before.Object("bowl1"), after.Object("bowl1"), "hidden, on the table");
}

TEST_F(ScenarioVariantTest, WhatIsNotAttachedStaysToTheLastBit) {
  const Places before(Write(Move("poseTable1", "[]")));
  const Places after(Write(Move("poseTable1", "[[hasX, [0.5]]]", "[poseChair1]")));
  for (const std::string body : {"chair2", "counter1", "table2", "walls"}) {
    EXPECT_EQ(before.Body(body).translation, after.Body(body).translation) << body;
  }
  EXPECT_EQ(before.Known("poseChair2").translation, after.Known("poseChair2").translation);
  EXPECT_EQ(before.Object("mug1").translation, after.Object("mug1").translation);
  EXPECT_EQ(before.scenario.X_MB.x, after.scenario.X_MB.x);
  EXPECT_EQ(before.world.extents.size(), after.world.extents.size());
}

TEST_F(ScenarioVariantTest, NothingMovedIsTheSameWorld) {
  const VariantFiles files = Write(Move("poseTable1", "[]"));
  EXPECT_EQ(world::LoadWorld(files.world).hash,
            world::LoadWorld(kRoot + "/worlds/restaurant.world").hash);
  const sim_robot::Scenario original =
      sim_robot::ReadScenario(kRoot + "/config/scenarios/serve_coffee.yaml");
  const sim_robot::Scenario written = sim_robot::ReadScenario(files.scenario);
  EXPECT_EQ(written.task, original.task);
  EXPECT_EQ(written.arms, original.arms);
  EXPECT_EQ(written.torso, original.torso);
  ASSERT_EQ(written.objects.size(), original.objects.size());
  for (std::size_t i = 0; i < original.objects.size(); ++i) {
    EXPECT_EQ(written.objects[i].name, original.objects[i].name);
    EXPECT_EQ(written.objects[i].is_told, original.objects[i].is_told);
    EXPECT_EQ(written.objects[i].X_MO.translation, original.objects[i].X_MO.translation);
  }
}

TEST_F(ScenarioVariantTest, TheCounterTakesItsMugsAlongOnceThoughTheFileAttachesThemToo) {
  const Places before(Write(Move("poseTable1", "[]")));
  const Places after(Write(Move("poseCounter1", "[[hasX, [-1]], [hasY, [2]]]", "[poseMug1]")));
  const Eigen::Vector3d shift(-1.0, 2.0, 0.0);
  for (const std::string mug : {"mug1", "mug2"}) {
    EXPECT_LT((after.Object(mug).translation - before.Object(mug).translation - shift).norm(), 1e-9)
        << mug;
  }
  EXPECT_LT(
      (after.Known("poseMug1").translation - before.Known("poseMug1").translation - shift).norm(),
      1e-9);
  EXPECT_LT((after.Known("posePeppermill1").translation -
             before.Known("posePeppermill1").translation - shift)
                .norm(),
            1e-9)
      << "known on the counter, though it is not in this scenario";
}

TEST_F(ScenarioVariantTest, TheRobotStartsElsewhere) {
  const Places after(Write(Move("posePR21", "[[hasX, [-1]], [hasY, [1]], [hasYaw, [-2]]]")));
  EXPECT_NEAR(after.scenario.X_MB.x, 11.5, 1e-12);
  EXPECT_NEAR(after.scenario.X_MB.y, 10.8, 1e-12);
  EXPECT_NEAR(after.scenario.X_MB.yaw, 0.0, 1e-12);
  EXPECT_NEAR(after.Known("posePR21").translation.x(), 11.5, 1e-12);
}

TEST_F(ScenarioVariantTest, WhatOnlyOneOfBothHasIsAnError) {
  EXPECT_THAT(ErrorOf(Move("poseBowl1", "[]")),
              AllOf(HasSubstr("document 1, line 1, Instance: 'poseBowl1'"),
                    HasSubstr("bowl1 is in the world alone")));
  EXPECT_THAT(ErrorOf(Move("posePeppermill1", "[]")),
              AllOf(HasSubstr("'posePeppermill1' is in the knowledge alone"),
                    HasSubstr("peppermill1 is neither a model or frame of"),
                    HasSubstr("serve_coffee.yaml")));
  EXPECT_THAT(ErrorOf(Move("poseTable1", "[]", "[poseSofa1]")),
              AllOf(HasSubstr("line 1, Attachments: 'poseSofa1'"), HasSubstr("no world either")));
  EXPECT_THAT(ErrorOf(Move("poseTable1", "[]"), "serve_coffee", kRoot + "/worlds/corridor.world"),
              AllOf(HasSubstr("knowledge alone"), HasSubstr("corridor.world")));
}

TEST_F(ScenarioVariantTest, AWorldThatStandsElsewhereThanKnownIsAnError) {
  std::string text = base::ReadTextFile(kRoot + "/worlds/restaurant.world");
  const std::string pose = "<pose>7.73 11.49 0 0 0 1.57</pose>";
  text.replace(text.find(pose), pose.size(), "<pose>7.83 11.49 0 0 0 1.57</pose>");
  EXPECT_THAT(ErrorOf(Move("poseTable1", "[[hasX, [1]]]"), "serve_coffee",
                      folder_.Write("other/restaurant.world", text)),
              AllOf(HasSubstr("table1 stands 0.100 m"), HasSubstr("posetable1")));
}

TEST_F(ScenarioVariantTest, APoseInAnotherFrameIsNotMovedTwice) {
  std::string text = base::ReadTextFile(kRoot + "/worlds/restaurant.world");
  const std::string frame = "name=\"sittingAreaWestTable1\" attached_to=\"world\"";
  text.replace(text.find(frame), frame.size(),
               "name=\"sittingAreaWestTable1\" attached_to=\"table1\"");
  EXPECT_THAT(ErrorOf(Move("poseTable1", "[[hasX, [1]]]"), "serve_coffee",
                      folder_.Write("other/restaurant.world", text)),
              AllOf(HasSubstr("restaurant.world:"), HasSubstr("'sittingAreaWestTable1'"),
                    HasSubstr("attach it to the world")));
}

TEST_F(ScenarioVariantTest, FurnitureBelowTheFloorIsAnErrorThatNamesZOrigin) {
  EXPECT_THAT(ErrorOf(Move("poseTable1", "[[hasZ, [-0.375]]]")),
              AllOf(HasSubstr("table1 at z -0.375 m"), HasSubstr("ZOrigin: -0.375")));
}

TEST_F(ScenarioVariantTest, AMapHasOnlyRobotAndObjectsToMove) {
  const std::string map = folder_.Write("map.yaml", "image: none.pgm\n");
  const VariantFiles files = Write(Move("posePR21", "[[hasX, [1]]]"), "serve_coffee", map);
  EXPECT_EQ(files.world, map);
  EXPECT_NEAR(sim_robot::ReadScenario(files.scenario).X_MB.x, 13.5, 1e-12);
}

}  // namespace
}  // namespace hires::lab::scenario_variant_test
