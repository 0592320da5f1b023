#include "cli/verbs/doctor/robot_view.h"

#include <algorithm>

#include "base/averages.h"
#include "hires/base/text.h"

namespace hires::cli {

double SeenMessages::rate() const {
  return count > 1 && last > first ? (count - 1) / (last - first) : 0.0;
}

std::optional<double> SeenMessages::age() const {
  if (ages.empty()) return std::nullopt;
  return base::Median(ages);
}

std::string SeenNode::host() const {
  const auto endpoint = hires::relay::ParseUri(uri);
  return endpoint ? endpoint->host : "";
}

const SeenTopic* RobotView::FindTopic(const std::string& name) const {
  const auto it = topics.find(name);
  return it == topics.end() ? nullptr : &it->second;
}

bool RobotView::IsHere(const std::string& host) const {
  if (hires::relay::IsLoopback(host) || this_host.count(hires::base::ToLower(host)) > 0) {
    return true;
  }
  const auto known = addresses.find(host);
  return known != addresses.end() &&
         std::any_of(known->second.begin(), known->second.end(),
                     [&](const std::string& address) { return this_host.count(address) > 0; });
}

}  // namespace hires::cli
