#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "execution/step_effects.h"
#include "hires/execution/monitor.h"

namespace hires::execution {

/// A condition of a step that observations can confirm or contradict.
struct Expectation {
  planning::Literal literal;
  std::string text;  ///< of its atom
  int producer{planning::CausalLink::kInitial};
};

/// A step of a plan and how far it is.
struct StepRun {
  enum class Kind {
    kAction,
    kImagine,      ///< `!imagine`: asks, and takes the robot no time
    kBookkeeping,  ///< `!!`: done as soon as its turn comes and what it rests on holds
  };
  Kind kind{Kind::kAction};
  base::ActionCall action;
  StepPhase phase{StepPhase::kWaiting};
  std::vector<int> after;  ///< steps that must be done before
  std::vector<Expectation> expectations;
  std::map<std::string, int> resources;
  Disturbance disturbance;
  planning::Duration duration;
  double expected{0.0};  ///< [s]

  int activity{0};            ///< 0: not begun
  std::vector<Datum> before;  ///< what held when it began of what it touches
  bool is_stopping{false};
  double time_limit{0.0};       ///< [s]
  std::optional<double> ready;  ///< [s] main ROS time, as the others
  std::optional<double> started;
  std::optional<double> finished;
  std::optional<double> stopped;  ///< when it was told to stop
  base::Failure stop_reason;      ///< and why
  std::string note;
  base::Failure failure;

  bool IsActive() const {
    return kind != Kind::kImagine &&
           (phase == StepPhase::kRunning || phase == StepPhase::kChecking);
  }
  bool IsWaiting() const { return phase == StepPhase::kWaiting || phase == StepPhase::kReady; }
};

/// A plan in execution. The index of a step is its place in the plan.
class PlanRun {
 public:
  /// @param problem  Which the plan solves, with the facts that held when it was made.
  /// @throws base::ConfigError where the plan does not fit domain, problem or operator data.
  PlanRun(int number, planning::Plan plan, planning::Problem problem,
          const planning::Domain& domain, const planning::OperatorData& operators);

  int number() const { return number_; }
  int size() const { return static_cast<int>(steps_.size()); }
  StepRun& at(int index) { return steps_[static_cast<std::size_t>(index)]; }
  const StepRun& at(int index) const { return steps_[static_cast<std::size_t>(index)]; }
  const planning::PlanStep& planned(int index) const {
    return plan_.steps[static_cast<std::size_t>(index)];
  }
  const planning::Plan& plan() const { return plan_; }
  const planning::Problem& problem() const { return problem_; }

  int FindActivity(int activity) const;  ///< a running step's index, or -1
  std::vector<int> Active() const;       ///< running, or over and being checked
  bool AreDone(const std::vector<int>& steps) const;
  bool IsOver() const;  ///< nothing is left to do

  /// The step takes other arguments, and with it what the same method binds to them.
  /// @return why that cannot be, and nothing has changed; else "".
  std::string Instantiate(int index, const std::vector<std::string>& arguments,
                          const planning::Domain& domain, const planning::OperatorData& operators);

  /// The plan in an order in which what is done comes first. A `!imagine` is done as soon as the
  /// step that it informs (`informs`, by step, -1 for none) has begun.
  struct DoneFirst {
    planning::Plan plan;
    int executed{0};
  };
  DoneFirst WithDoneFirst(const std::vector<int>& informs) const;

 private:
  void Derive(const planning::Domain& domain, const planning::OperatorData& operators);

  int number_;
  planning::Plan plan_;
  planning::Problem problem_;
  std::vector<StepRun> steps_;
};

}  // namespace hires::execution
