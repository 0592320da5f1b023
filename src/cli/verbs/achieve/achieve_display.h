#pragma once

#include <string>
#include <vector>

#include "loop/achieve.h"

namespace hires::cli {

/// The steps as a table for people: state, since when, when it is expected to end, note. Times are
/// seconds after `begin`. Steps of plans that were given up before they began are left out.
std::string StepTable(const loop::AchieveStatus& status, double begin);

/// What a dry run found: the last plan with the alternatives that imagination chose, how many
/// seconds after its beginning each step would begin and end, and what is expected of it.
std::string DryRunTable(const loop::AchieveStatus& status);

/// What is new in `after`, a line each: "  12.3 s  running  move_base(area1)". Times as above.
std::vector<std::string> ChangeLines(const loop::AchieveStatus& before,
                                     const loop::AchieveStatus& after, double begin);

/// Draws a table over itself on a terminal; elsewhere prints a line for each change.
class AchieveDisplay {
 public:
  /// @param width  of the terminal in characters; longer lines are cut. 0: no terminal.
  explicit AchieveDisplay(int width) : width_(width) {}
  /// What to print now.
  std::string Show(const loop::AchieveStatus& status);

 private:
  std::string Redraw(const loop::AchieveStatus& status);

  int width_;
  int lines_drawn_{0};
  std::optional<double> begin_;
  loop::AchieveStatus shown_;
};

}  // namespace hires::cli
