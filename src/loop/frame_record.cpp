#include "loop/frame_record.h"

#include <limits>
#include <set>

namespace hires::loop {
namespace {

using geometry::Pose3;
using sensing::FramePose;
using sensing::FrameStatus;

Pose3 Between(const Pose3& from, const Pose3& to, double share) {
  Pose3 pose;
  pose.translation = (1.0 - share) * from.translation + share * to.translation;
  pose.rotation = from.rotation.slerp(share, to.rotation);
  return pose;
}

}  // namespace

void FrameRecord::Tell(const std::string& parent, const std::string& child, double time,
                       const Pose3& X_PC) {
  auto& poses = poses_[{parent, child}];
  poses.Insert(time, X_PC);
  poses.KeepBetween(poses.back().stamp - history_, std::numeric_limits<double>::infinity());
}

FramePose FrameRecord::Find(const std::string& parent, const std::string& child,
                            double time) const {
  const auto found = poses_.find({parent, child});
  if (found == poses_.end()) return {FrameStatus::kNotConnected, {}};
  const auto* before = found->second.Before(time);
  const auto* after = found->second.After(time);
  if (before != nullptr && before->stamp == time) return {FrameStatus::kFound, before->value};
  if (before == nullptr || after == nullptr) return {FrameStatus::kNotThen, {}};
  const double share = (time - before->stamp) / (after->stamp - before->stamp);
  return {FrameStatus::kFound, Between(before->value, after->value, share)};
}

std::optional<double> FrameRecord::NewestOf(const std::string& parent,
                                            const std::string& child) const {
  const auto found = poses_.find({parent, child});
  if (found == poses_.end() || found->second.empty()) return std::nullopt;
  return found->second.back().stamp;
}

std::vector<std::string> FrameRecord::Names() const {
  std::set<std::string> names;
  for (const auto& [link, poses] : poses_) names.insert({link.first, link.second});
  return {names.begin(), names.end()};
}

}  // namespace hires::loop
