#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/manipulation/grasp.h"
#include "restaurant_scene.h"

namespace hires::manipulation::restaurant_reach_test {
namespace {

using namespace test_support;

constexpr double kTorsoUp = 0.295;

/// An object to be taken, and where the robot stands to take it.
struct Job {
  std::string area;  // of the robot
  world::ObjectState object;
};

const geometry::Pose3 kBack{{-0.10, 0.0, 0.0}, Eigen::Quaterniond::Identity()};

/// Everything around one arm that is to take one object, from "to side".
struct Reach {
  Reach(const Job& job, const std::string& arm)
      : kinematics(*Pr2(), arm),
        scene(RestaurantScene()),
        X_MB(Area(job.area)),
        posture(Posture("armtosideposture", kTorsoUp)),
        object(job.object) {
    scene.SetObjects({object}, X_MB, posture);
    const auto& profile = Pr2()->profile.upper_body->arms.at(arm);
    for (const auto& links : {profile.left_finger_links, profile.right_finger_links}) {
      for (const std::string& link : links) scene.Allow(link, object.name);
    }
  }

  /// The whole way: to the point in front of the object, and straight on.
  bool CanTake(const Grasp& grasp) const {
    const geometry::Pose3 X_BT = geometry::Lift(X_MB).Inverse() * object.X_MO * grasp.X_OT;
    for (const ArmJoints& joints :
         kinematics.Solve(posture, X_BT, kinematics.JointsOf(posture), 1)) {
      ArmScene at_object{&kinematics, &scene, X_MB, posture, std::nullopt};
      kinematics.SetJoints(joints, &at_object.posture);
      const ArmPathResult back = PlanStraight(at_object, X_BT * kBack);
      if (back.status != ArmPathStatus::kFound) continue;
      const ArmScene at_side{&kinematics, &scene, X_MB, posture, std::nullopt};
      if (PlanArmPath(at_side, {back.path.back()}, 7).status == ArmPathStatus::kFound) return true;
    }
    return false;
  }
  bool CanTake(const std::string& kind) const {
    const auto grasps = GraspsFor(*Model(object.model), Pr2()->profile.upper_body->gripper);
    return std::any_of(grasps.begin(), grasps.end(),
                       [&](const Grasp& grasp) { return grasp.kind == kind && CanTake(grasp); });
  }

  ArmKinematics kinematics;
  CollisionScene scene;
  geometry::Pose2 X_MB;
  robot::JointPositions posture;
  world::ObjectState object;
};

Job OnPlace(const std::string& manipulation_area, const std::string& place,
            const std::string& model) {
  const geometry::Pose3 X_MP = Restaurant()->FindFrame(place).value();
  const Eigen::Vector3d& p = X_MP.translation;
  return {manipulation_area, Standing("thing on " + place, model, p.x(), p.y(), p.z())};
}

std::vector<Job> AtCounter() {
  const std::string area = "manipulationAreaEastCounter1";
  return {{area, Standing("mug1", "coffee_cup", 5.37, 10.26, 0.75)},
          {area, Standing("mug2", "coffee_cup", 5.37, 9.94, 0.75)},
          {area, Standing("peppermill1", "peppermill_thesis", 5.47, 10.16, 0.75)}};
}

std::vector<Job> AtTables(const std::string& model) {
  return {OnPlace("manipulationAreaNorthTable1", "placingAreaWestLeftTable1", model),
          OnPlace("manipulationAreaNorthTable1", "placingAreaEastRightTable1", model),
          OnPlace("manipulationAreaSouthTable1", "placingAreaEastLeftTable1", model),
          OnPlace("manipulationAreaSouthTable1", "placingAreaWestRightTable1", model),
          OnPlace("manipulationAreaEastTable2", "placingAreaNorthLeftTable2", model),
          OnPlace("manipulationAreaEastTable2", "placingAreaSouthRightTable2", model),
          OnPlace("manipulationAreaWestTable2", "placingAreaNorthRightTable2", model),
          OnPlace("manipulationAreaWestTable2", "placingAreaSouthLeftTable2", model)};
}

void ExpectBothArmsTake(const std::vector<Job>& jobs) {
  for (const Job& job : jobs) {
    for (const std::string arm : {"leftarm1", "rightarm1"}) {
      const Reach reach(job, arm);
      for (const std::string kind : {"side", "top"}) {
        EXPECT_TRUE(reach.CanTake(kind)) << arm << ", " << kind << ", " << job.object.name;
      }
    }
  }
}

TEST(RestaurantReachTest, EachArmTakesWhatStandsOnTheCounter) { ExpectBothArmsTake(AtCounter()); }

TEST(RestaurantReachTest, EachArmReachesEveryPlacingAreaWithAMug) {
  ExpectBothArmsTake(AtTables("coffee_cup"));
}

TEST(RestaurantReachTest, SomeArmTakesTheMillFromEveryPlacingArea) {
  for (const Job& job : AtTables("peppermill_thesis")) {
    EXPECT_TRUE(Reach(job, "leftarm1").CanTake("side") || Reach(job, "rightarm1").CanTake("side"))
        << job.object.name;
  }
}

/// The slots of the tray [m] in base_footprint.
const std::map<std::string, Eigen::Vector3d> kSlots{{"right", {0.25, -0.13, 0.3462}},
                                                    {"middle", {0.25, 0.0, 0.3462}},
                                                    {"left", {0.25, 0.13, 0.3462}},
                                                    {"profile", {0.28, 0.0, 0.3462}}};

/// Can the arm hold the object there by some such grasp, and lift it straight up?
bool CanLiftFromTray(const std::string& arm, const std::string& model, const Eigen::Vector3d& slot,
                     const std::string& kind, const geometry::Pose2& X_MB) {
  const ArmKinematics kinematics(*Pr2(), arm);
  const auto& body = *Pr2()->profile.upper_body;
  for (const Grasp& grasp : GraspsFor(*Model(model), body.gripper)) {
    if (grasp.kind != kind) continue;
    robot::JointPositions posture = Posture("armtosideposture", kTorsoUp);
    robot::SetGap(body.gripper, body.arms.at(arm), grasp.gap, &posture);
    geometry::Pose3 X_BO;
    X_BO.translation = slot;
    const geometry::Pose3 X_BT = X_BO * grasp.X_OT;
    geometry::Pose3 X_BUp = X_BT;
    X_BUp.translation.z() += 0.10;
    const ArmJoints at_side = kinematics.JointsOf(posture);
    for (const ArmJoints& joints : kinematics.Solve(posture, X_BT, at_side, 3)) {
      kinematics.SetJoints(joints, &posture);
      world::ObjectState held = Standing("held", model, 0.0, 0.0, 0.0);
      held.X_MO = geometry::Lift(X_MB) * X_BO;
      held.attached_to = body.arms.at(arm).palm_link;
      CollisionScene scene = RestaurantScene();
      scene.SetObjects({held}, X_MB, posture);
      scene.Allow("held", "base_tray_link");
      const ArmScene in{&kinematics, &scene, X_MB, posture, std::nullopt};
      if (PlanStraight(in, X_BUp).status == ArmPathStatus::kFound) return true;
    }
  }
  return false;
}

TEST(RestaurantReachTest, EachArmReachesEverySlotOfTheTrayAtThePreManipulationArea) {
  const geometry::Pose2 X_MB = Area("preManipulationAreaEastCounter1");
  for (const std::string arm : {"leftarm1", "rightarm1"}) {
    for (const std::string model : {"peppermill_thesis", "coffee_cup"}) {
      for (const auto& [name, slot] : kSlots) {
        for (const std::string kind : {"side", "top"}) {
          EXPECT_TRUE(CanLiftFromTray(arm, model, slot, kind, X_MB))
              << arm << " " << model << " " << name << " " << kind;
        }
      }
    }
  }
}

// There the counter's slab lies over the tray: whoever stands so close has to leave first.
TEST(RestaurantReachTest, AtTheRecordedPoseAtTheCounterTheMillCannotBePutOnTheTray) {
  const geometry::Pose2 X_MB{5.90, 10.11, 3.14};
  for (const std::string arm : {"leftarm1", "rightarm1"}) {
    for (const std::string kind : {"side", "top"}) {
      EXPECT_FALSE(CanLiftFromTray(arm, "peppermill_thesis", kSlots.at("middle"), kind, X_MB));
    }
  }
}

}  // namespace
}  // namespace hires::manipulation::restaurant_reach_test
