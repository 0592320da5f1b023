#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/navigation/hybrid_a_star.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/skills/move_base.h"
#include "support/scenes.h"

/// Whole drives in the simulator, one after the other in one process, as rollouts play them: a base
/// with its lag and slip, a place that errs, cycles that come late.
namespace hires::skills::test_support {

constexpr double kLongestDrive = 300.0;  ///< [s] time_limit of config/scene.yaml

/// A box on wheels of a drive.
inline robot::Robot BoxOnWheels(robot::Drive drive, const Eigen::Vector2d& size = {0.5, 0.4}) {
  robot::Link base;
  base.name = "base";
  base.collisions = {hires::test_support::Shape("box", geometry::Box{{size.x(), size.y(), 0.2}},
                                                {0.0, 0.0, 0.16})};
  robot::Robot robot;
  robot.model.name = "box_on_wheels";
  robot.model.links = {base};
  robot.profile.base_link = "base";
  const double x = 0.5 * size.x(), y = 0.5 * size.y();
  robot.profile.footprint = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  robot.profile.base_controller.drive = drive;
  if (drive == robot::Drive::kCarLike) robot.profile.base_controller.min_turning_radius = 0.75;
  return robot;
}

/// As config/uncertainty.yaml draws what concerns a drive.
inline simulation::Variation DrawnDrive(base::Rng* rng) {
  simulation::Variation drawn;
  drawn.localisation_bias = {rng->Normal(0.0, 0.03), rng->Normal(0.0, 0.03),
                             rng->Normal(0.0, 0.02)};
  drawn.localisation_noise = drawn.localisation_noise_yaw = 0.002;
  drawn.wheel_slip = rng->Uniform(0.0, 0.03);
  drawn.command_delay = rng->Uniform(0.0, 0.05);
  drawn.late_cycle_probability = rng->Uniform(0.0, 0.0015);
  drawn.late_cycle_delay = rng->Uniform(0.1, 0.5);
  return drawn;
}

struct Leg {
  geometry::Pose2 X_MStart, X_MGoal;
};

struct PlayedLeg {
  Status status;
  double duration{0.0};  ///< [s]
  std::optional<simulation::RobotContact> contact;
  geometry::Pose2 X_MB;  ///< where it really stands in the end
};

using OnCycle = std::function<void(const simulation::RobotSimulator&, const robot::Observation&,
                                   const robot::Command&)>;

/// Until the skill ends, the robot touches something or time is over.
inline PlayedLeg PlayLeg(const std::shared_ptr<const simulation::Scene>& scene,
                         const std::shared_ptr<const DrivingContext>& context, const Leg& leg,
                         const robot::MotionSet& motion_set, base::Rng rng,
                         const OnCycle& on_cycle = {}) {
  const simulation::Variation variation = DrawnDrive(&rng);
  simulation::RobotSimulator simulator(scene, variation, {},
                                       hires::test_support::StandingAt(leg.X_MStart), rng.Fork(1));
  MoveBase skill(context, leg.X_MGoal, motion_set);
  base::Rng cycles = rng.Fork(2);
  PlayedLeg played;
  double next_cycle = 0.0;
  while (played.status.progress == Progress::kRunning && simulator.time() < kLongestDrive) {
    if (simulator.time() >= next_cycle - 0.5 * simulator.time_step()) {
      robot::Command command;
      const robot::Observation seen = simulator.Observe(0.0);
      played.status = skill.Update(seen, &command);
      if (on_cycle) on_cycle(simulator, seen, command);
      simulator.Send(command);
      next_cycle += skill.period();
      if (cycles.Bernoulli(variation.late_cycle_probability))
        next_cycle += variation.late_cycle_delay;
    }
    simulator.Step();
    played.contact = simulator.contact();
    if (played.contact) played.status = Failed(base::FailureCode::kRobotCollision);
  }
  if (played.status.progress == Progress::kRunning)
    played.status = Failed(base::FailureCode::kTimedOut);
  played.duration = simulator.time();
  played.X_MB = simulator.base().X_MB;
  return played;
}

/// [rad] by which the heading of a way changes, seen in pieces of 1 m, with what the base turns
/// before and after.
inline double TurnsOf(const std::vector<geometry::Pose2>& way, const Leg& leg) {
  double turns = 0.0, heading = leg.X_MStart.yaw;
  Eigen::Vector2d from = way.front().position();
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Eigen::Vector2d piece = way[i].position() - from;
    if (piece.norm() < 1.0 && i + 1 < way.size()) continue;
    const double ahead = std::atan2(piece.y(), piece.x());
    turns += std::abs(geometry::WrapToPi(ahead - heading));
    heading = ahead;
    from = way[i].position();
  }
  return turns + std::abs(geometry::WrapToPi(leg.X_MGoal.yaw - heading));
}

/// [m] Kept from things by who drives by the map alone, as imagination has it for DrawnDrive: 2.5
/// standard deviations of the place, and of the heading at the footprint's corners.
inline double PlaceMarginOf(const robot::Robot& robot) {
  return 2.5 * std::hypot(0.03, 0.02 * geometry::CircumscribedRadius(robot.profile.footprint));
}

/// The way as it is planned: the straight one where nothing is near it, else A*'s. Of a car: its
/// arcs. Empty: there is none.
inline std::vector<geometry::Pose2> PlannedWay(const DrivingContext& context, const Leg& leg) {
  const navigation::Costmap& costmap = *context.costmap;
  const robot::BaseControllerParams& base = context.robot->profile.base_controller;
  std::vector<geometry::Pose2> way;
  if (base.drive == robot::Drive::kCarLike) {
    for (const auto& pose : navigation::PlanCarPath(costmap, context.footprint, leg.X_MStart,
                                                    leg.X_MGoal, base.min_turning_radius)
                                .path)
      way.push_back(pose.X_MB);
    return way;
  }
  const Eigen::Vector2d from = leg.X_MStart.position(), along = leg.X_MGoal.position() - from;
  bool is_free = true;
  for (double share = 0.0; share <= 1.0 && is_free; share += 0.01) {
    int column = 0, row = 0;
    costmap.CellOf(from + share * along, &column, &row);
    is_free = costmap.Inside(column, row) && costmap.cost(column, row) == navigation::kFreeCost;
  }
  if (is_free) return {leg.X_MStart, leg.X_MGoal};
  return navigation::PlanPath(costmap, leg.X_MStart, leg.X_MGoal).path;
}

/// [s] that a drive may take: its way at full speed, its turns at theirs, and 10 s. 0: there is no
/// way.
inline double LongestFor(const DrivingContext& context, const Leg& leg,
                         const robot::MotionSet& motion_set) {
  constexpr double kSurplus = 10.0;
  const std::vector<geometry::Pose2> way = PlannedWay(context, leg);
  if (way.empty()) return 0.0;
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    length += (way[i].position() - way[i - 1].position()).norm();
  return length / motion_set.max_linear_velocity +
         TurnsOf(way, leg) / motion_set.max_angular_velocity + kSurplus;
}

/// A wall from one place to another [m], 0.1 m thick.
inline world::StaticBody Wall(const std::string& name, const Eigen::Vector2d& from,
                              const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = (to - from).cwiseAbs(), middle = 0.5 * (from + to);
  return hires::test_support::Block(name, {along.x() + 0.1, along.y() + 0.1, 1.0},
                                    {middle.x(), middle.y(), 0.5});
}

/// 12 m x 8 m: four rooms and a corridor with doors of 1 m, and furniture.
inline world::World House() {
  world::World house;
  house.name = "house";
  const auto add = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    house.statics.push_back(Wall("wall_" + std::to_string(house.statics.size()), from, to));
  };
  add({0, 0}, {12, 0});
  add({0, 8}, {12, 8});
  add({0, 0}, {0, 8});
  add({12, 0}, {12, 8});
  add({0, 3.2}, {2.5, 3.2});
  add({3.5, 3.2}, {8.5, 3.2});
  add({9.5, 3.2}, {12, 3.2});
  add({0, 4.8}, {4.0, 4.8});
  add({5.0, 4.8}, {7.5, 4.8});
  add({8.5, 4.8}, {12, 4.8});
  add({6, 0}, {6, 3.2});
  add({6, 4.8}, {6, 8});
  house.statics.push_back(hires::test_support::Block("table", {1.4, 0.8, 0.7}, {1.6, 1.2, 0.35}));
  house.statics.push_back(hires::test_support::Block("bed", {2.0, 1.4, 0.5}, {10.9, 7.2, 0.25}));
  house.statics.push_back(hires::test_support::Block("shelf", {0.4, 1.6, 1.8}, {6.3, 1.2, 0.9}));
  house.statics.push_back(hires::test_support::Block("chair", {0.45, 0.45, 0.9}, {3.2, 6.4, 0.45}));
  house.hash = house.ComputeHash();
  return house;
}

/// The floor alone, x and y from 0 to `size` [m].
inline world::World EmptyFloor(const Eigen::Vector2d& size) {
  world::World floor;
  floor.name = "floor";
  hires::test_support::AddArea(&floor, "Near", geometry::Lift({0.0, 0.0, 0.0}));
  hires::test_support::AddArea(&floor, "Far", geometry::Lift({size.x(), size.y(), 0.0}));
  floor.hash = floor.ComputeHash();
  return floor;
}

}  // namespace hires::skills::test_support
