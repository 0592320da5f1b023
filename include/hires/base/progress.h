#pragma once

#include <functional>
#include <string>

namespace hires::base {

/// Says how far work has come that somebody may wait for, such as reading a large world. Goes to
/// the sink, if there is one. Safe to call from any thread; the sink is called by one at a time.
/// @param task   what is done, as people are told: "reading hall.world".
/// @param share  [0, 1]; 1 once it is done.
void ReportProgress(const std::string& task, double share);

using ProgressSink = std::function<void(const std::string& task, double share)>;
/// Replaces the sink for the whole process; an empty function removes it.
void SetProgressSink(ProgressSink sink);

/// Which reports are worth a line for people: none in the first second, for what is done by then
/// needs no progress; afterwards each where the line is drawn over itself, else one every 5 s.
class ProgressPace {
 public:
  explicit ProgressPace(bool is_drawn_over) : is_drawn_over_(is_drawn_over) {}

  /// @param now  [s] of a clock that never goes back.
  bool IsDue(const std::string& task, double now);

 private:
  bool is_drawn_over_;
  std::string task_;
  double next_{0.0};
};

}  // namespace hires::base
