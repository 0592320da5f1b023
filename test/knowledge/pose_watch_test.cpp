#include "hires/knowledge/pose_watch.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hires/knowledge/live_view.h"

namespace hires::knowledge::pose_watch_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string kConfig = HIRES_SOURCE_DIR "/config/ontology/";

class PoseWatchTest : public ::testing::Test {
 protected:
  PoseWatchTest()
      : ontology_(Ontology::FromFiles({kConfig + "upper.ttl", kConfig + "race.ttl"})),
        watch_(&ontology_, {0.02, 0.1}) {
    Put("Mug", "Mug1", {{"hasPose", "Pose", "poseMug1"}});
    PutPose("poseMug1", 1.0, 2.0, 0.75, 0.0);
    Put("Robot", "PR21", {{"hasPose", "Pose", "posePR21"}});
    PutPose("posePR21", 5.0, 5.0, 0.0, 0.0);
    Put("TrayArea", "trayArea1", {});
    Put("PlacingArea", "area1", {});
    EXPECT_THAT(watch_.Update(view_), IsEmpty()) << "all is new at first";
  }

  void Put(const std::string& concept_name, const std::string& instance,
           std::vector<Property> properties) {
    Apply(Change::Kind::kAdded, {concept_name, instance, std::move(properties), {}, {}});
  }
  void PutPose(const std::string& instance, double x, double y, double z, double yaw,
               const std::string& frame = "") {
    std::vector<Property> properties{{"hasX", "xsd:float", x},
                                     {"hasY", "xsd:float", y},
                                     {"hasZ", "xsd:float", z},
                                     {"hasYaw", "xsd:float", yaw}};
    if (!frame.empty()) properties.push_back({"hasFrame", "xsd:string", frame});
    Put("Pose", instance, std::move(properties));
  }
  void Remove(const std::string& instance) {
    Apply(Change::Kind::kRemoved, {"", instance, {}, {}, {}});
  }
  void Apply(Change::Kind kind, Fluent fluent) {
    Change change;
    change.sequence = ++sequence_;
    change.kind = kind;
    change.fluent = std::move(fluent);
    view_.Apply(change);
  }

  const Ontology ontology_;
  LiveView view_{std::vector<Fluent>(), 0};
  std::uint64_t sequence_{0};
  PoseWatch watch_;
};

TEST_F(PoseWatchTest, NoiseIsNotTold) {
  PutPose("poseMug1", 1.01, 2.01, 0.755, -0.09);
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
}

TEST_F(PoseWatchTest, MotionsAndTurnsAreToldOnce) {
  PutPose("poseMug1", 1.03, 2.0, 0.75, 0.0);
  EXPECT_THAT(watch_.Update(view_), ElementsAre("mug1"));
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
  PutPose("poseMug1", 1.03, 2.0, 0.75, 0.2);
  EXPECT_THAT(watch_.Update(view_), ElementsAre("mug1"));
}

TEST_F(PoseWatchTest, AWholeTurnIsNone) {
  PutPose("poseMug1", 1.0, 2.0, 0.75, 6.28);
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
}

TEST_F(PoseWatchTest, CreepingIsMeasuredFromWhatWasToldLast) {
  PutPose("poseMug1", 1.015, 2.0, 0.75, 0.0);
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
  PutPose("poseMug1", 1.030, 2.0, 0.75, 0.0);
  EXPECT_THAT(watch_.Update(view_), ElementsAre("mug1"));
}

TEST_F(PoseWatchTest, WhatAppearsAndWhatVanishesIsTold) {
  Put("Bowl", "bowl1", {{"hasPose", "Pose", "poseBowl1"}});
  EXPECT_THAT(watch_.Update(view_), IsEmpty()) << "nobody knows where";
  PutPose("poseBowl1", 7.5, 11.2, 0.73, 0.0);
  EXPECT_THAT(watch_.Update(view_), ElementsAre("bowl1"));
  Remove("poseMug1");
  Remove("bowl1");
  EXPECT_THAT(watch_.Update(view_), ElementsAre("bowl1", "mug1"));
}

TEST_F(PoseWatchTest, TheRobotIsNotTold) {
  PutPose("posePR21", 6.0, 5.0, 0.0, 1.0);
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
}

TEST_F(PoseWatchTest, WhatTheRobotCarriesMayMoveInTheMapUntilItIsPutDown) {
  Put("Holding", "holdingLeftArm1", {{"hasPassiveObject", "Mug", "mug1"}});
  PutPose("poseMug1", 4.0, 2.0, 0.9, 0.0);
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
  Remove("holdingLeftArm1");
  Put("On", "onMug1", {{"hasPhysicalEntity", "Mug", "mug1"}, {"hasArea", "TrayArea", "trayArea1"}});
  PutPose("poseMug1", 4.1, 2.0, 0.35, 0.0);
  EXPECT_THAT(watch_.Update(view_), IsEmpty());
  Put("On", "onMug1", {{"hasPhysicalEntity", "Mug", "mug1"}, {"hasArea", "PlacingArea", "area1"}});
  PutPose("poseMug1", 7.5, 11.2, 0.73, 0.0);
  EXPECT_THAT(watch_.Update(view_), ElementsAre("mug1"));
}

TEST_F(PoseWatchTest, WhatSlidesOnTheTrayIsToldWhereItsPoseIsTheTrays) {
  Put("On", "onMug1", {{"hasPhysicalEntity", "Mug", "mug1"}, {"hasArea", "TrayArea", "trayArea1"}});
  PutPose("poseMug1", 0.28, 0.0, 0.35, 0.0, "base_footprint");
  EXPECT_THAT(watch_.Update(view_), ElementsAre("mug1"));
  PutPose("poseMug1", 0.25, 0.0, 0.35, 0.0, "base_footprint");
  EXPECT_THAT(watch_.Update(view_), ElementsAre("mug1"));
}

}  // namespace
}  // namespace hires::knowledge::pose_watch_test
