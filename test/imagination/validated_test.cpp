#include "hires/imagination/validated.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "hires/base/text.h"
#include "hires/imagination/uncertainty.h"
#include "hires/robot/load_robot.h"
#include "imagination/room_rollouts.h"
#include "support/messages.h"

namespace hires::imagination::validated_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kRoot = HIRES_SOURCE_DIR;

Validated Configured() {
  return ReadValidated(base::ParamReader::FromFile(kRoot + "/config/validated.yaml"));
}

/// Everything that the request of these tests needs.
Validated Wide() {
  Validated validated = Configured();
  validated.objects["mill"] = "docs/here.md";
  validated.floor_roughness.at_most = 1.0;
  validated.linear_speed.at_most = 100.0;
  validated.angular_speed.at_most = 100.0;
  validated.levels["planar"] = "docs/here.md";
  return validated;
}

RolloutSetup OnFloor(double largest_roughness) {
  Uncertainty rough = NoUncertainty();
  rough.quantities["floor_roughness"] = {Distribution::Kind::kUniform, 0.0, largest_roughness};
  RolloutSetup setup = RoomRollouts(Room(), "mill");
  setup.uncertainty = std::make_shared<const Uncertainty>(rough);
  return setup;
}

const std::vector<base::ActionCall> kDrive{{"move_base_param", {"east", "fast"}}};

/// Whether the document has a section whose heading begins so.
bool HasSection(const std::string& document, const std::string& heading) {
  for (const std::string& line : base::Split(document, '\n')) {
    const std::size_t text = line.find_first_not_of('#');
    if (text == 0 || text == std::string::npos) continue;
    if (line.substr(text).rfind(" " + heading, 0) == 0) return true;
  }
  return false;
}

TEST(ReadValidatedTest, EveryPlaceIsASectionOfADocumentOfThisPackage) {
  const Validated validated = Configured();
  std::vector<std::string> places{validated.floor_roughness.where, validated.linear_speed.where,
                                  validated.angular_speed.where};
  for (const auto& [model, where] : validated.objects) places.push_back(where);
  for (const auto& [level, where] : validated.levels) places.push_back(where);
  for (const std::string& place : places) {
    for (const std::string& part : base::Split(place, ';')) {
      const std::string place_of_part = part.substr(part.find("docs/"));
      const std::size_t comma = place_of_part.find(", ");
      ASSERT_NE(comma, std::string::npos) << place;
      const std::string heading = place_of_part.substr(comma + 2);
      const std::string text = base::ReadTextFile(kRoot + "/" + place_of_part.substr(0, comma));
      EXPECT_TRUE(HasSection(text, heading.substr(0, heading.find(':')))) << place;
    }
  }
}

TEST(ReadValidatedTest, EveryObjectHasAModel) {
  for (const auto& [model, where] : Configured().objects) {
    EXPECT_TRUE(std::filesystem::exists(kRoot + "/worlds/models/" + model)) << model;
  }
}

TEST(ReadValidatedTest, DefaultConfigurationIsWithinIt) {
  const Validated validated = Configured();
  const Uncertainty uncertainty = LoadUncertainty(kRoot + "/config/uncertainty.yaml");
  EXPECT_LE(uncertainty.quantities.at("floor_roughness").Largest(),
            validated.floor_roughness.at_most);
  const robot::Robot robot = robot::LoadAnyRobot(kRoot + "/config/robots/pr2.yaml");
  for (const auto& [name, set] : robot.profile.motion_sets) {
    EXPECT_LE(set.max_linear_velocity, validated.linear_speed.at_most) << name;
    EXPECT_LE(set.max_angular_velocity, validated.angular_speed.at_most) << name;
  }
}

TEST(ReadValidatedTest, RefusesWhatItDoesNotKnow) {
  const std::string yaml = base::ReadTextFile(kRoot + "/config/validated.yaml", 1u << 16);
  const auto why = [&](const std::string& from, const std::string& to) {
    std::string changed = yaml;
    changed.replace(changed.find(from), from.size(), to);
    return ConfigErrorOf(
        [&] { ReadValidated(base::ParamReader::FromString(changed, "validated.yaml")); });
  };
  EXPECT_THAT(why("  tray:", "  trai:"), AllOf(HasSubstr("validated.yaml"), HasSubstr("'trai'")));
  EXPECT_THAT(why("levels:", "level:"), HasSubstr("key 'level' is unknown; did you mean 'levels'"));
  EXPECT_THAT(why("at_most: 0.0005 ", "at_most: -1 "),
              HasSubstr("floor_roughness.at_most is '-1'"));
  EXPECT_THAT(why("linear_speed:", "speeds: {}\nlinear_speed:"), HasSubstr("'speeds' is unknown"));
}

TEST(CaveatsOfTest, WithinWhatWasValidatedThereAreNone) {
  EXPECT_THAT(CaveatsOf(RoomRollouts(Room(), "mill"), kDrive, Wide()), IsEmpty());
}

TEST(CaveatsOfTest, AnObjectThatIsCarriedIsNamedWithItsModel) {
  Validated validated = Wide();
  validated.objects = {{"cup", "docs/here.md"}};
  EXPECT_THAT(CaveatsOf(RoomRollouts(Room(), "mill"), kDrive, validated),
              ElementsAre(AllOf(HasSubstr("(model mill)"), HasSubstr("validated are cup"))));
}

TEST(CaveatsOfTest, NotesOfTheWorldAreCaveatsOfDrives) {
  world::World room = Room();
  room.notes = {"9048 cells are grey and count as free"};
  Report report;
  AddCaveats(RoomRollouts(room, "mill"), kDrive, Wide(), &report);
  EXPECT_THAT(report.caveats, testing::Contains(room.notes.front()));
}

TEST(CaveatsOfTest, NotesOfObjectsAreCaveatsWhereTheyAreThereOnceForEachKind) {
  world::World room = Room();
  auto model = std::make_shared<world::ObjectModel>(*room.models.at("mill"));
  model->notes = {"1 link whose <inertial> no such body has; mill.urdf 'l'"};
  room.models["mill"] = model;
  auto absent = std::make_shared<world::ObjectModel>(*model);
  absent->notes = {"what is not there says nothing"};
  room.models["absent"] = absent;
  RolloutSetup setup = RoomRollouts(room, "mill");
  world::ObjectState second = setup.world_state.objects.at(0);
  second.name = "mill2";
  second.X_MO.translation.x() += 0.2;
  setup.world_state.objects.push_back(second);
  Report report;
  AddCaveats(setup, {}, Wide(), &report);
  const auto told = [&](const std::string& note) {
    return std::count(report.caveats.begin(), report.caveats.end(), note);
  };
  EXPECT_EQ(told(model->notes.front()), 1);
  EXPECT_EQ(told(absent->notes.front()), 0);
}

TEST(CaveatsOfTest, TheFloorThatMayBeDrawnCounts) {
  Validated validated = Wide();
  validated.floor_roughness = {0.001, "docs/floor.md"};
  EXPECT_THAT(CaveatsOf(OnFloor(0.001), kDrive, validated), IsEmpty());
  EXPECT_THAT(CaveatsOf(OnFloor(0.004), kDrive, validated),
              ElementsAre("the floor may be uneven by 0.004 m, validated are up to 0.001 m "
                          "(docs/floor.md)"));
}

TEST(CaveatsOfTest, OnlyTheMotionSetsThatAreDrivenWithCount) {
  const RolloutSetup setup = RoomRollouts(Room(), "mill");
  const auto& sets = setup.skills->motion_sets;
  Validated validated = Wide();
  validated.linear_speed = {
      0.5 * (sets.at("slow").max_linear_velocity + sets.at("fast").max_linear_velocity),
      "docs/speed.md"};
  EXPECT_THAT(CaveatsOf(setup, kDrive, validated),
              ElementsAre(AllOf(HasSubstr("motion set fast drives"), HasSubstr("docs/speed.md"))));
  EXPECT_THAT(CaveatsOf(setup, {{"move_base_param", {"east", "slow"}}}, validated), IsEmpty());
}

TEST(CaveatsOfTest, TheLevelOfDetailCounts) {
  Validated validated = Wide();
  validated.levels.erase("tray");
  EXPECT_THAT(CaveatsOf(RoomRollouts(Room(), "mill"), kDrive, validated),
              ElementsAre("level of detail tray was not validated; validated are planar"));
}

TEST(DistributionTest, LargestIsNeverExceeded) {
  for (const Distribution& distribution : {Distribution{Distribution::Kind::kFixed, 0.3, 0.0},
                                           Distribution{Distribution::Kind::kUniform, -0.1, 0.2},
                                           Distribution{Distribution::Kind::kNormal, 0.1, 0.05}}) {
    base::Rng rng(3);
    for (int i = 0; i < 1000; ++i) EXPECT_LE(distribution.Sample(&rng), distribution.Largest());
  }
}

}  // namespace
}  // namespace hires::imagination::validated_test
