#include <gmock/gmock.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/robot/robot_profile.h"

namespace hires::robot::pr2_test {
namespace {

using geometry::kPi;
using geometry::Pose3;

const Robot& Pr2() {
  static const Robot robot = LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  return robot;
}

Eigen::Vector3d PositionOf(const std::string& link, const JointPositions& joints) {
  return ForwardKinematics(Pr2().model, joints)[*Pr2().model.FindLink(link)].translation;
}

void ExpectAt(const std::string& link, const JointPositions& joints, double x, double y, double z) {
  const Eigen::Vector3d p = PositionOf(link, joints);
  EXPECT_TRUE(p.isApprox(Eigen::Vector3d(x, y, z), 1e-9)) << link << ": " << p.transpose();
}

const Joint& JointNamed(const std::string& name) {
  for (const Link& link : Pr2().model.links) {
    if (link.joint && link.joint->name == name) return *link.joint;
  }
  throw std::out_of_range(name);
}

TEST(Pr2Urdf, TrayAndLasersStandWhereTheFactsSay) {
  ExpectAt("base_link", {}, 0.0, 0.0, 0.051);
  ExpectAt("base_tray_link", {}, 0.08, 0.0, 0.346);
  ExpectAt("base_tray_laser_link", {}, 0.08, 0.0, 0.366);
  ExpectAt("base_laser_link", {}, 0.275, 0.0, 0.303);
  // Torso 0.790675 high, 0.09893 - 0.05 forward; the beam is 0.03 above the tilting axis.
  ExpectAt("laser_tilt_link", {}, 0.04893, 0.0, 0.790675 + 0.227 + 0.03);
  ExpectAt("fl_caster_l_wheel_link", {}, 0.2246, 0.2736, 0.0792);
}

TEST(Pr2Urdf, StretchedArmsReachForward) {
  // -0.05 torso + 0.1 + 0.4 + 0.321 + 0.18 from shoulder to tool.
  ExpectAt("l_gripper_tool_frame", {}, 0.951, 0.188, 0.790675);
  ExpectAt("r_gripper_tool_frame", {}, 0.951, -0.188, 0.790675);
  ExpectAt("r_gripper_tool_frame", {{"torso_lift_joint", 0.295}}, 0.951, -0.188, 1.085675);
}

TEST(Pr2Urdf, ElbowBendsUpwards) {
  ExpectAt("l_gripper_tool_frame", {{"l_elbow_flex_joint", -kPi / 2}}, 0.45, 0.188,
           0.790675 + 0.321 + 0.18);
}

TEST(Pr2Urdf, ShoulderPansAboutItsColumn) {
  ExpectAt("l_gripper_tool_frame", {{"l_shoulder_pan_joint", 1.0}}, -0.05 + 1.001 * std::cos(1.0),
           0.188 + 1.001 * std::sin(1.0), 0.790675);
}

TEST(Pr2Urdf, KinectSitsOnTheHead) {
  ExpectAt("head_mount_kinect_ir_link", {}, -0.05 - 0.01707 + 0.068 + 0.0232 - 0.138 - 0.032267,
           0.0125, 0.790675 + 0.38145 + 0.0645 + 0.091 + 0.136453);
}

TEST(Pr2Urdf, OpticalFramesLookAlongTheirZ) {
  const auto X_R = ForwardKinematics(Pr2().model, {});
  for (const char* name : {"high_def_optical_frame", "wide_stereo_optical_frame",
                           "head_mount_kinect_ir_optical_frame", "thermal_cam_optical_frame"}) {
    const Pose3& X_RC = X_R[*Pr2().model.FindLink(name)];
    EXPECT_TRUE((X_RC.rotation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-9))
        << name;
    EXPECT_TRUE(
        (X_RC.rotation * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitY(), 1e-9))
        << name;
  }
}

TEST(Pr2Urdf, FingersOpenTogetherAndTipsStayParallel) {
  const auto X_R = ForwardKinematics(Pr2().model, {{"l_gripper_l_finger_joint", 0.4}});
  const auto rotation_of = [&](const char* link) {
    return X_R[*Pr2().model.FindLink(link)].rotation;
  };
  EXPECT_NEAR(geometry::YawOf(rotation_of("l_gripper_l_finger_link")), 0.4, 1e-12);
  EXPECT_NEAR(geometry::YawOf(rotation_of("l_gripper_r_finger_link")), -0.4, 1e-12);
  EXPECT_NEAR(geometry::YawOf(rotation_of("l_gripper_l_finger_tip_link")), 0.0, 1e-12);
  EXPECT_NEAR(geometry::YawOf(rotation_of("l_gripper_r_finger_tip_link")), 0.0, 1e-12);
}

TEST(Pr2Urdf, MassesSumToTheHistoricRobotPlusTray) {
  double total = 0.0;
  for (const Link& link : Pr2().model.links) {
    if (link.inertial) total += link.inertial->mass;
  }
  EXPECT_NEAR(total, 267.8 + 0.2 + 0.370, 0.005);  // robot, tray, tray laser
}

TEST(Pr2Urdf, TraysCentreOfMassIsThePlatesCentre) {
  const Link& tray = Pr2().model.links[*Pr2().model.FindLink("base_tray_link")];
  EXPECT_EQ(tray.inertial->p_BBcm, Eigen::Vector3d(0.125, 0.0, 0.0));
}

double HeightAt(double torso) {
  geometry::Aabb box;
  for (const auto& collision : FrozenCollisions(Pr2().model, {{"torso_lift_joint", torso}})) {
    box.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  return box.upper.z();
}

TEST(Pr2Urdf, HeightIsTheDataSheets) {
  EXPECT_NEAR(HeightAt(0.0), 1.33, 0.005);
  // The data sheet's 1.645 goes with a lift of a little less than the joint's limit of 0.33.
  EXPECT_NEAR(HeightAt(0.315), 1.645, 0.005);
  EXPECT_NEAR(HeightAt(0.33) - HeightAt(0.0), 0.33, 1e-12);
}

TEST(Pr2Urdf, WheelsStandOnTheFloor) {
  geometry::Aabb box;
  for (const auto& collision : FrozenCollisions(Pr2().model, {})) {
    box.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  EXPECT_NEAR(box.lower.z(), 0.0792 - 0.074792, 1e-3);
}

struct LimitRow {
  const char* joint;
  double lower, upper, velocity, effort;
};

TEST(Pr2Urdf, JointLimitsAreTheGoldenOnes) {
  const std::vector<LimitRow> rows{{"torso_lift_joint", 0, 0.33, 0.013, 10000},
                                   {"head_pan_joint", -3.007, 3.007, 6, 2.645},
                                   {"head_tilt_joint", -0.471238, 1.39626, 5, 18},
                                   {"laser_tilt_mount_joint", -0.7854, 1.48353, 10, 0.65},
                                   {"r_shoulder_pan_joint", -2.2854, 0.714602, 2.088, 30},
                                   {"l_shoulder_pan_joint", -0.714602, 2.2854, 2.088, 30},
                                   {"r_shoulder_lift_joint", -0.5236, 1.3963, 2.082, 30},
                                   {"l_shoulder_lift_joint", -0.5236, 1.3963, 2.082, 30},
                                   {"r_upper_arm_roll_joint", -3.9, 0.8, 3.27, 30},
                                   {"l_upper_arm_roll_joint", -0.8, 3.9, 3.27, 30},
                                   {"r_elbow_flex_joint", -2.3213, 0, 3.3, 30},
                                   {"l_elbow_flex_joint", -2.3213, 0, 3.3, 30},
                                   {"r_forearm_roll_joint", 0, 0, 3.6, 30},
                                   {"l_forearm_roll_joint", 0, 0, 3.6, 30},
                                   {"r_wrist_flex_joint", -2.18, 0, 3.078, 10},
                                   {"l_wrist_flex_joint", -2.18, 0, 3.078, 10},
                                   {"r_wrist_roll_joint", 0, 0, 3.6, 10},
                                   {"l_wrist_roll_joint", 0, 0, 3.6, 10},
                                   {"r_gripper_l_finger_joint", 0, 0.548, 0.5, 1000},
                                   {"l_gripper_l_finger_joint", 0, 0.548, 0.5, 1000},
                                   {"r_gripper_r_finger_tip_joint", 0, 0.548, 0.5, 1000},
                                   {"l_gripper_joint", 0, 0.09, 0.2, 1000},
                                   {"r_gripper_joint", 0, 0.09, 0.2, 1000},
                                   {"fl_caster_rotation_joint", 0, 0, 100, 100},
                                   {"fr_caster_l_wheel_joint", 0, 0, 100, 100},
                                   {"br_caster_r_wheel_joint", 0, 0, 100, 100}};
  for (const LimitRow& row : rows) {
    const Joint& joint = JointNamed(row.joint);
    ASSERT_TRUE(joint.limits) << row.joint;
    EXPECT_EQ(joint.limits->lower, row.lower) << row.joint;
    EXPECT_EQ(joint.limits->upper, row.upper) << row.joint;
    EXPECT_EQ(joint.limits->velocity, row.velocity) << row.joint;
    EXPECT_EQ(joint.limits->effort, row.effort) << row.joint;
  }
}

TEST(Pr2Urdf, DrivesOnFourCastersWithTwoWheelsEach) {
  int num_wheels = 0, num_casters = 0;
  for (const std::string& name : Pr2().model.JointNames()) {
    num_wheels += name.find("_wheel_joint") != std::string::npos;
    num_casters += name.find("_caster_rotation_joint") != std::string::npos;
  }
  EXPECT_EQ(num_wheels, 8);
  EXPECT_EQ(num_casters, 4);
}

TEST(Pr2Urdf, WheelsAndFingersGrip) {
  const auto friction_of = [](const char* link) {
    return Pr2().model.links[*Pr2().model.FindLink(link)].collisions.at(0).friction;
  };
  EXPECT_EQ(friction_of("bl_caster_r_wheel_link"), 100.0);
  EXPECT_EQ(friction_of("r_gripper_l_finger_tip_link"), 500.0);
  EXPECT_EQ(friction_of("base_tray_link"), 1.0);
}

/// Where an object stands, in base_footprint.
Pose3 ObjectOnTray() {
  const auto X_R = ForwardKinematics(Pr2().model, Pr2().profile.joints);
  return X_R[*Pr2().model.FindLink("base_tray_link")] * Pr2().profile.X_TO;
}

TEST(Pr2Profile, ObjectStandsOnThePlate) {
  const Pose3 X_RO = ObjectOnTray();
  EXPECT_TRUE(X_RO.translation.isApprox(Eigen::Vector3d(0.28, 0.0, 0.3462), 1e-9));
  EXPECT_NEAR(geometry::TiltOf(X_RO.rotation), 0.0, 1e-12);
  // A mill of radius 0.037 stands wholly on the plate, which ends at x 0.3291.
  const auto frozen = FrozenCollisions(Pr2().model, Pr2().profile.joints);
  const auto plate = std::find_if(frozen.begin(), frozen.end(),
                                  [](const auto& c) { return c.name == "base_tray_link/plate"; });
  ASSERT_NE(plate, frozen.end());
  const geometry::Aabb box = geometry::BoundsOf(plate->shape, plate->X_BS);
  EXPECT_NEAR(box.upper.z(), X_RO.translation.z(), 1e-9);
  EXPECT_LE(X_RO.translation.x() + 0.037, box.upper.x());
  EXPECT_GE(X_RO.translation.x() - 0.037, box.lower.x());
}

TEST(Pr2Profile, NothingHangsOverTheTrayWhileDriving) {
  const Eigen::Vector3d p_RO = ObjectOnTray().translation;
  const geometry::Cylinder room{0.05, 0.32};
  const Pose3 X_RRoom{p_RO + Eigen::Vector3d(0.0, 0.0, room.length / 2), {1.0, 0.0, 0.0, 0.0}};
  const double bottom = p_RO.z() + 1e-6, top = p_RO.z() + room.length;
  const geometry::Polygon kept_free = *geometry::OutlineInBand(room, X_RRoom, bottom, top);
  int num_in_band = 0;
  for (const auto& collision : FrozenCollisions(Pr2().model, Pr2().profile.joints)) {
    const auto outline = geometry::OutlineInBand(collision.shape, collision.X_BS, bottom, top);
    if (!outline) continue;
    ++num_in_band;
    EXPECT_GT(geometry::Distance(*outline, kept_free), 0.0) << collision.name;
  }
  EXPECT_GE(num_in_band, 3);  // column, torso and shoulders do reach down there, behind the tray
}

TEST(Pr2Profile, AnArmOverTheTrayWouldBeSeen) {
  // The counterpart: with the right arm lowered before the robot the same check must see it.
  JointPositions joints = Pr2().profile.joints;
  joints["torso_lift_joint"] = 0.0;
  for (const auto& [joint, position] : JointPositions{{"r_shoulder_pan_joint", 0.5},
                                                      {"r_shoulder_lift_joint", 0.9},
                                                      {"r_elbow_flex_joint", 0.0}}) {
    joints[joint] = position;
  }
  const Eigen::Vector3d p_RO = ObjectOnTray().translation;
  bool is_hit = false;
  for (const auto& collision : FrozenCollisions(Pr2().model, joints)) {
    const auto outline =
        geometry::OutlineInBand(collision.shape, collision.X_BS, p_RO.z() + 1e-6, p_RO.z() + 0.32);
    const geometry::Polygon near{{0.23, -0.05}, {0.33, -0.05}, {0.33, 0.05}, {0.23, 0.05}};
    is_hit = is_hit || (outline && geometry::Distance(*outline, near) == 0.0);
  }
  EXPECT_TRUE(is_hit);
}

TEST(Pr2Profile, PaddedFootprintCoversTheBase) {
  const geometry::Polygon padded =
      geometry::Padded(Pr2().profile.footprint, Pr2().profile.footprint_padding);
  for (const double x : {-0.334, 0.334}) {
    for (const double y : {-0.334, 0.334}) EXPECT_TRUE(geometry::Contains(padded, {x, y}));
  }
  EXPECT_TRUE(geometry::Contains(padded, {0.46, 0.0}));
  EXPECT_EQ(Pr2().profile.footprint.size(), 5u);
}

TEST(Pr2Profile, HoldsTheDissertationsMotionSets) {
  const auto& sets = Pr2().profile.motion_sets;
  ASSERT_EQ(sets.size(), 2u);
  const MotionSet& fast = sets.at("fast");
  EXPECT_EQ(fast.max_linear_velocity, 0.55);
  EXPECT_EQ(fast.max_angular_velocity, 1.0);
  EXPECT_EQ(fast.max_linear_acceleration, 2.5);
  EXPECT_EQ(fast.max_angular_acceleration, 3.2);
  const MotionSet& slow = sets.at("slow");
  EXPECT_EQ(slow.max_linear_velocity, 0.30);
  EXPECT_EQ(slow.max_angular_velocity, 1.0);
  EXPECT_EQ(slow.max_linear_acceleration, 1.4);
  EXPECT_EQ(slow.max_angular_acceleration, 2.0);
  EXPECT_EQ(Pr2().profile.default_motion_set, "fast");
}

TEST(Pr2Profile, BaseControllerHasTheOriginalsLimits) {
  const BaseControllerParams& base = Pr2().profile.base_controller;
  EXPECT_EQ(base.limits.max_linear_velocity, 1.0);
  EXPECT_EQ(base.limits.max_angular_velocity, 2.0);
  EXPECT_EQ(base.limits.max_linear_acceleration, 2.0);
  EXPECT_EQ(base.limits.max_angular_acceleration, 2.0);
  EXPECT_EQ(base.command_timeout, 0.2);
  EXPECT_TRUE(base.stops_at_timeout);  // as published; a scene with base_guard has the ramp
}

TEST(Pr2Profile, CastersAreThoseOfItsUrdf) {
  ASSERT_TRUE(Pr2().profile.base_controller.casters);
  const CasterParams& casters = *Pr2().profile.base_controller.casters;
  EXPECT_EQ(casters.version, 2);
  EXPECT_EQ(casters.at, JointNamed("fl_caster_rotation_joint").X_PJ.translation.x());
  EXPECT_EQ(casters.at, -JointNamed("br_caster_rotation_joint").X_PJ.translation.y());
  EXPECT_EQ(casters.track, JointNamed("fl_caster_l_wheel_joint").X_PJ.translation.y() -
                               JointNamed("fl_caster_r_wheel_joint").X_PJ.translation.y());
  const auto& model = Pr2().model;
  const Link& wheel = model.links[*model.FindLink("fl_caster_l_wheel_link")];
  const Link& caster = model.links[*model.FindLink("fl_caster_rotation_link")];
  EXPECT_EQ(casters.wheel_radius,
            std::get<geometry::Cylinder>(wheel.collisions.at(0).shape).radius);
  EXPECT_EQ(casters.wheel_inertia, wheel.inertial->I_BBcm(1, 1));
  // A wheel turns about its axle, so its inertia about the caster is a mean of two.
  const double of_wheel = 0.5 * (wheel.inertial->I_BBcm(0, 0) + wheel.inertial->I_BBcm(2, 2)) +
                          wheel.inertial->mass * 0.25 * casters.track * casters.track;
  EXPECT_NEAR(casters.steering_inertia, caster.inertial->I_BBcm(2, 2) + 2.0 * of_wheel, 5e-5);
}

TEST(Pr2Profile, MassAndYawInertiaAreThoseOfItsLinks) {
  const CasterParams& casters = *Pr2().profile.base_controller.casters;
  const auto X_R = ForwardKinematics(Pr2().model, Pr2().profile.joints);
  double mass = 0.0, inertia = 0.0;
  for (std::size_t i = 0; i < X_R.size(); ++i) {
    const auto& own = Pr2().model.links[i].inertial;
    if (!own) continue;
    const Eigen::Vector3d p = X_R[i] * own->p_BBcm;
    const Eigen::Matrix3d turn = X_R[i].rotation.toRotationMatrix();
    mass += own->mass;
    inertia +=
        (turn * own->I_BBcm * turn.transpose())(2, 2) + own->mass * (p.x() * p.x() + p.y() * p.y());
  }
  EXPECT_NEAR(casters.mass, mass, 0.005);
  EXPECT_NEAR(casters.yaw_inertia, inertia, 0.05);
}

TEST(Pr2Profile, HeadLooksAtTheFloorAhead) {
  const auto X_R = ForwardKinematics(Pr2().model, Pr2().profile.joints);
  const Pose3& X_RHead = X_R[*Pr2().model.FindLink("head_tilt_link")];
  const Eigen::Vector3d to_target =
      (Eigen::Vector3d(3.0, 0.0, 1.051) - X_RHead.translation).normalized();
  EXPECT_TRUE((X_RHead.rotation * Eigen::Vector3d::UnitX()).isApprox(to_target, 1e-4));
}

}  // namespace
}  // namespace hires::robot::pr2_test
