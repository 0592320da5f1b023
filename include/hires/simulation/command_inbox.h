#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hires/robot/observation.h"

namespace hires::simulation {

/// Gathers what controllers are told between two moments at which the robot listens. Each topic
/// keeps its order; what stands here does not depend on how messages of different topics
/// interleave.
class CommandInbox {
 public:
  /// @param sender  node whose message it was.
  void Add(const std::string& sender, const robot::Command& command);

  /// What has gathered since it was taken last; later ones replace earlier ones of the same kind.
  robot::Command Take();

  /// Messages of a sender that CountOff has not counted off.
  std::uint64_t num_from(const std::string& sender) const;
  void CountOff(const std::string& sender, std::uint64_t number);
  void Forget(const std::string& sender) { counts_.erase(sender); }

 private:
  robot::Command gathered_;
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace hires::simulation
