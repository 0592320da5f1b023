#include "hires/ros/perception/detection_messages.h"

#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {

hires::perception::Detection FromMsg(const hires::Detection& msg) {
  hires::perception::Detection out;
  if (!msg.instance.empty()) out.instance = msg.instance;
  out.label = msg.label;
  out.X_CO = FromMsg(msg.pose);
  out.visible_share = msg.visible_share;
  out.category = msg.category;
  out.confidence = msg.confidence == 0.0f ? 1.0 : msg.confidence;
  for (const hires::LabelConfidence& other : msg.alternatives) {
    out.alternatives.push_back({other.label, other.confidence});
  }
  out.size = {msg.size.x, msg.size.y, msg.size.z};
  out.num_points = static_cast<int>(msg.num_points);
  out.may_be_beside = msg.may_be_beside;
  return out;
}

hires::Detection ToMsg(const hires::perception::Detection& detection) {
  hires::Detection out;
  out.instance = detection.instance.value_or("");
  out.label = detection.label;
  out.pose = ToMsg(detection.X_CO);
  out.visible_share = static_cast<float>(detection.visible_share);
  out.category = detection.category;
  out.confidence = static_cast<float>(detection.confidence);
  for (const hires::perception::LabelConfidence& other : detection.alternatives) {
    out.alternatives.emplace_back();
    out.alternatives.back().label = other.label;
    out.alternatives.back().confidence = static_cast<float>(other.confidence);
  }
  out.size.x = detection.size.x();
  out.size.y = detection.size.y();
  out.size.z = detection.size.z();
  out.num_points = static_cast<std::uint32_t>(detection.num_points);
  out.may_be_beside = detection.may_be_beside;
  return out;
}

std::optional<hires::perception::Sighting> FromMsg(const hires::Detections& msg) {
  if (msg.is_blind) return std::nullopt;
  hires::perception::Sighting seen;
  for (const hires::Detection& detection : msg.detections)
    seen.detections.push_back(FromMsg(detection));
  for (const geometry_msgs::Point& corner : msg.table)
    seen.table.emplace_back(corner.x, corner.y, corner.z);
  return seen;
}

hires::Detections ToMsg(const std::optional<hires::perception::Sighting>& seen,
                        const std_msgs::Header& header) {
  hires::Detections out;
  out.header = header;
  out.is_blind = !seen;
  if (!seen) return out;
  for (const hires::perception::Detection& detection : seen->detections)
    out.detections.push_back(ToMsg(detection));
  for (const Eigen::Vector3d& corner : seen->table) {
    out.table.emplace_back();
    out.table.back().x = corner.x();
    out.table.back().y = corner.y();
    out.table.back().z = corner.z();
  }
  return out;
}

}  // namespace hires_ros
