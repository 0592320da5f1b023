#include "hires/ros/values/action_messages.h"

namespace hires_ros {

msg::ActionCall ToMsg(const hires::base::ActionCall& call) {
  msg::ActionCall out;
  out.name = call.name;
  out.arguments = call.arguments;
  return out;
}

hires::base::ActionCall FromMsg(const msg::ActionCall& call) { return {call.name, call.arguments}; }

msg::ActionTemplate ToMsg(const hires::base::ActionTemplate& action) {
  msg::ActionTemplate out;
  out.name = action.name;
  for (const auto& list : action.alternatives) {
    out.alternatives.emplace_back();
    out.alternatives.back().values = list;
  }
  return out;
}

hires::base::ActionTemplate FromMsg(const msg::ActionTemplate& action) {
  hires::base::ActionTemplate out{action.name, {}};
  for (const auto& list : action.alternatives) out.alternatives.push_back(list.values);
  return out;
}

}  // namespace hires_ros
