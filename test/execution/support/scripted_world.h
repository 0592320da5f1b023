#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/execution/monitor.h"
#include "hires/planning/domain.h"

namespace hires::test_support {

/// config/domains/restaurant.{lisp,yaml}.
const planning::PlanningKnowledge& Restaurant();
const planning::OperatorData& RestaurantData();
/// The facts of a problem of config/domains/problems.
std::vector<base::Atom> FactsOf(const std::string& problem);
std::string TaskOf(const std::string& problem);

/// How a step of the scripted world goes.
struct StepScript {
  double duration{5.0};  ///< [s]
  execution::StepFinished::Result result{execution::StepFinished::Result::kSucceeded};
  base::Failure failure;
  bool has_effects{true};  ///< the world changes as the operator says
  bool is_observed{true};  ///< and that is seen
  bool ends{true};         ///< else it goes on until it is stopped
  bool obeys{true};        ///< it ends when it is told to stop
};

/// A world around a monitor: a clock that jumps, the real planner, steps and imaginations that go
/// as they are told, observations. Watches what the monitor must never do.
class ScriptedWorld {
 public:
  struct Options {
    execution::MonitorParams monitor;
    std::vector<base::Atom> facts;
    double start{1000.0};  ///< [s] main ROS time at which the run begins
    const planning::PlanningKnowledge* planning{nullptr};  ///< null: the restaurant's
    const planning::OperatorData* operators{nullptr};      ///< null: the restaurant's
    double planner_delay{0.05};                            ///< [s]
    double imagine_delay{20.0};                            ///< [s]
    double observation_delay{0.1};                         ///< [s]
    double stop_delay{0.3};  ///< [s] until a step that is stopped has ended
    double horizon{7200.0};  ///< [s] after which a run counts as endless
    enum class PlanForm { kWhole, kSteps, kFlat };
    /// As the planner makes them, as steps alone, or as steps below one root.
    PlanForm plans{PlanForm::kWhole};
    /// `count`: how often this action was begun before.
    std::function<StepScript(const base::ActionCall&, int count)> step;
    /// Nothing: there is never an answer.
    std::function<std::optional<execution::ImagineAnswered>(const execution::StartImagination&,
                                                            int count)>
        imagine;
    /// Nothing: as the planner says. `count`: requests before.
    std::function<std::optional<execution::PlanArrived>(int count)> planner;
  };

  explicit ScriptedWorld(Options options);

  /// Something happens at that moment [s], before the monitor is told anything else of it.
  void At(double time, std::function<void(ScriptedWorld*)> what);
  /// When the monitor gives a command for the first time for which `when` is true.
  void When(std::function<bool(const execution::Command&)> when,
            std::function<void(ScriptedWorld*)> what);
  /// Runs until the task is finished. Fails if that never comes.
  execution::Finish Run(const std::string& task);

  // For scripts.
  double now() const { return now_; }
  void Post(execution::Event event, double delay = 0.0);
  void Set(const std::vector<base::Atom>& gone, const std::vector<base::Atom>& come);
  /// All atoms of that predicate are replaced by one.
  void ReplaceAll(const std::string& predicate, const base::Atom& by);
  void Observe(double delay = 0.0);
  /// The monitor hears that it knows all that was so until now.
  void ObserveUntilNow(double delay);
  void Repeat();  ///< tells the last answer of somebody once more

  // What happened.
  /// "pick_up_object(mug1, rightarm1)", as begun.
  std::vector<std::string> Begun() const;
  double StartOf(const std::string& action) const;  ///< [s] of the first one of that text; -1: none
  double TimeOf(const std::string& word) const;  ///< [s] of the first line that begins so; -1: none
  int CountOf(const std::string& word) const;    ///< lines of the log that begin with it
  bool Holds(const base::Atom& atom) const;
  const std::vector<std::string>& log() const { return log_; }
  const std::vector<std::string>& violations() const { return violations_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<execution::StartImagination>& imaginations() const { return imaginations_; }
  const std::vector<execution::MoveDeadline>& moves() const { return moves_; }
  const std::vector<execution::StartPlanning>& plannings() const { return plannings_; }
  const std::vector<execution::Record>& records() const { return records_; }
  execution::Monitor& monitor() { return monitor_; }
  /// [s] wall time that the monitor took for each event; for benchmarks.
  const std::vector<double>& handle_seconds() const { return handle_seconds_; }

 private:
  struct RunningStep {
    base::ActionCall action;
    StepScript script;
    bool is_stopped{false};
  };
  using Happening = std::function<void()>;

  const planning::Domain& domain() const;
  const planning::OperatorData& operators() const;
  void Schedule(double time, Happening happening);
  void Tell(const execution::Event& event);
  void Obey(const execution::Command& command);
  void Do(const execution::StartPlanning& command);
  void Do(const execution::CancelPlanning&) { Log("cancel planning"); }
  void Do(const execution::StartStep& command);
  void Do(const execution::StopStep& command);
  void Do(const execution::StartImagination& command);
  void Do(const execution::MoveDeadline& command);
  void Do(const execution::CancelImagination&) { Log("cancel imagination"); }
  void Do(const execution::Record& command) { records_.push_back(command); }
  void Do(const execution::Warn& command);
  void Do(const execution::Finish& command);
  void EndStep(int activity);
  void ApplyEffects(const RunningStep& step);
  void CheckStart(const execution::StartStep& command);
  planning::Problem ProblemOf(const std::map<std::string, base::Atom>& facts) const;
  void Violate(const std::string& text);
  void Log(const std::string& line);

  Options options_;
  execution::Monitor monitor_;
  double now_;
  std::map<std::string, base::Atom> world_, observed_;
  std::multimap<double, Happening> happenings_;
  std::vector<std::pair<std::function<bool(const execution::Command&)>,
                        std::function<void(ScriptedWorld*)>>>
      triggers_;
  std::map<int, RunningStep> running_;
  std::map<std::string, int> begun_count_, imagined_count_;
  std::optional<execution::Finish> finish_;
  std::vector<std::string> log_, violations_, warnings_;
  std::vector<std::pair<std::string, double>> begun_;
  std::vector<execution::StartImagination> imaginations_;
  std::vector<execution::MoveDeadline> moves_;
  std::vector<execution::StartPlanning> plannings_;
  std::vector<execution::Record> records_;
  std::vector<double> handle_seconds_;
  std::optional<execution::Event> last_answer_;
};

/// An answer that recommends one alternative.
execution::ImagineAnswered Ranked(const base::ActionCall& recommended, double duration);
/// All alternatives of the request fail.
execution::ImagineAnswered AllFail(const execution::StartImagination& request,
                                   const base::Failure& failure);

}  // namespace hires::test_support
