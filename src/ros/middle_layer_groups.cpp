#include "hires/ros/middle_layer_groups.h"

#include <map>
#include <vector>

#include "hires/base/text.h"

namespace hires_ros {
namespace {

struct Needs {
  std::vector<std::string> groups;
  int arm_argument{-1};  // which argument names an arm, if one does
};

const Needs kEverything{{"base", "torso", "head", "leftarm1", "rightarm1"}};

const std::map<std::string, Needs>& Table() {
  static const std::map<std::string, Needs> table{
      {"move_base", {{"base"}}},
      {"move_base_param", {{"base"}}},
      {"move_base_blind", {{"base"}}},
      {"move_torso", {{"torso"}}},
      {"look_at", {{"head"}}},
      {"observe_objects_on_area", {{"head"}}},
      {"tuck_arms", {{"leftarm1", "rightarm1"}}},
      {"move_arms_to_carryposture", {{"leftarm1", "rightarm1"}}},
      {"move_arm_to_side", {{}, 0}},
      {"pick_up_object", {{"base", "torso"}, 1}},
      {"place_object", {{"base", "torso"}, 1}},
      {"pick_up_from_tray", {{"base", "torso"}, 0}},
      {"place_on_tray", {{"base", "torso"}, 0}},
  };
  return table;
}

}  // namespace

std::set<std::string> GroupsOf(const hires::base::ActionCall& action) {
  const auto found = Table().find(hires::base::ToLower(action.name));
  const Needs& needs = found == Table().end() ? kEverything : found->second;
  std::set<std::string> groups(needs.groups.begin(), needs.groups.end());
  if (needs.arm_argument >= 0) {
    groups.insert(hires::base::ToLower(action.arguments.at(needs.arm_argument)));
  }
  return groups;
}

}  // namespace hires_ros
