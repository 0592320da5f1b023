#include "hires/sensing/object_memory.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/robot/gripper.h"
#include "hires/world/unknown_box.h"
#include "support/sight_scenes.h"

namespace hires::sensing::object_memory_test {
namespace {

using geometry::Pose3;
using perception::Detect;
using perception::Detection;
using perception::DetectorParams;
using perception::LineOfSight;
using perception::ShapesOf;
using perception::Surroundings;
using perception::ViewOf;
using test_support::At;
using test_support::Thing;
using testing::ElementsAre;
using testing::IsEmpty;

const robot::Robot& Pr2() {
  static const robot::Robot pr2 = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
  return pr2;
}

/// A PR2 at the origin of an empty room, what there really is, and what it remembers of it.
class ObjectMemoryTest : public testing::Test {
 protected:
  ObjectMemoryTest() {
    body_.joints = Pr2().profile.joints;
    SetGap("rightarm1", 0.0);
    SetGap("leftarm1", 0.0);
    body_.joints["head_pan_joint"] = 0.0;
    LookDown(0.5);
    PutArm("leftarm1", "armtosideposture");
    PutArm("rightarm1", "armtosideposture");
  }

  static std::shared_ptr<const Surroundings> MakeSurroundings() {
    world::World world = test_support::SightWorld();
    world.statics.clear();
    return std::make_shared<Surroundings>(world);
  }

  void LookDown(double tilt) { body_.joints["head_tilt_joint"] = tilt; }
  void PutArm(const std::string& name, const std::string& posture) {
    const robot::ArmProfile& arm = Pr2().profile.upper_body->arms.at(name);
    const auto& positions = arm.postures.at(posture)[0];
    for (std::size_t i = 0; i < positions.size(); ++i) body_.joints[arm.joints[i]] = positions[i];
  }
  void SetGap(const std::string& name, double gap) {
    const robot::UpperBodyProfile& upper = *Pr2().profile.upper_body;
    robot::SetGap(upper.gripper, upper.arms.at(name), gap, &body_.joints);
  }
  Pose3 X_ML(const std::string& link) const {
    const auto X_RL = robot::ForwardKinematics(Pr2().model, body_.joints);
    return geometry::Lift(body_.X_MB) *
           X_RL[*Pr2().model.FindLink(Pr2().profile.base_link)].Inverse() *
           X_RL[*Pr2().model.FindLink(link)];
  }

  /// A look at what there really is.
  void Look(const std::vector<world::ObjectState>& truth, double noise = 0.0) {
    body_.time += 0.5;
    const LineOfSight sight(surroundings_, truth, ShapesOf(Pr2(), body_.X_MB, body_.joints));
    const DetectorParams detector{0.3, noise, noise};
    memory_.Look(body_,
                 Detect(sight, ViewOf(Pr2(), body_.X_MB, body_.joints), truth, detector, &rng_));
  }
  /// Some time in which nothing moves.
  bool Rest() {
    bool has_changed = false;
    for (int i = 0; i < 10; ++i) {
      body_.time += 0.05;
      has_changed |= memory_.Feel(body_);
    }
    return has_changed;
  }
  Pose3 Remembered(const std::string& name) const {
    for (const robot::SeenObject& seen : memory_.Known(body_)) {
      if (seen.name == name) return seen.X_MO;
    }
    throw std::runtime_error("nothing is remembered of " + name);
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& [name, object] : memory_.objects()) names.push_back(name);
    return names;
  }
  /// Has the right hand take a mug that was seen between its fingers, upright.
  void Grasp() {
    PutArm("rightarm1", "armuntuckedposture");
    SetGap("rightarm1", 0.09);
    mug_ = Thing("mug1", "mug", {});
    mug_.X_MO.translation = X_ML("r_gripper_tool_frame").translation - Eigen::Vector3d(0, 0, 0.05);
    memory_.Believe("mug1", "mug", "", mug_.X_MO);
    Rest();
    SetGap("rightarm1", 0.079);
    ASSERT_TRUE(Rest());
    ASSERT_TRUE(memory_.objects().at("mug1").is_held);
  }

  std::shared_ptr<const Surroundings> surroundings_ = MakeSurroundings();
  ObjectMemory memory_{surroundings_, std::make_shared<const robot::Robot>(Pr2())};
  BodyReading body_;
  base::Rng rng_{5};
  world::ObjectState mug_;
};

TEST_F(ObjectMemoryTest, WhatWasSeenIsRememberedWhereItWasSeen) {
  Look({Thing("Mug1", "mug", At(1.5, 0.1, 0.7))});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_LT((Remembered("mug1").translation - Eigen::Vector3d(1.5, 0.1, 0.7)).norm(), 1e-9);
  EXPECT_EQ(memory_.objects().at("mug1").time, body_.time);
}

TEST_F(ObjectMemoryTest, ManyNoisyLooksSettleNearTheTruth) {
  const auto truth = {Thing("mug1", "mug", At(1.5, 0.1, 0.7))};
  for (int i = 0; i < 30; ++i) Look(truth, 0.005);
  double sum = 0.0;
  for (int i = 0; i < 200; ++i) {
    Look(truth, 0.005);
    sum += (Remembered("mug1").translation - Eigen::Vector3d(1.5, 0.1, 0.7)).squaredNorm();
  }
  // Blending by 0.3 leaves a share 0.3 / 1.7 of the variance 3 * 0.005^2; looks that count as a
  // move (0.04 m: 5 sd) hardly happen.
  EXPECT_NEAR(sum / 200, 3 * 2.5e-5 * 0.3 / 1.7, 6e-6);
}

TEST_F(ObjectMemoryTest, AMovedObjectIsBelievedAtOnce) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  Look({Thing("mug1", "mug", At(1.6, 0.1, 0.7))});
  EXPECT_NEAR(Remembered("mug1").translation.x(), 1.6, 1e-9);
}

TEST_F(ObjectMemoryTest, AnObjectVanishesAfterThreeLooksAtItsFreePlace) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  Look({});
  Look({});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_THAT(memory_.Vanished(), IsEmpty());
  Look({});
  EXPECT_THAT(Names(), IsEmpty());
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug1"));
  Look({Thing("mug1", "mug", At(1.5, 0.3, 0.7))});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_THAT(memory_.Vanished(), IsEmpty());
}

TEST_F(ObjectMemoryTest, ALookThatFindsItBetweenStartsTheCountAnew) {
  const auto mug = Thing("mug1", "mug", At(1.5, 0.1, 0.7));
  for (int i = 0; i < 5; ++i) {
    Look({mug});
    Look({});
    Look({});
  }
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

TEST_F(ObjectMemoryTest, WhatIsHiddenOrOutOfViewDoesNotVanish) {
  const auto mug = Thing("mug1", "mug", At(1.8, 0.0, 0.7));
  const auto screen = Thing("screen1", "screen", At(1.3, 0.0, 0.6));
  Look({mug});
  for (int i = 0; i < 5; ++i) Look({mug, screen});  // seen from above the screen's edge or not
  Look({screen});
  for (int i = 0; i < 5; ++i) Look({screen});
  EXPECT_THAT(Names(), ElementsAre("mug1", "screen1")) << "the screen hides its place";
  body_.joints["head_pan_joint"] = 1.5;
  for (int i = 0; i < 5; ++i) Look({});
  EXPECT_THAT(Names(), ElementsAre("mug1", "screen1")) << "the robot looked elsewhere";
}

TEST_F(ObjectMemoryTest, WhatMayBeHiddenBySomethingCloseBesideDoesNotVanish) {
  // The mug was seen first, the screen by another error of localisation: it may stand before it.
  const auto screen = Thing("screen1", "screen", At(1.3, -0.4, 0.6));  // up to y 0.1 m
  const Eigen::Vector3d p_MC = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.translation;
  const double edge = p_MC.y() + (0.1 - p_MC.y()) * (1.6 - p_MC.x()) / (1.3 - p_MC.x());
  memory_.Believe("mug1", "mug", "", At(1.6, edge + 0.05, 0.7));  // 0.04 m is its radius
  for (int i = 0; i < 5; ++i) Look({screen});
  EXPECT_THAT(Names(), ElementsAre("mug1", "screen1"));
  memory_.Believe("mug1", "mug", "", At(1.6, edge + 0.15, 0.7));
  for (int i = 0; i < 5; ++i) Look({screen});
  EXPECT_THAT(Names(), ElementsAre("screen1")) << "nothing hides that place";
}

TEST_F(ObjectMemoryTest, WhatIsFarAwayMayBeOverlooked) {
  memory_.Believe("mug1", "mug", "", At(2.2, 0.0, 0.7));
  for (int i = 0; i < 5; ++i) Look({});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  memory_.Believe("mug2", "mug", "", At(1.6, 0.0, 0.7));
  for (int i = 0; i < 5; ++i) Look({});
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "nobody overlooks what is near";
}

TEST_F(ObjectMemoryTest, TheOwnArmBeforeAnObjectDoesNotMakeItVanish) {
  PutArm("rightarm1", "armuntuckedposture");
  body_.joints["head_pan_joint"] = -0.7;  // towards the arm
  LookDown(0.9);
  // In the line from the camera through the forearm.
  const Pose3 X_MC = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC;
  const Eigen::Vector3d way =
      X_ML("r_forearm_link") * Eigen::Vector3d(0.15, 0.0, 0.0) - X_MC.translation;
  world::ObjectState mug = Thing("mug1", "mug", {});
  mug.X_MO.translation = X_MC.translation + (way.norm() + 0.25) * way.normalized();
  memory_.Believe("mug1", "mug", "", mug.X_MO);
  for (int i = 0; i < 5; ++i) Look({});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  PutArm("rightarm1", "armtosideposture");
  for (int i = 0; i < 5; ++i) Look({});
  EXPECT_THAT(Names(), IsEmpty());
}

TEST_F(ObjectMemoryTest, AGripperThatRestsOnAnObjectHoldsIt) {
  Grasp();
  EXPECT_EQ(memory_.objects().at("mug1").link, "r_gripper_palm_link");
  const Eigen::Vector3d p_PO =
      X_ML("r_gripper_palm_link").Inverse() * Remembered("mug1").translation;
  PutArm("rightarm1", "armcarryposture");
  body_.X_MB = {2.0, 1.0, 0.7};
  Rest();
  EXPECT_LT((X_ML("r_gripper_palm_link") * p_PO - Remembered("mug1").translation).norm(), 1e-9);
  for (const robot::SeenObject& seen : memory_.Known(body_)) {
    EXPECT_EQ(seen.attached_to, "r_gripper_palm_link");
  }
}

TEST_F(ObjectMemoryTest, WhatWasSeenBesideTheFingersIsBetweenThemWhenTheyHoldIt) {
  PutArm("rightarm1", "armuntuckedposture");
  const Eigen::Vector3d tool = X_ML("r_gripper_tool_frame").translation;
  Pose3 beside;
  beside.translation = tool + Eigen::Vector3d(0.12, 0.0, -0.05);  // 0.08 m from the mug's side
  memory_.Believe("mug1", "mug", "", beside);
  SetGap("rightarm1", 0.08);
  ASSERT_TRUE(Rest());
  const Eigen::Vector3d off = Remembered("mug1").translation - tool;
  EXPECT_NEAR(off.head<2>().lpNorm<Eigen::Infinity>(), 0.04, 1e-9) << "at the side of its box";
  memory_.Look(body_, {{"mug1", "mug",
                        ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse() * beside, 1.0}});
  EXPECT_TRUE(memory_.objects().at("mug1").is_held) << "seen within reach of the fingers";
}

TEST_F(ObjectMemoryTest, WhatFingersCloseOnIsInTheMiddleBetweenThem) {
  PutArm("rightarm1", "armuntuckedposture");
  const Pose3 X_MT = X_ML("r_gripper_tool_frame");
  Pose3 aside;  // the eye erred by 9 mm across and 4 mm along the fingers
  aside.translation = X_MT * Eigen::Vector3d(0.004, 0.009, 0.0) - Eigen::Vector3d(0.0, 0.0, 0.05);
  memory_.Believe("mug1", "mug", "", aside);
  SetGap("rightarm1", 0.079);
  ASSERT_TRUE(Rest());
  const Eigen::Vector3d middle = Remembered("mug1").translation + Eigen::Vector3d(0.0, 0.0, 0.05);
  const Eigen::Vector3d p_TO = X_MT.Inverse() * middle;
  EXPECT_NEAR(p_TO.x(), 0.004, 1e-6);
  EXPECT_NEAR(p_TO.y(), 0.0, 1e-6);
}

TEST_F(ObjectMemoryTest, AnObjectThatStandsAslantInTheHandIsHeld) {
  PutArm("rightarm1", "armuntuckedposture");
  memory_.Believe("mug1", "mug", "", X_ML("r_gripper_tool_frame"));
  SetGap("rightarm1", 0.087);  // 7 mm wider than the mug, 3 mm from open
  EXPECT_TRUE(Rest());
  EXPECT_TRUE(memory_.objects().at("mug1").is_held);
  SetGap("rightarm1", 0.09);
  EXPECT_TRUE(Rest());
  EXPECT_FALSE(memory_.objects().at("mug1").is_held);
}

TEST_F(ObjectMemoryTest, AnOpenGripperRoundAnObjectHoldsNothing) {
  PutArm("rightarm1", "armuntuckedposture");
  memory_.Believe("mug1", "mug", "", X_ML("r_gripper_tool_frame"));
  for (const double gap : {0.088, 0.09}) {
    SetGap("rightarm1", gap);
    EXPECT_FALSE(Rest()) << gap;
  }
}

TEST_F(ObjectMemoryTest, AGripperThatIsStillClosingHoldsNothingYet) {
  PutArm("rightarm1", "armuntuckedposture");
  memory_.Believe("mug1", "mug", "", X_ML("r_gripper_tool_frame"));
  for (double gap = 0.09; gap > 0.062; gap -= 0.0025) {  // 0.05 m/s
    SetGap("rightarm1", gap);
    body_.time += 0.05;
    EXPECT_FALSE(memory_.Feel(body_)) << gap;
  }
}

TEST_F(ObjectMemoryTest, AGripperThatClosesOnSomethingElseHoldsNothing) {
  PutArm("rightarm1", "armuntuckedposture");
  memory_.Believe("mug1", "mug", "", X_ML("r_gripper_tool_frame"));
  SetGap("rightarm1", 0.03);  // a mug is 0.08 m wide
  EXPECT_FALSE(Rest());
  memory_.Believe("mug1", "mug", "", At(3.0, 0.0, 0.5));
  SetGap("rightarm1", 0.08);  // right width, wrong place
  EXPECT_FALSE(Rest());
}

TEST_F(ObjectMemoryTest, AHandThatOpensLetsGoWhereItIs) {
  Grasp();
  const Eigen::Vector3d before = Remembered("mug1").translation;
  SetGap("rightarm1", 0.088);
  EXPECT_TRUE(Rest());
  EXPECT_FALSE(memory_.objects().at("mug1").is_held);
  PutArm("rightarm1", "armtosideposture");
  Rest();
  EXPECT_LT((Remembered("mug1").translation - before).norm(), 1e-9);
}

TEST_F(ObjectMemoryTest, AnObjectThatSlippedOutIsGone) {
  Grasp();
  SetGap("rightarm1", 0.0);
  EXPECT_TRUE(Rest());
  EXPECT_THAT(Names(), IsEmpty());
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug1"));
}

TEST_F(ObjectMemoryTest, AHeldObjectThatIsSeenElsewhereIsNotHeld) {
  Grasp();
  Look({Thing("mug1", "mug", At(1.6, 0.2, 0.7))});
  EXPECT_FALSE(memory_.objects().at("mug1").is_held);
  EXPECT_NEAR(Remembered("mug1").translation.x(), 1.6, 1e-9);
}

TEST_F(ObjectMemoryTest, WhatStandsOnTheTrayTravelsWithTheBase) {
  LookDown(1.2);
  Look({Thing("mug1", "mug", At(0.28, 0.1, 0.3462))});
  ASSERT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_EQ(memory_.objects().at("mug1").link, Pr2().profile.base_link);
  body_.X_MB = {1.0, 2.0, geometry::kPi / 2};
  EXPECT_LT((Remembered("mug1").translation - Eigen::Vector3d(0.9, 2.28, 0.3462)).norm(), 1e-9);
  // It slides off, and is seen on the floor behind.
  body_.X_MB = {};
  Look({Thing("mug1", "mug", At(1.5, 0.0, 0.0))});
  EXPECT_EQ(memory_.objects().at("mug1").link, "");
}

TEST_F(ObjectMemoryTest, HearsayCountsUntilSomethingIsObserved) {
  memory_.Believe("mug1", "mug", "", At(1.5, 0.1, 0.7));
  EXPECT_FALSE(memory_.objects().at("mug1").is_observed);
  Look({Thing("mug1", "mug", At(1.52, 0.1, 0.7))});
  EXPECT_NEAR(Remembered("mug1").translation.x(), 1.52, 1e-9) << "seen, not blended with hearsay";
  memory_.Believe("mug1", "mug", "", At(9.0, 9.0, 0.7));
  memory_.Disbelieve("mug1");
  EXPECT_NEAR(Remembered("mug1").translation.x(), 1.52, 1e-9);
  memory_.Believe("mug2", "mug", "", At(3.0, 1.0, 0.7));
  memory_.Disbelieve("Mug2");
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

TEST_F(ObjectMemoryTest, HearsayThatIsLookedAtInVainVanishes) {
  memory_.Believe("mug1", "mug", "", At(1.5, 0.1, 0.7));
  for (int i = 0; i < 3; ++i) Look({});
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug1"));
  memory_.Believe("mug1", "mug", "", At(1.5, 0.1, 0.7));
  EXPECT_THAT(Names(), IsEmpty()) << "who has looked knows better";
}

TEST_F(ObjectMemoryTest, WhatIsSaidToBeInTheHandIsThereAsLongAsTheFingersFeelIt) {
  SetGap("rightarm1", 0.08);
  memory_.Believe("mug1", "mug", "r_gripper_palm_link", At(0.18, 0.0, -0.04));
  EXPECT_FALSE(Rest());
  EXPECT_TRUE(memory_.objects().at("mug1").is_held);
  SetGap("rightarm1", 0.0);
  EXPECT_TRUE(Rest());
  EXPECT_THAT(Names(), IsEmpty());
}

TEST_F(ObjectMemoryTest, AnotherObjectIsNotTakenIntoAHandThatIsFull) {
  Grasp();
  memory_.Believe("mug2", "mug", "", X_ML("r_gripper_tool_frame"));
  EXPECT_FALSE(Rest());
  EXPECT_FALSE(memory_.objects().at("mug2").is_held);
}

TEST_F(ObjectMemoryTest, ABadLookLeavesTheMemoryAsItWas) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  EXPECT_THROW(memory_.Look(body_, {{"teapot1", "teapot", At(1, 0, 0), 1.0}}), base::ConfigError);
  EXPECT_THROW(memory_.Look(body_, {{"mug2", "mug", At(std::nan(""), 0, 0), 1.0}}),
               base::ConfigError);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_THROW(memory_.Believe("mug2", "mugg", "", {}), base::ConfigError);
  EXPECT_THROW(memory_.Believe("mug2", "mug", "r_palm", {}), base::ConfigError);
}

TEST_F(ObjectMemoryTest, ARobotWithoutHandsFeelsNothing) {
  ObjectMemory memory(surroundings_,
                      std::make_shared<const robot::Robot>(test_support::TrayRobot()));
  EXPECT_FALSE(memory.Feel({}));
  memory.Believe("mug1", "mug", "", At(1.0, 0.0, 0.5));
  EXPECT_EQ(memory.Known({}).size(), 1u);
}

// ---- Recognisers that know kinds alone.

class NamelessTest : public ObjectMemoryTest {
 protected:
  /// A look in which mugs are seen there, whoever they are.
  void SeeMugs(const std::vector<Pose3>& X_MOs) {
    body_.time += 0.5;
    const Pose3 X_CM = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse();
    std::vector<Detection> detections;
    for (const Pose3& X_MO : X_MOs) {
      Detection detection;
      detection.label = "mug";
      detection.X_CO = X_CM * X_MO;
      detections.push_back(detection);
    }
    memory_.Look(body_, detections);
  }
};

TEST_F(NamelessTest, AThingNearTheOneObjectOfItsKindIsThatObject) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  SeeMugs({At(1.5, 0.17, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_NEAR(Remembered("mug1").translation.y(), 0.17, 1e-9);
  EXPECT_EQ(memory_.objects().at("mug1").time, body_.time);
}

TEST_F(NamelessTest, WhatAHandLiftsIsNotSeenToStandOnTheTable) {
  Grasp();
  const Pose3 held = Remembered("mug1");
  Pose3 below = held;  // a recogniser takes all things for standing on the table
  below.translation += Eigen::Vector3d(0.01, 0.0, -0.06);
  for (int i = 0; i < 5; ++i) SeeMugs({below});
  EXPECT_TRUE(memory_.objects().at("mug1").is_held);
  const Eigen::Vector3d p_M = Remembered("mug1").translation;
  EXPECT_NEAR(p_M.z(), held.translation.z(), 1e-9) << "how high it is in the hand, the grasp told";
  EXPECT_GT(p_M.x() - held.translation.x(), 0.008) << "where it is sideways, looks tell";
  EXPECT_LT(Remembered("mug1").rotation.angularDistance(held.rotation), 1e-6);
}

TEST_F(NamelessTest, AThingBetweenTwoObjectsOfItsKindIsNoneOfThem) {
  Look({Thing("mug1", "mug", At(1.5, 0.08, 0.7)), Thing("mug2", "mug", At(1.5, -0.08, 0.7))});
  const double before = body_.time;
  for (int i = 0; i < 4; ++i) SeeMugs({At(1.5, 0.0, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2")) << "one of them is there: none is missed";
  EXPECT_EQ(memory_.objects().at("mug1").time, before);
  EXPECT_EQ(memory_.num_ambiguous(), 1);
  EXPECT_EQ(memory_.num_newcomers(), 1) << "another look may tell";
  SeeMugs({At(1.5, 0.07, 0.7)});
  EXPECT_EQ(memory_.num_newcomers(), 0);
}

TEST_F(NamelessTest, TwoThingsNearOneObjectAreNotTold) {
  Look({Thing("mug1", "mug", At(1.5, 0.0, 0.7))});
  SeeMugs({At(1.5, 0.08, 0.7), At(1.5, -0.08, 0.7)});
  EXPECT_NEAR(Remembered("mug1").translation.y(), 0.0, 1e-9);
}

TEST_F(NamelessTest, OfSeveralKindsEachFindsItsOwn) {
  Look({Thing("mug1", "mug", At(1.5, 0.05, 0.7)), Thing("jug1", "jug", At(1.5, -0.12, 0.7))});
  SeeMugs({At(1.5, -0.02, 0.7)});
  EXPECT_NEAR(Remembered("mug1").translation.y(), -0.02, 1e-9);
  EXPECT_NEAR(Remembered("jug1").translation.y(), -0.12, 1e-9);
}

TEST_F(NamelessTest, AThingThatVanishedIsTheOneThatAppearsElsewhere) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  for (int i = 0; i < 2; ++i) SeeMugs({At(1.5, -0.4, 0.7)});
  EXPECT_NEAR(Remembered("mug1").translation.y(), 0.1, 1e-9) << "not yet missed for long enough";
  SeeMugs({At(1.5, -0.4, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_THAT(memory_.Vanished(), IsEmpty());
  EXPECT_NEAR(Remembered("mug1").translation.y(), -0.4, 1e-9);
}

TEST_F(NamelessTest, WhatWasToldAndNeverSeenIsTheThingNearby) {
  memory_.Believe("mug1", "mug", "", At(1.5, -1.15, 0.7));  // out of view, so it is not missed
  for (int i = 0; i < 2; ++i) SeeMugs({At(1.5, -0.75, 0.7)});
  EXPECT_FALSE(memory_.objects().at("mug1").is_observed) << "not yet seen for long enough";
  SeeMugs({At(1.5, -0.75, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_NEAR(Remembered("mug1").translation.y(), -0.75, 1e-9);
}

TEST_F(NamelessTest, WhatWasToldIsTheNearerThingThoughAnotherWasSeenForLonger) {
  memory_.Believe("mug1", "mug", "", At(1.5, -1.15, 0.7));  // out of view, so it is not missed
  const Pose3 nearer = At(1.5, -0.9, 0.7), farther = At(1.5, -0.7, 0.7);
  for (int i = 0; i < 2; ++i) SeeMugs({farther});
  for (int i = 0; i < 2; ++i) {
    SeeMugs({farther, nearer});
    EXPECT_FALSE(memory_.objects().at("mug1").is_observed) << "the nearer one may be it";
    EXPECT_EQ(memory_.num_ambiguous(), 1);
    EXPECT_THAT(Names(), ElementsAre("mug1"));
  }
  SeeMugs({farther, nearer});
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2"));
  EXPECT_NEAR(Remembered("mug1").translation.y(), -0.9, 1e-9);
  EXPECT_NEAR(Remembered("mug2").translation.y(), -0.7, 1e-9);
}

TEST_F(NamelessTest, APieceOfTheSameThingIsNoNearerThing) {
  memory_.Believe("mug1", "mug", "", At(1.5, -1.15, 0.7));  // out of view, so it is not missed
  for (int i = 0; i < 2; ++i) SeeMugs({At(1.5, -0.75, 0.7)});
  SeeMugs({At(1.5, -0.75, 0.7), At(1.5, -0.76, 0.7)});
  EXPECT_TRUE(memory_.objects().at("mug1").is_observed);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

TEST_F(NamelessTest, WhatWasToldToBeFarAwayIsNotTheThingSeenHere) {
  memory_.Believe("mug1", "mug", "", At(1.5, -1.35, 0.7));
  for (int i = 0; i < 3; ++i) SeeMugs({At(1.5, -0.75, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2"));
  EXPECT_FALSE(memory_.objects().at("mug1").is_observed);
}

TEST_F(NamelessTest, WhatWasSeenIsNotTheThingNearby) {
  Look({Thing("mug1", "mug", At(1.5, -0.7, 0.7))});
  body_.X_MB.yaw = 0.3;  // mug1 is out of view
  for (int i = 0; i < 3; ++i) SeeMugs({At(1.5, -0.3, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2"));
  EXPECT_NEAR(Remembered("mug1").translation.y(), -0.7, 1e-9);
}

TEST_F(NamelessTest, AThingMoreThanWereKnownGetsTheNextNameAfterSomeLooks) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  for (int i = 0; i < 2; ++i) SeeMugs({At(1.5, 0.1, 0.7), At(1.5, -0.2, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  SeeMugs({At(1.5, -0.2, 0.7), At(1.5, 0.1, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2"));
  EXPECT_NEAR(Remembered("mug2").translation.y(), -0.2, 1e-9);
  for (int i = 0; i < 3; ++i) SeeMugs({At(1.5, 0.1, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "and vanishes as others do";
}

TEST_F(NamelessTest, WhatHasNoNameYetIsCounted) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  EXPECT_EQ(memory_.num_newcomers(), 0);
  for (int i = 0; i < 2; ++i) {
    SeeMugs({At(1.5, 0.1, 0.7), At(1.5, -0.2, 0.7), At(1.5, -0.4, 0.7)});
    EXPECT_EQ(memory_.num_newcomers(), 2);
  }
  SeeMugs({At(1.5, 0.1, 0.7), At(1.5, -0.2, 0.7), At(1.5, 0.4, 0.7)});
  EXPECT_THAT(Names(), ElementsAre("mug1", "mug2"));
  EXPECT_EQ(memory_.num_newcomers(), 1);
}

TEST_F(NamelessTest, AThingThatIsSeenOnceIsNothing) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  for (int i = 0; i < 5; ++i) {
    SeeMugs({At(1.5, 0.1, 0.7), At(1.5, -0.2, 0.7)});
    SeeMugs({At(1.5, 0.1, 0.7)});
  }
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

TEST_F(NamelessTest, WhatIsNotOnTheTableThatWasLookedAtIsNotMissed) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7)), Thing("mug2", "mug", At(1.5, -0.2, 0.7))});
  const Pose3 X_CM = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse();
  const std::vector<Eigen::Vector3d> half{
      X_CM * Eigen::Vector3d(1.2, -0.5, 0.7), X_CM * Eigen::Vector3d(1.8, -0.5, 0.7),
      X_CM * Eigen::Vector3d(1.8, 0.0, 0.7), X_CM * Eigen::Vector3d(1.2, 0.0, 0.7)};
  for (int i = 0; i < 3; ++i) {
    body_.time += 0.5;
    memory_.Look(body_, {}, half);
  }
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "mug2 stood on it";
}

TEST_F(NamelessTest, WhatIsTooFarForACloudIsNotMissedInIt) {
  Look({Thing("mug1", "mug", At(2.6, 0.1, 0.7))});
  const Pose3 X_CM = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse();
  const std::vector<Eigen::Vector3d> table{
      X_CM * Eigen::Vector3d(2.2, -0.5, 0.7), X_CM * Eigen::Vector3d(2.9, -0.5, 0.7),
      X_CM * Eigen::Vector3d(2.9, 0.5, 0.7), X_CM * Eigen::Vector3d(2.2, 0.5, 0.7)};
  for (int i = 0; i < 5; ++i) {
    body_.time += 0.5;
    memory_.Look(body_, {}, table);
  }
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

/// Looks in which it is in doubt whether a jug stands there.
class DoubtfulTest : public NamelessTest {
 protected:
  void LookOften(const Pose3& X_MO, double confidence, decltype(Detection::alternatives) others) {
    Detection seen;
    seen.label = "jug";
    seen.X_CO = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse() * X_MO;
    seen.confidence = confidence;
    seen.alternatives = std::move(others);
    for (int i = 0; i < 6; ++i) {
      body_.time += 0.5;
      memory_.Look(body_, {seen});
    }
  }
};

TEST_F(DoubtfulTest, WhatLooksLikeSomethingElseForAWhileIsStillWhatItWas) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  LookOften(At(1.5, 0.1, 0.7), 0.8, {{"mug", 0.1}, {perception::kUnknownLabel, 0.1}});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  LookOften(At(1.5, 0.1, 0.7), 0.8, {});
  EXPECT_THAT(Names(), ElementsAre("jug1")) << "when there is no doubt, it is another thing";
}

TEST_F(DoubtfulTest, WhatIsSeenInsteadOfWhatWasToldIsThatOrAnother) {
  memory_.Believe("mug1", "mug", "", At(1.5, 0.1, 0.7));
  LookOften(At(1.5, 0.19, 0.7), 0.5, {{"mug", 0.25}});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_TRUE(memory_.objects().at("mug1").is_observed);
  EXPECT_NEAR(Remembered("mug1").translation.y(), 0.19, 1e-9);
}

TEST_F(DoubtfulTest, WhatIsHardlyWhatWasToldTakesItsPlace) {
  memory_.Believe("mug1", "mug", "", At(1.5, 0.1, 0.7));
  LookOften(At(1.5, 0.19, 0.7), 0.5, {{"mug", 0.05}});
  EXPECT_THAT(Names(), ElementsAre("jug1"));
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug1"));
}

TEST_F(NamelessTest, ATurnThatNobodyCanSeeIsNone) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  Pose3 turned = At(1.5, 0.1, 0.7);
  turned.rotation = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ());
  SeeMugs({turned});
  EXPECT_NEAR(Remembered("mug1").rotation.angularDistance(At(1.5, 0.1, 0.7).rotation), 0.0, 1e-6);
}

TEST_F(NamelessTest, WhatHasNoNameYetHidesWhatIsBehindIt) {
  const auto mug = Thing("mug1", "mug", At(1.5, 0.1, 0.7));
  Look({mug});
  const Pose3 X_CM = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse();
  Detection jug;
  jug.label = "jug";
  jug.X_CO = X_CM * At(1.34, 0.09, 0.7);
  for (int i = 0; i < 3; ++i) {
    body_.time += 0.5;
    memory_.Look(body_, {jug});
  }
  EXPECT_THAT(Names(), ElementsAre("jug1", "mug1"));
}

TEST_F(NamelessTest, WhatHasNoNameYetIsNotItsNeighbourThatOneLookOverlooks) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  SeeMugs({At(1.5, 0.1, 0.7), At(1.5, 0.0, 0.7)});
  SeeMugs({At(1.5, 0.001, 0.7)});
  EXPECT_NEAR(Remembered("mug1").translation.y(), 0.1, 1e-9);
}

TEST_F(NamelessTest, OneLookThatTakesANewThingForAnotherKindDoesNotNameIt) {
  Detection seen;
  seen.X_CO = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse() * At(1.5, 0.1, 0.7);
  for (const char* label : {"mug", "mug", "jug", "mug", "mug"}) {
    EXPECT_THAT(Names(), IsEmpty());
    seen.label = label;
    body_.time += 0.5;
    memory_.Look(body_, {seen});
  }
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

/// Looks at things of unknown kind, of which boxes alone are measured.
class UnknownThingTest : public NamelessTest {
 protected:
  struct Seen {
    Pose3 X_MO;
    Eigen::Vector3d size;
    std::string label = perception::kUnknownLabel;
    int num_points = 0;
    bool may_be_beside = false;
  };
  void See(const std::vector<Seen>& things) {
    body_.time += 0.5;
    const Pose3 X_CM = ViewOf(Pr2(), body_.X_MB, body_.joints).X_MC.Inverse();
    std::vector<Detection> detections;
    for (const Seen& thing : things) {
      Detection detection;
      detection.label = thing.label;
      detection.X_CO = X_CM * thing.X_MO;
      detection.size = thing.size;
      detection.num_points = thing.num_points;
      detection.may_be_beside = thing.may_be_beside;
      detections.push_back(detection);
    }
    memory_.Look(body_, detections);
  }
  const std::string& ModelOf(const std::string& name) const {
    return memory_.objects().at(name).model;
  }
  Pose3 Turned(double y, double yaw) const {
    Pose3 X_MO = At(1.5, y, 0.7);
    X_MO.rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    return X_MO;
  }
  const Eigen::Vector3d size_{0.12, 0.08, 0.2};
};

TEST_F(UnknownThingTest, AThingThatNoModelExplainsGetsNameAndBoxAfterSomeLooks) {
  for (int i = 0; i < 2; ++i) See({{At(1.5, 0.1, 0.7), size_}});
  EXPECT_THAT(Names(), IsEmpty());
  See({{At(1.5, 0.1, 0.7), size_}});
  EXPECT_THAT(Names(), ElementsAre("unknown1"));
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.120x0.080x0.200");
  EXPECT_LT((Remembered("unknown1").translation - Eigen::Vector3d(1.5, 0.1, 0.7)).norm(), 1e-9);
  for (int i = 0; i < 3; ++i) See({{At(1.5, 0.1, 0.7), size_}, {At(1.5, -0.3, 0.7), size_}});
  EXPECT_THAT(Names(), ElementsAre("unknown1", "unknown2"));
  for (int i = 0; i < 3; ++i) See({{At(1.5, -0.3, 0.7), size_}});
  EXPECT_THAT(Names(), ElementsAre("unknown2")) << "it vanishes as others do";
}

// It would never be missed: no look covers where no table is.
TEST_F(UnknownThingTest, WhatMayBeFurnitureBesideTheTableIsCountedAlone) {
  const std::string unknown = perception::kUnknownLabel;
  const Seen mug{At(1.5, -0.3, 0.7), {0.08, 0.08, 0.1}, "mug", 0, true};
  for (int i = 0; i < 5; ++i) {
    See({mug, {At(1.5, 0.1, 0.7), size_, unknown, 0, true}});
    EXPECT_EQ(memory_.num_beside(), 2);
  }
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "a model explains it";
  for (int i = 0; i < 3; ++i) See({mug, {At(1.5, 0.1, 0.7), size_}});
  EXPECT_EQ(memory_.num_beside(), 1);
  EXPECT_THAT(Names(), ElementsAre("mug1", "unknown1")) << "a look from elsewhere shows the table";
  for (int i = 0; i < 3; ++i) See({mug, {At(1.5, 0.12, 0.7), size_, unknown, 0, true}});
  EXPECT_THAT(Names(), ElementsAre("mug1", "unknown1")) << "what is known is seen there, too";
}

TEST_F(UnknownThingTest, WhatIsExpectedThereIsNoNewThing) {
  Look({Thing("mug1", "mug", At(1.5, 0.1, 0.7))});
  for (int i = 0; i < 5; ++i) See({{At(1.5, 0.14, 0.7), size_}});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  for (int i = 0; i < 5; ++i) See({{At(1.5, 0.14, 0.7), size_, perception::kUnknownLabel, 5000}});
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "looks do not overrule what was told";
}

TEST_F(UnknownThingTest, APartOfWhatIsKnownIsNoThing) {
  const Seen mug{At(1.5, 0.1, 0.7), {0.08, 0.08, 0.1}, "mug"};
  Look({Thing("mug1", "mug", mug.X_MO)});
  for (int i = 0; i < 5; ++i) See({mug, {At(1.5, 0.13, 0.7), {0.06, 0.02, 0.1}}});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  for (int i = 0; i < 3; ++i) See({mug, {At(1.5, 0.18, 0.7), {0.06, 0.02, 0.1}}});
  EXPECT_THAT(Names(), ElementsAre("mug1", "unknown1")) << "beside it";
}

TEST_F(UnknownThingTest, LooksThatShowMoreOfItKnowBetterWhatKindItIs) {
  const auto look = [&](const std::string& label, int num_points) {
    See({{At(1.5, 0.1, 0.7), size_, label, num_points}});
  };
  const std::string unknown = perception::kUnknownLabel;
  for (int i = 0; i < 3; ++i) look("mug", 300);
  for (int i = 0; i < 5; ++i) look(unknown, 300);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  look("mug", 400);
  for (int i = 0; i < 5; ++i) look(unknown, 400);
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "the best look counts, not the first";
  for (int i = 0; i < 2; ++i) look(unknown, 3000);
  EXPECT_THAT(Names(), ElementsAre("mug1")) << "not yet";
  look(unknown, 3000);
  EXPECT_THAT(Names(), ElementsAre("unknown1"));
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.120x0.080x0.200");
  EXPECT_THAT(memory_.Vanished(), ElementsAre("mug1"));
}

TEST_F(UnknownThingTest, LooksThatShowLessOfItDoNotSayWhatKindItIs) {
  const auto look = [&](const std::string& label, int num_points) {
    See({{Turned(0.1, 0.3), size_, label, num_points}});
  };
  memory_.Believe("unknown1", world::UnknownBoxModel(size_), "", Turned(0.1, 0.0));
  for (int i = 0; i < 3; ++i) look(perception::kUnknownLabel, 3000);
  const Pose3 before = Remembered("unknown1");
  for (int i = 0; i < 5; ++i) See({{At(1.5, 0.1, 0.7), {0.08, 0.08, 0.1}, "mug", 900}});
  EXPECT_THAT(Names(), ElementsAre("unknown1"));
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.120x0.080x0.200");
  EXPECT_NEAR(Remembered("unknown1").rotation.angularDistance(before.rotation), 0.0, 1e-6);
  for (int i = 0; i < 3; ++i) look("mug", 4000);
  EXPECT_THAT(Names(), ElementsAre("mug1"));
}

TEST_F(UnknownThingTest, ABoxTurnedByAQuarterIsTheSameBox) {
  for (int i = 0; i < 3; ++i) See({{Turned(0.1, 0.3), size_}});
  const Pose3 before = Remembered("unknown1");
  for (int i = 0; i < 3; ++i) See({{Turned(0.1, 0.3 + geometry::kPi / 2), {0.08, 0.12, 0.2}}});
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.120x0.080x0.200");
  EXPECT_NEAR(Remembered("unknown1").rotation.angularDistance(before.rotation), 0.0, 1e-6);
}

TEST_F(UnknownThingTest, ABoxIsMeasuredAnewByLooksInARowAlone) {
  for (int i = 0; i < 3; ++i) See({{At(1.5, 0.1, 0.7), size_}});
  for (int i = 0; i < 5; ++i) {
    See({{At(1.5, 0.1, 0.7), {0.16, 0.08, 0.2}}});
    See({{At(1.5, 0.1, 0.7), {0.16, 0.08, 0.2}}});
    See({{At(1.5, 0.1, 0.7), {0.13, 0.08, 0.2}}});
  }
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.120x0.080x0.200");
  for (int i = 0; i < 3; ++i) See({{At(1.5, 0.1, 0.7), {0.16, 0.08, 0.2}}});
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.160x0.080x0.200");
  EXPECT_THAT(Names(), ElementsAre("unknown1"));
}

TEST_F(UnknownThingTest, WhatTurnsOutToBeSomethingKnownIsThat) {
  for (int i = 0; i < 3; ++i) See({{At(1.5, 0.1, 0.7), size_}});
  for (int i = 0; i < 3; ++i) See({{At(1.5, 0.11, 0.7), {0.08, 0.08, 0.1}, "mug"}});
  EXPECT_THAT(Names(), ElementsAre("mug1"));
  EXPECT_THAT(memory_.Vanished(), ElementsAre("unknown1"));
}

TEST_F(UnknownThingTest, WhatHidesItDoesNotTakeItsPlace) {
  for (int i = 0; i < 3; ++i) See({{At(1.8, 0.1, 0.7), size_}});
  const auto screen = Thing("screen1", "screen", At(1.3, 0.0, 0.6));
  for (int i = 0; i < 5; ++i) Look({screen});
  EXPECT_THAT(Names(), ElementsAre("screen1", "unknown1"));
}

TEST_F(UnknownThingTest, TheHandAboveTheTableIsNoThingOnIt) {
  PutArm("rightarm1", "armuntuckedposture");
  Pose3 below{X_ML("r_gripper_tool_frame").translation, {}};
  below.translation.z() -= 0.3;
  for (int i = 0; i < 5; ++i) See({{below, size_}});
  EXPECT_THAT(Names(), IsEmpty());
  below.translation.y() += 0.5;
  for (int i = 0; i < 3; ++i) See({{below, size_}});
  EXPECT_THAT(Names(), ElementsAre("unknown1"));
}

// With the fingers about it, a box may look like a thing of some kind.
TEST_F(UnknownThingTest, WhatIsAboutAHandIsNoNewThingWhateverItLooksLike) {
  PutArm("rightarm1", "armuntuckedposture");
  SetGap("rightarm1", 0.09);
  const Eigen::Vector3d tool = X_ML("r_gripper_tool_frame").translation;
  Pose3 below{tool, {}};
  below.translation.z() -= 0.18;
  memory_.Believe("unknown1", "unknown_0.060x0.060x0.200", "",
                  {tool - Eigen::Vector3d(0.0, 0.0, 0.1), Eigen::Quaterniond::Identity()});
  Rest();
  for (int i = 0; i < 5; ++i) See({{below, {0.06, 0.06, 0.3}, "jug"}});
  EXPECT_THAT(Names(), ElementsAre("unknown1")) << "before it takes it";
  SetGap("rightarm1", 0.06);
  ASSERT_TRUE(Rest());
  for (int i = 0; i < 5; ++i) See({{below, {0.06, 0.06, 0.3}, "jug"}});
  EXPECT_THAT(Names(), ElementsAre("unknown1"));
}

TEST_F(UnknownThingTest, WhatVanishedAndIsSeenThereAgainIsThatThing) {
  for (int i = 0; i < 3; ++i) See({{At(1.5, 0.1, 0.7), size_}, {At(1.5, -0.3, 0.7), size_}});
  ASSERT_THAT(Names(), ElementsAre("unknown1", "unknown2"));
  for (int i = 0; i < 3; ++i) Look({});
  ASSERT_THAT(Names(), IsEmpty());
  for (int i = 0; i < 3; ++i) See({{At(1.5, -0.28, 0.7), size_}});
  EXPECT_THAT(Names(), ElementsAre("unknown2"));
  for (int i = 0; i < 3; ++i) See({{At(1.5, -0.28, 0.7), size_}, {At(1.5, 0.4, 0.7), size_}});
  EXPECT_THAT(Names(), ElementsAre("unknown2", "unknown3")) << "a box elsewhere may be any box";
}

TEST_F(UnknownThingTest, NobodyNamesWhatWasNotMeasured) {
  for (int i = 0; i < 5; ++i) See({{At(1.5, 0.1, 0.7), Eigen::Vector3d::Zero()}});
  EXPECT_THAT(Names(), IsEmpty());
  EXPECT_THROW(See({{At(1.5, 0.1, 0.7), {0.1, -0.1, 0.1}}}), base::ConfigError);
  EXPECT_THROW(See({{At(1.5, 0.1, 0.7), {0.1, 11.0, 0.1}}}), base::ConfigError);
  EXPECT_THROW(See({{At(1.5, 0.1, 0.7), {NAN, 0.1, 0.1}}}), base::ConfigError);
}

TEST_F(UnknownThingTest, AHandTakesItByItsBox) {
  PutArm("rightarm1", "armuntuckedposture");
  SetGap("rightarm1", 0.09);
  const Eigen::Vector3d tool = X_ML("r_gripper_tool_frame").translation;
  memory_.Believe("unknown1", "unknown_0.060x0.060x0.200", "",
                  {tool - Eigen::Vector3d(0.0, 0.0, 0.1), Eigen::Quaterniond::Identity()});
  Rest();
  SetGap("rightarm1", 0.06);
  EXPECT_TRUE(Rest());
  EXPECT_TRUE(memory_.objects().at("unknown1").is_held);
  Pose3 below{tool, {}};  // a recogniser takes all things for standing on the table
  below.translation.z() -= 0.18;
  for (int i = 0; i < 5; ++i) See({{below, {0.06, 0.06, 0.3}}});
  EXPECT_TRUE(memory_.objects().at("unknown1").is_held);
  EXPECT_EQ(ModelOf("unknown1"), "unknown_0.060x0.060x0.200");
}

TEST_F(ObjectMemoryTest, AHandThatClosesAfterTheClockBeganAgainTakesHold) {
  body_.time = 1000.0;
  PutArm("rightarm1", "armuntuckedposture");
  SetGap("rightarm1", 0.079);
  memory_.Feel(body_);
  mug_ = Thing("mug1", "mug", {});
  mug_.X_MO.translation = X_ML("r_gripper_tool_frame").translation - Eigen::Vector3d(0, 0, 0.05);
  memory_.Believe("mug1", "mug", "", mug_.X_MO);
  body_.time = 1.0;
  EXPECT_TRUE(Rest());
  EXPECT_TRUE(memory_.objects().at("mug1").is_held);
}

}  // namespace
}  // namespace hires::sensing::object_memory_test
