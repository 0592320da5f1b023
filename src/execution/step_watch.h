#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "execution/session.h"

namespace hires::execution {

/// Holds what is observed against what the plan expects: results, effects, durations, and what
/// steps rest on. Reports violations to the session, and stops what cannot go on.
class StepWatch {
 public:
  explicit StepWatch(Session* session) : session_(*session) {}

  void OnFinished(const StepFinished& finished);
  /// @param with_later_steps  Also what steps rest on that have not begun; not while a plan is
  ///                          sought that takes their place.
  void Check(bool with_later_steps);
  std::optional<double> WakeAt() const { return wake_at_; }
  /// A step did not stop when it was told to: why the task cannot go on. "" if all is well.
  const std::string& lost() const { return lost_; }

 private:
  void CheckStop(int step);
  void CheckDuration(int step);
  void CheckEffects(int step);
  bool MayBeOnItsWay(double due, const std::string& action);
  void CheckConditions(int step);
  void CheckLinks(int step);
  std::optional<base::Failure> MissingEffect(int step) const;
  bool IsDisturbed(const Expectation& expectation) const;
  std::optional<double> BrokenSince(const Expectation& expectation);
  void Wake(double at);
  bool IsPast(double at);

  Session& session_;
  std::map<std::string, double> broken_;  ///< expectation that does not hold, since [s]
  std::map<std::string, double> still_broken_;
  std::set<std::string> late_;  ///< actions whose late observation was reported
  std::optional<double> wake_at_;
  std::string lost_;
};

}  // namespace hires::execution
