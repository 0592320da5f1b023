#pragma once

#include <functional>
#include <string>

#include "hires/control/move_base_journal.h"
#include "hires/control/move_base_limits.h"
#include "hires/control/robot_names.h"

namespace hires::control {

/// Changes values of a dynamic_reconfigure server and returns all that it has then; no changes:
/// just looks.  Throws base::ConfigError where the server is missing or silent.
using Reconfigure =
    std::function<PlannerValues(const std::string& server, const PlannerValues& changes)>;

/// Brings a motion set to move_base's local planner, and what was there before back again; a
/// journal on disk outlives it. One thread owns it; calls take as long as the planner does.
class MotionSetKeeper {
 public:
  /// @param names  the planner's name resolved.
  MotionSetKeeper(const RobotNames::MoveBase& names, std::string journal_path,
                  Reconfigure reconfigure);

  /// All limits of the set in one call, read back; what another set of ours changed before is
  /// replaced. On an error nothing of it stays in force.
  /// @throws base::ConfigError naming server and parameter, what was wanted and what is: a
  /// parameter that is not there, a value that was clamped or ignored, a server that is missing, a
  /// journal that cannot be written or read.
  void Apply(const std::string& set_name, const robot::MotionSet& set);

  /// Puts back what was before, also what another process left behind. A value that is neither what
  /// was set nor what was before has been changed by another program since: it stays, with a
  /// warning. Nothing happens without a journal.
  /// @throws base::ConfigError as Apply; the journal stays then.
  void Restore();

  /// Whether the planner still has what Apply told it.
  /// @throws base::ConfigError naming what is different, or as Apply.
  void Verify() const;

  const PlannerValues& in_force() const { return in_force_; }  ///< empty: nothing of ours

 private:
  void Change(const MoveBaseJournal& journal, const PlannerValues& having);
  PlannerValues Call(const std::string& server, const PlannerValues& changes) const;

  RobotNames::MoveBase names_;
  std::string path_;
  Reconfigure reconfigure_;
  PlannerValues in_force_;
};

}  // namespace hires::control
