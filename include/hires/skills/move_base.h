#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "hires/navigation/a_star.h"
#include "hires/navigation/car_follower.h"
#include "hires/navigation/costmap.h"
#include "hires/navigation/dwa.h"
#include "hires/navigation/hybrid_a_star.h"
#include "hires/robot/robot_profile.h"
#include "hires/skills/local_costmap.h"
#include "hires/skills/lost_watch.h"
#include "hires/skills/scan_watch.h"
#include "hires/skills/seen_place.h"
#include "hires/skills/skill.h"

namespace hires::skills {

/// So many ways a car is given that comes to rest out of tolerance each time.
constexpr int kMostCarWays = 8;

struct MoveBaseParams {
  navigation::CostmapParams costmap;
  navigation::AStarParams planner;
  navigation::DwaParams local;
  double min_obstacle_height{0.08};  ///< [m] what is lower is driven over
  double map_resolution{0.05};       ///< [m] cell of the costmap made from a world
  double replanning_period{1.0};     ///< [s] between two attempts when there is no valid trajectory
  double controller_patience{15.0};  ///< [s] without a valid trajectory before giving up
  double progress_timeout{5.0};  ///< [s] without coming nearer along a path, before another one is
                                 ///< looked for by what the laser sees
  double oscillation_timeout{10.0};  ///< [s] without ...
  double oscillation_distance{0.5};  ///< [m] ... this much motion (or its half in rad) before
                                     ///< planning again; twice in a row: giving up
  /// Local control goes by what the base's laser sees now; none: by the map.
  std::optional<navigation::ObstacleLayerParams> obstacle_layer;
  /// Beside furniture the robot goes by the place where that laser sees it; none: by the told one.
  std::optional<SeenPlaceParams> seen_place;
  LostParams lost;
  /// [m] What drives by the map alone keeps so far from all that is in it, for its place may err;
  /// less where the way, its beginning or its end leaves no room for that.
  double place_margin{0.0};
};

/// A costmap in which ways keep a margin [m] from everything.
struct MarginMap {
  double margin;
  std::shared_ptr<const navigation::Costmap> costmap;
};

/// What a driving skill knows about where it drives; constant, shared by all skills of a scene.
struct DrivingContext {
  std::shared_ptr<const navigation::Costmap> costmap;
  std::shared_ptr<const robot::Robot> robot;
  geometry::Polygon footprint;  ///< padded; of the posture for driving
  navigation::Footprint body;   ///< that, and what of it is at the heights of the costmap's layers
  geometry::Polygon base;       ///< outline of what drives, without arms: robot::BaseOutlineOf
  MoveBaseParams params;
  std::vector<MarginMap> with_margin;  ///< the widest first; none: nothing but the map's own
  /// What of a world stands where it may be in the way, by name; null for a map.
  std::shared_ptr<const std::vector<world::NamedOutline>> obstacles;
  /// Cells of the costmap that no floor bears (world::FloorHoles); null: the floor has no end.
  std::shared_ptr<const world::OccupancyGrid> holes;
  /// What bears a base, by name, where the floor ends somewhere; else null.
  std::shared_ptr<const std::vector<world::NamedOutline>> floor;

  std::optional<MapByPlane> by_plane;           ///< with an obstacle layer
  std::shared_ptr<const SeenPlace> seen_place;  ///< of a world, where asked for; else null
};

struct NarrowPlace;

/// The footprint of a robot that does not have its arms where they are for driving: the padded
/// footprint, and what sticks out of it in this posture, padded as well. It counts at all
/// heights.
geometry::Polygon FootprintOf(const DrivingContext& context, const robot::JointPositions& measured);

/// A costmap of everything that stands between the lowest obstacle that matters and the robot's
/// top. Where the footprint is that of the model's shapes and no arm moves, what stands at heights
/// at which the robot is narrower is in layers of it, in the way of no more than that.
/// @throws base::ConfigError for a robot without a base laser where local control asks for one.
DrivingContext MakeDrivingContext(const world::World& world, const robot::Robot& robot,
                                  const MoveBaseParams& params);
/// ... from a recorded map, which has what a laser in its plane sees. Its cells are too coarse for
/// a seen place.
DrivingContext MakeDrivingContext(const world::OccupancyGrid& map, const robot::Robot& robot,
                                  const MoveBaseParams& params);

/// What is in the way of a base that stands at its goal exactly, as goal_blocked tells it; empty:
/// nothing. Within the goal's tolerance there may be room.
std::string WhyGoalIsTight(const DrivingContext& context, const geometry::Pose2& X_MGoal);

/// Drives to a pose in the map round all known obstacles: A* on the inflated costmap, dynamic
/// window approach for control, as move_base does, with room for the arms as they are when it
/// begins. A base that steers like a car: hybrid A*, and a follower of arcs; where it came
/// to rest out of tolerance it is given a new way, some times, and oscillates after these. While
/// the robot is lost it stops and turns to look around, if the base can turn on the spot, scans
/// come that measure something, and an obstacle layer has no mark within its circle (what the laser
/// does not see counts as room); found again, it plans anew. Fails with start_blocked,
/// goal_blocked, no_path, no_valid_trajectory, oscillating or localisation_lost.
class MoveBase : public Skill {
 public:
  MoveBase(std::shared_ptr<const DrivingContext> context, const geometry::Pose2& X_MGoal,
           const robot::MotionSet& motion_set);

  Status Update(const robot::Observation& observation, robot::Command* command) override;
  double period() const override { return context_->params.local.control_period; }
  std::string phase() const override { return lost_.is_lost() ? "lost" : ""; }
  std::optional<DriveView> drive_view() const override;

 private:
  geometry::Twist2 LookAround(const robot::Observation& observation);
  void Begin(const robot::Observation& observation);
  std::optional<Status> Plan(const robot::Observation& observation);
  std::optional<std::string> WhyNoRoomAtGoal(const robot::Observation& observation) const;
  navigation::PathStatus FindPath(const navigation::Costmap& costmap, const geometry::Pose2& X_MB,
                                  double margin = 0.0);
  navigation::PathResult FindWayThatIsWide(const navigation::Costmap& costmap,
                                           const geometry::Pose2& X_MB);
  bool IsAtGoal(const robot::Observation& observation) const;
  void PlanAnewIfStuck(const robot::Observation& observation);
  bool NoteMotion(const robot::Observation& observation);
  std::shared_ptr<const navigation::Costmap> Completed(
      const std::shared_ptr<const navigation::Costmap>& map, const robot::Observation& observation,
      const LocalCostmap* seen = nullptr) const;
  bool PlanWithMargin(const robot::Observation& observation);
  navigation::Footprint Body() const;
  navigation::Costmap MapWithMarks(const robot::Observation& observation) const;
  void Look(const robot::Observation& observation);
  Status Recover(const robot::Observation& observation);
  Status Stuck(base::FailureCode code, const robot::Observation& observation) const;

  std::shared_ptr<const DrivingContext> context_;
  geometry::Pose2 X_MGoal_;
  robot::MotionSet motion_set_;
  std::shared_ptr<const navigation::Costmap> costmap_;  // the map, inflated for this drive
  std::optional<LocalCostmap> sensed_;                  // none: it drives by the map alone
  geometry::Polygon footprint_;
  navigation::DwaPlanner local_;
  std::optional<navigation::CarFollower> car_;  // drives instead, where the base steers like a car
  LostWatch lost_;
  bool has_begun_{false};
  std::shared_ptr<const std::vector<geometry::Pose2>> path_;  // null: not planned yet
  std::vector<MarginMap> with_margins_;                       // of this drive, the widest first
  std::size_t first_margin_{0};  // of those with which ways are looked for
  /// By which it was planned with a margin; null: without.
  std::shared_ptr<const navigation::Costmap> with_margin_;
  std::shared_ptr<const navigation::Costmap> now_;  // what it drove by at the last look
  geometry::Pose2 X_MBNow_;                         // and where the robot was
  double last_valid_{0.0};                          // [s] when a valid trajectory was last found
  double last_plan_{0.0};                           // [s]
  geometry::Pose2 X_MMoved_;                        // where it last counted as having moved
  double last_moved_{0.0};                          // [s]
  int oscillations_{0};
  std::shared_ptr<const NarrowPlace> narrow_;  // where the last search found it too wide; or null
  std::ptrdiff_t least_left_{0};               // so many poses of the path were left; 0: it is new
  double last_nearer_{0.0};                    // [s] when that became less
  int num_missed_{0};  // ways that a car was given because the one before ended out of tolerance
};

/// The body that a blind drive sees to that it touches nothing; none where local control goes by
/// the map alone.
std::optional<geometry::Polygon> BodyThatLooks(const DrivingContext& context);

struct MoveBaseBlindParams {
  double period{0.05};               ///< [s] control cycle
  double max_velocity{0.3};          ///< [m/s]; the motion set may be slower
  double max_angular_velocity{0.5};  ///< [rad/s]
  double deceleration{0.5};          ///< [m/s^2], [rad/s^2] with which it comes to its goal
  double reaction_time{0.15};        ///< [s] from what is seen to what the wheels do of it
  double xy_tolerance{0.03};         ///< [m]
  double yaw_tolerance{0.03};        ///< [rad]
  double stuck_timeout{5.0};         ///< [s] without coming 0.01 m or rad nearer
  LostParams lost;
};

/// Drives straight to a pose, turning on the way (two driven wheels: before and after; a car: on
/// Reeds and Shepp's shortest way, forward and backward), not round obstacles: for the last stretch
/// to furniture, under whose top the base fits. Where local control goes by the laser it slows down
/// and stops before what that sees, and stands while no scans come. While the robot is lost it
/// stands. Fails with stuck, stale_scan or localisation_lost.
class MoveBaseBlind : public Skill {
 public:
  /// @param body  outline of what drives, where it shall stop before what its laser sees.
  MoveBaseBlind(const MoveBaseBlindParams& params, const geometry::Pose2& X_MGoal,
                const robot::MotionSet& motion_set, const robot::BaseControllerParams& base,
                std::optional<geometry::Polygon> body = std::nullopt);

  Status Update(const robot::Observation& observation, robot::Command* command) override;
  double period() const override { return params_.period; }
  /// Of a car: so many ways it has planned; one more whenever it came to rest out of tolerance.
  int num_ways() const { return num_ways_; }

 private:
  struct Course {
    geometry::Twist2 velocity;  // in the base frame
    double remaining;           // [m] + [rad] falls on the way
  };
  double LinearSpeed(double distance) const;
  double TurningSpeed(double angle) const;
  Course Straight(const geometry::Pose2& X_BGoal) const;
  Course TurnAndDrive(const geometry::Pose2& X_BGoal);
  Course Steer(const robot::Observation& observation);
  void PlanWay(const geometry::Pose2& X_MB);
  Course CourseTo(const robot::Observation& observation, const geometry::Pose2& X_BGoal);
  double Deceleration() const;
  double AngularDeceleration() const;
  void LookAround(const robot::Observation& observation);
  geometry::Twist2 BeforeThings(const geometry::Twist2& wanted,
                                const robot::Observation& observation) const;
  Status Stuck(const robot::Observation& observation) const;

  MoveBaseBlindParams params_;
  geometry::Pose2 X_MGoal_;
  robot::MotionSet motion_set_;
  robot::Drive drive_;
  double min_turning_radius_;
  std::optional<geometry::Polygon> body_;  // none: it does not look
  ScanWatch watch_;
  std::shared_ptr<const robot::PlacedScan> scan_;  // null: none of now, and it stands
  std::optional<navigation::CarFollower> car_;     // where the base steers like one
  int num_ways_{0};                                // that it has been given
  LostWatch lost_;
  bool begun_driving_{false};
  bool backwards_{false};
  double nearest_{1e9};        // [m] + [rad] least that remained so far
  double last_progress_{0.0};  // [s]
};

}  // namespace hires::skills
