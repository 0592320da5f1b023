#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/sensing/frame_tree.h"

namespace hires_ros {

/// What came on /tf and /tf_static, as the core asks for it: tf2's buffer without its thread.
class TransformBuffer : public hires::sensing::FrameTree {
 public:
  /// What a message brought.
  struct News {
    std::vector<double> stamps;         ///< [s] of what was taken, each once; infinity: fixed ones
    std::vector<std::string> warnings;  ///< what was left out, and why
    std::vector<std::string> doubts;    ///< what was taken and cannot be right, and why
  };
  News Take(const tf2_msgs::TFMessage& msg, bool are_static);

  hires::sensing::FramePose Find(const std::string& parent, const std::string& child,
                                 double time) const override;
  std::optional<double> NewestOf(const std::string& parent,
                                 const std::string& child) const override;
  std::vector<std::string> Names() const override;
  void ForgetMoving() override;

  /// For people: why Find does not find the one in the other, with all that is known above both;
  /// empty where it does.
  std::string WhyNot(const std::string& parent, const std::string& child, double time) const;

 private:
  bool IsKnown(const std::string& frame) const;
  std::string ParentOf(const std::string& frame) const;
  std::string LineOf(const std::string& frame) const;
  std::string WhyTornApart(const geometry_msgs::TransformStamped& msg);
  bool IsRepeated(const geometry_msgs::TransformStamped& msg);

  tf2::BufferCore buffer_;
  std::map<std::string, ros::Time> newest_;            // stamp that came last, by child frame
  std::map<std::string, std::set<std::string>> left_;  // frames below which a frame hung before
};

}  // namespace hires_ros
