#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "hires/imagination/report.h"
#include "hires/simulation/robot_simulator.h"

namespace hires_ros {

/// Markers of one worker's rollout in the map frame, lifetime 2 s: robot and load, the trace of the
/// base (thickness = speed, green = speeding up, red = braking), the load's axis and the world's up
/// as arrows, and the circle on which the load turns (dissertation, Figures 5.7 and 5.16).
class TraceMarkers {
 public:
  explicit TraceMarkers(int worker_index);

  void Clear();  ///< a new rollout begins
  void Add(const hires::simulation::RobotSimulator& simulator, double tilt);
  visualization_msgs::MarkerArray Draw(const hires::simulation::RobotSimulator& simulator,
                                       double tilt) const;

 private:
  struct Point {
    Eigen::Vector3d p_M;
    double speed;         // [m/s]
    double acceleration;  // [m/s^2], positive: along the motion
  };
  visualization_msgs::Marker Blank(const std::string& name, int id, int type) const;
  void DrawBodies(const hires::simulation::RobotSimulator& simulator,
                  visualization_msgs::MarkerArray* markers) const;
  void DrawTrace(visualization_msgs::MarkerArray* markers) const;
  void DrawLoad(const hires::simulation::RobotSimulator& simulator, double tilt,
                visualization_msgs::MarkerArray* markers) const;
  void DrawCircle(const hires::simulation::RobotSimulator& simulator,
                  visualization_msgs::MarkerArray* markers) const;

  std::string name_space_;
  std::vector<Point> points_;
};

/// The ranking as text above the place where the robot would go, latched until the next one.
visualization_msgs::MarkerArray RankingMarkers(
    const std::vector<hires::imagination::Prediction>& ranking, int recommended,
    const hires::geometry::Pose2& X_MB);

/// Furniture, walls and areas, for display under the main master.
visualization_msgs::MarkerArray WorldMarkers(const hires::world::World& world);

}  // namespace hires_ros
