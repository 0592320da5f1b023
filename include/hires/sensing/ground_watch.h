#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/self_filter.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/sensing/scan_obstacles.h"

namespace hires::sensing {

struct FloorParams {
  double max_tilt{0.03};    ///< [rad] of the floor against the base: what is steeper is no floor
  double max_offset{0.03};  ///< [m] of the floor below or above the base's origin
  double inlier{0.015};     ///< [m] a point this near to a plane is of it
  double min_share{0.3};    ///< of the points that may be floor, in the plane
  int min_points{100};      ///< in the plane
};

struct GroundParams {
  FloorParams floor{};
  double min_height{0.03};  ///< [m] over the floor, from which on it is an obstacle
  double min_depth{0.05};   ///< [m] below the floor, likewise: a hole, a stair down
  int min_points{3};        ///< of a cell, before it counts
};

struct GroundWatchParams {
  bool is_enabled{false};  ///< else nobody listens to the clouds
  GroundParams ground{};
  perception::SelfFilterParams self{};
  std::string eye{};  ///< frame where clouds are seen from; empty: the clouds' own
  double keep{5.0};   ///< [s] after which what a cloud showed is forgotten
};

/// The block `ground` of config/middle_layer.yaml.  @throws base::ConfigError naming the key.
GroundWatchParams ReadGroundWatchParams(base::ParamReader in);

class GroundObstacles;

/// Watches the way by clouds that show the floor, of a depth camera or of a tilting laser's sweeps
/// put together: what stands out of it and holes, without the robot itself.
class GroundWatch {
 public:
  /// @param state      outlives this.
  /// @param map        what is known to stand there.
  /// @param footprint  of the robot, in its base: points over it are the robot's own.
  /// @param rng        for the search for the floor.
  GroundWatch(const RobotStateEstimator* state, std::shared_ptr<const robot::Robot> robot,
              std::shared_ptr<const navigation::Costmap> map, geometry::Polygon footprint,
              const ScanParams& scan, const GroundWatchParams& params, base::Rng rng);
  ~GroundWatch();
  GroundWatch(GroundWatch&&) noexcept;

  /// @param stamp  of the cloud; of a sweep, of its end.
  Receipt OnCloud(double stamp, const std::string& frame, perception::PointCloud cloud);

  /// Squares in the map, of the last cloud up to now, where the robot was when it was taken.
  const std::vector<geometry::Polygon>& Obstacles(const RobotEstimate& now);
  /// What became of the last cloud that was looked at.
  const Receipt& receipt() const { return receipt_; }

 private:
  void Look(double stamp, const std::string& frame, perception::PointCloud cloud);

  struct Cloud {
    double stamp{0.0};
    std::string frame;
    perception::PointCloud points;
  };
  const RobotStateEstimator* state_;
  std::shared_ptr<const robot::Robot> robot_;
  std::unique_ptr<const GroundObstacles> find_;
  perception::SelfFilter self_;
  GroundWatchParams params_;
  base::Rng rng_;
  std::optional<Cloud> waiting_;  // not looked at yet
  double seen_{0.0};              // [s] stamp of what obstacles_M_ are of
  std::vector<geometry::Polygon> obstacles_M_;
  Receipt receipt_;
};

}  // namespace hires::sensing
