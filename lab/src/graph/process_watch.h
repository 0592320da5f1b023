#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hires::lab {

/// A process that this one, or one that it started, has started.
struct Descendant {
  int pid{0};
  std::string name;  ///< of the ROS node where it is one, else of its program
  bool is_node{false};
  char state{'R'};  ///< as in stat of /proc: R, S, D run or wait; T is stopped; Z has ended
};

/// All of them, without those that end meanwhile.
std::vector<Descendant> Descendants();

/// Notices that a system of processes breaks down: that one of them has died, though another may
/// take its place, or stands still because somebody stopped it.
class BreakdownWatch {
 public:
  /// The system is what lives below this process now, and each ROS node that comes later.
  /// @param stopped_limit  [s] that a process may be stopped.
  explicit BreakdownWatch(double stopped_limit);

  /// @param now  [s] of a clock that never goes back.
  /// @return "planner (pid 71) died", "sim_worker (pid 80) is stopped since 10 s"; nothing while
  /// all is well.
  std::optional<std::string> Broken(double now);

 private:
  double stopped_limit_;
  std::map<int, std::string> names_;
  std::map<int, double> stopped_;  ///< [s] since when, by pid
};

}  // namespace hires::lab
