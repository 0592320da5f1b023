#include "hires/imagination/imagination_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>
#include <utility>

#include "hires/simulation/pose_error.h"
#include "imagination/physics_hash.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::imagination::imagination_setup_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string& Root() {
  static const std::string root = HIRES_SOURCE_DIR;
  return root;
}

/// A hall with two areas and a table.
std::string HallSdf(double table_x = 3.0) {
  return R"(<?xml version="1.0"?>
<sdf version="1.7"><world name="hall">
  <gravity>0 0 -9.81</gravity>
  <frame name="Door" attached_to="world"><pose>0 0 0 0 0 0.5</pose></frame>
  <frame name="Window" attached_to="world"><pose>2 1 0 0 0 0</pose></frame>
  <frame name="TableTop" attached_to="world"><pose>)" +
         std::to_string(table_x) + R"( 0 0.7 0 0 0</pose></frame>
  <model name="table"><static>true</static><pose>)" +
         std::to_string(table_x) + R"( 0 0.35 0 0 0</pose>
    <link name="link"><collision name="slab">
      <geometry><box><size>0.8 0.8 0.7</size></box></geometry>
    </collision></link>
  </model>
</world></sdf>)";
}

/// The configured scene with absolute paths, its world replaced by the hall and its robot by the
/// cart, so that it loads quickly; ready to be spoilt.
struct SceneFile {
  SceneFile() : root(YAML::LoadFile(Root() + "/config/scene.yaml")) {
    root["world"] = folder.Write("hall.world", HallSdf());
    root["robot"] = Root() + "/config/robots/cart.yaml";
    root["objects"] = folder.Write("objects.yaml", "mill1: mill\nMill2: mill\n");
    root["uncertainty"] = "none";
    root["detector"] = "none";
    root["obstacle_layer"] = Root() + "/config/obstacle_layer.yaml";
    folder.Write("models/mill/model.config",
                 "<?xml version=\"1.0\"?><model><name>mill</name><sdf version=\"1.7\">model.sdf"
                 "</sdf></model>");
    folder.Write("models/mill/model.sdf", MillSdf("mill", 0.14));
  }

  static std::string MillSdf(const std::string& name, double mass) {
    return "<?xml version=\"1.0\"?><sdf version=\"1.7\"><model name=\"" + name +
           "\"><link name=\"body\"><pose>0 0 0.137 0 0 0</pose><inertial><mass>" +
           std::to_string(mass) +
           "</mass><inertia><ixx>0.000924</ixx><iyy>0.000924</iyy><izz>0.0000958</izz></inertia>"
           "</inertial><collision name=\"body\"><geometry><cylinder><radius>0.037</radius>"
           "<length>0.274</length></cylinder></geometry></collision></link></model></sdf>";
  }

  SetupConfig Read(const std::string& comment = "") const {
    return ReadSetupConfig(folder.Write("scene.yaml", comment + YAML::Dump(root)));
  }
  ImaginationSetup Load() const { return LoadImaginationSetup(Read()); }
  std::string WhyRefused() const {
    return ConfigErrorOf([&] { Load(); });
  }

  TemporaryFolder folder;
  YAML::Node root;
};

/// Calls visit(path, node) for every number, truth value or text below these sections.
void ForEveryParameter(const YAML::Node& root,
                       const std::function<void(const std::string&, YAML::Node)>& visit) {
  const std::function<void(const std::string&, YAML::Node)> descend = [&](const std::string& path,
                                                                          YAML::Node node) {
    if (path == "sensing.ground.eye") return;  // a name: any will do
    if (!node.IsMap()) return visit(path, node);
    for (auto entry : node) descend(path + "." + entry.first.Scalar(), entry.second);
  };
  for (const char* section :
       {"driving", "blind_driving", "sensing", "physics", "rollout", "standing"}) {
    descend(section, root[section]);
  }
}

// ------------------------------------------------------------------------------- scene files

TEST(SetupConfigTest, PathsCountFromTheFilesFolder) {
  SceneFile file;
  file.root["world"] = "worlds/my.world";
  file.root["uncertainty"] = "../u.yaml";
  const SetupConfig config = file.Read();
  EXPECT_EQ(config.world, (file.folder.path() / "worlds/my.world").string());
  EXPECT_EQ(config.uncertainty, (file.folder.path().parent_path() / "u.yaml").string());
  EXPECT_EQ(config.robot, Root() + "/config/robots/cart.yaml");
  EXPECT_EQ(SceneFile().Read().uncertainty, "none");
}

TEST(SetupConfigTest, EveryParameterIsReadAndNamedWhenItIsBad) {
  int count = 0;
  SceneFile file;
  ForEveryParameter(file.root, [&](const std::string& path, YAML::Node node) {
    const std::string before = node.Scalar();
    node = "nonsense";
    EXPECT_THAT(
        ConfigErrorOf([&] { file.Read(); }),
        AllOf(HasSubstr("scene.yaml"), HasSubstr(path + " is 'nonsense'"), HasSubstr("line ")));
    node = before;
    ++count;
  });
  EXPECT_GT(count, 40);
  EXPECT_NO_THROW(file.Read());
}

TEST(SetupConfigTest, NumbersMustMakeSense) {
  ForEveryParameter(SceneFile().root, [&](const std::string& path, const YAML::Node& original) {
    if (original.Scalar() == "true" || original.Scalar() == "false") return;
    SceneFile file;
    ForEveryParameter(file.root, [&](const std::string& other, YAML::Node node) {
      if (other == path) node = "-1.5";
    });
    EXPECT_THAT(ConfigErrorOf([&] { file.Read(); }), HasSubstr(path + " is '-1.5'"));
    ForEveryParameter(file.root, [&](const std::string& other, YAML::Node node) {
      if (other == path) node = ".nan";
    });
    EXPECT_THAT(ConfigErrorOf([&] { file.Read(); }), HasSubstr(path + " is '.nan'"));
  });
}

TEST(SetupConfigTest, EverySectionIsNeeded) {
  for (const char* key : {"world", "robot", "objects", "uncertainty", "obstacle_layer", "driving",
                          "blind_driving", "physics", "rollout"}) {
    SceneFile file;
    file.root.remove(key);
    EXPECT_THAT(file.WhyRefused(),
                AllOf(HasSubstr("scene.yaml"), HasSubstr(std::string(key) + " is missing")));
  }
  SceneFile file;
  file.root["driving"]["costmap"].remove("inflation_radius");
  EXPECT_THAT(file.WhyRefused(), HasSubstr("driving.costmap.inflation_radius is missing"));
}

TEST(SetupConfigTest, AnObstacleLayerIsReadFromItsFileAndMatters) {
  const std::string path = Root() + "/config/obstacle_layer.yaml";
  SceneFile file;
  file.root["obstacle_layer"] = "none";
  EXPECT_FALSE(file.Read().driving.obstacle_layer);
  const std::uint64_t without = file.Read().layer_hash;
  file.root["obstacle_layer"] = path;
  EXPECT_EQ(file.Read().driving.obstacle_layer->raytrace_range, 3.0);
  EXPECT_EQ(file.Read().scans->laser.num_beams, 120);
  EXPECT_NE(file.Read().layer_hash, without);
  const std::uint64_t with_layer = file.Load().world_hash;
  file.root["obstacle_layer"] = "none";
  EXPECT_NE(file.Load().world_hash, with_layer);

  YAML::Node layer = YAML::LoadFile(path);
  const auto why_refused = [&] {
    file.root["obstacle_layer"] = file.folder.Write("layer.yaml", YAML::Dump(layer));
    return ConfigErrorOf([&] { file.Read(); });
  };
  layer["keep"] = -1;
  EXPECT_THAT(why_refused(), AllOf(HasSubstr("layer.yaml"), HasSubstr("keep is '-1'")));
  layer["keep"] = 10;
  layer["laser"]["period"] = 0;
  EXPECT_THAT(why_refused(), HasSubstr("laser.period is '0'"));
  layer["laser"].remove("period");
  EXPECT_THAT(why_refused(), HasSubstr("laser.period is missing"));
  layer["laser"]["period"] = 0.4;
  layer["decay"] = 1;
  EXPECT_THAT(why_refused(), HasSubstr("key 'decay' is unknown"));
}

TEST(SetupConfigTest, ASeenPlaceIsReadFromTheLayersFileAndMatters) {
  const std::string path = Root() + "/config/obstacle_layer.yaml";
  SceneFile file;
  const std::uint64_t with = file.Read().layer_hash;
  const skills::SeenPlaceParams read = file.Read().driving.seen_place.value(), defaults;
  EXPECT_EQ(read.match.gate, defaults.match.gate);
  EXPECT_EQ(read.match.least_view, defaults.match.least_view);
  EXPECT_EQ(read.told_yaw_sd, defaults.told_yaw_sd);
  EXPECT_EQ(read.drift, defaults.drift);

  YAML::Node layer = YAML::LoadFile(path);
  const auto write = [&] {
    file.root["obstacle_layer"] = file.folder.Write("layer.yaml", YAML::Dump(layer));
  };
  layer["seen_place"]["gate"] = 0;
  write();
  EXPECT_THAT(ConfigErrorOf([&] { file.Read(); }), HasSubstr("seen_place.gate is '0'"));
  layer["seen_place"].remove("gate");
  write();
  EXPECT_THAT(ConfigErrorOf([&] { file.Read(); }), HasSubstr("seen_place.gate is missing"));
  layer.remove("seen_place");
  write();
  EXPECT_FALSE(file.Read().driving.seen_place);
  EXPECT_NE(file.Read().layer_hash, with);
}

TEST(SetupConfigTest, WhatTellsTheRobotItsPlaceIsReadAndMatters) {
  SceneFile file;
  const ImaginationSetup drawn = file.Load();
  EXPECT_FALSE(drawn.scene->self_localisation);
  EXPECT_FALSE(drawn.scene->pose_error);
  const std::string shipped = Root() + "/config/self_localisation.yaml";
  file.root["self_localisation"] = shipped;
  const std::uint64_t without = file.Load().world_hash;
  file.root["localisation"] = "filter";
  const ImaginationSetup filter = file.Load();
  EXPECT_TRUE(filter.scene->self_localisation);
  EXPECT_NE(filter.world_hash, without);

  const std::string hash =
      simulation::PlaceHash(shipped, filter.scene->world, *filter.scene->laser_height);
  file.root["localisation"] = "fitted";
  const auto write = [&](const std::string& of) {
    file.root["localisation_error"] = file.folder.Write("error.yaml", simulation::ToYaml({{}, of}));
  };
  write(hash);
  const ImaginationSetup fitted = file.Load();
  EXPECT_TRUE(fitted.scene->pose_error);
  EXPECT_FALSE(fitted.scene->self_localisation);
  EXPECT_NE(fitted.world_hash, filter.world_hash);
  write("0123456789abcdef");
  EXPECT_THAT(file.WhyRefused(),
              AllOf(HasSubstr("error.yaml: fitted_to is 0123456789abcdef, wanted " + hash),
                    HasSubstr("hires_lab experiment localisation")));
  file.root["localisation"] = "amcl";
  EXPECT_THAT(file.WhyRefused(), HasSubstr("localisation is 'amcl'"));
}

TEST(SetupConfigTest, ARobotWithoutALaserIsToldItsPlaceAndDrivesByTheMap) {
  SceneFile file;
  EXPECT_TRUE(file.Load().skills->driving->by_plane);
  YAML::Node robot = YAML::LoadFile(Root() + "/config/robots/cart.yaml");
  robot["urdf"] = Root() + "/urdf/cart.urdf";
  robot["laser_link"] = "";
  file.root["robot"] = file.folder.Write("blind.yaml", YAML::Dump(robot));
  const ImaginationSetup blind = file.Load();
  EXPECT_FALSE(blind.skills->driving->by_plane);
  EXPECT_FALSE(blind.skills->driving->seen_place);
  EXPECT_FALSE(blind.scene->sight.scans);
  file.root["obstacle_layer"] = "none";
  EXPECT_EQ(file.Load().world_hash, blind.world_hash);
  file.root["localisation"] = "filter";
  EXPECT_THAT(file.WhyRefused(), AllOf(HasSubstr("laser_link"), HasSubstr("drawn")));
}

/// With or without a laser: what the drawn place may err is kept where nothing seen corrects it.
TEST(SetupConfigTest, WhoDrivesByTheMapAloneKeepsWhatItsPlaceMayErr) {
  SceneFile file;
  file.root["uncertainty"] = file.folder.Write(
      "place.yaml",
      "localisation_x: {distribution: normal, mean: 0.0, sd: 0.03, unit: m, source: here}\n");
  EXPECT_TRUE(file.Load().skills->driving->with_margin.empty());
  file.root["obstacle_layer"] = "none";
  const ImaginationSetup by_map = file.Load();
  ASSERT_FALSE(by_map.skills->driving->with_margin.empty());
  EXPECT_NEAR(by_map.skills->driving->with_margin.front().margin, 2.5 * 0.03, 1e-9);
  file.root["uncertainty"] = "none";
  EXPECT_TRUE(file.Load().skills->driving->with_margin.empty());
}

TEST(SetupConfigTest, RefusesTypos) {
  SceneFile file;
  file.root["rollout"]["setling_time"] = 0.5;
  EXPECT_THAT(file.WhyRefused(), AllOf(HasSubstr("key 'rollout.setling_time' is unknown"),
                                       HasSubstr("did you mean 'rollout.settling_time'")));
  SceneFile section;
  section.root["drivign"] = 1;
  EXPECT_THAT(section.WhyRefused(), HasSubstr("key 'drivign' is unknown"));
}

TEST(SetupConfigTest, RefusesWhatIsNoMap) {
  SceneFile file;
  file.root["physics"] = 7;
  EXPECT_THAT(file.WhyRefused(), AllOf(HasSubstr("physics is '7'"), HasSubstr("a map")));
  EXPECT_THAT(ConfigErrorOf([&] { ReadSetupConfig(file.folder.Write("list.yaml", "[1, 2]")); }),
              AllOf(HasSubstr("list.yaml"), HasSubstr("a map")));
  EXPECT_THAT(ConfigErrorOf([&] { ReadSetupConfig(file.folder.Write("no.yaml", "world: [")); }),
              HasSubstr("no.yaml: no valid YAML"));
  EXPECT_THAT(ConfigErrorOf([&] { ReadSetupConfig(file.folder.Write("empty.yaml", "")); }),
              HasSubstr("world is missing"));
  EXPECT_THAT(ConfigErrorOf([] { ReadSetupConfig("/nowhere/scene.yaml"); }),
              HasSubstr("/nowhere/scene.yaml: no such file"));
}

TEST(SetupConfigTest, NamesFilesThatAreMissing) {
  for (const char* key :
       {"world", "robot", "objects", "uncertainty", "detector", "recogniser", "obstacle_layer"}) {
    SceneFile file;
    file.root[key] = std::string("missing_") + key + ".yaml";
    EXPECT_THAT(file.WhyRefused(), HasSubstr(std::string("missing_") + key)) << key;
  }
}

TEST(SetupConfigTest, OverridesReplaceWhatIsGiven) {
  SetupConfig config;
  config.world = "a";
  config.robot = "b";
  config.objects = "c";
  config.uncertainty = "d";
  OverridePaths("w", std::nullopt, "", "none", &config);
  EXPECT_EQ(config.world, "w");
  EXPECT_EQ(config.robot, "b");
  EXPECT_EQ(config.objects, "c");
  EXPECT_EQ(config.uncertainty, "none");
}

TEST(SetupConfigTest, ResolvesPaths) {
  EXPECT_EQ(ResolvePath("../worlds/a.world", "/pkg/config/scene.yaml"), "/pkg/worlds/a.world");
  EXPECT_EQ(ResolvePath("/abs/a.world", "/pkg/config/scene.yaml"), "/abs/a.world");
  EXPECT_EQ(ResolvePath("none", "/pkg/config/scene.yaml"), "none");
  EXPECT_EQ(ResolvePath("a.world", "scene.yaml"), "a.world");
}

TEST(SetupConfigTest, AFallMustShowBeforeARolloutEnds) {
  SceneFile file;
  file.root["rollout"]["aftermath"] = 0.5;
  file.root["standing"]["hold_time"] = 0.5;
  EXPECT_NO_THROW(file.Read());
  file.root["standing"]["hold_time"] = 0.6;
  EXPECT_THAT(ConfigErrorOf([&] { file.Read(); }),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("standing.hold_time"),
                    HasSubstr("rollout.aftermath, 0.5 s")));
}

TEST(SetupConfigTest, WhatAFallIsReachesAllWhoJudge) {
  SceneFile file;
  file.root["standing"]["tilt"] = 0.4;
  const ImaginationSetup setup = file.Load();
  EXPECT_EQ(setup.standing.tilt, 0.4);
  EXPECT_EQ(setup.translator.standing.tilt, 0.4);
  EXPECT_EQ(MakeRolloutSetup(setup, {}, 1).standing.tilt, 0.4);
}

// ------------------------------------------------------------------------------------ hashes

/// Of skills, and of physics with what judges rollouts.
std::pair<std::uint64_t, std::uint64_t> HashesOf(const SetupConfig& config) {
  return {config.params_hash, PhysicsHash(config.physics, config.rollout, config.standing)};
}

TEST(SetupHashTest, EveryParameterMattersCommentsDoNot) {
  const auto hashes = HashesOf(SceneFile().Read());
  EXPECT_EQ(HashesOf(SceneFile().Read("# a remark\n")), hashes);
  ForEveryParameter(SceneFile().root, [&](const std::string& path, const YAML::Node& original) {
    SceneFile file;
    ForEveryParameter(file.root, [&](const std::string& other, YAML::Node node) {
      if (other != path) return;
      const std::string before = original.Scalar();
      if (before == "true" || before == "false") {
        node = before == "true" ? "false" : "true";
      } else if (before.find_first_of(".e") == std::string::npos) {
        node = std::to_string(std::stoi(before) + 1);
      } else {
        node = std::to_string(0.99 * std::stod(before) + 1e-6);
      }
    });
    EXPECT_NE(HashesOf(file.Read()), hashes) << path;
  });
}

TEST(SetupHashTest, TheConfiguredFilesCommentsDoNotMatter) {
  const std::string path = Root() + "/config/scene.yaml";
  const TemporaryFolder folder;
  YAML::Node root = YAML::LoadFile(path);
  root["obstacle_layer"] = Root() + "/config/obstacle_layer.yaml";
  const std::string bare = folder.Write("scene.yaml", YAML::Dump(root));
  EXPECT_EQ(ReadSetupConfig(bare).params_hash, ReadSetupConfig(path).params_hash);
}

TEST(SetupHashTest, WorldObjectsAndParametersMatter) {
  const SceneFile file;
  const ImaginationSetup setup = file.Load();
  EXPECT_EQ(file.Load().world_hash, setup.world_hash);
  EXPECT_EQ(file.Load().robot_hash, setup.robot_hash);

  SceneFile moved;
  moved.root["world"] = moved.folder.Write("hall.world", HallSdf(3.01));
  EXPECT_NE(moved.Load().world_hash, setup.world_hash);
  EXPECT_EQ(moved.Load().robot_hash, setup.robot_hash);

  SceneFile heavier;
  heavier.folder.Write("models/mill/model.sdf", SceneFile::MillSdf("mill", 0.15));
  EXPECT_NE(heavier.Load().world_hash, setup.world_hash);

  SceneFile coarser;
  coarser.root["driving"]["map_resolution"] = 0.07;
  EXPECT_NE(coarser.Load().world_hash, setup.world_hash);

  SceneFile erring, looking;
  erring.root["detector"] = Root() + "/config/detector.yaml";
  EXPECT_NE(erring.Load().world_hash, setup.world_hash);
  EXPECT_TRUE(erring.Load().scene->sight.errors);
  looking.root["recogniser"] = Root() + "/config/recogniser.yaml";
  EXPECT_NE(looking.Load().world_hash, setup.world_hash);
  EXPECT_TRUE(looking.Load().scene->sight.recogniser);

  SceneFile stricter;  // another meaning of a fall is another physics, in the same world
  stricter.root["standing"]["tilt"] = 0.4;
  EXPECT_EQ(stricter.Load().world_hash, setup.world_hash);
  EXPECT_NE(stricter.Load().physics_hash, setup.physics_hash);
  EXPECT_EQ(coarser.Load().physics_hash, setup.physics_hash);

  SetupConfig with_more = file.Read();
  with_more.extra_objects = {file.folder.Write("extra/jug.sdf", SceneFile::MillSdf("jug", 0.2))};
  EXPECT_NE(LoadImaginationSetup(with_more).world_hash, setup.world_hash);
}

/// A mill with its origin in its middle, once in the world and once as an object of its own file or
/// of the catalogue, where its origin is at its underside.
TEST(OwnObjectTest, AKindOfTheWorldThatDiffersInItsOriginAloneIsTheSameKind) {
  std::string mill = SceneFile::MillSdf("jug", 0.14);
  mill.replace(mill.find("0 0 0.137"), 9, "0 0 0");
  for (const bool is_of_catalogue : {true, false}) {
    SceneFile file;
    file.folder.Write("models/jug/model.sdf", mill);
    file.folder.Write("models/jug/model.config",
                      "<?xml version=\"1.0\"?><model><name>jug</name><sdf version=\"1.7\">model.sdf"
                      "</sdf></model>");
    std::string hall = HallSdf();
    hall.insert(hall.find("<frame"),
                "<include><uri>model://jug</uri><name>jug7</name><pose>1 1 0.137 0 0 0</pose>"
                "</include>");
    file.root["world"] = file.folder.Write("hall.world", hall);
    if (is_of_catalogue) file.folder.Write("objects.yaml", "mill1: mill\njug1: jug\n");
    SetupConfig config = file.Read();
    if (!is_of_catalogue)
      config.extra_objects = {(file.folder.path() / "models/jug/model.sdf").string()};
    const ImaginationSetup setup = LoadImaginationSetup(config);
    const world::World& world = setup.scene->world;
    const auto lowest = [](const world::ObjectModel& model) {
      const geometry::Collision& shape = model.collisions.at(0);
      return geometry::BoundsOf(shape.shape, shape.X_BS).lower.z();
    };
    const world::ObjectState& jug7 = *world.initial.Find("jug7");
    EXPECT_EQ(jug7.model, "jug");
    EXPECT_NEAR(jug7.X_MO.translation.z(), 0.0, 1e-9);
    EXPECT_NEAR(lowest(*world.ModelOf(jug7)), 0.0, 1e-9);
    EXPECT_NEAR(lowest(*world.RequireModel("jug")), 0.0, 1e-9);
  }
}

TEST(SetupHashTest, TheRobotMattersForItsOwnHash) {
  const SceneFile file;
  YAML::Node robot = YAML::LoadFile(Root() + "/config/robots/cart.yaml");
  robot["urdf"] = Root() + "/urdf/cart.urdf";
  SceneFile same, lively;
  same.root["robot"] = same.folder.Write("robot.yaml", YAML::Dump(robot));
  robot["base_controller"]["sway_compliance"] = 0.007;
  lively.root["robot"] = lively.folder.Write("robot.yaml", YAML::Dump(robot));
  EXPECT_EQ(same.Load().robot_hash, file.Load().robot_hash);
  EXPECT_NE(lively.Load().robot_hash, file.Load().robot_hash);
  EXPECT_EQ(lively.Load().world_hash, file.Load().world_hash);
}

TEST(SetupHashTest, CommentsInTheWorldDoNotMatter) {
  SceneFile remarked;
  std::string sdf = HallSdf();
  sdf.insert(sdf.find("<frame"), "<!-- a remark -->\n\n");
  remarked.root["world"] = remarked.folder.Write("hall.world", sdf);
  EXPECT_EQ(remarked.Load().world_hash, SceneFile().Load().world_hash);
}

// -------------------------------------------------------------------------------- start states

const ImaginationSetup& Hall() {
  static const ImaginationSetup setup = SceneFile().Load();
  return setup;
}

TEST(ImaginationSetupTest, FindsModelsByInstanceOrName) {
  EXPECT_EQ(Hall().ModelOf("MILL1"), "mill");
  EXPECT_EQ(Hall().ModelOf("mill2"), "mill");
  EXPECT_EQ(Hall().ModelOf("Mill"), "mill");
  EXPECT_THAT(ConfigErrorOf([] { Hall().ModelOf("mil1"); }),
              AllOf(HasSubstr("object 'mil1' is unknown"), HasSubstr("'mill1'")));
}

TEST(ImaginationSetupTest, ABareUrdfWillDo) {
  SceneFile file;
  file.root["robot"] = Root() + "/urdf/cart.urdf";
  const ImaginationSetup setup = file.Load();
  EXPECT_EQ(setup.scene->robot.model.name, "cart");
  EXPECT_EQ(setup.scene->robot.profile.tray_link, "tray_link");
}

/// Skills put things on the tray, too.
TEST(StartStateTest, PlacesOnTheTrayAreAsFarApartAsThoseOfSkills) {
  SceneFile file;
  file.root["manipulation"]["place"]["slot_distance"] = 0.1;
  const ImaginationSetup setup = file.Load();
  const geometry::Pose3 X_BO = setup.scene->X_BO;
  for (const StartState& start : {MakeStartState(setup, "door", {"mill1", "Mill2"}),
                                  MakeStartState(setup, {{"RobotAt", {"door"}},
                                                         {"On", {"mill1", "trayArea1"}},
                                                         {"On", {"mill2", "trayArea1"}}})}) {
    ASSERT_THAT(start.world.objects, SizeIs(2));
    const Eigen::Vector3d p_O =
        ((geometry::Lift(start.robot.X_MB) * X_BO).Inverse() * start.world.objects[1].X_MO)
            .translation;
    EXPECT_LT((p_O - Eigen::Vector3d(0.0, -0.1, 0.0)).norm(), 1e-9);
  }
}

TEST(StartStateTest, PutsTheRobotAtTheAreaAndItsLoadInSlots) {
  const StartState start = MakeStartState(Hall(), "door", {"mill1", "Mill2", "mill"});
  EXPECT_EQ(start.robot.X_MB.x, 0.0);
  EXPECT_NEAR(start.robot.X_MB.yaw, 0.5, 1e-12);
  EXPECT_EQ(start.robot.joints, Hall().scene->robot.profile.joints);
  ASSERT_THAT(start.world.objects, SizeIs(3));
  EXPECT_EQ(start.world.objects[1].name, "mill2");
  EXPECT_EQ(start.world.objects[1].model, "mill");
  const geometry::Pose3 X_OM = (geometry::Lift(start.robot.X_MB) * Hall().scene->X_BO).Inverse();
  const double y[] = {0.0, -0.13, 0.13};
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d p_O = (X_OM * start.world.objects[i].X_MO).translation;
    EXPECT_LT((p_O - Eigen::Vector3d(0.0, y[i], 0.0)).norm(), 1e-9) << "object " << i;
  }
}

TEST(StartStateTest, RefusesWhatItCannotPlace) {
  const auto why_not = [](const std::string& area, const std::vector<std::string>& objects) {
    return ConfigErrorOf([&] { MakeStartState(Hall(), area, objects); });
  };
  EXPECT_THAT(why_not("dor", {}), AllOf(HasSubstr("area 'dor' is unknown"), HasSubstr("'Door'")));
  EXPECT_THAT(why_not("door", {"vase"}), HasSubstr("object 'vase' is unknown"));
  EXPECT_THAT(why_not("door", {"mill", "mill", "mill", "mill"}),
              AllOf(HasSubstr("4 objects"), HasSubstr("at most 3")));
}

/// It would be there twice: as an obstacle, too.
TEST(StartStateTest, RefusesToPutWhatStandsStillElsewhere) {
  SceneFile file;
  std::string hall = HallSdf();
  for (const std::string name : {"mill7", "mill8"}) {
    hall.insert(hall.find("<frame"), "<include><uri>model://mill</uri><name>" + name +
                                         "</name><pose>1 1 0 0 0 0</pose></include>");
  }
  file.root["world"] = file.folder.Write("hall.world", hall);
  const ImaginationSetup setup = file.Load();
  EXPECT_EQ(setup.scene->world.initial.Find("mill7"), nullptr) << "stands in another one";
  const auto told = AllOf(HasSubstr("object 'Mill7' stands still where the world"),
                          HasSubstr("model.sdf:1"), HasSubstr("move it in the world's file"));
  EXPECT_THAT(ConfigErrorOf([&] { MakeStartState(setup, "door", {"Mill7"}); }), told);
  PutObject put;
  put.object = "Mill7";
  EXPECT_THAT(ConfigErrorOf([&] { MakeStartState(setup, {{"RobotAt", {"door"}}}, {put}); }), told);
}

TEST(StartStateTest, RefusesALoadWithoutATray) {
  YAML::Node robot = YAML::LoadFile(Root() + "/config/robots/cart.yaml");
  robot["urdf"] = Root() + "/urdf/cart.urdf";
  robot["tray_link"] = "";
  SceneFile file;
  file.root["robot"] = file.folder.Write("robot.yaml", YAML::Dump(robot));
  const ImaginationSetup setup = file.Load();
  EXPECT_NO_THROW(MakeStartState(setup, "door", {}));
  EXPECT_THAT(ConfigErrorOf([&] { MakeStartState(setup, "door", {"mill1"}); }),
              AllOf(HasSubstr("robot 'cart' has no tray"), HasSubstr("tray_link"),
                    HasSubstr("nothing is over the middle of tray_link")));
}

TEST(StartStateTest, NoRobotStartsOnAnotherStorey) {
  ImaginationSetup setup = Hall();
  skills::SkillSet skills = *setup.skills;
  skills.elsewhere["door"] = "area 'door' stands on 'gallery'";
  setup.skills = std::make_shared<const skills::SkillSet>(skills);
  const auto is_told = AllOf(HasSubstr("the start"), HasSubstr("'door' stands on 'gallery'"));
  EXPECT_THAT(ConfigErrorOf([&] { MakeStartState(setup, "Door", {}); }), is_told);
  EXPECT_THAT(ConfigErrorOf([&] { MakeStartState(setup, {{"RobotAt", {"Door"}}}, {}); }), is_told);
}

TEST(StartStateTest, RefusesALoadWhosePlaceIsBesideTheTray) {
  YAML::Node robot = YAML::LoadFile(Root() + "/config/robots/cart.yaml");
  robot["urdf"] = Root() + "/urdf/cart.urdf";
  robot["object_on_tray"]["xyz"][1] = 0.9;
  SceneFile file;
  file.root["robot"] = file.folder.Write("robot.yaml", YAML::Dump(robot));
  const ImaginationSetup setup = file.Load();
  const base::Atom here{"RobotAt", {"door"}}, load{"On", {"Mill1", "TrayArea1"}};
  EXPECT_NO_THROW(MakeStartState(setup, "door", {}));
  EXPECT_NO_THROW(MakeStartState(setup, {here, {"On", {"mill1", "tabletop"}}}));
  for (const std::string& why :
       {ConfigErrorOf([&] { MakeStartState(setup, "door", {"mill1"}); }), ConfigErrorOf([&] {
          MakeStartState(setup, {here, load});
        })}) {
    EXPECT_THAT(why, AllOf(HasSubstr("'mill1' would begin"), HasSubstr("m beside the tray's plate"),
                           HasSubstr("object_on_tray")));
  }
}

// The place of the second thing, 0.13 m to the right of the first, lies beside the plate.
TEST(StartStateTest, ASecondThingOnTheTrayBeginsWhereThereIsRoom) {
  YAML::Node robot = YAML::LoadFile(Root() + "/config/robots/cart.yaml");
  robot["urdf"] = Root() + "/urdf/cart.urdf";
  robot["object_on_tray"]["xyz"][1] = -0.12;
  SceneFile file;
  file.root["robot"] = file.folder.Write("robot.yaml", YAML::Dump(robot));
  const ImaginationSetup setup = file.Load();
  const base::Atom here{"RobotAt", {"door"}};
  for (const StartState& start :
       {MakeStartState(setup, "door", {"mill1", "Mill2"}),
        MakeStartState(
            setup, {here, {"On", {"Mill2", "trayArea1"}}, {"On", {"mill1", "trayArea1"}}}, {})}) {
    const geometry::Pose3 X_TM = (geometry::Lift(start.robot.X_MB) * setup.scene->X_BO).Inverse();
    ASSERT_THAT(start.world.objects, SizeIs(2));
    const Eigen::Vector3d first = (X_TM * start.world.objects[0].X_MO).translation;
    const Eigen::Vector3d second = (X_TM * start.world.objects[1].X_MO).translation;
    EXPECT_LT(first.norm(), 1e-9);
    EXPECT_NEAR(second.z(), 0.0, 1e-9);
    EXPECT_GT(second.norm(), 2.0 * 0.037) << "beside the first";
    EXPECT_LT(second.norm(), 2.0 * 0.037 + 0.03) << "and no farther than need be";
    EXPECT_NO_THROW(CheckSetup(MakeRolloutSetup(setup, start, 42), {"move_base", {"window"}}));
  }
}

TEST(StartStateTest, ReadsAtoms) {
  const StartState start = MakeStartState(Hall(), {{"HasArmPosture", {"leftArm1", "tucked"}},
                                                   {"On", {"mill1", "trayArea1"}},
                                                   {"on", {"Mill2", "tabletop"}},
                                                   {"RobotAt", {"window"}},
                                                   {"HasTorsoPosture", {"up"}},
                                                   {"Instance", {"mill1", "PepperMill"}},
                                                   {"Holding", {"leftArm1", "nothing"}}});
  EXPECT_EQ(start.robot.X_MB.x, 2.0);
  ASSERT_THAT(start.world.objects, SizeIs(2));
  EXPECT_EQ(start.world.objects[0].name, "mill1");
  const geometry::Pose3 X_MTray = geometry::Lift(start.robot.X_MB) * Hall().scene->X_BO;
  EXPECT_LT((start.world.objects[0].X_MO.translation - X_MTray.translation).norm(), 1e-9);
  EXPECT_EQ(start.world.objects[1].name, "mill2");
  EXPECT_NEAR(start.world.objects[1].X_MO.translation.x(), 3.0, 1e-9);
  EXPECT_NEAR(start.world.objects[1].X_MO.translation.z(), 0.7, 1e-9);
}

TEST(StartStateTest, RefusesAtomsItDoesNotUnderstand) {
  const auto why_not = [](const std::vector<base::Atom>& atoms) {
    return ConfigErrorOf([&] { MakeStartState(Hall(), atoms); });
  };
  const base::Atom here{"RobotAt", {"door"}};
  EXPECT_THAT(why_not({}), HasSubstr("RobotAt(area) is missing"));
  EXPECT_NO_THROW(MakeStartState(Hall(), {here, here}));
  EXPECT_THAT(why_not({here, {"RobotAt", {"window"}}}),
              AllOf(HasSubstr("RobotAt(window): contradicts"), HasSubstr("'door'")));
  EXPECT_THAT(why_not({{"RobotAt", {}}}), HasSubstr("RobotAt(): has 0 arguments, wanted 1"));
  EXPECT_THAT(why_not({{"RobotAt", {"door", "window"}}}), HasSubstr("has 2 arguments, wanted 1"));
  EXPECT_THAT(why_not({{"RobotAt", {"moon"}}}), HasSubstr("area 'moon' is unknown"));
  EXPECT_THAT(why_not({here, {"Under", {"mill1", "door"}}}),
              AllOf(HasSubstr("Under(mill1, door)"), HasSubstr("predicate 'Under' is unknown")));
  EXPECT_THAT(why_not({here, {"On", {"mill1"}}}), HasSubstr("On(mill1)"));
  EXPECT_THAT(why_not({here, {"On", {"mill1", "moon"}}}), HasSubstr("area 'moon' is unknown"));
  EXPECT_THAT(why_not({here, {"On", {"vase", "trayArea1"}}}),
              HasSubstr("object 'vase' is unknown"));
}

TEST(StartStateTest, RolloutsGetTheWholeSetup) {
  const StartState start = MakeStartState(Hall(), "door", {"mill1"});
  const RolloutSetup rollouts = MakeRolloutSetup(Hall(), start, 42);
  EXPECT_EQ(rollouts.seed, 42u);
  EXPECT_EQ(rollouts.scene, Hall().scene);
  EXPECT_EQ(rollouts.skills, Hall().skills);
  EXPECT_EQ(rollouts.params.time_limit, Hall().rollout.time_limit);
  EXPECT_NO_THROW(CheckSetup(rollouts, {"move_base", {"window"}}));
}

TEST(ImaginationSetupTest, LateCommandsEndInARampBehindTheGuardWhateverTheProfileSays) {
  SceneFile scene;
  YAML::Node cart = YAML::LoadFile(Root() + "/config/robots/cart.yaml");
  cart["urdf"] = Root() + "/config/robots/" + cart["urdf"].Scalar();
  cart["base_controller"]["at_timeout"] = "stop";
  scene.root["robot"] = scene.folder.Write("cart.yaml", YAML::Dump(cart));
  const ImaginationSetup alone = scene.Load();
  scene.root["base_guard"] = true;
  const ImaginationSetup guarded = scene.Load();
  EXPECT_TRUE(alone.scene->robot.profile.base_controller.stops_at_timeout);
  EXPECT_FALSE(guarded.scene->robot.profile.base_controller.stops_at_timeout);
  EXPECT_NE(alone.robot_hash, guarded.robot_hash);  // client and worker must agree
}

}  // namespace
}  // namespace hires::imagination::imagination_setup_test
