#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/GetMap.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>
#include <topic_tools/shape_shifter.h>

#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/mapping/mapper.h"
#include "hires/ros/place/placed_scans.h"
#include "hires/ros/transforms/transform_listener.h"
#include "nodes/mapping/mapping_params.h"

namespace hires_ros {

/// Makes a map of what a robot's base laser sees while it drives: the interface of gmapping. The
/// map's frame is the robot's at the first scan that met something. Maps are drawn by the stamps of
/// scans, beside the scans that come meanwhile; the same messages give the same maps. A clock that
/// begins again begins a new map.
class MappingNode {
 public:
  MappingNode(const MappingNodeParams& params, ros::NodeHandle* nh);

 private:
  struct DrawnMap {
    hires::world::OccupancyGrid grid;
    nav_msgs::OccupancyGrid msg;
    std::string doubt;    // what speaks against it; empty: nothing
    std::string why_not;  // empty: it is there
    double took{0.0};     // [s]
    long restart{0};      // num_restarts_ when it was begun
  };

  void Listen(ros::NodeHandle* nh);
  void OnTransforms(const TransformBuffer::News& news);
  void OnScan(const topic_tools::ShapeShifter& msg);
  void OnTimer();
  bool OnMapRequest(nav_msgs::GetMap::Request& request, nav_msgs::GetMap::Response& response);
  bool OnSave(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  /// Draws it where it is old.  @return why there is none; empty: map_ holds all scans.
  std::string WhyNoMap();

  void WatchClock();
  void BeginMap();
  void Use(const PlacedScan& scan);
  /// @return why it says nothing about the map; empty: use it.
  std::string WhyUseless(const PlacedScan& scan);
  void AddToMap(const PlacedScan& scan);
  void PublishTransform(const PlacedScan& scan);
  bool IsDue() const;
  static DrawnMap DrawFrom(const hires::mapping::MapSketch& sketch,
                           const hires::mapping::MapCounts& counts, const std_msgs::Header& header,
                           long restart);
  void BeginDrawing();  ///< @pre there is a scan, and no map is being drawn
  /// Publishes the map that is being drawn.  @param is_awaited  even if it is not yet done.
  void TakeDrawn(bool is_awaited);

  void Refuse(const std::string& topic, const std::string& why);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  std::string Complaint() const;  ///< what is odd, for people; empty: nothing

  const MappingNodeParams params_;
  TransformListener transforms_;
  PlacedScans scans_;
  std::optional<hires::mapping::Mapper> mapper_;
  hires::mapping::MapCounts counts_;     // after the last scan
  bool is_lost_{false};                  // at the last scan
  std::optional<ros::Time> last_scan_;   // in the map
  double last_used_{0.0};                // [s] steady, when that came
  std::optional<DrawnMap> map_;          // the last one that was drawn
  bool is_map_old_{false};               // scans came since
  std::optional<ros::Time> last_drawn_;  // last scan when it was last tried
  std::string why_not_drawn_;
  std::future<DrawnMap> drawing_;  // in a thread of its own
  double drawing_took_{0.0};       // [s] that it took
  ros::Time now_;                  // when it was last looked at

  std::string last_drop_;                     // the last message that was dropped, and why
  std::map<std::string, long> num_outcomes_;  // of scans that were placed
  std::map<std::string, long> num_dropped_;   // by topic
  hires::base::TopicWarnings warnings_;
  long num_scans_{0}, num_maps_{0}, num_restarts_{0};

  ros::Publisher map_publisher_, metadata_, transform_;
  ros::Subscriber input_;
  std::vector<ros::ServiceServer> services_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace hires_ros
