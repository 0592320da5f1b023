#include "sim_robot/scenario.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/live_view.h"
#include "hires/knowledge/loading.h"
#include "hires/knowledge/state_view.h"
#include "hires/planning/planner_config.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/task_text.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/object_catalogue.h"
#include "sim_robot/scenario_names.h"
#include "support/temporary_folder.h"

namespace hires::sim_robot::scenario_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;

constexpr char kGood[] = R"(task: carry peppermill1
knowledge: [known.yaml, ../more.yaml]
robot: {pose: [1.0, 2.0, 3.0], torso: TorsoUpPosture, arms: {leftArm1: ArmTuckedPosture}}
objects:
  - {name: Mug1, pose: [0.1, 0.2, 0.3, 0.5]}
hidden:
  - {name: book1, model: book, pose: [1.0, 1.0, 0.7, 0.0]}
)";

/// A scenario file with `from` replaced by `to`.
class ScenarioTest : public ::testing::Test {
 protected:
  Scenario Read(const std::string& from = "", const std::string& to = "") {
    std::string text = kGood;
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return ReadScenario(folder_.Write("some_day.yaml", text));
  }

  std::string ErrorOf(const std::string& from, const std::string& to) {
    try {
      Read(from, to);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(ScenarioTest, ObjectsMayHaveATemperature) {
  Read("0.5]}", "0.5], temperature: 338.15}");
  const std::string path = (folder_.path() / "some_day.yaml").string();
  EXPECT_THAT(TemperaturesOf(path), ElementsAre(Pair("mug1", 338.15)));
  EXPECT_THAT(TemperaturesOf(""), IsEmpty());
  EXPECT_THAT(ErrorOf("0.5]}", "0.5], temperature: 65}"),
              AllOf(HasSubstr("temperature is '65'"), HasSubstr("between 200 and 600")));
}

TEST_F(ScenarioTest, ReadsEverythingInLowerCase) {
  const Scenario scenario = Read();
  EXPECT_EQ(scenario.name, "some_day");
  EXPECT_EQ(scenario.task, "carry peppermill1");
  EXPECT_THAT(scenario.knowledge,
              ElementsAre((folder_.path() / "known.yaml").string(),
                          (folder_.path().parent_path() / "more.yaml").string()));
  EXPECT_EQ(scenario.X_MB.yaw, 3.0);
  EXPECT_EQ(scenario.torso, "torsoupposture");
  EXPECT_EQ(scenario.arms.at("leftarm1"), "armtuckedposture");
  ASSERT_THAT(scenario.objects, SizeIs(2));
  EXPECT_EQ(scenario.objects[0].name, "mug1");
  EXPECT_EQ(scenario.objects[0].model, "");
  EXPECT_TRUE(scenario.objects[0].is_told);
  EXPECT_NEAR(geometry::YawOf(scenario.objects[0].X_MO.rotation), 0.5, 1e-12);
  EXPECT_EQ(scenario.objects[0].X_MO.translation.z(), 0.3);
  EXPECT_EQ(scenario.objects[1].model, "book");
  EXPECT_FALSE(scenario.objects[1].is_told);
}

TEST_F(ScenarioTest, ARobotWithoutTorsoAndArmsAndAWorldWithoutObjectsNeedNoWord) {
  const Scenario scenario = ReadScenario(
      folder_.Write("bare.yaml", "task: go\nknowledge: []\nrobot: {pose: [1, 2, 3]}\n"));
  EXPECT_EQ(scenario.torso, "");
  EXPECT_THAT(scenario.arms, IsEmpty());
  EXPECT_THAT(scenario.objects, IsEmpty());
}

TEST_F(ScenarioTest, AllMissingKeysAreToldAtOnce) {
  const std::string path = folder_.Write("bare.yaml", "robot: {torso: up}\n");
  try {
    ReadScenario(path);
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("task, knowledge, robot.pose are missing"));
  }
}

TEST_F(ScenarioTest, BadFilesAreErrorsThatNameTheKey) {
  EXPECT_THAT(ErrorOf("task: carry peppermill1", "task: ''"),
              AllOf(HasSubstr("some_day.yaml"), HasSubstr("wanted a task")));
  EXPECT_THAT(ErrorOf("[1.0, 2.0, 3.0]", "[1.0, 2.0]"), HasSubstr("robot.pose"));
  EXPECT_THAT(ErrorOf("[1.0, 2.0, 3.0]", "[1.0, 2.0, 90.0]"),
              AllOf(HasSubstr("robot.pose"), HasSubstr("yaw within 6.3 rad")));
  EXPECT_THAT(ErrorOf("torso: TorsoUpPosture", "torso: ''"),
              HasSubstr("robot.torso is '', wanted a name"));
  EXPECT_THAT(ErrorOf("[0.1, 0.2, 0.3, 0.5]", "[0.1, 0.2, 300.0, 0.5]"),
              AllOf(HasSubstr("objects[0].pose"), HasSubstr("z within 100 m")));
  EXPECT_THAT(ErrorOf("name: book1", "name: mug1"),
              AllOf(HasSubstr("hidden[0].name"), HasSubstr("every object once")));
  EXPECT_THAT(ErrorOf("name: book1", "nmae: book1"), HasSubstr("hidden[0].name"));
  EXPECT_THAT(ErrorOf("hidden:", "hidden_things:"), HasSubstr("hidden"));
  EXPECT_THAT(ErrorOf("knowledge: [known.yaml, ../more.yaml]", "knowledge: known.yaml"),
              HasSubstr("knowledge"));
}

/// What does not fit between a scenario with one object and a file of knowledge.
class ScenarioNamesTest : public ::testing::Test {
 protected:
  static std::string FluentText(const std::string& head, const std::string& property) {
    return "!Fluent\nClass_Instance: [" + head + "]\nStartTime: [0, 0]\nFinishTime: [0, 0]\n" +
           "Properties:\n  - [" + property + "]\n---\n";
  }
  std::vector<std::string> Misfits(const std::string& area, const std::string& object,
                                   const std::string& task) {
    folder_.Write("known.yaml", FluentText("Area, dock", "hasPose, Pose, poseDock") +
                                    FluentText("RobotAt, at1", "hasArea, Area, " + area) +
                                    FluentText("Mug, mug1", "hasPose, Pose, poseMug1") +
                                    FluentText("\"On\", onMug1", "hasPhysicalEntity, Mug, mug1"));
    const std::string path =
        folder_.Write("day.yaml",
                      "task: go\nknowledge: [known.yaml]\nrobot: {pose: [0, 0, 0]}\nobjects:\n"
                      "  - {name: " +
                          object + ", pose: [0, 0, 0, 0]}\n");
    return NamesThatDoNotFit(ReadScenario(path), path, task);
  }
  std::string In(const std::string& file) { return (folder_.path() / file).string() + ": "; }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(ScenarioNamesTest, NamesThatFitInAnyCaseAreNotSpokenOf) {
  EXPECT_THAT(Misfits("DOCK", "MUG1", "((bring Mug1 dock))"), IsEmpty());
}

TEST_F(ScenarioNamesTest, AnAreaThatTheKnowledgeDoesNotDefineIsNamedWithTheNearest) {
  EXPECT_THAT(Misfits("dokc", "mug1", "go"),
              ElementsAre(In("known.yaml") + "fluent 'at1' of RobotAt: area 'dokc' is unknown; did "
                                             "you mean 'dock'?"));
}

TEST_F(ScenarioNamesTest, AnObjectThatIsToldOfAndNotKnownIsNamedWithTheNearest) {
  EXPECT_THAT(Misfits("dock", "mugg1", "go"),
              ElementsAre(In("day.yaml") + "objects: in the knowledge files object 'mugg1' is "
                                           "unknown; did you mean 'mug1'? Or move it to `hidden`"));
}

TEST_F(ScenarioNamesTest, AKnownObjectThatTheScenarioLacksIsSaidWhereTheTaskIsAboutIt) {
  EXPECT_THAT(Misfits("dock", "mugg1", "((bring MUG1 dock))"),
              ::testing::Contains(In("day.yaml") +
                                  "task: the knowledge files say where it is, but among the "
                                  "scenario's objects object 'mug1' is unknown; did you mean "
                                  "'mugg1'?"));
}

/// Of the scenarios that come with the package.
class ShippedScenarioTest : public ::testing::TestWithParam<const char*> {
 protected:
  ShippedScenarioTest() : scenario_(ReadScenario(kRoot + "/config/scenarios/" + GetParam())) {}
  const Scenario scenario_;
};

TEST_P(ShippedScenarioTest, IsATaskOfTheRestaurantsDomain) {
  const auto knowledge =
      planning::LoadPlanningKnowledge(planning::ReadPlannerConfig(kRoot + "/config/planner.yaml"));
  planning::Problem problem;
  problem.source = GetParam();
  problem.tasks = planning::ReadTasks(scenario_.task, GetParam());
  EXPECT_NO_THROW(planning::CheckTasks(problem, knowledge.domain));
}

TEST_P(ShippedScenarioTest, NamesPosturesOfTheRobotAndObjectsOfTheCatalogue) {
  const robot::Robot robot = robot::LoadRobot(kRoot + "/config/robots/pr2.yaml");
  ASSERT_TRUE(robot.profile.upper_body.has_value());
  EXPECT_EQ(robot.profile.upper_body->torso_postures.count(scenario_.torso), 1u);
  for (const auto& [arm, posture] : scenario_.arms) {
    ASSERT_EQ(robot.profile.upper_body->arms.count(arm), 1u) << arm;
    EXPECT_EQ(robot.profile.upper_body->arms.at(arm).postures.count(posture), 1u) << posture;
  }
  const auto models = world::LoadObjectCatalogue(kRoot + "/worlds/objects.yaml");
  for (const ScenarioObject& object : scenario_.objects) {
    EXPECT_TRUE(!object.model.empty() || models.count(object.name) == 1) << object.name;
  }
}

/// What an empty Blackboard knows after the scenario's files.
TEST_P(ShippedScenarioTest, TheRobotKnowsOfWhatItIsToldAndNothingElse) {
  const auto config = knowledge::ReadBlackboardConfig(kRoot + "/config/blackboard.yaml");
  const auto ontology =
      std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromFiles(config.ontology));
  knowledge::Store store(":memory:", ontology);
  for (const std::string& path : scenario_.knowledge) {
    knowledge::Load(knowledge::LoadKnowledge(path), base::Rng(1),
                    {knowledge::Source::kKnowledge, 0, 0.0}, &store);
  }
  for (const ScenarioObject& object : scenario_.objects) {
    EXPECT_EQ(store.Find(object.name).has_value(), object.is_told) << object.name;
  }
  std::vector<std::string> wishes;
  for (const base::Atom& atom : knowledge::StateAtoms(knowledge::LiveView(store), *ontology)) {
    if (atom.predicate == "imagine") wishes.push_back(base::ToString(atom));
  }
  if (scenario_.name == "serve_coffee") {
    EXPECT_THAT(wishes, ElementsAre("imagine(place_object)"));
  } else if (scenario_.name == "coffee_spots") {
    EXPECT_THAT(wishes, ElementsAre("imagine(place_object_at)"));
  } else {
    EXPECT_THAT(wishes, IsEmpty());
  }
}

TEST_P(ShippedScenarioTest, ItsNamesFit) {
  const std::string path = kRoot + "/config/scenarios/" + GetParam();
  EXPECT_THAT(NamesThatDoNotFit(scenario_, path, scenario_.task), IsEmpty());
}

TEST_P(ShippedScenarioTest, ItsLaunchFileHasTheSameTaskAndKnowledge) {
  const std::string launch = base::ReadTextFile(kRoot + "/launch/" + scenario_.name + ".launch");
  EXPECT_THAT(launch, HasSubstr("default=\"" + scenario_.task + "\""));
  for (const std::string& path : scenario_.knowledge) {
    const std::string name = std::filesystem::path(path).filename().string();
    EXPECT_THAT(launch, HasSubstr("$(find hires)/config/knowledge/" + name));
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenarioTest,
                         ::testing::Values("topple.yaml", "serve_coffee.yaml", "hot_coffee.yaml",
                                           "coffee_spots.yaml"));

}  // namespace
}  // namespace hires::sim_robot::scenario_test
