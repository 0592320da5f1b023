#pragma once

#include <nav_msgs/OccupancyGrid.h>

#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "hires/base/thread_pool.h"

namespace hires_ros {

/// Asks a map server (nav_msgs/GetMap) without waiting for it: one
/// that never answers holds up nothing.
class MapRequest {
 public:
  explicit MapRequest(std::string service) : service_(std::move(service)) {}

  /// Asks, unless an answer is being waited for.
  void Ask();
  /// The map that came since, once.
  std::optional<nav_msgs::OccupancyGrid> Take();
  /// [s] since the question that has no answer yet; 0: there is none.
  double Waiting() const;

 private:
  void Call();

  const std::string service_;
  mutable std::mutex mutex_;
  std::optional<nav_msgs::OccupancyGrid> answer_;  // guarded
  std::optional<double> asked_;                    // [s] steady, of the open question; guarded
  hires::base::ThreadPool thread_;                 // last: it uses the others
};

}  // namespace hires_ros
