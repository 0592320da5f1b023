#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/self_filter.h"
#include "hires/sensing/ground_reading.h"
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
  bool is_enabled{true};  ///< else nobody listens to the clouds
  GroundParams ground{};
  perception::SelfFilterParams self{};
  std::string eye{
      "laser_tilt_mount_link"};  ///< frame where clouds are seen from; empty: the clouds' own
  double keep{5.0};              ///< [s] after which what a cloud showed is forgotten
  ScanParams scan{};             ///< how far and how finely clouds are looked at
  bool operator==(const GroundWatchParams& other) const;
};

/// The block `sensing: ground` of config/scene.yaml.  @throws base::ConfigError naming the key.
GroundWatchParams ReadGroundWatchParams(base::ParamReader in);

class GroundObstacles;

/// Watches the way by clouds that show the floor, of a depth camera or of a tilting laser's sweeps
/// put together: what stands out of it and holes, without the robot itself.
class GroundWatch {
 public:
  /// @param state      outlives this.
  /// @param robot      points over its footprint are its own.
  /// @param map        what is known to stand there.
  GroundWatch(const RobotStateEstimator* state, std::shared_ptr<const robot::Robot> robot,
              std::shared_ptr<const navigation::Costmap> map, const GroundWatchParams& params);
  ~GroundWatch();
  GroundWatch(GroundWatch&&) noexcept;

  /// @param stamp  of the cloud; of a sweep, of its end.
  Receipt OnCloud(double stamp, const std::string& frame, perception::PointCloud cloud);

  /// Looks at the newest cloud up to now.  @return whether there was one, and it could be.
  bool Update(const RobotEstimate& now);
  /// Of the last cloud that was looked at, where the robot was when it was taken.
  const GroundReading& reading() const { return reading_; }
  double cell() const { return params_.scan.cell; }  ///< [m] edge of the reading's
  /// Squares in the map, of the last cloud up to now.
  const std::vector<geometry::Polygon>& Obstacles(const RobotEstimate& now);
  /// What became of the last cloud that was looked at.
  const Receipt& receipt() const { return receipt_; }

 private:
  bool Look(double stamp, const std::string& frame, perception::PointCloud cloud);
  void DropOwn(double stamp);

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
  GroundReading reading_;
  std::vector<geometry::Polygon> obstacles_M_;
  Receipt receipt_;
};

}  // namespace hires::sensing
