#include "hires/simulation/command_inbox.h"

#include <algorithm>
#include <utility>

namespace hires::simulation {

void CommandInbox::Add(const std::string& sender, const robot::Command& command) {
  ++counts_[sender];
  if (command.base_velocity) gathered_.base_velocity = command.base_velocity;
  for (const auto& [group, trajectory] : command.trajectories) {
    gathered_.trajectories[group] = trajectory;
  }
  for (const auto& [arm, gripper] : command.grippers) gathered_.grippers[arm] = gripper;
}

robot::Command CommandInbox::Take() { return std::exchange(gathered_, {}); }

std::uint64_t CommandInbox::num_from(const std::string& sender) const {
  const auto found = counts_.find(sender);
  return found == counts_.end() ? 0 : found->second;
}

void CommandInbox::CountOff(const std::string& sender, std::uint64_t number) {
  std::uint64_t& count = counts_[sender];
  count -= std::min(count, number);
}

}  // namespace hires::simulation
