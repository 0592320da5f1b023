#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>
#include <vector>

#include "hires/imagination/report.h"
#include "hires/simulation/fall_watch.h"
#include "hires/simulation/robot_simulator.h"

namespace hires_ros {

/// Markers of one worker's rollout in the map frame, lifetime 2 s: robot and load, the trace of the
/// base (thickness = speed, green = speeding up, red = braking), the load's axis (red once it has
/// fallen) and the world's up as arrows, and the circle on which the load turns (dissertation,
/// Figures 5.7 and 5.16).
class TraceMarkers {
 public:
  TraceMarkers(int worker_index, const hires::world::StandingCriterion& standing);

  void Clear();                                                  ///< a new rollout begins
  void Add(const hires::simulation::RobotSimulator& simulator);  ///< 20 times a simulated second
  visualization_msgs::MarkerArray Draw(const hires::simulation::RobotSimulator& simulator) const;

 private:
  struct Point {
    Eigen::Vector3d p_M;
    double speed;         // [m/s]
    double acceleration;  // [m/s^2], positive: along the motion
  };
  struct Load {
    int index;  // in the simulator
    hires::simulation::FallWatch watch;
  };
  visualization_msgs::Marker Blank(const std::string& name, int id, int type) const;
  void DrawBodies(const hires::simulation::RobotSimulator& simulator,
                  visualization_msgs::MarkerArray* markers) const;
  void DrawTrace(visualization_msgs::MarkerArray* markers) const;
  void DrawLoad(const hires::simulation::RobotSimulator& simulator, const Load& load,
                visualization_msgs::MarkerArray* markers) const;
  void DrawCircle(const hires::simulation::RobotSimulator& simulator, const Load& load,
                  visualization_msgs::MarkerArray* markers) const;

  std::string name_space_;
  hires::world::StandingCriterion standing_;
  std::map<std::string, Load> load_;  // what stood on the robot at the start, by name
  std::vector<Point> points_;
};

/// The ranking as text above the place where the robot would go, latched until the next one.
visualization_msgs::MarkerArray RankingMarkers(
    const std::vector<hires::imagination::Prediction>& ranking, int recommended,
    const hires::geometry::Pose2& X_MB);

/// Text `above` [m] a point of the map, its letters `height` [m] high; no text deletes it.
visualization_msgs::Marker TextMarker(const std::string& name_space, const std::string& text,
                                      const Eigen::Vector3d& p_M, double above, double height);

/// Furniture, walls and areas, for display under the main master.
visualization_msgs::MarkerArray WorldMarkers(const hires::world::World& world);

}  // namespace hires_ros
