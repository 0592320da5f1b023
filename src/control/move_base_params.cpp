#include "hires/control/move_base_params.h"

#include <fmt/format.h>

#include "hires/base/error.h"

namespace hires::control {
namespace {

using base::Between;
using base::ConfigError;

bool IsMoveBase(const std::string& by) {
  if (by == "own" || by == "move_base") return by == "move_base";
  throw ConfigError(fmt::format("~navigation is '{}', wanted own or move_base", by));
}

}  // namespace

MoveBaseDriveParams ReadNavigation(base::ParamReader in, std::optional<std::string> by) {
  MoveBaseDriveParams params;
  params.is_used = in.Get("by", base::OneOf({"own", "move_base"})) == "move_base";
  if (by) params.is_used = IsMoveBase(*by);
  params.start_patience = in.Get("start_patience", Between(0.1, 600.0));
  params.answer_patience = in.Get("answer_patience", Between(0.1, 600.0));
  params.max_rest = in.Get("max_rest", Between(0.0, 2.0));
  params.max_rest_turn = in.Get("max_rest_turn", Between(0.0, 3.2));
  return params;
}

void RequireMeansFor(const MoveBaseDriveParams& navigation, const RobotNames& names,
                     bool is_guard_there) {
  if (!navigation.is_used) return;
  if (names.move_base.action.empty()) {
    throw ConfigError(
        "navigation is move_base, but the robot's names have no move_base.action; name it "
        "there or take navigation own");
  }
  if (!is_guard_there) {
    throw ConfigError(
        "navigation is move_base without a guard of the base: nothing would set the motion set's "
        "limits in move_base's planner, nor stop it; set ~guard and start base_guard with "
        "~navigation "
        "move_base, or take navigation own");
  }
}

}  // namespace hires::control
