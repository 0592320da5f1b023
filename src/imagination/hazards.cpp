#include "imagination/hazards.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "hires/base/text.h"
#include "hires/robot/posture.h"
#include "imagination/rollout/rollout_start.h"
#include "simulation/floor/robot_balance.h"
#include "world/liquid.h"

namespace hires::imagination {
namespace {

using Sentences = std::vector<std::string>;
using MotionSets = std::map<std::string, robot::MotionSet>;

constexpr double kOnFloor = 0.02;     // [m] a threshold begins no higher
constexpr double kLeastStep = 0.001;  // [m] what is lower is floor

/// What driving actions name, with names in lower case, and their own limits.
MotionSets DrivingLimitsOf(const RolloutSetup& setup, const std::vector<base::ActionCall>& drives) {
  const robot::MotionSet& own = setup.scene->robot.profile.base_controller.limits;
  MotionSets sets;
  for (const base::ActionCall& drive : drives) {
    const std::string name = skills::MotionSetNameOf(*setup.skills, drive);
    const auto found = setup.skills->motion_sets.find(name);
    if (found == setup.skills->motion_sets.end()) continue;
    robot::MotionSet& set = sets[name] = found->second;
    for (double robot::MotionSet::*limit :
         {&robot::MotionSet::max_linear_velocity, &robot::MotionSet::max_angular_velocity,
          &robot::MotionSet::max_linear_acceleration})
      set.*limit = std::min(set.*limit, own.*limit);
  }
  return sets;
}

void AddTipping(const RolloutSetup& setup, const simulation::RobotSimulator& start,
                const MotionSets& sets, Sentences* texts) {
  const robot::Robot& robot = setup.scene->robot;
  const auto loaded = simulation::BalanceOf(start);
  if (!loaded || !loaded->IsStableAtRest()) {
    texts->push_back(
        fmt::format("whether the robot itself tips over is not checked: {}; correct the <inertial> "
                    "of its links",
                    loaded ? "by its URDF's masses it falls at rest" : "its URDF gives no masses"));
    return;
  }
  if (loaded->support.is_assumed) {
    texts->push_back(fmt::format(
        "assumed of the robot, support: {} of its wheels, casters and skids are on the floor, so "
        "whether it tips over is computed for its footprint; add collision shapes of the others",
        loaded->support.num_contacts));
  }
  const auto alone = simulation::BalanceOf(robot, robot::PostureOf(robot, setup.robot_state.joints),
                                           {}, setup.scene->world.gravity);
  const robot::Drive drive = robot.profile.base_controller.drive;
  const auto add = [&](const std::string& what, double demanded, double bears, double alone_bears) {
    if (demanded <= bears) return;
    texts->push_back(fmt::format(
        "the robot itself may tip over: {} {:.2f} m/s^2. By g b / c, if it lasts, the robot alone "
        "{}; with its payload it {}",
        what, demanded, alone->Text(alone_bears), loaded->Text(bears)));
  };
  for (const auto& [name, set] : sets) {
    add(fmt::format("motion set {} accelerates by up to", name), set.max_linear_acceleration,
        loaded->TippingAcceleration(drive), alone->TippingAcceleration(drive));
    add(fmt::format("arcs of motion set {} push it sideways by up to", name),
        set.max_linear_velocity * set.max_angular_velocity, loaded->SidewaysTippingAcceleration(),
        alone->SidewaysTippingAcceleration());
  }
}

void AddLiquid(const std::string& object, const world::ObjectModel& model, double gravity,
               const MotionSets& sets, Sentences* texts) {
  const std::string unknown = UnknownLiquidText(object, model);
  if (!unknown.empty()) texts->push_back(unknown);
  if (!model.liquid) return;
  const world::Liquid& liquid = *model.liquid;
  const double spills = SpillingAcceleration(liquid, gravity);
  for (const auto& [name, set] : sets) {
    const double a = set.max_linear_acceleration;
    const double rise = 1e3 * physics::SurfaceRise(a, liquid.radius, gravity);  // [mm]
    if (a <= spills) continue;
    texts->push_back(fmt::format(
        "the liquid in {} may spill, which is not simulated: motion set {} accelerates by up to "
        "{:.2f} m/s^2, which raises the surface by {:.1f} mm, after a sudden start by {:.1f} mm; "
        "the rim is {:.1f} mm above it, reached from {:.2f} m/s^2 (first sloshing mode {:.2f} Hz)",
        object, name, a, rise, physics::kSuddenSlosh * rise, 1e3 * (liquid.rim - liquid.fill),
        spills, physics::SloshFrequency(liquid.radius, liquid.fill, gravity) / (2.0 * M_PI)));
  }
}

void AddLiquids(const RolloutSetup& setup, const simulation::RobotSimulator& start,
                const MotionSets& sets, Sentences* texts) {
  const world::World& world = setup.scene->world;
  const std::vector<int>& on_tray = start.carried();
  const auto& objects = setup.world_state.objects;
  for (int i = 0; i < static_cast<int>(objects.size()); ++i) {
    const bool is_on_tray = std::count(on_tray.begin(), on_tray.end(), i) > 0;
    if (is_on_tray || !objects[i].attached_to.empty())
      AddLiquid(objects[i].name, *world.ModelOf(objects[i]), world.gravity, sets, texts);
  }
}

/// A static body that wheels roll over.
struct LowBody {
  std::string name;
  geometry::Polygon outline_M;
  double height{0.0};  // [m]
};

std::vector<LowBody> LowBodiesOf(const RolloutSetup& setup) {
  const double most = setup.skills->driving->params.min_obstacle_height;
  std::vector<LowBody> low;
  for (const world::StaticBody& body : setup.scene->world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      const geometry::Pose3 X_MS = body.X_MB * shape.X_BS;
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_MS);
      const double height = bounds.upper.z();
      if (bounds.lower.z() > kOnFloor || height < kLeastStep || height > most) continue;
      const auto outline = geometry::OutlineInBand(shape.shape, X_MS, kLeastStep, height);
      if (outline) low.push_back({world::NameOf(body, shape), *outline, height});
    }
  }
  return low;
}

/// As the skill plans it from the start; empty: it plans none.
std::vector<geometry::Pose2> RouteOf(const RolloutSetup& setup, const base::ActionCall& drive,
                                     simulation::RobotSimulator* start) {
  const auto skill = skills::MakeSkill(*setup.skills, drive);
  robot::Command command;
  skill->Update(start->Observe(0.0), &command);
  const auto view = skill->drive_view();
  return view && view->path ? *view->path : std::vector<geometry::Pose2>();
}

/// Whether it comes onto the body or leaves it. A body that is below all of the route is floor.
bool LeadsOver(const std::vector<geometry::Pose2>& route, const geometry::Polygon& support_B,
               const LowBody& body) {
  bool is_on = false, is_off = false;
  for (const geometry::Pose2& X_MB : route) {
    const bool touches =
        geometry::Distance(geometry::Transformed(X_MB, support_B), body.outline_M) <= 0.0;
    (touches ? is_on : is_off) = true;
  }
  return is_on && is_off;
}

std::string StepText(const LowBody& body, double speed, const std::optional<double>& radius) {
  std::string effect = "its wheels have no shapes, so what speed they lose is unknown";
  if (radius) {
    effect = fmt::format("a wheel of radius {:.3f} m loses {:.2f} m/s of {:.2f} m/s at once",
                         *radius, physics::SpeedLossAtStep(speed, body.height, *radius), speed);
  }
  return fmt::format(
      "the route leads over '{}' ({:.3f} m high): {}; what that does to robot and payload is not "
      "simulated",
      body.name, body.height, effect);
}

void AddSteps(const RolloutSetup& setup, const std::vector<base::ActionCall>& drives,
              const MotionSets& sets, const robot::FloorSupport& support,
              simulation::RobotSimulator* start, Sentences* texts) {
  const std::vector<LowBody> low = LowBodiesOf(setup);
  if (low.empty()) return;
  std::vector<double> speeds(low.size(), -1.0);  // [m/s] of the fastest that crosses it
  for (const base::ActionCall& drive : drives) {
    const auto set = sets.find(skills::MotionSetNameOf(*setup.skills, drive));
    const double speed = set == sets.end() ? 0.0 : set->second.max_linear_velocity;
    const std::vector<geometry::Pose2> route = RouteOf(setup, drive, start);
    for (std::size_t i = 0; i < low.size(); ++i)
      if (LeadsOver(route, support.polygon, low[i])) speeds[i] = std::max(speeds[i], speed);
  }
  for (std::size_t i = 0; i < low.size(); ++i)
    if (speeds[i] >= 0.0) texts->push_back(StepText(low[i], speeds[i], support.wheel_radius));
}

}  // namespace

Sentences HazardsOf(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions) {
  Sentences texts;
  if (actions.empty()) return texts;
  std::vector<base::ActionCall> drives;
  for (const base::ActionCall& action : actions)
    if (skills::SpecOf(*setup.skills, action).driving != actions::Driving::kNone)
      drives.push_back(action);
  simulation::RobotSimulator start(setup.scene, {}, setup.world_state, setup.robot_state,
                                   base::Rng(setup.seed), setup.physics,
                                   LevelFor(*setup.skills, actions.front()));
  const MotionSets sets = DrivingLimitsOf(setup, drives);
  AddLiquids(setup, start, sets, &texts);
  if (drives.empty()) return texts;
  const robot::Robot& robot = setup.scene->robot;
  const robot::FloorSupport support =
      robot::FloorSupportOf(robot, robot::PostureOf(robot, setup.robot_state.joints));
  AddTipping(setup, start, sets, &texts);
  AddSteps(setup, drives, sets, support, &start, &texts);
  for (const std::string& cart : support.towed) {
    texts.push_back(
        fmt::format("the robot tows '{}' by a passive hitch, which is simulated as rigid: how the "
                    "cart swings, cuts corners or jackknifes, and its weight, are not simulated",
                    cart));
  }
  return texts;
}

std::string UnknownLiquidText(const std::string& object, const world::ObjectModel& model) {
  if (!world::MayHoldUnknownLiquid(model)) return "";
  return fmt::format(
      "left out: liquids that slosh ({} may hold one; describe it by `liquid: {{radius: .., fill: "
      ".., rim: ..}}` in its file, or by `liquids` in the catalogue)",
      object);
}

double SpillingAcceleration(const world::Liquid& liquid, double gravity) {
  return (liquid.rim - liquid.fill) /
         (physics::kSuddenSlosh * physics::SurfaceRise(1.0, liquid.radius, gravity));
}

}  // namespace hires::imagination
