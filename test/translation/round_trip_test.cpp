// Symbols become geometry and symbols again: both ways must agree, for all areas, postures, hands.
#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/knowledge/state_view.h"
#include "hires/translation/classification.h"
#include "support/restaurant_translation.h"

namespace hires::translation::round_trip_test {
namespace {

using base::Atom;
using test_support::RestaurantContext;
using test_support::Texts;

std::vector<std::string> NamesOfKind(AreaKind kind) {
  std::vector<std::string> names;
  for (const Area& area : RestaurantContext().areas.all) {
    if (area.kind == kind) names.push_back(area.name);
  }
  return names;
}

template <typename Map>
std::vector<std::string> KeysAnd(const Map& map, const std::string& more) {
  std::vector<std::string> keys = {more};
  for (const auto& [key, unused] : map) keys.push_back(key);
  return keys;
}

const std::string& AnyOf(const std::vector<std::string>& names, base::Rng* rng) {
  return names[rng->Index(static_cast<int>(names.size()))];
}

/// A state that makes sense: every object in one place, at most three on the tray.
std::vector<Atom> AnyState(base::Rng* rng) {
  const robot::UpperBodyProfile& body = *RestaurantContext().robot->profile.upper_body;
  auto standing = NamesOfKind(AreaKind::kStanding);
  standing.push_back(NamesOfKind(AreaKind::kRoom)[0]);
  auto placing = NamesOfKind(AreaKind::kPlacing);
  placing.push_back(kTrayArea);
  std::vector<Atom> atoms = {
      {"RobotAt", {AnyOf(standing, rng)}},
      {"HasTorsoPosture", {AnyOf(KeysAnd(body.torso_postures, "torsoposture"), rng)}}};
  std::vector<std::string> objects = {"mug1",  "peppermill1", "mug2",
                                      "vase1", "bowl1",       "wine_glass1"};
  for (const auto& [name, arm] : body.arms) {
    atoms.push_back(
        {"HasArmPosture", {name, AnyOf(KeysAnd(arm.postures, "armunnamedposture"), rng)}});
    const bool holds = rng->Bernoulli(0.5);
    atoms.push_back({"Holding", {name, holds ? objects.back() : "nothing"}});
    if (holds) objects.pop_back();
  }
  int on_tray = 0;
  for (const std::string& object : objects) {
    std::string place = AnyOf(placing, rng);
    if (place == kTrayArea && ++on_tray > 3) place = placing.front();
    if (rng->Bernoulli(0.7)) atoms.push_back({"On", {object, place}});
  }
  return atoms;
}

TEST(RoundTripTest, WhatIsBuiltFromAtomsStandsForTheSameAtoms) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    base::Rng rng(seed);
    const auto atoms = AnyState(&rng);
    const GeometricState state = StateOf(RestaurantContext(), nullptr, atoms);
    ASSERT_EQ(Texts(AtomsOf(RestaurantContext(), state)), Texts(atoms)) << "seed " << seed;
  }
}

TEST(RoundTripTest, WhatWasSeenChangesNothingAboutTheAtoms) {
  std::vector<knowledge::Fluent> fluents = test_support::RestaurantFluents();
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng(1000 + seed);
    const auto atoms = AnyState(&rng);
    knowledge::LiveView view(fluents, 1);
    const GeometricState state = StateOf(RestaurantContext(), &view, atoms);
    std::vector<std::string> wanted = Texts(atoms);
    for (const std::string& atom : Texts(AtomsOf(RestaurantContext(), state))) {
      // The room is where a robot is that was seen there, and objects that no atom names stay.
      if (atom == "RobotAt(nearstartarea1)") continue;
      if (atom.rfind("On(", 0) == 0 && atom.find("counter1)") != std::string::npos) continue;
      EXPECT_THAT(wanted, testing::Contains(atom)) << "seed " << seed;
    }
  }
}

TEST(RoundTripTest, ObjectsThatArePutSomewhereDoNotOverlap) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng(2000 + seed);
    const auto objects = StateOf(RestaurantContext(), nullptr, AnyState(&rng)).world.objects;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!objects[i].attached_to.empty() || !objects[j].attached_to.empty()) continue;
        const Eigen::Vector3d way = objects[i].X_MO.translation - objects[j].X_MO.translation;
        EXPECT_GT(way.norm(), 0.07) << objects[i].name << ", " << objects[j].name << ", " << seed;
      }
    }
  }
}

TEST(RoundTripTest, TheSameAtomsGiveTheSameBits) {
  base::Rng rng(7);
  const auto atoms = AnyState(&rng);
  const auto one = StateOf(RestaurantContext(), nullptr, atoms);
  const auto two = StateOf(RestaurantContext(), nullptr, atoms);
  EXPECT_TRUE(one.robot == two.robot);
  ASSERT_EQ(one.world.objects.size(), two.world.objects.size());
  for (std::size_t i = 0; i < one.world.objects.size(); ++i) {
    EXPECT_EQ(one.world.objects[i].X_MO.translation, two.world.objects[i].X_MO.translation);
    EXPECT_EQ(one.world.objects[i].X_MO.rotation.coeffs(),
              two.world.objects[i].X_MO.rotation.coeffs());
  }
}

TEST(RoundTripTest, AHeldObjectIsUprightWhereverTheArmCarriesIt) {
  for (const char* arm : {"leftarm1", "rightarm1"}) {
    const std::vector<Atom> atoms = {{"RobotAt", {"nearstartarea1"}},
                                     {"HasArmPosture", {arm, "armcarryposture"}},
                                     {"Holding", {arm, "mug1"}}};
    const GeometricState state = StateOf(RestaurantContext(), nullptr, atoms);
    ASSERT_EQ(state.world.objects.size(), 1u);
    EXPECT_LT(geometry::TiltOf(state.world.objects[0].X_MO.rotation), 0.35) << arm;
  }
}

}  // namespace
}  // namespace hires::translation::round_trip_test
