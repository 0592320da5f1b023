#include "imagination/rollout/reach_watch.h"

#include <algorithm>
#include <cmath>

#include "hires/actions/catalogue.h"
#include "hires/base/text.h"
#include "hires/robot/posture.h"
#include "hires/skills/move_base.h"
#include "imagination/rollout/floor_objects.h"

namespace hires::imagination {
namespace {

using Disc = RolloutReach::Disc;
using Eigen::Vector2d;

// [m] Fidelity only: whatever these are, what was left out has changed nothing.
constexpr double kAtEnds = 1.0;   // around start and goal: what is in at once
constexpr double kStride = 0.1;   // between two places that are noted
constexpr double kMargin = 0.1;   // that is left between what moves and what was left out
constexpr double kCompany = 0.5;  // around what was come near to: all that is in then, too
constexpr double kAside = 1.0;    // of the straight way to the goal: what may come in sight, is in
constexpr double kNoise = 0.5;    // by which no range errs

/// [m] How far its bounds reach from the body's origin, along each axis.
Eigen::Vector3d FarthestOf(const geometry::Collision& shape) {
  const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, shape.X_BS);
  return bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs());
}

double RadiusOf(const std::vector<geometry::Collision>& shapes) {
  double radius = 0.0;
  for (const geometry::Collision& shape : shapes) {
    radius = std::max(radius, FarthestOf(shape).norm());
  }
  return radius;
}

/// From above, of a robot with these joints.
double RadiusOf(const simulation::Scene& scene, const robot::JointPositions& joints) {
  const robot::JointPositions posture = robot::PostureOf(scene.robot, joints);
  const bool is_usual = posture == robot::PostureOf(scene.robot, {});
  double radius = 0.0;
  for (const geometry::Collision& shape :
       is_usual ? scene.robot_shapes_B : simulation::FrozenShapes(scene.robot, posture)) {
    radius = std::max(radius, FarthestOf(shape).head<2>().norm());
  }
  return radius;
}

double RadiusOf(const RolloutSetup& setup, const world::ObjectState& object) {
  return RadiusOf(setup.scene->world.RequireModel(object.model)->collisions);
}

Disc DiscOf(const RolloutSetup& setup, const world::ObjectState& object) {
  return {object.X_MO.translation.head<2>(), RadiusOf(setup, object)};
}

bool Meet(const Disc& a, const Disc& b) {
  const double apart = a.radius + b.radius;
  return (a.p_M - b.p_M).squaredNorm() <= apart * apart;
}

bool IsAtRest(const world::ObjectState& object) {
  return object.V_MO.linear.isZero(0.0) && object.V_MO.angular.isZero(0.0);
}

/// [m] of the base's laser from the base, seen from above.
double LaserOffset(const RolloutSetup& setup) {
  const robot::Robot& robot = setup.scene->robot;
  const auto laser = robot.model.FindLink(robot.profile.laser_link);
  if (!laser) return 0.0;
  const auto X_RL =
      robot::ForwardKinematics(robot.model, robot::PostureOf(robot, setup.robot_state.joints));
  const geometry::Pose3& X_RB = X_RL[*robot.model.FindLink(robot.profile.base_link)];
  return (X_RB.Inverse() * X_RL[*laser]).translation.head<2>().norm();
}

bool IsNamedBy(const base::ActionCall& action, const std::string& name) {
  return std::any_of(action.arguments.begin(), action.arguments.end(), [&](const auto& argument) {
    return base::ToLower(argument) == base::ToLower(name);
  });
}

bool IsAlwaysWithin(const RolloutReach& reach, const RolloutSetup& setup,
                    const base::ActionCall& action, const world::ObjectState& object) {
  const bool is_own = !object.attached_to.empty() || IsNamedBy(action, object.name);
  return reach.is_everything || is_own || !IsAtRest(object) ||
         !setup.scene->world.FindModel(object.model);  // which is refused by name
}

}  // namespace

bool AllAreAtRest(const world::WorldState& state) {
  return std::all_of(state.objects.begin(), state.objects.end(), [](const auto& object) {
    return !object.attached_to.empty() || IsAtRest(object);
  });
}

bool RolloutReach::Touches(const Disc& other) const {
  return std::any_of(discs.begin(), discs.end(),
                     [&](const Disc& disc) { return Meet(disc, other); });
}

std::optional<double> SightOf(const RolloutSetup& setup, const base::ActionCall& action) {
  const auto& own = actions::OwnActions().specs();
  const auto spec = own.find(action.name);
  const bool is_known =
      spec != own.end() && spec->second.driving == actions::Driving::kRoundObstacles;
  if (!is_known || setup.scene->self_localisation || !setup.skills->driving) return std::nullopt;
  double sight = FloorObjects::kRange;
  const skills::MoveBaseParams& params = setup.skills->driving->params;
  if (params.obstacle_layer) {
    sight = std::max(
        {sight, params.obstacle_layer->obstacle_range, params.obstacle_layer->raytrace_range});
  }
  if (params.seen_place) sight = std::max(sight, params.seen_place->match.reach);
  if (setup.scene->sight.scans) sight += setup.scene->sight.scans->laser.mixing_depth;
  return sight + LaserOffset(setup) + kNoise;
}

bool IsWithin(const RolloutReach& reach, const RolloutSetup& setup, const base::ActionCall& action,
              const world::ObjectState& object) {
  if (IsAlwaysWithin(reach, setup, action, object)) return true;
  Disc disc = DiscOf(setup, object);
  if (IsInLaserPlane(*setup.scene, object)) {
    const auto sight = SightOf(setup, action);
    if (!sight) return true;
    disc.radius += *sight;
  }
  return reach.Touches(disc);
}

ReachWatch::ReachWatch(const RolloutSetup& setup, const base::ActionCall& action)
    : setup_(setup),
      action_(action),
      sight_(SightOf(setup, action)),
      robot_radius_(RadiusOf(*setup.scene, setup.robot_state.joints)),
      narrowed_(setup) {
  reach_.is_everything = seen_.is_everything = false;
  reach_.discs.push_back({setup.robot_state.X_MB.position(), kAtEnds});
  SeeTheWay(setup.robot_state.X_MB.position());
  for (const std::string& argument : action.arguments) {
    const auto area = setup.skills->areas.find(base::ToLower(argument));
    if (area != setup.skills->areas.end()) {
      reach_.discs.push_back({area->second.position(), kAtEnds});
      SeeTheWay(area->second.position());
    }
  }
  BeginAgain();
}

/// What the laser may see on the straight way is in at once: beginning again costs more.
void ReachWatch::SeeTheWay(const Vector2d& p_MGoal) {
  if (!sight_) return;
  const Vector2d begin = setup_.robot_state.X_MB.position(), way = p_MGoal - begin;
  const int parts = std::max(1, static_cast<int>(std::ceil(way.norm() / kAside)));
  for (int i = 0; i <= parts; ++i)
    seen_.discs.push_back({begin + (1.0 * i / parts) * way, *sight_ + kAside});
}

bool ReachWatch::IsWithin(const world::ObjectState& object) const {
  if (IsAlwaysWithin(reach_, setup_, action_, object)) return true;
  const Disc disc = DiscOf(setup_, object);
  if (reach_.Touches(disc)) return true;
  return IsInLaserPlane(*setup_.scene, object) && (!sight_ || seen_.Touches(disc));
}

void ReachWatch::BeginAgain() {
  is_touched_ = false;
  narrowed_.world_state.objects.clear();
  left_out_.clear();
  radii_.clear();
  for (const world::ObjectState& object : setup_.world_state.objects) {
    if (!IsWithin(object)) {
      left_out_.push_back({DiscOf(setup_, object), IsInLaserPlane(*setup_.scene, object)});
      continue;
    }
    const bool is_known = setup_.scene->world.FindModel(object.model) != nullptr;
    radii_.push_back(is_known ? RadiusOf(setup_, object) : 0.0);
    narrowed_.world_state.objects.push_back(object);
  }
  noted_.assign(radii_.size() + 1, std::nullopt);
}

bool ReachWatch::Look(const simulation::RobotSimulator& simulator) {
  is_touched_ = !Note(0, simulator.base().X_MB.position(), robot_radius_);
  for (std::size_t i = 0; i < radii_.size() && !is_touched_; ++i) {
    const Eigen::Vector3d p_MO = simulator.PoseOf(static_cast<int>(i)).translation;
    is_touched_ = !Note(i + 1, p_MO.head<2>(), radii_[i]);
  }
  return !is_touched_;
}

bool ReachWatch::Note(std::size_t thing, const Vector2d& p_M, double radius) {
  std::optional<Vector2d>& noted = noted_[thing];
  if (noted && (p_M - *noted).squaredNorm() <= kStride * kStride) return true;
  noted = p_M;
  Disc disc{p_M, radius + kStride + kMargin};
  const bool is_near = std::any_of(left_out_.begin(), left_out_.end(),
                                   [&](const LeftOut& other) { return Meet(disc, other.disc); });
  if (is_near) disc.radius += kCompany;
  reach_.discs.push_back(disc);
  const bool is_robot = thing == 0;
  const bool is_in_sight = is_robot && sight_ && !NoteSeen({p_M, *sight_ + kStride});
  return !is_near && !is_in_sight;
}

/// What comes in sight has more around it each time, so that few beginnings do for any way.
bool ReachWatch::NoteSeen(const Disc& robot) {
  const bool is_seen = std::any_of(left_out_.begin(), left_out_.end(), [&](const LeftOut& other) {
    return other.is_seen && Meet(robot, other.disc);
  });
  if (!is_seen) return true;
  seen_.discs.push_back({robot.p_M, robot.radius + more_});
  more_ *= 2.0;
  return false;
}

world::WorldState ReachWatch::WithLeftOut(const world::WorldState& narrowed) const {
  world::WorldState all = setup_.world_state;
  for (world::ObjectState& object : all.objects) {
    const world::ObjectState* moved = narrowed.Find(object.name);
    if (moved != nullptr) object = *moved;
  }
  return all;
}

}  // namespace hires::imagination
