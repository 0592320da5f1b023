// The knowledge that the package comes with agrees with its ontology, worlds, models and domain.
#include <gmock/gmock.h>
#include <tinyxml2.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge::restaurant_knowledge_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::Eq;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kRoot = HIRES_SOURCE_DIR;
using Names = std::vector<std::string>;
using Numbers = std::array<double, 6>;  // x y z [m], roll pitch yaw [rad]

std::shared_ptr<const Ontology> TheOntology() {
  static const auto ontology = std::make_shared<const Ontology>(Ontology::FromFiles(
      {kRoot + "/config/ontology/upper.ttl", kRoot + "/config/ontology/race.ttl"}));
  return ontology;
}

bool IsA(const std::string& below, const std::string& above) {
  return TheOntology()->IsA(TheOntology()->Require(below), TheOntology()->Require(above));
}

/// Fluents of a file, by instance.
class Knowledge {
 public:
  explicit Knowledge(const std::string& name)
      : file_(LoadKnowledge(kRoot + "/config/knowledge/" + name + ".yaml")) {
    for (const Fluent& fluent : file_.fluents) by_instance_.emplace(fluent.instance, &fluent);
  }

  const KnowledgeFile& file() const { return file_; }
  const std::vector<Fluent>& fluents() const { return file_.fluents; }
  const Fluent* Find(const std::string& instance) const {
    const auto found = by_instance_.find(instance);
    return found == by_instance_.end() ? nullptr : found->second;
  }
  const Fluent& Get(const std::string& instance) const {
    const Fluent* fluent = Find(instance);
    if (fluent == nullptr) throw std::runtime_error("no fluent is called " + instance);
    return *fluent;
  }
  std::vector<const Fluent*> Below(const std::string& concept_name) const {
    std::vector<const Fluent*> found;
    for (const Fluent& fluent : fluents()) {
      if (IsA(fluent.concept_name, concept_name)) found.push_back(&fluent);
    }
    return found;
  }

 private:
  KnowledgeFile file_;
  std::map<std::string, const Fluent*> by_instance_;
};

const Knowledge& Restaurant() {
  static const Knowledge knowledge("restaurant");
  return knowledge;
}

Names Links(const Fluent& fluent, const std::string& role) {
  Names links;
  for (const Property& property : fluent.properties) {
    if (property.role == role) links.push_back(std::get<std::string>(property.filler));
  }
  return links;
}

std::string Link(const Fluent& fluent, const std::string& role) {
  const Names links = Links(fluent, role);
  if (links.size() != 1) throw std::runtime_error(fluent.instance + " has not one " + role);
  return links[0];
}

double Number(const Fluent& fluent, const std::string& role, double otherwise) {
  for (const Property& property : fluent.properties) {
    if (property.role == role) return std::get<double>(property.filler);
  }
  return otherwise;
}

Numbers PoseNumbers(const Fluent& pose) {
  const double missing = std::numeric_limits<double>::quiet_NaN();  // equals nothing
  return {Number(pose, "hasX", missing), Number(pose, "hasY", missing),
          Number(pose, "hasZ", missing), Number(pose, "hasRoll", 0.0),
          Number(pose, "hasPitch", 0.0), Number(pose, "hasYaw", missing)};
}

Numbers PoseOf(const Knowledge& knowledge, const std::string& instance) {
  return PoseNumbers(knowledge.Get(Link(knowledge.Get(instance), "hasPose")));
}

Numbers Parse(const tinyxml2::XMLElement* pose) {
  Numbers numbers{};
  if (pose == nullptr) return numbers;
  std::istringstream in(pose->GetText());
  for (double& number : numbers) in >> number;
  if (!in) throw std::runtime_error(std::string("no six numbers: ") + pose->GetText());
  return numbers;
}

/// What a world file says, read without any of the package's own readers.
struct WorldFile {
  std::map<std::string, Numbers> frames;
  std::map<std::string, Numbers> models;      // included, or with bodies but a floor's
  std::map<std::string, std::string> folder;  // of included models
};

WorldFile ReadWorld(const std::string& name) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile((kRoot + "/worlds/" + name + ".world").c_str()) != tinyxml2::XML_SUCCESS) {
    throw std::runtime_error(document.ErrorStr());
  }
  WorldFile file;
  const tinyxml2::XMLElement* world = document.RootElement()->FirstChildElement("world");
  for (auto* e = world->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    const Numbers pose = Parse(e->FirstChildElement("pose"));
    if (kind == "frame") file.frames[e->Attribute("name")] = pose;
    if (kind == "model") file.models[e->Attribute("name")] = pose;
    if (kind != "include") continue;
    const std::string model = e->FirstChildElement("name")->GetText();
    file.models[model] = pose;
    file.folder[model] = std::string(e->FirstChildElement("uri")->GetText()).substr(8);
  }
  for (const char* floor : {"ground_plane", "floor"}) file.models.erase(floor);
  return file;
}

struct Extent {  // along x, y, z [m]
  std::array<double, 3> lower, upper;
};

/// Bounds of a model's collision boxes and upright cylinders, none of them turned.
Extent ExtentOf(const std::string& folder) {
  tinyxml2::XMLDocument document;
  document.LoadFile((kRoot + "/worlds/models/" + folder + "/model.sdf").c_str());
  const double big = std::numeric_limits<double>::infinity();
  Extent extent{{big, big, big}, {-big, -big, -big}};
  const tinyxml2::XMLElement* link =
      document.RootElement()->FirstChildElement("model")->FirstChildElement("link");
  for (auto* e = link->FirstChildElement("collision"); e != nullptr;
       e = e->NextSiblingElement("collision")) {
    const Numbers pose = Parse(e->FirstChildElement("pose"));
    std::array<double, 3> size{};
    const tinyxml2::XMLElement* geometry = e->FirstChildElement("geometry");
    if (const auto* box = geometry->FirstChildElement("box")) {
      std::istringstream(box->FirstChildElement("size")->GetText()) >> size[0] >> size[1] >>
          size[2];
    } else {
      const tinyxml2::XMLElement* cylinder = geometry->FirstChildElement("cylinder");
      size[0] = size[1] = 2.0 * cylinder->FirstChildElement("radius")->DoubleText();
      size[2] = cylinder->FirstChildElement("length")->DoubleText();
    }
    for (int i = 0; i < 3; ++i) {
      extent.lower[i] = std::min(extent.lower[i], pose[i] - size[i] / 2.0);
      extent.upper[i] = std::max(extent.upper[i], pose[i] + size[i] / 2.0);
    }
  }
  return extent;
}

std::array<double, 3> SizeOf(const Fluent& box) {
  return {Number(box, "hasXSize", -1.0), Number(box, "hasYSize", -1.0),
          Number(box, "hasZSize", -1.0)};
}

/// A point of the map (x, y) in the axes of a pose.
std::array<double, 2> Seen(const Numbers& from, double x, double y) {
  const double c = std::cos(from[5]), s = std::sin(from[5]);
  const double dx = x - from[0], dy = y - from[1];
  return {c * dx + s * dy, -s * dx + c * dy};
}

const Fluent& BoxOf(const Knowledge& knowledge, const std::string& instance) {
  return knowledge.Get(Link(knowledge.Get(instance), "hasBoundingBox"));
}

/// How far a point of the map lies outside of the bounding box of an instance, seen from above [m].
double Outside(const Knowledge& knowledge, const std::string& instance, double x, double y) {
  const Fluent& box = BoxOf(knowledge, instance);
  const std::array<double, 2> seen = Seen(PoseOf(knowledge, box.instance), x, y);
  const std::array<double, 3> size = SizeOf(box);
  return std::max({0.0, std::abs(seen[0]) - size[0] / 2.0, std::abs(seen[1]) - size[1] / 2.0});
}

/// Facts `(predicate a b ...)` about names alone of the planner's domain, the words in lower case.
std::set<Names> DomainFacts(const std::string& predicate) {
  const std::string text =
      base::ToLower(base::ReadTextFile(kRoot + "/config/domains/restaurant.lisp"));
  const std::regex fact("\\(:-\\s+\\(" + base::ToLower(predicate) +
                        "\\s+([^()?]+)\\)\\s+\\(\\)\\)");
  std::set<Names> facts;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), fact); it != std::sregex_iterator();
       ++it) {
    std::istringstream words((*it)[1]);
    facts.insert(Names(std::istream_iterator<std::string>(words), {}));
  }
  return facts;
}

// Files and ontology ------------------------------------------------------------------------------

class ShippedKnowledgeTest : public ::testing::TestWithParam<const char*> {
 protected:
  const Knowledge knowledge_{GetParam()};
};

TEST_P(ShippedKnowledgeTest, HoldsFluentsAloneEachInstanceOnceSinceEverAndForEver) {
  EXPECT_THAT(knowledge_.file().modifications, IsEmpty());
  EXPECT_THAT(knowledge_.file().topics, IsEmpty());
  std::set<std::string> seen;
  for (const Fluent& fluent : knowledge_.fluents()) {
    EXPECT_TRUE(seen.insert(base::ToLower(fluent.instance)).second)
        << fluent.instance << " comes twice; the planner ignores case";
    EXPECT_EQ(fluent.start, (temporal::Bounds{-temporal::kForever, -temporal::kForever}));
    EXPECT_EQ(fluent.finish, (temporal::Bounds{temporal::kForever, temporal::kForever}));
  }
  EXPECT_GT(seen.size(), 10u);
}

TEST_P(ShippedKnowledgeTest, ConceptsRolesDomainsAndRangesAreThoseOfTheOntology) {
  for (const Fluent& fluent : knowledge_.fluents()) {
    const Ontology::ConceptId id = TheOntology()->Require(fluent.concept_name);
    EXPECT_FALSE(IsA(fluent.concept_name, "ExecutionRecord")) << fluent.instance;
    std::set<std::string> roles;
    for (const Property& property : fluent.properties) {
      const Ontology::Relation* relation = TheOntology()->FindRelation(property.role);
      ASSERT_NE(relation, nullptr) << fluent.instance << ", " << property.role;
      EXPECT_THAT(relation->domain, Contains(::testing::Truly([&](Ontology::ConceptId domain) {
                    return TheOntology()->IsA(id, domain);
                  })))
          << fluent.instance << ", " << property.role;
      EXPECT_TRUE(roles.insert(property.role).second || !relation->functional)
          << fluent.instance << " has two " << property.role;
      if (property.IsLink()) {
        EXPECT_TRUE(IsA(property.type, relation->range))
            << fluent.instance << ", " << property.role;
      } else {
        EXPECT_EQ(property.type, relation->range) << fluent.instance << ", " << property.role;
      }
    }
  }
}

TEST_P(ShippedKnowledgeTest, EveryLinkLeadsToAFluentOfItsType) {
  for (const Fluent& fluent : knowledge_.fluents()) {
    for (const Property& property : fluent.properties) {
      if (!property.IsLink()) continue;
      const Fluent* target = knowledge_.Find(std::get<std::string>(property.filler));
      ASSERT_NE(target, nullptr) << fluent.instance << ", " << property.role;
      EXPECT_TRUE(IsA(target->concept_name, property.type))
          << fluent.instance << " calls " << target->instance << " a " << property.type;
    }
  }
}

TEST_P(ShippedKnowledgeTest, TheStoreTakesAllOfIt) {
  Store store(":memory:", TheOntology());
  Assertion by;
  by.source = Source::kKnowledge;
  by.time = -temporal::kForever;
  EXPECT_THAT(store.Add(knowledge_.fluents(), by), SizeIs(knowledge_.fluents().size()));
  for (const Fluent& fluent : knowledge_.fluents()) {
    const std::optional<Fluent> kept = store.Find(fluent.instance);
    ASSERT_TRUE(kept.has_value()) << fluent.instance;
    EXPECT_TRUE(*kept == fluent) << fluent.instance;
  }
}

TEST_P(ShippedKnowledgeTest, IsWrittenAsTheWriterWrites) {
  std::istringstream in(base::ReadTextFile(kRoot + "/config/knowledge/" + GetParam() + ".yaml"));
  std::string without_comments;
  for (std::string line; std::getline(in, line);) {
    if (line[0] != '#') without_comments += line + "\n";
  }
  EXPECT_EQ(without_comments, WriteFluents(knowledge_.fluents()));
}

// World -------------------------------------------------------------------------------------------

TEST_P(ShippedKnowledgeTest, AreasAreTheFramesOfTheWorldAndStandWhereTheyDo) {
  const WorldFile world = ReadWorld(GetParam());
  Names areas;
  for (const Fluent* area : knowledge_.Below("Area")) {
    if (IsA(area->concept_name, "TrayArea")) continue;  // moves with the robot
    areas.push_back(area->instance);
    const auto frame = world.frames.find(area->instance);
    ASSERT_NE(frame, world.frames.end()) << area->instance << " is no frame";
    EXPECT_THAT(PoseOf(knowledge_, area->instance), ElementsAreArray(frame->second))
        << area->instance;
  }
  EXPECT_EQ(areas.size(), world.frames.size());
}

TEST_P(ShippedKnowledgeTest, EveryModelOfTheWorldHasItsFluentAtItsPose) {
  const WorldFile world = ReadWorld(GetParam());
  EXPECT_GE(world.models.size(), 3u);
  for (const auto& [name, pose] : world.models) {
    ASSERT_NE(knowledge_.Find(name), nullptr) << name;
    EXPECT_TRUE(IsA(knowledge_.Get(name).concept_name, "PassiveObject")) << name;
    EXPECT_THAT(PoseOf(knowledge_, name), ElementsAreArray(pose)) << name;
  }
  for (const Fluent* furniture : knowledge_.Below("Furniture")) {
    EXPECT_EQ(world.models.count(furniture->instance), 1u) << furniture->instance;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedKnowledgeTest, ::testing::Values("restaurant", "workshop"),
                         [](const auto& info) { return std::string(info.param); });

// Restaurant --------------------------------------------------------------------------------------

TEST(RestaurantKnowledgeTest, HasSoManyFluentsOfEachConcept) {
  std::map<std::string, int> counts;
  for (const Fluent& fluent : Restaurant().fluents()) ++counts[fluent.concept_name];
  const std::map<std::string, int> expected{{"ArmUnTuckedPosture", 2},
                                            {"Arm", 2},
                                            {"At", 4},
                                            {"Board", 1},
                                            {"BoundingBox", 42},
                                            {"Chair", 4},
                                            {"Coffee", 1},
                                            {"CoffeeJug", 1},
                                            {"Connected", 9},
                                            {"Counter", 1},
                                            {"FloorArea", 1},
                                            {"Gripper", 2},
                                            {"Guest", 4},
                                            {"Holding", 2},
                                            {"HomeArea", 1},
                                            {"HorizontalTable", 4},
                                            {"ManipulationArea", 5},
                                            {"MilkPot", 1},
                                            {"MotionSet", 2},
                                            {"Mug", 3},
                                            {"NearStartArea", 1},
                                            {"NoObject", 1},
                                            {"On", 3},
                                            {"Peppermill", 1},
                                            {"PlacingArea", 9},
                                            {"Pose", 54},
                                            {"PreManipulationArea", 5},
                                            {"Robot", 1},
                                            {"RobotAt", 1},
                                            {"SittingArea", 4},
                                            {"SugarPot", 2},
                                            {"Table", 2},
                                            {"Torso", 1},
                                            {"TorsoDownPosture", 1},
                                            {"Tray", 1},
                                            {"TrayArea", 1},
                                            {"Wall", 1}};
  EXPECT_THAT(counts, Eq(expected));
}

TEST(RestaurantKnowledgeTest, BoxesHoldTheBodiesOfTheModelsExactly) {
  std::map<std::string, std::string> folders = ReadWorld("restaurant").folder;
  const YAML::Node objects = YAML::LoadFile(kRoot + "/worlds/objects.yaml");
  for (const char* object : {"mug1", "mug2", "peppermill1"}) {
    folders[object] = objects[object].as<std::string>();
  }
  folders.erase("walls");  // has no box: it is hollow
  ASSERT_THAT(folders, SizeIs(15));
  for (const auto& [name, folder] : folders) {
    const Extent extent = ExtentOf(folder);
    const Fluent& box = BoxOf(Restaurant(), name);
    const Numbers at = PoseOf(Restaurant(), box.instance);
    const Numbers model = PoseOf(Restaurant(), name);
    const std::array<double, 2> offset = Seen(model, at[0], at[1]);
    const std::array<double, 3> size = SizeOf(box);
    EXPECT_EQ(at[5], model[5]) << name;
    EXPECT_NEAR(at[2] - model[2], extent.lower[2], 1e-12) << name;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(size[i], extent.upper[i] - extent.lower[i], 1e-12) << name << ", axis " << i;
    }
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(offset[i], (extent.upper[i] + extent.lower[i]) / 2.0, 1e-12) << name;
    }
  }
}

TEST(RestaurantKnowledgeTest, PlacingAreasLieOnTheirFurniture) {
  int count = 0;
  for (const Fluent* furniture : Restaurant().Below("Furniture")) {
    const double top = SizeOf(BoxOf(Restaurant(), furniture->instance))[2];
    for (const std::string& area : Links(*furniture, "hasPlacingArea")) {
      const Fluent& box = BoxOf(Restaurant(), area);
      const Numbers at = PoseOf(Restaurant(), box.instance);
      const Numbers middle = PoseOf(Restaurant(), area);
      EXPECT_EQ(at[2], top) << area;
      EXPECT_EQ(Outside(Restaurant(), area, middle[0], middle[1]), 0.0) << area;
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          // Furniture stands at 1.57 rad, which is not quite a right angle.
          EXPECT_LT(Outside(Restaurant(), furniture->instance, at[0] + x * SizeOf(box)[0],
                            at[1] + y * SizeOf(box)[1]),
                    0.001)
              << area;
        }
      }
      ++count;
    }
  }
  EXPECT_EQ(count, 9);
}

TEST(RestaurantKnowledgeTest, ObjectsStandWhereOnSaysAndApart) {
  const std::vector<const Fluent*> statements = Restaurant().Below("On");
  for (const Fluent* on : statements) {
    const std::string object = Link(*on, "hasPhysicalEntity");
    const Numbers at = PoseOf(Restaurant(), object);
    const std::string area = Link(*on, "hasArea");
    EXPECT_EQ(Outside(Restaurant(), area, at[0], at[1]), 0.0) << object;
    EXPECT_EQ(at[2], PoseOf(Restaurant(), area)[2]) << object;
    for (const Fluent* other : statements) {
      if (other == on) continue;
      const Numbers beside = PoseOf(Restaurant(), Link(*other, "hasPhysicalEntity"));
      EXPECT_GT(std::hypot(at[0] - beside[0], at[1] - beside[1]), 0.1) << object;
    }
  }
}

TEST(RestaurantKnowledgeTest, TheRobotIsOnTheFloorAreaAndWhereItsLocalisationStarts) {
  const Numbers robot = PoseOf(Restaurant(), "PR21");
  EXPECT_THAT(robot, ElementsAreArray(PoseOf(Restaurant(), "nearStartArea1")));
  const std::string area = Link(Restaurant().Get("robotAtPR21"), "hasArea");
  EXPECT_EQ(area, "floorAreaTamsRestaurant1");
  EXPECT_EQ(Outside(Restaurant(), area, robot[0], robot[1]), 0.0);
}

TEST(RestaurantKnowledgeTest, FloorAreasAreThoseThatTheOriginalsQueryFinds) {
  for (const Fluent* area : Restaurant().Below("Area")) {
    const double z = PoseOf(Restaurant(), Link(*area, "hasBoundingBox"))[2];
    EXPECT_EQ(z == 0.0, !IsA(area->concept_name, "PlacingArea")) << area->instance;
  }
}

// The original's files --------------------------------------------------------------------------

TEST(OriginalKnowledgeTest, ConceptsAndRelationsOfTheOriginalsFilesAreKnown) {
  const std::string folder = HIRES_SHARED_DATA;
  if (!std::filesystem::exists(folder + "/spawn_objects.yaml")) {
    GTEST_SKIP() << "the original's files are not at " << folder;
  }
  std::set<std::string> concepts, relations;
  for (const Fluent& fluent : LoadKnowledge(folder + "/spawn_objects.yaml").fluents) {
    concepts.insert(fluent.concept_name);
    for (const Property& property : fluent.properties) {
      relations.insert(property.role);
      if (property.IsLink()) concepts.insert(property.type);
    }
  }
  for (const DemandTopic& topic : LoadKnowledge(folder + "/bb_topics.yaml").topics) {
    for (const Names& names : {topic.exact, topic.below, topic.above}) {
      concepts.insert(names.begin(), names.end());
    }
    relations.insert(topic.properties.begin(), topic.properties.end());
  }
  EXPECT_GE(concepts.size(), 16u);
  for (const std::string& name : concepts) EXPECT_NO_THROW(TheOntology()->Require(name));
  for (const std::string& name : relations) {
    EXPECT_NE(TheOntology()->FindRelation(name), nullptr) << name;
  }
}

/// `upper:On` and the like in a query.
Names QualifiedNames(const std::string& query) {
  const std::regex name("\\b(upper|race):\\w+");
  return {std::sregex_token_iterator(query.begin(), query.end(), name), {}};
}

TEST(OriginalKnowledgeTest, QueriesOfTheOriginalsTopicsUseOurPrefixes) {
  const std::string file = HIRES_SHARED_DATA "/bb_topics.yaml";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the original's topics are not at " << file;
  int count = 0;
  for (const DemandTopic& topic : LoadKnowledge(file).topics) {
    for (const std::string& query : topic.queries) {
      for (const std::string& name : QualifiedNames(query)) {
        EXPECT_EQ(TheOntology()->Qualified(name.substr(name.find(':') + 1)), name) << topic.name;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 30);
}

// Planner -----------------------------------------------------------------------------------------

TEST(RestaurantKnowledgeTest, ConnectionsAreThePlanners) {
  std::set<Names> connections;
  for (const Fluent* connected : Restaurant().Below("Connected")) {
    connections.insert({base::ToLower(Link(*connected, "hasPlacingArea")),
                        base::ToLower(Link(*connected, "hasManipulationArea")),
                        base::ToLower(Link(*connected, "hasPreManipulationArea"))});
  }
  EXPECT_THAT(connections, SizeIs(9));
  EXPECT_EQ(connections, DomainFacts("Connected"));
}

TEST(RestaurantKnowledgeTest, PlacingAreasAreTriedInThePlannersOrder) {
  std::set<Names> facts;
  for (const Fluent* furniture : Restaurant().Below("Furniture")) {
    int rank = 0;
    for (const std::string& area : Links(*furniture, "hasPlacingArea")) {
      facts.insert({furniture->instance, base::ToLower(area), std::to_string(++rank)});
    }
  }
  EXPECT_THAT(facts, SizeIs(9));
  EXPECT_EQ(facts, DomainFacts("hasPlacingArea"));
}

TEST(RestaurantKnowledgeTest, SeatsHaveThePlannersPlacesLeftAndRight) {
  for (const char* role : {"hasPlacingAreaLeft", "hasPlacingAreaRight"}) {
    std::set<Names> facts;
    for (const Fluent* seat : Restaurant().Below("SittingArea")) {
      facts.insert({base::ToLower(seat->instance), base::ToLower(Link(*seat, role))});
    }
    EXPECT_THAT(facts, SizeIs(4));
    EXPECT_EQ(facts, DomainFacts(role)) << role;
  }
}

TEST(RestaurantKnowledgeTest, TypesAreThePlanners) {
  for (const Names& type : DomainFacts("Type")) {
    ASSERT_THAT(type, SizeIs(2));
    EXPECT_EQ(base::ToLower(Restaurant().Get(type[1]).concept_name), type[0]);
  }
  EXPECT_THAT(DomainFacts("Type"), SizeIs(3));
}

/// Arguments of the facts in which the planner's problems speak of the state, in lower case.
std::set<std::string> NamesOfProblem(const std::string& problem) {
  const std::string text =
      base::ReadTextFile(kRoot + "/config/domains/problems/" + problem + ".lisp");
  const std::string code = base::ToLower(std::regex_replace(text, std::regex(";[^\n]*"), ""));
  const std::regex fact(
      "\\((?:robotat|at|on|holding|hasarmposture|hastorsoposture|type) ([^()]+)\\)");
  std::set<std::string> names;
  for (auto it = std::sregex_iterator(code.begin(), code.end(), fact); it != std::sregex_iterator();
       ++it) {
    for (const std::string& name : base::Split((*it)[1].str(), ' ')) names.insert(name);
  }
  return names;
}

TEST(RestaurantKnowledgeTest, EveryNameOfThePlannersProblemsIsKnown) {
  std::set<std::string> known;
  for (const Fluent& fluent : Restaurant().fluents()) known.insert(base::ToLower(fluent.instance));
  for (const std::string& name : TheOntology()->ConceptNames()) known.insert(base::ToLower(name));
  for (const char* problem : {"serve_coffee", "serve_coffee_imagined", "clear_table",
                              "carry_object", "serve_coffee_south_failed"}) {
    const std::set<std::string> names = NamesOfProblem(problem);
    EXPECT_GT(names.size(), 15u) << problem;
    EXPECT_TRUE(std::includes(known.begin(), known.end(), names.begin(), names.end()))
        << problem << " speaks of one of: " << base::Join({names.begin(), names.end()}, ", ");
  }
}

}  // namespace
}  // namespace hires::knowledge::restaurant_knowledge_test
