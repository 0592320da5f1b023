#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/robot/observation.h"
#include "hires/sensing/ground_watch.h"
#include "hires/sensing/scan_queue.h"
#include "hires/world/world.h"

namespace hires::sensing {

struct FloorWatchParams {
  bool is_enabled{true};
  double range{3.0};         ///< [m] from the laser
  double tolerance{0.15};    ///< [m] a point this near to something known is that
  double cell{0.1};          ///< [m] edge of the squares in which points are counted
  double appear_after{5.0};  ///< [s] of being seen: what is there for longer stays there
  double gap{0.45};          ///< [m] at most between parts of one thing: a chair's legs
  double height{0.4};        ///< [m] of things that the laser alone sees: a slice of them
  double min_change{0.08};   ///< [m] by which a thing must differ before that is said
};

/// The block `floor` of config/world_tracker.yaml.  @throws base::ConfigError naming the key.
FloorWatchParams ReadFloorWatchParams(base::ParamReader in);

/// Remembers what stands on the floor and is not in the world as it is known: what the base's laser
/// has seen for some time, until the laser sees through its place for a fifth of that. Neighbouring
/// points are one thing, as large as the smallest box around them; where such a box would reach
/// into something known, it is divided. What is above and below the scan nobody sees: boxes have
/// all the same height.
///
/// Where clouds show the floor, what stands out of it in two of them is there as well, as high as
/// it was seen, until two show the floor in its place. What hangs above `height` stands somewhere
/// else. A hole is a thing of that height: nothing drives there.
///
/// Things have names, obstacle1, obstacle2, ..., for as long as they stand. Knows no clock; same
/// input, same output.
class FloorWatch {
 public:
  /// @param state  outlives this.
  /// @param world  what is known to stand there; constant.
  /// @param robot  that watches.
  /// @param ground  of clouds; not enabled: none come.
  FloorWatch(const RobotStateEstimator* state, std::shared_ptr<const world::World> world,
             std::shared_ptr<const robot::Robot> robot, const FloorWatchParams& params,
             const GroundWatchParams& ground = {});

  bool hears_clouds() const { return ground_ != nullptr; }
  /// As GroundWatch::OnCloud.  @pre hears_clouds()
  Receipt OnCloud(double stamp, const std::string& frame, perception::PointCloud cloud) {
    return ground_->OnCloud(stamp, frame, std::move(cloud));
  }
  Receipt OnScan(double stamp, const std::string& frame, robot::ScanReading reading);
  /// Takes in the newest scan and cloud up to a time [s].
  /// @return whether other things are there than before.
  bool Update(double time);

  /// By name, in the map, standing on the floor; models are world::UnknownBoxModel.
  const std::vector<robot::SeenObject>& things() const { return things_; }
  /// That stood there and are gone; until they appear again.
  const std::vector<std::string>& vanished() const { return vanished_; }
  const Receipt& receipt() const { return scans_.receipt(); }
  /// Of the last cloud that was looked at.  @pre hears_clouds()
  const Receipt& cloud_receipt() const { return ground_->receipt(); }

 private:
  using Key = std::pair<long, long>;
  struct Cell {
    double seen{0.0};  // [s] for how long; what is free takes away from it
    Eigen::Vector2d sum{0.0, 0.0};
    int count{0};  // of points, whose sum it is
    bool is_taken{false};
  };
  /// A cell of the clouds' grid in which something stands out.
  struct Swept {
    int clouds{0};  // that showed it; what shows the floor takes away from it
    bool is_taken{false};
    Eigen::Vector2d p_M{0.0, 0.0};
    double height{0.0};  // [m]
  };
  struct Spot {
    Eigen::Vector2d p_M;
    double height;  // [m] 0: nobody saw it
  };
  struct Thing {
    geometry::Rectangle box;
    double height;  // [m]
  };

  bool TakeScan(double time);
  bool TakeCloud(double time);
  bool ForgetSwept(const GroundReading& reading);
  bool IsPassed(const Swept& swept, const GroundReading& reading) const;
  bool Count(const ScanQueue::Placed& scan, double elapsed);
  bool Forget(const ScanQueue::Placed& scan, double elapsed, const std::map<Key, int>& hit);
  Key KeyOf(const Eigen::Vector2d& p_M) const;
  std::vector<Spot> Taken() const;
  std::vector<std::vector<Spot>> Groups() const;
  void Box(std::vector<Spot> spots, std::vector<Thing>* boxes) const;
  bool IsFree(const geometry::Rectangle& box) const;
  bool AreAlike(const Thing& a, const Thing& b) const;
  void Name(const std::vector<Thing>& boxes, double time);

  FloorWatchParams params_;
  geometry::Polygon footprint_;
  std::vector<geometry::Polygon> known_M_;  // outlines of what is known, in the height of things
  navigation::Costmap map_;                 // the same as cells
  const RobotStateEstimator* state_;
  ScanQueue scans_;
  std::unique_ptr<GroundWatch> ground_;  // null: no clouds come
  double time_{-1.0};                    // [s] of the last scan
  std::map<Key, Cell> cells_;
  std::map<GroundCell, Swept> swept_;
  std::vector<Thing> boxes_;  // of things_
  std::vector<robot::SeenObject> things_;
  std::vector<std::string> vanished_;
};

}  // namespace hires::sensing
