// Docking at the restaurant's own furniture by what the laser sees, as the shipped files have it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/rng.h"
#include "hires/robot/scan_memory.h"
#include "hires/skills/move_base.h"
#include "hires/world/occupancy_grid.h"
#include "restaurant.h"
#include "skills/laser_robot.h"
#include "skills/point_robot.h"

namespace hires::skills::docking_test {
namespace {

using geometry::Pose2;
using test_support::TheRestaurant;

constexpr double kTolerance = 0.03;  // [m] of a blind drive
constexpr double kBaseTop = 0.35;    // [m] of what drives below tops of tables
constexpr int kCyclesOfAScan = 8;    // 0.4 s, as in rollouts
const Pose2 X_BL{0.275, 0.0, 0.0};   // base_laser_link of the PR2
const std::vector<std::string> kDocks{"eastcounter1", "northtable1", "southtable1", "westtable2",
                                      "easttable2"};

/// The restaurant's skills with local control by the laser.
SkillSet MakeSkills(bool by_seen_place) {
  const simulation::Scene& scene = *TheRestaurant().scene;
  MoveBaseParams driving;
  driving.obstacle_layer.emplace();
  if (by_seen_place) driving.seen_place.emplace();
  base::ParamReader file = base::ParamReader::FromFile(test_support::InSource("config/scene.yaml"));
  return MakeSkillSet(scene.world, scene.robot, driving, {},
                      ReadManipulationParams(file.Sub("manipulation")));
}

const SkillSet& Skills() {
  static const SkillSet skills = MakeSkills(true);
  return skills;
}

const Pose2& Area(const std::string& name) { return Skills().areas.at(name); }

/// Outlines of what stands between two heights [m].
std::vector<geometry::Polygon> Outlines(double lower, double upper) {
  return world::OutlinesInBand(TheRestaurant().scene->world, nullptr, lower, upper);
}

struct Docking {
  test_support::SkillRun run;
  double off_goal{0.0};                                  // [m] in truth
  double clearance{std::numeric_limits<double>::max()};  // [m] the least on the way
};

/// @param off   of the goal, by which the map, and so the told place, is off round it.
/// @param slip  [m] by which the base slides aside after 1.5 s, without its wheels.
Docking Dock(const std::string& dock, const Pose2& off, base::Rng* rng, double slip = 0.0,
             const SkillSet& skills = Skills()) {
  static const double plane = *TheRestaurant().scene->laser_height;
  static const auto seen = Outlines(plane, plane), solid = Outlines(0.02, kBaseTop);
  const hires::test_support::Beams beams{-2.2689, 4.5378 / 119, 120, 0.08, 10.0, rng};
  const std::string goal = "manipulationarea" + dock;
  const auto skill = MakeSkill(skills, {"move_base_blind", {goal}});
  const Pose2 X_WM = Area(goal) * off * Area(goal).Inverse();
  Docking docking;
  Pose2 X_OM, X_WB;
  int cycle = 0;
  robot::ScanMemory memory(skills.driving->base);
  std::shared_ptr<const robot::PlacedScan> scan;
  const test_support::PointRobot start{X_WM.Inverse() * Area("pre" + goal), {}, false};
  docking.run = RunSkill(skill.get(), start, [&](auto* observation, auto* robot) {
    if (cycle == 30) {
      const Pose2 X_MBefore = robot->X_MB;
      robot->X_MB = X_MBefore * Pose2{0.0, slip, 0.0};
      X_OM = X_MBefore * robot->X_MB.Inverse();
    }
    X_WB = X_WM * robot->X_MB;
    observation->X_OB = X_OM * robot->X_MB;
    if (cycle++ % kCyclesOfAScan == 0) {
      auto now = hires::test_support::ScanOf(seen, X_WB, observation->X_OB, X_BL, beams);
      memory.Complete(observation->time, &now);
      scan = std::make_shared<const robot::PlacedScan>(std::move(now));
    }
    observation->scan = scan;
    const geometry::Polygon body = geometry::Transformed(X_WB, Skills().driving->base);
    for (const geometry::Polygon& outline : solid)
      docking.clearance = std::min(docking.clearance, geometry::Distance(body, outline));
  });
  docking.off_goal = (X_WB.position() - Area(goal).position()).norm();
  return docking;
}

void ExpectDocked(const Docking& docking, const std::string& what) {
  EXPECT_EQ(docking.run.status.progress, Progress::kSucceeded)
      << what << ": " << ToString(docking.run.status.failure);
  EXPECT_LT(docking.off_goal, kTolerance + 0.015) << what;
  EXPECT_GT(docking.clearance, 0.0) << what;
}

TEST(DockingTest, WhoeverIsToldAWrongPlaceDocksWhereTheFurnitureIs) {
  base::Rng rng(11);
  for (const std::string& dock : kDocks) {
    for (const Pose2& off :
         {Pose2{}, Pose2{0.04, -0.03, 0.01}, Pose2{-0.04, 0.03, -0.015}, Pose2{0.03, 0.05, 0.0}}) {
      const Docking docking = Dock(dock, off, &rng);
      ExpectDocked(docking, fmt::format("{}, told off by {} {} {}", dock, off.x, off.y, off.yaw));
    }
  }
}

/// Else the others show nothing.
TEST(DockingTest, ByTheToldPlaceItWouldMissIt) {
  base::Rng rng(11);
  const SkillSet told = MakeSkills(false);
  const Docking docking = Dock("northtable1", {0.03, 0.05, 0.0}, &rng, 0.0, told);
  EXPECT_GT(docking.off_goal, kTolerance + 0.015);
}

TEST(DockingTest, ASlipThatNoWheelNoticesIsSeen) {
  base::Rng rng(12);
  for (const std::string& dock : kDocks) {
    for (const double slip : {-0.03, 0.03}) {
      const Docking docking = Dock(dock, {0.02, -0.02, 0.0}, &rng, slip);
      ExpectDocked(docking, fmt::format("{}, slip of {} m", dock, slip));
    }
  }
}

}  // namespace
}  // namespace hires::skills::docking_test
