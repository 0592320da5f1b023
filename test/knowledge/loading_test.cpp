#include "hires/knowledge/loading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/error.h"
#include "knowledge/support/restaurant_world.h"
#include "knowledge/support/store_world.h"

namespace hires::knowledge::loading_test {
namespace {

using test_support::At;
using test_support::PoseAt;
using test_support::SmallOntology;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

PoseModification Shift(const std::string& instance, double delta,
                       std::vector<std::string> attachments = {}) {
  return {instance, "group", 1, {{"hasX", {delta}}}, std::move(attachments)};
}

class LoadingTest : public ::testing::Test {
 protected:
  double X(const std::string& instance) {
    const std::optional<Fluent> pose = store_.Find(instance);
    if (!pose) return std::nan("");
    for (const Property& property : pose->properties) {
      if (property.role == "hasX") return std::get<double>(property.filler);
    }
    return std::nan("");
  }
  LoadSummary LoadFile(const KnowledgeFile& file) {
    return Load(file, base::Rng(1), At(0.0), &store_);
  }
  Store store_{":memory:", SmallOntology()};
};

TEST_F(LoadingTest, TheSummaryCountsWhatWasNewByConcept) {
  EXPECT_THAT(LoadFile({{PoseAt("p1", 1.0)}, {}, {}}).concepts, ElementsAre(Pair("Pose", 1u)));
  const LoadSummary again = LoadFile({{PoseAt("p1", 1.0), PoseAt("p2", 2.0)}, {}, {}});
  EXPECT_THAT(again.concepts, ElementsAre(Pair("Pose", 1u)));
  EXPECT_EQ(again.known, 1u);
}

TEST_F(LoadingTest, PosesOfTheFileMoveBeforeTheyGoIn) {
  const LoadSummary summary = LoadFile({{PoseAt("p1", 1.0)}, {Shift("p1", 0.5)}, {}});
  EXPECT_EQ(summary.modifications, 1u);
  EXPECT_EQ(X("p1"), 1.5);
  EXPECT_EQ(store_.last_sequence(), 1u);
}

TEST_F(LoadingTest, PosesOfTheStoreMoveWithWhatIsAttached) {
  LoadFile({{PoseAt("p1", 1.0), PoseAt("p2", 2.0)}, {}, {}});
  LoadFile({{}, {Shift("p1", 0.5, {"p2"})}, {}});
  EXPECT_EQ(X("p1"), 1.5);
  EXPECT_EQ(X("p2"), 2.5);
}

TEST_F(LoadingTest, APoseOfTheStoreMayBeSpelledInAnotherCase) {
  LoadFile({{PoseAt("poseMug1", 1.0), PoseAt("p2", 2.0)}, {}, {}});
  LoadFile({{}, {Shift("POSEMUG1", 0.5, {"P2"})}, {}});
  EXPECT_EQ(X("poseMug1"), 1.5);
  EXPECT_EQ(X("p2"), 2.5);
  EXPECT_EQ(store_.Stats().instances, 2u);
}

TEST_F(LoadingTest, WhatTheStoreRefusesIsSaidWithItsFileAndTheNearestName) {
  KnowledgeFile file = ReadKnowledge(
      "!Fluent\nClass_Instance: [Posse, p1]\nStartTime: [0, 0]\nFinishTime: [0, 0]\n"
      "Properties: []\n",
      "/home/me/rooms.yaml");
  const auto error = [&] {
    try {
      LoadFile(file);
    } catch (const base::ConfigError& refused) {
      return std::string(refused.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error(),
            "/home/me/rooms.yaml: document 1, line 1: fluent 'p1': concept 'Posse' is unknown; did "
            "you mean 'Pose'?");
  file.source.clear();
  file.places.clear();
  EXPECT_THAT(error(), ::testing::StartsWith("fluent 'p1'"));
  EXPECT_EQ(store_.last_sequence(), 0u);
}

std::string PoseText(const std::string& name, const std::string& property) {
  return "---\n!Fluent\nClass_Instance: [Pose, " + name +
         "]\nStartTime: [0, 0]\nFinishTime: [0, 0]\nProperties:\n  - " + property + "\n";
}

TEST_F(LoadingTest, AllFluentsThatCannotBeAreToldAtOnceWithTheirPlaces) {
  std::string text = PoseText("p1", "[hasXX, \"xsd:float\", 1.0]") +
                     PoseText("p2", "[hasX, \"xsd:float\", 1.0]") +
                     PoseText("p3", "[hasX, \"xsd:string\", far]");
  try {
    LoadFile(ReadKnowledge(text, "rooms.yaml"));
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rooms.yaml: document 1, line 2: fluent 'p1'"));
    EXPECT_THAT(error.what(), HasSubstr("\nrooms.yaml: document 3, line 16: fluent 'p3'"));
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("'p2'")));
  }
  EXPECT_EQ(store_.last_sequence(), 0u);
  for (int i = 0; i < 60; ++i) text += PoseText("q", "[hasY, Pose, p]");
  try {
    LoadFile(ReadKnowledge(text, "rooms.yaml"));
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::EndsWith("\nand 12 more"));
  }
}

TEST_F(LoadingTest, WhatAFileLinksToAsOneConceptAndDeclaresAsAnotherIsRefused) {
  const auto load = [&](const std::string& target, const std::string& concept_name) {
    Store store(":memory:", test_support::RestaurantOntology());
    const Fluent cup = test_support::MakeFluent("Mug", "mug1", {{"hasPose", "Pose", target}});
    const Fluent other = test_support::MakeFluent(concept_name, "PoseMug1");
    Load({{cup, other}, {}, {}}, base::Rng(1), At(0.0), &store);
  };
  EXPECT_NO_THROW(load("poseMug1", "Pose"));
  EXPECT_NO_THROW(load("poseMug1", "SpatialEntity"));  // a wider word for it
  EXPECT_NO_THROW(load("poseMug2", "Mug"));            // another file may say what that is
  EXPECT_THROW(load("poseMug1", "Mug"), base::ConfigError);
  EXPECT_THROW(load("mug1", "Pose"), base::ConfigError);
}

TEST_F(LoadingTest, AnglesOfMoreThanATurnAreRefusedAsDegrees) {
  Store store(":memory:", test_support::RestaurantOntology());
  const auto error = [&](const Filler& yaw) {
    Fluent pose = PoseAt("p1", 1.0);
    pose.properties.push_back({"hasYaw", "xsd:float", yaw});
    try {
      Load({{pose}, {}, {}}, base::Rng(1), At(0.0), &store);
    } catch (const base::ConfigError& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  for (const double yaw : {0.0, 3.15, -6.28, 6.2832}) EXPECT_EQ(error(yaw), "") << yaw;
  EXPECT_THAT(error(90.0), HasSubstr("is 90, more than a turn, wanted radians between -2 pi and 2 "
                                     "pi; 90 degrees are 1.5708"));
  EXPECT_THAT(error(-180.0), HasSubstr("-180 degrees are -3.1416"));
  EXPECT_THAT(error(std::int64_t{45}), HasSubstr("is 45, more than a turn"));
}

TEST_F(LoadingTest, APoseNobodyKnowsIsNamedAndNothingGoesIn) {
  try {
    LoadFile({{PoseAt("p1", 1.0)}, {Shift("p9", 0.5)}, {}});
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p9"));
  }
  EXPECT_EQ(store_.last_sequence(), 0u);
}

TEST_F(LoadingTest, TopicsAreTold) {
  EXPECT_THAT(LoadFile({{}, {}, {{"areas", {}, {"Pose"}, {}, {}, false, {}}}}).topics,
              ElementsAre("areas"));
}

}  // namespace
}  // namespace hires::knowledge::loading_test
