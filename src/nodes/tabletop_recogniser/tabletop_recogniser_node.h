#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/Detections.h>
#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/perception/tabletop_recogniser.h"
#include "hires/ros/transforms/transform_listener.h"
#include "nodes/tabletop_recogniser/tabletop_recogniser_params.h"

namespace hires_ros {

/// Tells what stands on tables in the clouds of a depth camera. tf says where the camera and the
/// robot's own links are at the stamp of a cloud. Works while somebody listens, on the newest cloud
/// that came; each gets one answer, also where no table is seen, and what it says depends on cloud
/// and transforms alone. A cloud that comes again is answered again, by the same. One that is not
/// of now, or that its frame does not fit, is dropped with the reason, and gets no answer.
class TabletopRecogniserNode {
 public:
  TabletopRecogniserNode(const TabletopRecogniserParams& params, ros::NodeHandle* nh);

 private:
  using Steady = std::chrono::steady_clock;
  /// Why a cloud is dropped.
  enum class Fault { kMalformed, kTooOld, kAhead, kNoTransform };
  static constexpr std::size_t kNumFaults = 4;

  void ListenWhereHeard();
  void OnCloud(const sensor_msgs::PointCloud2ConstPtr& msg);
  void Try();               ///< recognises in the cloud that waits, if its transform is there
  bool RefuseIfUntimely();  ///< the cloud that waits; whether it did
  void Recognise(const hires::geometry::Pose3& X_BC);
  std::vector<hires::geometry::Collision> RobotShapes(double time);
  void Refuse(Fault fault, const std::string& why);
  void Tell();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const TabletopRecogniserParams params_;
  ros::NodeHandle nh_;
  hires::perception::TabletopRecogniser recogniser_;
  TransformListener transforms_;
  sensor_msgs::PointCloud2ConstPtr waiting_;  // for its transform; or null
  hires::Detections last_;                    // answer

  std::string waits_for_, refused_;  // why the last cloud was not recognised; or empty
  std::vector<std::string> uncut_;   // links that tf did not know
  long num_clouds_{0}, num_recognised_{0}, num_replaced_{0};
  std::array<long, kNumFaults> num_refused_{};               // by fault
  int num_own_points_{0}, num_points_{0}, num_measured_{0};  // of the last cloud
  int num_left_out_{0};                                      // likewise, above the table
  double seconds_{0.0};                                      // [s] that it took
  hires::base::TopicWarnings warnings_;

  ros::Publisher detections_, markers_;
  std::optional<ros::Subscriber> clouds_;  // while somebody listens
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace hires_ros
