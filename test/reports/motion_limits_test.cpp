#include "reports/limits/motion_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/physics/closed_forms.h"
#include "support/temporary_folder.h"

namespace hires::reports::motion_limits_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kScaleStep = 0.03;  // a limit lies so far below what nothing bears
constexpr double kModel = 0.002;     // by so much the model's numbers are rounded
constexpr double kGravity = 9.8;     // [m/s^2] of the world of config/scene.yaml
const physics::UprightCylinder kMill{0.037, 0.274, 0.140};  // peppermill1

imagination::ImaginationSetup SetupWith(
    const std::function<void(robot::BaseControllerParams*)>& change = nullptr,
    const std::string& uncertainty = "none") {
  const std::string folder = std::string(HIRES_SOURCE_DIR) + "/config/";
  imagination::SetupConfig config = imagination::ReadSetupConfig(folder + "scene.yaml");
  config.uncertainty = uncertainty.empty() ? config.uncertainty : uncertainty;
  imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(config);
  if (change) {
    simulation::Scene scene = *setup.scene;
    change(&scene.robot.profile.base_controller);
    setup.scene = simulation::MakeScene(scene.world, scene.robot, scene.memory);
  }
  return setup;
}

/// Follows exactly, so that closed forms speak of it; at its time-out it stops within a step.
void MakeIdeal(robot::BaseControllerParams* controller) {
  controller->casters.reset();
  controller->loop_frequency = controller->command_lag = controller->sway_compliance = 0.0;
  controller->stops_at_timeout = true;
}

LimitsRequest Mill(double max_fall) {
  LimitsRequest request;
  request.objects = {"peppermill1"};
  request.max_fall = max_fall;
  return request;
}

TEST(MotionLimitsTest, SoManyTruthsWithoutAFallTellEnough) {
  EXPECT_EQ(NumTruths(0.01), 299);
  EXPECT_EQ(NumTruths(0.05), 59);
  EXPECT_EQ(NumTruths(0.5), 5);
  for (const double share : {0.001, 0.0137, 0.2}) {
    const int n = NumTruths(share);
    EXPECT_LE(std::pow(1.0 - share, n), 0.05);
    EXPECT_GT(std::pow(1.0 - share, n - 1), 0.05);
  }
}

TEST(MotionLimitsTest, TheSpeedOfALockedWheelIsTheClosedForms) {
  const auto report = FindLimits(Mill(0.5), SetupWith(MakeIdeal), {});
  ASSERT_TRUE(report);
  const double speed = physics::SuddenStopTopplingSpeed(kMill, 9.81);
  EXPECT_NEAR(report->Of("speed").closed_form, speed, kModel * speed);
  EXPECT_NEAR(report->Of("speed").value, speed, 2.0 * kScaleStep * speed);
  // On the spot, too: the tray stops as suddenly, some way off the centre.
  const double reach = SetupWith().scene->X_BO.translation.head<2>().norm();
  EXPECT_NEAR(report->Of("turning").closed_form, speed / reach, kModel * speed / reach);
  EXPECT_NEAR(report->Of("turning").value, speed / reach, 2.0 * kScaleStep * speed / reach);
  const double tips = physics::TippingAcceleration(kMill, 9.81);
  EXPECT_NEAR(report->Of("deceleration").closed_form, tips, kModel * tips);
  const std::vector<MotionBounds> bounds =
      ClosedFormLimits({"peppermill1"}, SetupWith(MakeIdeal)).weakest;
  ASSERT_EQ(bounds.size(), 4u);
  for (const MotionBounds& motion : bounds) {
    EXPECT_EQ(motion.closed_form, report->Of(motion.motion).closed_form) << motion.motion;
  }
}

TEST(MotionLimitsTest, WhatIsRoundBelowRollsAtAnyMotion) {
  const hires::test_support::TemporaryFolder folder;
  const auto limits_of = [&](const std::string& shapes) {
    imagination::SetupConfig config =
        imagination::ReadSetupConfig(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml");
    config.uncertainty = "none";
    config.extra_objects = {folder.Write(
        "thing.sdf",
        "<sdf version='1.7'><model name='thing'><link name='l'><inertial><mass>0.3</mass><inertia>"
        "<ixx>0.0003</ixx><iyy>0.0003</iyy><izz>0.0003</izz></inertia></inertial>" +
            shapes + "</link></model></sdf>")};
    return ClosedFormLimits({"thing"}, imagination::LoadImaginationSetup(config)).weakest;
  };
  const auto shape = [](const std::string& name, const std::string& pose, const std::string& text) {
    return "<collision name='" + name + "'><pose>" + pose + "</pose><geometry>" + text +
           "</geometry></collision>";
  };
  const std::string ball = "<sphere><radius>0.04</radius></sphere>";
  const std::string can = "<cylinder><radius>0.04</radius><length>0.1</length></cylinder>";
  for (const std::string& round :
       {shape("a", "0 0 0 0 0 0", ball), shape("a", "0 0 0 1.5708 0.3 0", can)}) {
    for (const MotionBounds& motion : limits_of(round)) {
      EXPECT_EQ(motion.closed_form, 0.0) << motion.motion;
      EXPECT_THAT(motion.stated, HasSubstr("rolls")) << motion.motion;
    }
  }
  for (const std::string& firm :
       {shape("a", "0 0 0 0 0 0", can), shape("a", "0.03 0 0 0 0 0", ball) +
                                            shape("b", "-0.03 0.03 0 0 0 0", ball) +
                                            shape("c", "-0.03 -0.03 0 0 0 0", ball)}) {
    for (const MotionBounds& motion : limits_of(firm)) EXPECT_GT(motion.closed_form, 0.0);
  }
}

TEST(MotionLimitsTest, AControllersOwnStopOverturnsFromWhereThePulseIsLongEnough) {
  constexpr double kBraking = 4.0;  // [m/s^2]
  const auto setup = SetupWith([](robot::BaseControllerParams* controller) {
    MakeIdeal(controller);
    controller->stops_at_timeout = false;
    controller->limits.max_linear_acceleration = kBraking;
  });
  const auto report = FindLimits(Mill(0.5), setup, {});
  ASSERT_TRUE(report);
  // Each axis has a ramp of its own: a slanting stop is sqrt(2) times as hard.
  const double hardest = std::sqrt(2.0) * kBraking;
  const double speed = hardest * physics::OverturningPulseDuration(kMill, hardest, 9.81);
  ASSERT_LT(speed, report->Of("speed").robots_own);
  EXPECT_NEAR(report->Of("speed").value, speed, 2.0 * kScaleStep * speed);
}

TEST(MotionLimitsTest, WhoAllowsMoreFallsMayGoFurther) {
  const auto setup = SetupWith(nullptr, "");
  const auto strict = FindLimits(Mill(0.1), setup, {2, {}, {}});
  const auto lax = FindLimits(Mill(0.4), setup, {2, {}, {}});
  ASSERT_TRUE(strict && lax);
  EXPECT_LE(strict->Of("speed").value, lax->Of("speed").value);
  EXPECT_LT(lax->Of("speed").value, lax->Of("speed").robots_own);
  EXPECT_EQ(strict->num_truths, 29);
}

TEST(MotionLimitsTest, NewTruthsFallMoreOftenAboveALimit) {
  LimitsRequest request = Mill(0.4);
  request.check_truths = 120;
  const auto report = FindLimits(request, SetupWith(nullptr, ""), {2, {}, {}});
  ASSERT_TRUE(report);
  const LimitCheck& speed = *report->Of("speed").check;
  EXPECT_LE(speed.falls_at, 48);
  ASSERT_TRUE(speed.falls_above);
  EXPECT_GT(*speed.falls_above, speed.falls_at);
  EXPECT_THAT(LimitsText(*report), HasSubstr("of 120 new"));
}

TEST(MotionLimitsTest, AnyNumberOfThreadsFindsTheSame) {
  const auto setup = SetupWith(nullptr, "");
  const auto one = FindLimits(Mill(0.3), setup, {1, {}, {}});
  const auto three = FindLimits(Mill(0.3), setup, {3, {}, {}});
  ASSERT_TRUE(one && three);
  EXPECT_EQ(ToJson(*one).dump(), ToJson(*three).dump());
}

TEST(MotionLimitsTest, WhatIsPastedIsNoMoreThanWhatHoldsTogether) {
  const auto report = FindLimits(Mill(0.4), SetupWith(nullptr, ""), {2, {}, {}});
  ASSERT_TRUE(report);
  const std::string yaml = LimitsYaml(*report);
  base::ParamReader pasted = base::ParamReader::FromString(yaml, "pasted").Sub("DWAPlannerROS");
  const double share = report->Of("together").value;
  const auto number = [&](const std::string& key) { return pasted.Get(key, base::Positive()); };
  EXPECT_LE(number("max_vel_x"), share * report->Of("speed").value);
  EXPECT_GT(number("max_vel_x"), share * report->Of("speed").value - 0.0011);
  EXPECT_LE(number("acc_lim_x") * std::sqrt(2.0), share * report->Of("deceleration").value);
  EXPECT_LE(number("max_vel_theta"), share * report->Of("turning").value);
  EXPECT_EQ(number("max_vel_y"), number("max_vel_x"));
  const auto wheels =
      SetupWith([](auto* controller) { controller->drive = robot::Drive::kDifferential; });
  const auto two_wheels = FindLimits(Mill(0.5), wheels, {});
  ASSERT_TRUE(two_wheels);
  EXPECT_THAT(LimitsYaml(*two_wheels),
              AllOf(HasSubstr("max_vel_y: 0\n"), HasSubstr("min_vel_y: 0\n")));
}

TEST(MotionLimitsTest, TurningDoesNotPushWhatStandsOverTheBasesCentre) {
  const std::string folder = std::string(HIRES_SOURCE_DIR) + "/config/";
  imagination::SetupConfig config = imagination::ReadSetupConfig(folder + "scene.yaml");
  config.robot = folder + "robots/cart.yaml";  // its plate reaches over the base's centre
  config.uncertainty = "none";
  imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(config);
  simulation::Scene scene = *setup.scene;
  MakeIdeal(&scene.robot.profile.base_controller);
  scene.X_BO.translation.head<2>().setZero();
  setup.scene = std::make_shared<const simulation::Scene>(scene);
  EXPECT_NE(
      ClosedFormLimits({"peppermill1"}, setup).weakest[3].stated.find("turning does not push it"),
      std::string::npos);
}

TEST(MotionLimitsTest, ACarTurnsRoundItsSmallestCircle) {
  constexpr double kRadius = 0.5;
  const auto setup = SetupWith([](robot::BaseControllerParams* controller) {
    MakeIdeal(controller);
    controller->drive = robot::Drive::kCarLike;
    controller->min_turning_radius = kRadius;
    controller->limits.max_linear_velocity = 3.0;
    controller->limits.max_angular_velocity = 7.0;
  });
  const auto report = FindLimits(Mill(0.5), setup, {});
  ASSERT_TRUE(report);
  const auto& p_BO = setup.scene->X_BO.translation;
  const double arm = std::hypot(p_BO.x(), kRadius + std::abs(p_BO.y()));
  const double turning = physics::SuddenStopTopplingSpeed(kMill, 9.81) / arm;
  EXPECT_EQ(report->Of("turning").robots_own, 3.0 / kRadius);
  EXPECT_NEAR(report->Of("turning").closed_form, turning, kModel * turning);
  EXPECT_NEAR(report->Of("turning").value, turning, 2.0 * kScaleStep * turning);
  EXPECT_THAT(LimitsYaml(*report),
              AllOf(HasSubstr("TebLocalPlannerROS:"), HasSubstr("max_vel_y: 0\n"),
                    HasSubstr("min_turning_radius: 0.5\n")));
  EXPECT_EQ(report->num_directions, 2);
}

TEST(MotionLimitsTest, WhatStandsFirmlyIsAskedForAsFarAsTheWheelsBringTheBase) {
  const auto casters = SetupWith(nullptr, "");  // at full speed and turning, they slip
  for (const std::string object : {"coffee_cup1", "bowl1"}) {
    LimitsRequest request = Mill(0.3);
    request.objects = {object};
    const auto report = FindLimits(request, casters, {2, {}, {}});
    ASSERT_TRUE(report) << object;
    EXPECT_GT(report->Of("together").value, 0.0) << object;
    EXPECT_LE(report->Of("together").value, 1.0) << object;
  }
}

/// Robot plat: a differential base that stops within a step, a plate of 0.40 x 0.40 m.
imagination::ImaginationSetup PlateSetup(const hires::test_support::TemporaryFolder& folder,
                                         const std::vector<std::string>& objects,
                                         const std::string& place = "0, 0, 0") {
  const std::string config_folder = std::string(HIRES_SOURCE_DIR) + "/config/";
  imagination::SetupConfig config = imagination::ReadSetupConfig(config_folder + "scene.yaml");
  config.uncertainty = "none";
  config.extra_objects = objects;
  folder.Write("plat.urdf",
               "<robot name='plat'><link name='base'><collision><origin xyz='0 0 0.2'/><geometry>"
               "<box size='0.8 0.5 0.3'/></geometry></collision></link><joint name='j' "
               "type='fixed'><origin xyz='0 0 0.4'/><parent link='base'/><child link='tray'/>"
               "</joint><link name='tray'><collision><origin xyz='0 0 -0.01'/><geometry><box "
               "size='0.4 0.4 0.02'/></geometry></collision></link></robot>");
  config.robot = folder.Write(
      "plat.yaml",
      "urdf: plat.urdf\nbase_link: base\ntray_link: tray\nobject_on_tray: {xyz: [" + place +
          "], rpy: [0, 0, 0]}\nbase_controller: {drive: differential, at_timeout: stop, limits: "
          "{max_linear_velocity: 3.0, max_angular_velocity: 8.0, max_linear_acceleration: 12.0, "
          "max_angular_acceleration: 100.0}}\n");
  return imagination::LoadImaginationSetup(config);
}

std::string BoxFile(const hires::test_support::TemporaryFolder& folder, const std::string& name,
                    const std::string& size) {
  return folder.Write(name + ".yaml", "{shape: box, " + size + ", mass: 2.0, friction: 0.9}");
}

TEST(MotionLimitsTest, ClosedFormUsesTheDirectionOfTravel) {
  const hires::test_support::TemporaryFolder folder;
  const std::string deep = BoxFile(folder, "deep", "depth: 0.20, width: 0.10, height: 0.60");
  auto setup = PlateSetup(folder, {deep});
  const auto differential = ClosedFormLimits({"deep"}, setup).weakest;
  EXPECT_NEAR(differential[0].closed_form, 0.686, 0.0005);  // b = 0.10, c = 0.30
  EXPECT_NEAR(differential[1].closed_form, kGravity * 0.10 / 0.30, 1e-9);
  EXPECT_NEAR(differential[2].closed_form, kGravity * 0.10 / 0.30, 1e-9);
  simulation::Scene scene = *setup.scene;
  scene.robot.profile.base_controller.drive = robot::Drive::kOmnidirectional;
  setup.scene = std::make_shared<const simulation::Scene>(scene);
  EXPECT_NEAR(ClosedFormLimits({"deep"}, setup).weakest[1].closed_form, kGravity * 0.05 / 0.30,
              1e-9);
}

TEST(MotionLimitsTest, ClosedFormOfTurningFollowsThePositionOnTheTray) {
  const hires::test_support::TemporaryFolder folder;
  const std::string tall = BoxFile(folder, "tall", "depth: 0.10, width: 0.20, height: 0.60");
  const MotionBounds front =
      ClosedFormLimits({"tall"}, PlateSetup(folder, {tall}, "0.12, 0, 0")).weakest[3];
  // The centrifugal force acts along x (b = 0.05), the stop along y (b = 0.10).
  EXPECT_NEAR(front.closed_form, std::sqrt(kGravity * 0.05 / 0.30 / 0.12), 1e-6);
  EXPECT_THAT(front.stated, AllOf(HasSubstr("tips outward on the arc"), HasSubstr("5.72")));
  const MotionBounds side =
      ClosedFormLimits({"tall"}, PlateSetup(folder, {tall}, "0, 0.1, 0")).weakest[3];
  EXPECT_NEAR(side.closed_form, 0.333 / 0.1, 0.005);  // the stop acts along x
  EXPECT_THAT(side.stated, HasSubstr("topples where wheels lock"));
}

TEST(MotionLimitsTest, OverhangingPayloadTipsAboutThePlatesEdge) {
  const hires::test_support::TemporaryFolder folder;
  const std::string load = BoxFile(folder, "load", "depth: 1.0, width: 0.8, height: 1.6");
  const ClosedForms forms = ClosedFormLimits({"load"}, PlateSetup(folder, {load}));
  EXPECT_NEAR(forms.weakest[1].closed_form, kGravity * 0.20 / 0.80, 1e-9);
  // v = sqrt(2 g (R - c) I_A / m) / c with R = 0.8246 m, I_A / m = 0.9767 m^2
  EXPECT_NEAR(forms.weakest[0].closed_form, 0.858, 0.0005);
  EXPECT_NEAR(forms.payloads[0].overhang.x(), 0.30, 1e-9);
  EXPECT_NEAR(forms.payloads[0].overhang.y(), 0.20, 1e-9);
  EXPECT_THAT(ClosedFormText(forms, false), HasSubstr("load extends 0.30 / 0.20 m"));
}

TEST(MotionLimitsTest, CanAtThePlatesEdgeTipsOverItsRemainingSupport) {
  const hires::test_support::TemporaryFolder folder;
  const std::string can = folder.Write(
      "can.yaml", "{shape: cylinder, radius: 0.033, height: 0.2, mass: 0.5, friction: 0.9}");
  const ClosedForms inside = ClosedFormLimits({"can"}, PlateSetup(folder, {can}));
  EXPECT_NEAR(inside.weakest[1].closed_form, kGravity * 0.033 / 0.1, 1e-3);
  EXPECT_EQ(inside.payloads[0].overhang.maxCoeff(), 0.0);
  const ClosedForms edge = ClosedFormLimits({"can"}, PlateSetup(folder, {can}, "0.19, 0, 0"));
  EXPECT_NEAR(edge.weakest[1].closed_form, kGravity * 0.01 / 0.1, 1e-6);
  EXPECT_NEAR(edge.payloads[0].overhang.x(), 0.023, 1e-3);
}

TEST(MotionLimitsTest, LegsNextToThePlateAreRefusedWithTheReason) {
  const hires::test_support::TemporaryFolder folder;
  std::string shapes =
      "<collision name='deck'><pose>0 0 0.27 0 0 0</pose><geometry><box><size>1.0 0.8 0.04</size>"
      "</box></geometry></collision>";
  for (const auto& [name, pose] : {std::pair("a", "0.47 0.37"), std::pair("b", "0.47 -0.37"),
                                   std::pair("c", "-0.47 0.37"), std::pair("d", "-0.47 -0.37")}) {
    shapes += std::string("<collision name='") + name + "'><pose>" + pose +
              " 0.125 0 0 0</pose><geometry><box><size>0.04 0.04 0.25</size></box></geometry>"
              "</collision>";
  }
  const std::string shelf = folder.Write(
      "shelf.sdf",
      "<sdf version='1.7'><model name='shelf'><link name='l'><inertial><pose>0 0 0.27 0 0 0</pose>"
      "<mass>30</mass><inertia><ixx>2.6</ixx><iyy>3.5</iyy><izz>4.1</izz></inertia></inertial>" +
          shapes + "</link></model></sdf>");
  try {
    ClosedFormLimits({"shelf"}, PlateSetup(folder, {shelf}));
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'shelf'"), HasSubstr("no plate below them")));
  }
}

TEST(MotionLimitsTest, SlideOfTheStopIsNotOffsetByTheApproach) {
  const hires::test_support::TemporaryFolder folder;
  const std::string slick = folder.Write(
      "slick.yaml", "{shape: cylinder, radius: 0.1, height: 0.04, mass: 1.0, friction: 0.05}");
  auto setup = PlateSetup(folder, {slick});
  LimitsRequest request;
  request.objects = {"slick"};
  request.max_fall = 0.5;
  const auto report = FindLimits(request, setup, {});
  ASSERT_TRUE(report);
  // v = sqrt(2 s mu g): a slower approach must not make it slide farther than 0.10 m in the stop.
  const double speed = std::sqrt(2.0 * 0.10 * 0.05 * kGravity);
  EXPECT_NEAR(report->Of("speed").closed_form, speed, 1e-6);
  EXPECT_LE(report->Of("speed").value, speed * 1.005);
  EXPECT_GT(report->Of("speed").value, (1.0 - 2.0 * kScaleStep) * speed);
  EXPECT_LE(report->Of("speed").slide, 0.10);
  ASSERT_TRUE(report->careful && report->careful->value);
  const double careful = std::sqrt(2.0 * 0.02 * 0.05 * kGravity);
  EXPECT_LE(*report->careful->value, careful * 1.005);
  EXPECT_GT(*report->careful->value, (1.0 - 3.0 * kScaleStep) * careful);
  EXPECT_THAT(LimitsText(*report),
              AllOf(HasSubstr("slides at most 0.1 m"), HasSubstr("at any speed"),
                    HasSubstr("a faster robot has 0.490 m/s^2 (mu g)"),
                    HasSubstr("slide of at most 0.02 m")));
  EXPECT_THAT(LimitsYaml(*report), HasSubstr("slides at every start"));
  setup.standing.slide = 0.02;
  const auto strict = FindLimits(request, setup, {});
  ASSERT_TRUE(strict);
  EXPECT_FALSE(strict->careful);
  EXPECT_LE(strict->Of("speed").value, careful * 1.005);
}

TEST(MotionLimitsTest, SeveralObjectsHaveTheWeakestOnesClosedForms) {
  const hires::test_support::TemporaryFolder folder;
  const std::string low = BoxFile(folder, "low", "depth: 0.06, width: 0.06, height: 0.06");
  const std::string tall = BoxFile(folder, "tall", "depth: 0.06, width: 0.06, height: 0.30");
  const auto setup = PlateSetup(folder, {low, tall});
  const ClosedForms forms = ClosedFormLimits({"low", "tall"}, setup);
  ASSERT_EQ(forms.of_each.size(), 2u);
  EXPECT_EQ(forms.weakest[1].closed_form, forms.of_each[1][1].closed_form);
  EXPECT_THAT(forms.weakest[1].stated, HasSubstr("tall: tips"));
  EXPECT_THAT(ClosedFormText(forms, false), HasSubstr("together on the tray"));
  const auto both = FindLimits({{"low", "tall"}, false, 0.5}, setup, {});
  ASSERT_TRUE(both);
  EXPECT_EQ(both->payloads.size(), 2u);
  EXPECT_NEAR(both->Of("speed").closed_form, forms.of_each[1][0].closed_form, 1e-12);
}

TEST(MotionLimitsTest, ObjectsThatOverlapAreNamed) {
  const hires::test_support::TemporaryFolder folder;
  const std::string a = BoxFile(folder, "wide_a", "depth: 0.35, width: 0.35, height: 0.1");
  const std::string b = BoxFile(folder, "wide_b", "depth: 0.35, width: 0.35, height: 0.1");
  try {
    ClosedFormLimits({"wide_a", "wide_b"}, PlateSetup(folder, {a, b}));
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'wide_a' and 'wide_b' overlap")));
  }
}

TEST(MotionLimitsTest, GivenLimitsAreCheckedForEachObject) {
  const hires::test_support::TemporaryFolder folder;
  const std::string low = BoxFile(folder, "low", "depth: 0.08, width: 0.08, height: 0.04");
  const std::string tall = BoxFile(folder, "tall", "depth: 0.06, width: 0.06, height: 0.40");
  const auto setup = PlateSetup(folder, {low, tall});
  const GivenLimits given{
      {{"speed", 0.4}, {"acceleration", 1.0}, {"deceleration", 1.0}, {"turning", 0.5}}, {}, {}};
  const auto report = CheckGivenLimits({{"low", "tall"}, false, 0.5}, setup, given, {});
  ASSERT_TRUE(report);
  ASSERT_EQ(report->verdicts.size(), 10u);
  // A sudden stop from 0.4 m/s: the tall box topples from 0.14 m/s, the low one from 0.8 m/s.
  EXPECT_EQ(report->verdicts[0].object, "low");
  EXPECT_TRUE(report->verdicts[0].survives());
  EXPECT_EQ(report->verdicts[1].object, "tall");
  EXPECT_EQ(report->verdicts[1].falls, report->num_truths);
  EXPECT_EQ(report->verdicts[8].bounds.motion, "together");
  EXPECT_THAT(GivenText(*report, given), HasSubstr("no: 5 of 5 fail"));
  EXPECT_THAT(GivenCsv(*report),
              AllOf(HasSubstr("object,motion,unit,limit,source"),
                    HasSubstr("low,speed,m/s,0.4,given,"), HasSubstr("tall,speed,m/s,0.4,given,")));
}

TEST(GivenLimitsTest, ReadsRos1AndNav2Keys) {
  const hires::test_support::TemporaryFolder folder;
  const std::string dwa = folder.Write(
      "dwa.yaml",
      "DWAPlannerROS:\n  max_vel_x: 0.3\n  max_vel_y: 0.4\n  max_vel_trans: 0.45\n  max_vel_theta: "
      "1.0\n  acc_lim_x: 3.0\n  acc_lim_y: 4.0\n  acc_lim_theta: 2.0\n  sim_time: 1.7\n");
  const GivenLimits omni = ReadGivenLimits(dwa, true);
  EXPECT_EQ(omni.values.at("speed"), 0.45);  // of 0.5 along the diagonal
  EXPECT_EQ(omni.values.at("acceleration"), 5.0);
  EXPECT_EQ(omni.values.at("deceleration"), 5.0);
  EXPECT_EQ(omni.values.at("angular_acceleration"), 2.0);
  EXPECT_THAT(omni.unused, testing::ElementsAre("DWAPlannerROS: sim_time"));
  EXPECT_EQ(ReadGivenLimits(dwa, false).values.at("speed"), 0.3);
  const std::string nav2 = folder.Write(
      "nav2.yaml",
      "controller_server:\n  ros__parameters:\n    FollowPath:\n      max_vel_x: 0.5\n      "
      "acc_lim_x: "
      "2.5\n      decel_lim_x: -2.0\n      acc_lim_theta: 3.2\nvelocity_smoother:\n  "
      "ros__parameters:\n    max_velocity: [0.26, 0.0, 1.0]\n    min_velocity: [-0.3, 0.0, -1.0]\n"
      "    max_accel: [1.5, 0.0, 3.0]\n");
  const GivenLimits limits = ReadGivenLimits(nav2, false);
  EXPECT_EQ(limits.values.at("speed"), 0.3);  // backward
  EXPECT_EQ(limits.values.at("acceleration"), 1.5);
  EXPECT_EQ(limits.values.at("deceleration"), 2.0);  // of the controller
  EXPECT_EQ(limits.values.at("angular_acceleration"), 3.0);
  EXPECT_EQ(limits.used.size(), 2u);
  const std::string both = folder.Write("both.yaml", "max_accel: [1, 1, 1]\nmax_vel_x: 0.2\n");
  const GivenLimits ros1 = ReadGivenLimits(both, false);
  EXPECT_EQ(ros1.values.count("acceleration"), 0u);
  EXPECT_THAT(ros1.used, testing::ElementsAre("max_vel_x"));
  EXPECT_THAT(ros1.unused, testing::ElementsAre("max_accel"));
}

TEST(GivenLimitsTest, NamesAllThatIsWrong) {
  const hires::test_support::TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) {
    try {
      ReadGivenLimits(folder.Write("given.yaml", text), false);
    } catch (const base::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error_of("DWAPlannerROS:\n  max_vel_x: fast\n  acc_lim_x: .nan\n"),
              AllOf(HasSubstr("given.yaml:2: DWAPlannerROS: max_vel_x is fast; expected a finite"),
                    HasSubstr("given.yaml:3: DWAPlannerROS: acc_lim_x is .nan")));
  EXPECT_THAT(error_of("max_accel: [1, 2]\n"), HasSubstr("a list of 3 numbers"));
  EXPECT_THAT(error_of("max_val_x: 0.3\n"),
              AllOf(HasSubstr("no limits found"), HasSubstr("max_val_x")));
  EXPECT_THAT(error_of("max_vel_x: 0\nacc_lim_x: 0\n"),
              AllOf(HasSubstr("speed is 0"), HasSubstr("acceleration is 0")));
  EXPECT_THAT(error_of("a: [\n"), HasSubstr("not valid YAML"));
}

TEST(MotionLimitsTest, EndsWhenItIsCancelled) {
  EXPECT_FALSE(FindLimits(Mill(0.3), SetupWith(nullptr, ""), {2, [] { return true; }, {}}));
}

TEST(MotionLimitsTest, SaysWhatCannotBeCarried) {
  const auto error_of = [](const std::string& object, const imagination::ImaginationSetup& setup) {
    LimitsRequest request = Mill(0.5);
    request.objects = {object};
    try {
      FindLimits(request, setup, {});
    } catch (const base::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error_of("pepermill1", SetupWith()), HasSubstr("peppermill1"));
  const auto idle = SetupWith([](robot::BaseControllerParams* controller) {
    controller->limits.max_linear_acceleration = 0.0;
  });
  EXPECT_THAT(error_of("peppermill1", idle), HasSubstr("max_linear_acceleration is 0"));
  const auto hasty = SetupWith([](robot::BaseControllerParams* controller) {
    MakeIdeal(controller);
    controller->limits.max_linear_velocity = 12.0;
  });
  EXPECT_THAT(error_of("peppermill1", hasty),
              AllOf(HasSubstr("peppermill1"), HasSubstr("speed"), HasSubstr("--max-fall")));
}

}  // namespace
}  // namespace hires::reports::motion_limits_test
