#pragma once

#include <hires/ImagineGoal.h>
#include <hires/ImagineResult.h>

#include <string>
#include <vector>

#include "nodes/hires/bag_file.h"

namespace hires_ros {

/// One recorded request, with the answer it got then.
struct RecordedRequest {
  std::string action;   ///< whose topics were recorded: "/imagine"
  std::string goal_id;  ///< never empty
  hires::ImagineGoal goal;
  hires::ImagineResult result;
};

struct ImagineRecording {
  std::vector<RecordedRequest> requests;  ///< in the order of their goals, never empty
  int results_without_goal{0};            ///< of requests that were sent before the recording began
  std::vector<std::string> left_out;      ///< goals that cannot be replayed: each with its reason
};

/// Whether goals of an `imagine` action are among them.
bool HasImagineGoals(const std::vector<BagTopic>& topics);

/// Reads a bag in which topics of `imagine` actions were recorded, in any namespace. Goals and
/// results belong together by action and goal id. A bag is data from outside: one that asks for
/// more than 2 GB of memory is refused.
/// @param action  "/imagine", or one of its topics ("/imagine/goal"); empty: all in the bag.
/// @throws hires::base::ConfigError naming the bag and what to do: no such bag, unindexed or broken
/// bag, no such action in it (with a list of what is there), messages of another version, or no
/// goal that has an id and a result (others are left out).
ImagineRecording ReadImagineRecording(const std::string& path, const std::string& action);

}  // namespace hires_ros
