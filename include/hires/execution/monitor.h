#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/plan.h"
#include "hires/planning/planner_config.h"
#include "hires/temporal/stn.h"

namespace hires::execution {

// What can happen. Times are main ROS time [s], handed in with each event.
struct TaskRequested {
  std::string task;  ///< "serve_coffee_to_guest guest1", or a SHOP2 task network
};
/// The answer to StartPlanning.
struct PlanArrived {
  int request{0};
  enum class Outcome { kFound, kNoPlan, kLimit, kInvalid, kUnavailable } outcome{Outcome::kFound};
  /// With its reasons, bindings and decomposition. Reasons that are missing are worked out again;
  /// without nodes a repair plans the whole task again from the state that is, and without bindings
  /// durations of legs are not known.
  planning::Plan plan;
  std::string why;  ///< one sentence
};
/// The answer to StartStep (or StopStep).
struct StepFinished {
  int activity{0};
  enum class Result { kSucceeded, kFailed, kPreempted, kUnavailable } result{Result::kSucceeded};
  base::Failure failure;  ///< nothing where it succeeded, or is unknown
};
/// What is observed to hold now: all atoms of the state, whenever they change.
struct StateObserved {
  std::vector<base::Atom> atoms;
  std::uint64_t sequence{0};  ///< of the Blackboard
};
/// All that was observed until then [s] has been told, so that what is missing is not so. Where it
/// is never told, observations count as told at once.
struct ObservedUntil {
  double time{0.0};
};
/// A fluent that imagination may rest on changed more than its noise: an object was seen somewhere
/// new, moved, or vanished.
struct GeometryChanged {
  std::vector<std::string> instances;  ///< lower case
};
struct ImagineAnswered {
  int request{0};
  enum class Outcome {
    kRanked,
    kAllFailed,
    kUndecided,  ///< too few rollouts to tell whether an alternative is good enough
    kNoWorker,
    kNothingFinished,
    kInvalid,
    kUnavailable
  } outcome{Outcome::kRanked};
  base::ActionCall recommended;                  ///< kRanked
  double duration{0.0};                          ///< [s] expected, of the recommended one
  double duration_low{0.0}, duration_high{0.0};  ///< [s] quantiles 0.05 and 0.95
  std::vector<base::ActionCall> failed;          ///< all alternatives that are expected to fail
  std::vector<base::Failure> failures;           ///< of each of `failed`, the most frequent one
  std::vector<std::string> depends_on;           ///< instances it rests on
  std::string why;
};
struct PreemptRequested {};
struct ClockTicked {};  ///< at WakeAt() at the latest
using Event = std::variant<TaskRequested, PlanArrived, StepFinished, StateObserved, ObservedUntil,
                           GeometryChanged, ImagineAnswered, PreemptRequested, ClockTicked>;

// What to do.
struct StartPlanning {
  int request{0};
  std::string tasks;              ///< task network as SHOP2 text
  std::vector<base::Atom> state;  ///< whole state
  std::vector<base::Atom> facts;  ///< imagined_failure(...) and others, besides
};
struct CancelPlanning {
  int request{0};
};
struct StartStep {
  int activity{0};
  base::ActionCall action;
  double time_limit{0.0};  ///< [s]
};
struct StopStep {
  int activity{0};
};
struct StartImagination {
  int request{0};
  int plan{0};  ///< StepStatus::plan and index of the step that will be imagined
  int step{0};
  base::ActionTemplate action;
  std::vector<base::Atom> state;  ///< projected to the moment at which the action will start
  double deadline{0.0};           ///< [s] main ROS time; infinite: none
  double min_success{0.0};        ///< as the domain's sidecar wants it; 0: it says nothing
  int first_request{0};           ///< of this task that asked for the same action

  /// A request that begins again draws what the first one drew, so that rollouts stay valid.
  std::uint64_t SeedFrom(std::uint64_t seed) const {
    return seed + static_cast<std::uint64_t>(first_request);
  }
};
struct MoveDeadline {
  int request{0};
  double deadline{0.0};
};
struct CancelImagination {
  int request{0};
};
/// For the Blackboard: what the monitor itself knows (plan, activities, predictions, failures).
struct Record {
  enum class Kind { kBegin, kUpdate, kEnd } kind{Kind::kBegin};
  std::string concept_name;     ///< below ExecutionRecord (docs/ontology.md): "MoveBaseTask"
  std::string general_concept;  ///< for ontologies that do not know it: "PrimitiveTask"
  std::string instance;
  std::vector<std::pair<std::string, std::string>> texts;  ///< role, value
  std::vector<std::pair<std::string, double>> numbers;     ///< role, value
  std::vector<std::pair<std::string, std::string>> links;  ///< role, instance
};
struct Warn {
  std::string text;
};  ///< for people: what went wrong and what is done about it
struct Finish {
  enum class Outcome {
    kSucceeded,
    kNoPlan,
    kFailed,
    kPreempted,
    kDryRun,  ///< planned and imagined; nothing was begun, on purpose
  } outcome{Outcome::kSucceeded};
  std::string reason;       ///< one sentence
  base::Failure failure{};  ///< the one that it ended with; nothing where no failure ended it
};
using Command = std::variant<StartPlanning, CancelPlanning, StartStep, StopStep, StartImagination,
                             MoveDeadline, CancelImagination, Record, Warn, Finish>;

struct MonitorParams {
  enum class ImaginePolicy { kDomain, kThesis, kOff };
  ImaginePolicy imagination{ImaginePolicy::kDomain};  ///< kOff: `!imagine` steps take the default
  /// Values of imagined parameters that replace the defaults of the domain, by parameter, in lower
  /// case.
  std::map<std::string, std::string> defaults;
  /// Motion sets of the robot, lowest limits first. Where the domain has no default among the
  /// alternatives, the first of these that is one is used.
  std::vector<std::string> motion_sets;
  /// Plans and imagines from the state that is, repairs the plan where all alternatives of a step
  /// are imagined to fail, and ends instead of beginning a step. Then those steps are imagined,
  /// too, that can be and of which the operators' data do not say how long they are expected to
  /// last. Answers have all the time of `max_wait`.
  bool dry_run{false};
  int max_replans{10};             ///< of one task before giving up
  double effect_timeout{3.0};      ///< [s] after a step's end until its effects must be observed,
  double observation_delay{30.0};  ///< [s] and so much longer until that must have been told
  double overdue_factor{3.0};      ///< of the expected duration: a step that lasts longer is
  double overdue_minimum{30.0};    ///< stopped, but never before so many [s]
  double planning_timeout{30.0};   ///< [s]
  double arrival_margin{0.0};      ///< [s] before the latest start: the imagination's deadline
  double answer_grace{0.5};        ///< [s] after that deadline in which its answer still counts
  /// [s] An imagined step waits at least so long for the answer to its question, also beyond its
  /// latest start, unless a bound of the plan requires it to begin earlier.
  double late_wait{30.0};
  double max_wait{300.0};          ///< [s] at most for an answer where the domain says `wait`
  double retry_period{5.0};        ///< [s] until imagination is asked again in vain, then
  double break_delay{0.5};         ///< [s] that an observation must contradict before it counts
  double stop_timeout{10.0};       ///< [s] for a stopped step to answer; then it is given up
  /// Facts that say that the robot carries ?object, whose pose then tells nothing new.
  std::vector<std::string> carried{"(Holding ?arm ?object)", "(On ?object trayArea1)"};
};

enum class StepPhase { kWaiting, kReady, kRunning, kChecking, kDone, kFailed, kSkipped };

/// For a live table and timelines.
struct StepStatus {
  int plan{0};   ///< 0: the first one, then one more for each repair
  int index{0};  ///< place in that plan
  base::ActionCall action;
  bool is_of_robot{true};  ///< its robot does it; else it imagines, or keeps the books
  StepPhase phase{StepPhase::kWaiting};
  std::optional<double> started, finished;           ///< [s]
  temporal::Bounds start, finish;                    ///< from the network
  double expected_start{0.0}, expected_finish{0.0};  ///< [s] if all last as long as expected
  std::string note;       ///< for people: "imagined: slow, success 0.98 (0.93..1.00)", a failure
  base::Failure failure;  ///< of a step that failed
};

/// The semantic execution monitor: one state machine, events in, commands out.
/// It has no thread, clock or connection. Same events at the same times give the same commands.
class Monitor {
 public:
  /// @pre both outlive the monitor.
  Monitor(const planning::PlanningKnowledge* knowledge, const planning::OperatorData* operators,
          const MonitorParams& params);
  ~Monitor();

  std::vector<Command> Handle(const Event& event, double now);
  std::optional<double> WakeAt() const;   ///< when ClockTicked is due without another event
  bool is_busy() const;                   ///< a task is being carried out
  std::vector<StepStatus> Steps() const;  ///< of the present plan, done ones of earlier plans first

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::execution
