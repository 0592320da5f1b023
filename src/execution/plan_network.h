#pragma once

#include <optional>
#include <string>
#include <vector>

#include "execution/plan_run.h"
#include "hires/temporal/stn.h"

namespace hires::execution {

/// When the steps of a plan begin and end: two temporal networks over the same points. One holds
/// what must be: durations within their bounds, order, what has happened. In the other each step
/// lasts as long as it is expected to; it tells when a step will come, and how late it may.
class PlanNetwork {
 public:
  /// @param informs  For each `!imagine` step the one that it informs, else -1.
  /// @param lead     [s] A step that has less than that left by expectation, and goes on, is
  ///                 expected to go on for longer than that.
  PlanNetwork(const PlanRun& run, const std::vector<int>& informs, double now, double lead);

  void SetNow(double now);               ///< nothing that has not happened happens before
  void Begin(int step, double started);  ///< now, or some time ago
  void End(int step, double finished);
  void Forget(int step);  ///< a `!imagine` step that holds up nothing any more
  /// What imagination says about the duration of a step.
  /// @return the conflict as text where that cannot be; then only the expectation changes.
  std::optional<std::string> Tighten(int step, const planning::Duration& duration);

  temporal::Bounds StartOf(int step) const;
  temporal::Bounds FinishOf(int step) const;
  double Expected(int step) const { return expected_[step]; }  ///< [s] duration
  double ExpectedStart(int step) const;   ///< [s] if all steps last as long as expected
  double ExpectedFinish(int step) const;  ///< [s] likewise
  /// When the step must begin at the latest so that the plan ends as early as it is expected to.
  double LatestStart(int step) const;

 private:
  using Stn = temporal::Stn;
  static constexpr int kNone = -1;
  struct Layer {
    Stn network;
    Stn::Point now{0}, end{0};
    std::vector<Stn::Point> starts, finishes;
    std::vector<std::vector<Stn::ConstraintId>> lasts;  ///< durations
    std::vector<Stn::ConstraintId> is_ahead;  ///< not begun, or not ended, before now; or kNone
    Stn::ConstraintId is_now{kNone};

    void AddStep(const std::string& name, const temporal::Bounds& lasts);
    std::optional<Stn::Conflict> AddDuration(int step, const temporal::Bounds& bounds,
                                             const std::string& why);
    void DropDurations(int step);
    void SetAhead(int step, Stn::Point point, const std::string& why);
    void DropAhead(int step);
    void SetNow(double now);
    void Fix(Stn::Point point, double time, const std::string& why);
  };

  void AddOrder(const PlanRun& run, const std::vector<int>& informs);
  void Expect(int step, double duration);
  void Extend(int step);

  Layer bounds_, expectation_;
  std::vector<std::string> names_;
  std::vector<double> expected_;  ///< [s]
  std::vector<bool> is_imagine_;
  std::vector<Stn::ConstraintId> informs_;  ///< in time for what they inform, or kNone
  std::vector<std::optional<double>> started_;
  std::vector<int> running_;
  double lead_, now_;
};

}  // namespace hires::execution
