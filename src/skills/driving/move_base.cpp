#include "hires/skills/move_base.h"

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/robot/echoes.h"
#include "hires/robot/link_bounds.h"
#include "skills/driving/base_limits.h"
#include "skills/driving/by_height.h"
#include "skills/driving/narrow_place.h"
#include "skills/driving/way_blocked.h"
#include "skills/posture_skills.h"
#include "world/floor_level.h"
#include "world/map_region.h"

namespace hires::skills {
namespace {

using geometry::Pose2;

constexpr double kMapMargin = 2.0;    // [m] free floor around the outermost body or area, at least
constexpr double kBeyondReach = 1.0;  // [m] of it that a base leaves which turns at an area

/// [m] The map covers all bodies and this much more: far enough that all areas lie well inside, and
/// the base with them, for what lies outside of the map is an obstacle.
/// @param reach  [m] of the base from its origin
double MapMargin(const world::World& world, double reach) {
  const double margin = std::max(kMapMargin, reach + kBeyondReach);
  if (world::MapRegion(world)) return margin;  // areas lie in it
  geometry::Aabb bodies;
  for (const world::StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      bodies.Include(geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS));
    }
  }
  if (world.statics.empty()) bodies.Include(Eigen::Vector3d::Zero());
  double outside = 0.0;
  for (const auto& [name, X_MF] : world.frames) {
    const Eigen::Vector3d& p = X_MF.translation;
    const Eigen::Vector3d beyond = (bodies.lower - p).cwiseMax(p - bodies.upper);
    outside = std::max({outside, beyond.x(), beyond.y()});
  }
  return outside + margin;
}

/// Follows what a car's planner found, as the local planner of other robots is set up.
std::optional<navigation::CarFollower> MakeFollower(const DrivingContext& context,
                                                    const navigation::Footprint& footprint,
                                                    const robot::MotionSet& motion_set) {
  const robot::BaseControllerParams& base = context.robot->profile.base_controller;
  if (base.drive != robot::Drive::kCarLike) return std::nullopt;
  const navigation::DwaParams& local = context.params.local;
  navigation::CarFollowerParams params;
  params.control_period = local.control_period;
  params.xy_goal_tolerance = local.xy_goal_tolerance;
  params.yaw_goal_tolerance = local.yaw_goal_tolerance;
  params.stopped_linear_velocity = local.stopped_linear_velocity;
  navigation::CarFollower follower(params, footprint, base.min_turning_radius);
  follower.SetMotionSet(WithinLimits(motion_set, base.limits));
  return follower;
}

/// What a robot is checked against: what is higher than it drives over, but no more than the floor
/// step of collision checks above its lowest shape, for it touches what is higher than that. A
/// robot without shapes is its footprint, up to where footprints are made of shapes; a plate may
/// end below that step.
Band ObstacleHeights(const robot::Robot& robot, const MoveBaseParams& params) {
  if (!robot::HasShapes(robot.model)) {
    return {params.min_obstacle_height, std::max(params.min_obstacle_height, robot::kFootprintTop)};
  }
  geometry::Aabb all;
  for (const geometry::Aabb& link : robot::LinkBounds(robot)) all.Include(link);
  const double touched = std::min(0.0, all.lower.z()) + world::kFloorStep;
  const double lower = std::min(params.min_obstacle_height, std::max(touched, all.lower.z()));
  return {lower, std::max(lower, all.upper.z())};
}

/// In whole steps: arms in no known posture, measured and never quite the same, give the same
/// drive.
double Outwards(double coordinate, double padding) {
  constexpr double kStep = 0.05;  // [m] a cell of the map
  return std::copysign(kStep * std::ceil((std::abs(coordinate) + padding) / kStep), coordinate);
}

/// The map with room for a robot that is in it, where that is not so already. A localisation that
/// errs by a hand's breadth would else let it stand in a wall for good; move_base's costmaps clear
/// the footprint for the same reason. A robot whose centre lies in an obstacle is lost instead.
std::optional<navigation::Costmap> WithRoom(const navigation::Costmap& map, const Pose2& X_MB,
                                            const navigation::Footprint& footprint) {
  const navigation::Footprint footprint_M = Transformed(X_MB, footprint);
  int column = 0, row = 0;
  map.CellOf(X_MB.position(), &column, &row);
  const bool is_in_it = map.Inside(column, row) && map.cost(column, row) < navigation::kLethalCost;
  if (!is_in_it || map.CostBelow(footprint_M) < navigation::kLethalCost) return std::nullopt;
  return map.WithRoomFor(footprint_M);
}

/// Whether a robot may stand somewhere near a goal and touch nothing.
/// @param xy  [m] how near. @param yaw  [rad] likewise.
bool HasRoomAt(const navigation::Costmap& map, const navigation::Footprint& footprint,
               const Pose2& X_MGoal, double xy, double yaw) {
  const double step = 0.5 * map.resolution();
  if (map.FootprintCost(footprint, X_MGoal) < navigation::kLethalCost) return true;
  const double reach = geometry::CircumscribedRadius(footprint.outline);
  const int yaw_steps = std::max(1, static_cast<int>(std::ceil(yaw * reach / step)));
  for (int i = -yaw_steps; i <= yaw_steps; ++i) {
    const double turned = yaw * i / yaw_steps;
    for (double x = -xy; x <= xy; x += step) {
      for (double y = -xy; y <= xy; y += step) {
        const Pose2 X_MB{X_MGoal.x + x, X_MGoal.y + y, X_MGoal.yaw + turned};
        const bool is_within = std::hypot(x, y) <= xy;
        if (is_within && map.FootprintCost(footprint, X_MB) < navigation::kLethalCost) return true;
      }
    }
  }
  return false;
}

/// Centres keep so far from what is in a layer that the robot may head anywhere. Where it stands,
/// and at its goal, it heads somewhere: a mast may be nearer to a counter's edge than that.
std::optional<navigation::Costmap> WithPlaces(const navigation::Costmap& map,
                                              const navigation::Footprint& footprint,
                                              const std::vector<Pose2>& places) {
  std::optional<navigation::Costmap> eased;
  if (!map.has_layers()) return eased;
  for (const Pose2& X_MB : places) {
    const geometry::Polygon outline_M = geometry::Transformed(X_MB, footprint.outline);
    if (map.FootprintCost(footprint, X_MB) < navigation::kLethalCost)
      eased = (eased ? *eased : map).WithAccessUnder(outline_M);
  }
  return eased;
}

/// The same map for ways that keep more or less of a margin from everything, the widest first.
std::vector<MarginMap> WithMargins(const navigation::Costmap& map, double inscribed_radius,
                                   const MoveBaseParams& params) {
  std::vector<MarginMap> margins;
  if (params.obstacle_layer || params.place_margin == 0.0) return margins;
  for (const double share : {1.0, 0.5}) {
    const double margin = share * params.place_margin;
    const double radius = inscribed_radius + margin + params.map_resolution;
    margins.push_back(
        {margin, std::make_shared<const navigation::Costmap>(map.WithInscribedRadius(radius))});
  }
  return margins;
}

DrivingContext ContextOf(const SlicedByHeight& world, const robot::Robot& robot,
                         const MoveBaseParams& params) {
  const geometry::Polygon footprint =
      geometry::Padded(robot.profile.footprint, robot.profile.footprint_padding);
  MoveBaseParams possible = params;
  if (robot.profile.base_controller.drive != robot::Drive::kOmnidirectional) {
    possible.local.max_lateral_velocity = 0.0;
  }
  DrivingContext context;
  const double radius = geometry::InscribedRadius(footprint);
  context.costmap = std::make_shared<const navigation::Costmap>(
      Layered({world.whole, radius, params.costmap}, world.layers, robot));
  context.robot = std::make_shared<const robot::Robot>(robot);
  context.footprint = footprint;
  context.body = BodyOf(footprint, world.layers, robot);
  if (params.obstacle_layer || params.seen_place) context.base = robot::BaseOutlineOf(robot);
  context.params = possible;
  context.with_margin = WithMargins(*context.costmap, radius, params);
  return context;
}

double LaserPlane(const robot::Robot& robot) {
  const auto height = robot::LaserHeight(robot);
  if (height) return *height;
  throw base::ConfigError(
      "obstacle_layer: the robot has no base laser; name one in its profile (laser_link), or say "
      "`obstacle_layer: none` in the scene");
}

/// @param seen  has what is in the laser's plane, `world` everything, in the same cells.
MapByPlane ByPlane(const world::OccupancyGrid& seen, const SlicedByHeight& world,
                   const DrivingContext& context) {
  MapByPlane by_plane;
  world::OccupancyGrid beyond = world.whole;
  for (int row = 0; row < seen.height; ++row) {
    for (int column = 0; column < seen.width; ++column) {
      if (seen.at(column, row) != world::Cell::kOccupied) continue;
      by_plane.in_plane_M.push_back(seen.CentreOf(column, row));
      beyond.cells[static_cast<std::size_t>(row) * beyond.width + column] = world::Cell::kFree;
    }
  }
  if (context.holes) Occupy(*context.holes, &beyond);
  const double radius = geometry::InscribedRadius(context.footprint);
  by_plane.beyond = std::make_shared<const navigation::Costmap>(
      Layered({beyond, radius, context.params.costmap}, world.layers, *context.robot));
  return by_plane;
}

}  // namespace

DrivingContext MakeDrivingContext(const world::OccupancyGrid& map, const robot::Robot& robot,
                                  const MoveBaseParams& params) {
  const SlicedByHeight of_no_height{map, {}};
  DrivingContext context = ContextOf(of_no_height, robot, params);
  if (params.obstacle_layer) context.by_plane = ByPlane(map, of_no_height, context);
  return context;
}

DrivingContext MakeDrivingContext(const world::World& world, const robot::Robot& robot,
                                  const MoveBaseParams& params) {
  const geometry::Polygon footprint =
      geometry::Padded(robot.profile.footprint, robot.profile.footprint_padding);
  const double margin = MapMargin(world, geometry::CircumscribedRadius(footprint));
  const Band heights = ObstacleHeights(robot, params);
  SlicedByHeight map = SliceByHeight(world, robot, heights, params.map_resolution, margin);
  const double step = params.min_obstacle_height;  // what is no deeper is driven over as well
  const auto holes = world::FloorHoles(world, step, params.map_resolution, margin);
  if (holes) Occupy(*holes, &map.whole);  // in the way of the whole base
  DrivingContext context = ContextOf(map, robot, params);
  if (holes) {
    context.holes = std::make_shared<const world::OccupancyGrid>(*holes);
    context.floor = std::make_shared<const std::vector<world::NamedOutline>>(
        world::NamedOutlinesInBand(world, -step, 0.0));
  }
  context.obstacles = std::make_shared<const std::vector<world::NamedOutline>>(
      world::NamedOutlinesInBand(world, heights.first, heights.second));
  if (!params.obstacle_layer && !params.seen_place) return context;
  const double plane = LaserPlane(robot);
  if (params.obstacle_layer) {
    context.by_plane = ByPlane(
        world::SliceWorld(world, plane, plane, params.map_resolution, margin), map, context);
  }
  if (params.seen_place) {
    context.seen_place = std::make_shared<const SeenPlace>(
        SeenPlace{{world::OutlinesInBand(world, nullptr, plane, plane), params.seen_place->match},
                  *params.seen_place});
  }
  return context;
}

geometry::Polygon FootprintOf(const DrivingContext& context,
                              const robot::JointPositions& measured) {
  const robot::Robot& robot = *context.robot;
  if (!robot.profile.upper_body || measured.empty() || !robot::HasShapes(robot.model))
    return context.footprint;
  const geometry::Polygon outline =
      robot::OutlineOf(robot.model, robot.profile.base_link, DrivingJoints(robot, measured));
  std::vector<Eigen::Vector2d> corners = context.footprint;
  for (const Eigen::Vector2d& corner : outline) {
    if (geometry::Contains(context.footprint, corner)) continue;
    corners.emplace_back(Outwards(corner.x(), robot.profile.footprint_padding),
                         Outwards(corner.y(), robot.profile.footprint_padding));
  }
  if (corners.size() == context.footprint.size()) return context.footprint;
  return geometry::ConvexHull(std::move(corners));
}

std::string WhyGoalIsTight(const DrivingContext& context, const Pose2& X_MGoal) {
  constexpr double kMargin = 0.02;  // [m] that local control keeps where it can
  const navigation::Costmap& map = *context.costmap;
  const navigation::Footprint body = Padded(context.body, kMargin);
  if (map.FootprintCost(body, X_MGoal) < navigation::kLethalCost) return "";
  return WhyBlocked(context, map, "goal", X_MGoal);
}

MoveBase::MoveBase(std::shared_ptr<const DrivingContext> context, const Pose2& X_MGoal,
                   const robot::MotionSet& motion_set)
    : context_(std::move(context)),
      X_MGoal_(X_MGoal),
      motion_set_(motion_set),
      costmap_(context_->costmap),
      footprint_(context_->footprint),
      local_(context_->params.local, context_->body),
      car_(MakeFollower(*context_, context_->body, motion_set)),
      lost_(context_->params.lost),
      with_margins_(context_->with_margin) {
  local_.SetMotionSet(motion_set);
  if (context_->by_plane) {
    sensed_.emplace(&*context_->by_plane, *context_->params.obstacle_layer, footprint_,
                    context_->params.costmap.inflation_radius);
  }
}

/// A robot whose arms are not in the driving posture needs more room: to turn anywhere on its way,
/// or at least to pass. Where there is no such way it is tried as if there were no arms; the local
/// planner sees to it that nothing is touched.
void MoveBase::Begin(const robot::Observation& observation) {
  has_begun_ = true;
  footprint_ = FootprintOf(*context_, observation.joints);
  if (footprint_ == context_->footprint) return;
  if (car_) {  // it plans with the footprint itself, at every heading
    car_ = MakeFollower(*context_, footprint_, motion_set_);
    return;
  }
  local_ = navigation::DwaPlanner(context_->params.local, footprint_);
  local_.SetMotionSet(motion_set_);
  double half_width = 0.0;
  for (const Eigen::Vector2d& p : footprint_) half_width = std::max(half_width, std::abs(p.y()));
  for (const double radius : {geometry::CircumscribedRadius(footprint_), half_width}) {
    costmap_ =
        std::make_shared<const navigation::Costmap>(context_->costmap->WithInscribedRadius(radius));
    const auto way = navigation::PlanPath(*Completed(costmap_, observation), observation.X_MB,
                                          X_MGoal_, context_->params.planner);
    if (way.status != navigation::PathStatus::kFound) continue;
    if (sensed_) sensed_->SetInscribedRadius(radius);
    with_margins_ = WithMargins(*costmap_, radius, context_->params);
    return;
  }
  costmap_ = context_->costmap;
}

/// What sticks out of the footprint counts at all heights, and then the whole of it.
navigation::Footprint MoveBase::Body() const {
  return footprint_ == context_->footprint ? context_->body : navigation::Footprint(footprint_);
}

navigation::PathStatus MoveBase::FindPath(const navigation::Costmap& costmap, const Pose2& X_MB,
                                          double margin) {
  if (!car_) {
    auto found = FindWayThatIsWide(costmap, X_MB);
    if (found.status != navigation::PathStatus::kFound) return found.status;
    path_ = std::make_shared<const std::vector<Pose2>>(std::move(found.path));
    local_.SetPath(*path_);
    least_left_ = 0;
    return found.status;
  }
  navigation::CarPathParams params;
  params.costs = context_->params.planner;
  auto found =
      navigation::PlanCarPath(costmap, Padded(Body(), margin), X_MB, X_MGoal_,
                              context_->robot->profile.base_controller.min_turning_radius, params);
  if (found.status != navigation::PathStatus::kFound) return found.status;
  std::vector<Pose2> poses;
  for (const navigation::CarPose& pose : found.path) poses.push_back(pose.X_MB);
  path_ = std::make_shared<const std::vector<Pose2>>(std::move(poses));
  car_->SetPath(std::move(found.path));
  return found.status;
}

/// Where the footprint is too wide for a passage, the way round it, with room to both sides where
/// there is such a one; the cheapest way otherwise.
navigation::PathResult MoveBase::FindWayThatIsWide(const navigation::Costmap& costmap,
                                                   const Pose2& X_MB) {
  constexpr int kMostPassages = 8;
  const navigation::AStarParams& planner = context_->params.planner;
  auto found = navigation::PlanPath(costmap, X_MB, X_MGoal_, planner);
  narrow_.reset();
  if (found.status != navigation::PathStatus::kFound) return found;
  auto narrow = FindTooNarrow(costmap, Body(), found.path);
  if (!narrow) return found;
  narrow_ = std::make_shared<const NarrowPlace>(*narrow);
  double half_width = 0.0;
  for (const Eigen::Vector2d& p : footprint_) half_width = std::max(half_width, std::abs(p.y()));
  auto roomy =
      navigation::PlanPath(costmap.WithInscribedRadius(half_width), X_MB, X_MGoal_, planner);
  if (roomy.status == navigation::PathStatus::kFound && !FindTooNarrow(costmap, Body(), roomy.path))
    return roomy;
  navigation::Costmap closed = costmap;
  for (int i = 0; narrow && i < kMostPassages; ++i) {
    closed = WithClosed(closed, *narrow);
    found = navigation::PlanPath(closed, X_MB, X_MGoal_, planner);
    if (found.status != navigation::PathStatus::kFound) {
      found.status = navigation::PathStatus::kNoPath;
      return found;
    }
    narrow = FindTooNarrow(costmap, Body(), found.path);
  }
  return found;
}

navigation::Costmap MoveBase::MapWithMarks(const robot::Observation& observation) const {
  return Completed(costmap_, observation)->WithObstaclesAt(sensed_->Marks(observation));
}

/// On the way that keeps farthest from all that is in the map, for the robot's place errs and
/// nothing shows it how far; false where there is no such way. Where the robot stands, and its
/// goal, may be nearer to something than ways lead.
bool MoveBase::PlanWithMargin(const robot::Observation& observation) {
  with_margin_.reset();
  local_.SetMargin(0.0);
  for (std::size_t i = first_margin_; i < with_margins_.size(); ++i) {
    const MarginMap& map = with_margins_[i];
    auto open = std::make_shared<const navigation::Costmap>(
        map.costmap->WithAccessTo(geometry::Transformed(observation.X_MB, footprint_))
            .WithAccessTo(geometry::Transformed(X_MGoal_, footprint_)));
    auto now = Completed(open, observation);
    if (FindPath(*now, observation.X_MB, map.margin) != navigation::PathStatus::kFound) continue;
    local_.SetMargin(map.margin);
    with_margin_ = std::move(open);
    now_ = std::move(now);
    return true;
  }
  return false;
}

/// Of a base that would touch something wherever it stood within the goal's tolerance. A car is
/// asked whether it fits its goal when its way is planned. Where a laser shows what is in the way,
/// the map may lie beside that by as much again.
std::optional<std::string> MoveBase::WhyNoRoomAtGoal(const robot::Observation& observation) const {
  if (car_) return std::nullopt;
  const navigation::DwaParams& local = context_->params.local;
  const double xy = (sensed_ ? 2.0 : 1.0) * local.xy_goal_tolerance;
  const auto here = WithRoom(*costmap_, observation.X_MB, Body());
  const navigation::Costmap& map = here ? *here : *costmap_;
  if (HasRoomAt(map, Body(), X_MGoal_, xy, local.yaw_goal_tolerance)) return std::nullopt;
  return WhyBlocked(*context_, map, "goal", X_MGoal_);
}

/// Round what the laser sees, if that leaves a way: where map and marks lie beside each other, for
/// a localisation errs, narrow places are closed that are not.
std::optional<Status> MoveBase::Plan(const robot::Observation& observation) {
  if (const auto why = WhyOffMap(*costmap_, footprint_, "start", observation.X_MB, 0.0))
    return Failed({base::FailureCode::kStartBlocked, {}, *why});
  const double slack = context_->params.local.xy_goal_tolerance;
  if (const auto why = WhyOffMap(*costmap_, footprint_, "goal", X_MGoal_, slack))
    return Failed({base::FailureCode::kGoalBlocked, {}, *why});
  if (const auto why = WhyNoRoomAtGoal(observation))
    return Failed({base::FailureCode::kGoalBlocked, {}, *why});
  if (sensed_ &&
      FindPath(MapWithMarks(observation), observation.X_MB) == navigation::PathStatus::kFound) {
    return std::nullopt;
  }
  if (PlanWithMargin(observation)) return std::nullopt;
  const auto map = Completed(costmap_, observation);
  if (!sensed_) now_ = map;
  switch (FindPath(*map, observation.X_MB)) {
    case navigation::PathStatus::kStartBlocked:
      return Failed({base::FailureCode::kStartBlocked,
                     {},
                     WhyBlocked(*context_, *map, "start", observation.X_MB)});
    case navigation::PathStatus::kGoalBlocked:
      return Failed(
          {base::FailureCode::kGoalBlocked, {}, WhyBlocked(*context_, *map, "goal", X_MGoal_)});
    case navigation::PathStatus::kNoPath:
      return Failed({base::FailureCode::kNoPath,
                     {},
                     WhyNoPath(*context_, *map, observation.X_MB, X_MGoal_, narrow_.get())});
    case navigation::PathStatus::kFound:
      break;
  }
  return std::nullopt;
}

/// What is seen may close a path, or show a shorter way that draws the local planner off it: it
/// then turns where it stands as long as it can. Where what is seen leaves no path, this one stays.
void MoveBase::PlanAnewIfStuck(const robot::Observation& observation) {
  const auto apart = [&](const Pose2& pose) {
    return (pose.position() - observation.X_MB.position()).norm();
  };
  // At its goal it turns and corrects.
  const bool is_there = apart(X_MGoal_) <= 2.0 * context_->params.local.xy_goal_tolerance;
  if ((!sensed_ && !with_margin_) || car_ || is_there) return;
  const auto nearest =
      std::min_element(path_->begin(), path_->end(),
                       [&](const Pose2& a, const Pose2& b) { return apart(a) < apart(b); });
  const std::ptrdiff_t left = path_->end() - nearest;
  if (least_left_ == 0 || left + 2 <= least_left_) {  // 2: a cell is no way
    least_left_ = left;
    last_nearer_ = observation.time;
  }
  if (observation.time - last_nearer_ < context_->params.progress_timeout) return;
  last_nearer_ = observation.time;
  if (sensed_) {
    FindPath(MapWithMarks(observation), observation.X_MB);
  } else {  // the way has room for the margin, the robot on its arcs has not
    ++first_margin_;
    Plan(observation);
  }
}

/// False when the robot has been going to and fro for too long. Of a slow motion set no more is
/// asked than half of what it lets the robot do meanwhile.
bool MoveBase::NoteMotion(const robot::Observation& observation) {
  const Pose2 moved = X_MMoved_.Inverse() * observation.X_MB;
  const MoveBaseParams& params = context_->params;
  const double half_time = 0.5 * params.oscillation_timeout;
  const double enough =
      std::min(params.oscillation_distance, half_time * motion_set_.max_linear_velocity);
  const double enough_turn =
      std::min(params.oscillation_distance / 2, half_time * motion_set_.max_angular_velocity);
  if (std::hypot(moved.x, moved.y) > enough || std::abs(moved.yaw) > enough_turn) {
    X_MMoved_ = observation.X_MB;
    last_moved_ = observation.time;
    oscillations_ = 0;
  }
  return observation.time - last_moved_ <= context_->params.oscillation_timeout;
}

Status MoveBase::Stuck(base::FailureCode code, const robot::Observation& observation) const {
  constexpr double kAtGoal = 1.0;  // [m] what goes wrong so near has to do with the goal
  std::string why = WhyStuck(*now_, footprint_, observation.X_MB);
  const double to_goal = (X_MGoal_.position() - observation.X_MB.position()).norm();
  if (why.empty() && to_goal <= kAtGoal) why = WhyGoalIsTight(*context_, X_MGoal_);
  if (code == base::FailureCode::kNoValidTrajectory) {
    if (why.empty()) why = WhyNoTurn(*context_, *now_, footprint_, observation.X_MB);
    if (why.empty() && path_) why = WhyNoWay(*context_, *now_, Body(), observation.X_MB, *path_);
    if (why.empty()) why = WhyNoMotion(*context_, *now_, footprint_, observation.X_MB);
  }
  return Failed({code, {}, why});
}

Status MoveBase::Recover(const robot::Observation& observation) {
  if (observation.time - last_valid_ > context_->params.controller_patience) {
    return Stuck(base::FailureCode::kNoValidTrajectory, observation);
  }
  if (observation.time - last_plan_ >= context_->params.replanning_period) {
    // A car with nothing in its way came to rest out of tolerance: the next way may end so, too.
    const bool has_missed = car_ && !car_->is_blocked();
    if (has_missed && num_missed_ + 1 == kMostCarWays)
      return Failed(base::FailureCode::kOscillating);
    last_plan_ = observation.time;
    // What blocks the way may go: patience decides, not one plan.
    const bool is_planned = !Plan(observation);
    if (has_missed && is_planned) ++num_missed_;
  }
  return {};
}

/// A map as it must be now: with what is seen, and open where the robot stands and shall stand.
/// What is seen below its arms stays: it may be driven into.
/// @param seen  whose marks the map has; null: it has none.
std::shared_ptr<const navigation::Costmap> MoveBase::Completed(
    const std::shared_ptr<const navigation::Costmap>& map, const robot::Observation& observation,
    const LocalCostmap* seen) const {
  std::optional<navigation::Costmap> now = WithRoom(*map, observation.X_MB, Body());
  const bool has_arms_out = footprint_ != context_->footprint;
  const bool is_seen_below = now && seen && has_arms_out;
  if (is_seen_below) now = now->WithObstaclesAt(seen->Marks(observation));
  if (!observation.obstacles_M.empty())
    now = (now ? *now : *map).WithObstacles(observation.obstacles_M);
  if (is_seen_below || !observation.obstacles_M.empty()) {
    auto roomier = WithRoom(*now, observation.X_MB, context_->body);
    if (roomier) now = std::move(roomier);
  }
  auto open = WithPlaces(now ? *now : *map, Body(), {observation.X_MB, X_MGoal_});
  if (open) now = std::move(open);
  if (!now) return map;
  return std::make_shared<const navigation::Costmap>(std::move(*now));
}

void MoveBase::Look(const robot::Observation& observation) {
  now_.reset();  // so that a rollout holds one copy of the map, not two
  now_ = sensed_ ? Completed(sensed_->Look(observation), observation, &*sensed_)
                 : Completed(with_margin_ ? with_margin_ : costmap_, observation);
  X_MBNow_ = observation.X_MB;
}

std::optional<DriveView> MoveBase::drive_view() const {
  if (!path_) return std::nullopt;
  return DriveView{path_, now_, X_MBNow_};
}

bool MoveBase::IsAtGoal(const robot::Observation& observation) const {
  const navigation::DwaParams& params = context_->params.local;
  const Pose2 X_BGoal = observation.X_MB.Inverse() * X_MGoal_;
  return std::hypot(X_BGoal.x, X_BGoal.y) <= params.xy_goal_tolerance &&
         std::abs(geometry::WrapToPi(X_BGoal.yaw)) <= params.yaw_goal_tolerance &&
         std::abs(observation.V_B.vx) <= params.stopped_linear_velocity;
}

/// The laser alone tells what is in the way: where the map has things is not known now. Behind it
/// most lasers see nothing, so what is unseen counts as room, or a robot that stands never turns.
/// Who sees nothing at all, as no scans come or none that measured anything, stands.
geometry::Twist2 MoveBase::LookAround(const robot::Observation& observation) {
  if (!sensed_ || car_) return {};
  sensed_->Look(observation);
  const bool sees = observation.scan && observation.scan_age <= kScanPatience &&
                    robot::HasMeasured(observation.scan->reading);
  if (!sees) return {};
  const LostParams& params = context_->params.lost;
  const double reach = geometry::CircumscribedRadius(footprint_) + params.room;
  const auto is_near = [&](const Eigen::Vector2d& p_M) {
    return (p_M - observation.X_MB.position()).norm() < reach;
  };
  const auto marks = sensed_->Marks(observation);
  if (std::any_of(marks.begin(), marks.end(), is_near)) return {};
  for (const geometry::Polygon& obstacle : observation.obstacles_M)
    if (std::any_of(obstacle.begin(), obstacle.end(), is_near)) return {};
  return {0.0, 0.0, std::min(params.turning, motion_set_.max_angular_velocity)};
}

Status MoveBase::Update(const robot::Observation& observation, robot::Command* command) {
  command->motion_set = motion_set_;
  switch (lost_.Look(observation)) {
    case LostWatch::State::kGivenUp:
      return Failed(lost_.Why(observation));
    case LostWatch::State::kLost:
      command->base_velocity = LookAround(observation);
      return {};
    case LostWatch::State::kFound:
      path_.reset();
      break;
    case LostWatch::State::kSure:
      break;
  }
  if (!has_begun_) Begin(observation);
  Look(observation);
  if (!path_) {
    if (car_ && IsAtGoal(observation)) {  // else it would drive to and fro for a few cm
      command->base_velocity = geometry::Twist2{};
      return Succeeded();
    }
    if (const auto failed = Plan(observation)) return *failed;
    X_MMoved_ = observation.X_MB;
    last_valid_ = last_plan_ = last_moved_ = observation.time;
  }
  PlanAnewIfStuck(observation);
  const navigation::DwaResult result =
      car_ ? car_->Update(now_.get(), observation.X_MB, observation.V_B)
           : local_.Update(*now_, observation.X_MB, observation.V_B);
  command->base_velocity = result.velocity;
  if (result.status == navigation::DwaStatus::kGoalReached) return Succeeded();
  if (result.status == navigation::DwaStatus::kNoValidTrajectory) {
    return Recover(observation);
  }
  last_valid_ = observation.time;
  if (!NoteMotion(observation)) {
    if (++oscillations_ > 1) return Stuck(base::FailureCode::kOscillating, observation);
    last_moved_ = observation.time;
    if (const auto failed = Plan(observation)) return *failed;
  }
  return {};
}

}  // namespace hires::skills
