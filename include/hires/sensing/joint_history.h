#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "hires/robot/readings.h"
#include "hires/robot/robot_profile.h"
#include "hires/sensing/history.h"

namespace hires::sensing {

/// Joint states of the last seconds; several drivers may tell of some joints each. Joints that
/// follow others, or that a robot with arms does not have, are left out (a PR2's finger tips);
/// what a sensor sees beyond a joint's stop counts as the stop.
class JointHistory {
 public:
  explicit JointHistory(std::shared_ptr<const robot::Robot> robot);

  /// @return whether it said anything new.  @pre all numbers are finite
  bool Insert(double stamp, const robot::JointReading& reading);
  void KeepBetween(double from, double to);
  void Clear();

  bool empty() const { return history_.empty(); }
  double newest() const { return history_.back().stamp; }  ///< [s] @pre not empty
  /// The stamp of the first reading after `time`.
  std::optional<double> NextAfter(double time) const;
  /// [s] from `time` to the reading that is nearest in time; infinity if there is none.
  double DistanceTo(double time) const;

  /// Each joint between the two readings around `time`, as long as they are at most `max_gap` [s]
  /// apart; else as in the earlier one, or in the later one where nothing came before.
  robot::JointReading At(double time, double max_gap) const;
  /// How the whole robot stands, see robot::PostureOf; names that its model does not know, or whose
  /// joint is fixed, are left out.
  robot::JointPositions PostureOf(const robot::JointPositions& measured) const;

 private:
  using Joints = std::map<std::string, const robot::Joint*>;

  bool IsOurs(const robot::Joint* joint) const;

  std::shared_ptr<const robot::Robot> robot_;
  Joints joints_;  // of the robot
  History<robot::JointReading> history_;
  robot::JointReading older_;    // the last words about joints before the history begins
  std::set<std::string> names_;  // of all joints that were ever told of
};

}  // namespace hires::sensing
