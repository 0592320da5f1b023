#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/imagination/evidence.h"
#include "hires/imagination/ranking.h"
#include "hires/imagination/rollout_result.h"

namespace hires::imagination {

struct SchedulerParams {
  int rollouts{64};          ///< at most so many per alternative, 1..100000
  double deadline{0.0};      ///< [s] after the start; 0: none
  double worker_wait{10.0};  ///< [s] to wait while there is no worker before giving up, >= 0
  bool early_stop{true};     ///< stop at the first look at which the answer is decided
  Criteria criteria;
  /// kRisk, kThesis: looks are at first_look, twice that, four times that, ...; kCost: rollouts of
  /// each alternative in the first round; >= 1.
  int first_look{16};
  int batch{4};  ///< at most so many rollouts per assignment, 1..1000
  /// A rollout that was given up so often by a failed assignment or a lost worker is unplayable and
  /// counts as failed (unplayable), so that one that kills its worker ends; 1..100.
  int max_attempts{5};
  SettleParams settle;
};

/// Reads every field; keys as the fields are called, `ranking` for the rule, min_success, and
/// optionally max_regret, alpha, indifference, only_best. The last three do not affect
/// `ranking: cost`, so that there they cause a warning. Prices have a file of their own: the caller
/// fills them in.
/// @throws base::ConfigError naming file, key and bounds.
SchedulerParams ReadSchedulerParams(base::ParamReader in);

/// @throws base::ConfigError naming the field, what came and what was wanted.
void CheckParams(const SchedulerParams& params);

// What can happen. Workers have ids of the caller's choice.
struct WorkerJoined {
  int worker;  ///< ready for an assignment; if it was known, it lost what it had
};
struct WorkerLost {
  int worker;
};
struct RolloutFinished {
  int worker;
  int assignment;
  int alternative;
  int index;
  RolloutResult result;
};
/// The worker is free again. Post it after all RolloutFinished of the assignment: what is missing
/// then counts as failed.
struct AssignmentFinished {
  int worker;
  int assignment;
};
struct AssignmentFailed {
  int worker;
  int assignment;
  std::string reason;       ///< for people
  bool is_worker_unusable;  ///< e.g. its world differs: it gets nothing more until it joins again
};
using Event =
    std::variant<WorkerJoined, WorkerLost, RolloutFinished, AssignmentFinished, AssignmentFailed>;

// What to do.
struct Assign {
  int worker;
  int assignment;   ///< unique for this scheduler
  int alternative;  ///< 0-based
  int first_index;  ///< rollouts first_index .. first_index + count - 1, in this order
  int count;        ///< >= 1
};
/// The worker may stop; no event is expected any more.
struct CancelAssignment {
  int worker;
  int assignment;
};
using Command = std::variant<Assign, CancelAssignment>;

enum class ImaginationOutcome {
  kRanked,           ///< there is a recommendation
  kClose,            ///< kCost: there is one, but with less than kSettledProbability: a near tie
  kAllFailed,        ///< no alternative is good enough, as far as rollouts can tell
  kUndecided,        ///< rollouts were played, too few to tell whether one is good enough
  kNoWorker,         ///< nothing was compared, because there was no worker
  kNothingFinished,  ///< nothing was compared by the deadline, although there were workers
  kCancelled
};
std::string ToString(ImaginationOutcome outcome);

/// The alternatives after as many rollouts as their evidence counts: under kRisk and kThesis
/// equally many.
struct Ranking {
  std::vector<Evidence> evidence;  ///< per alternative
  std::vector<int> order;          ///< best first
  std::optional<int> recommended;
  int num_rollouts{0};  ///< of each alternative at least; 0: nothing is known, `order` is that of
                        ///< the request
};

struct SchedulerResult {
  ImaginationOutcome outcome{ImaginationOutcome::kNothingFinished};
  /// Of a cancelled request: what the rollouts that were finished say, by the rule of every other
  /// end; kCancelled where none was. Else as `outcome`.
  ImaginationOutcome found{ImaginationOutcome::kCancelled};
  bool complete{false};    ///< the answer was decided or all rollouts played; false: cut short
  std::string stopped_by;  ///< where it was cut short: "the deadline", ...
  int num_unplayable{
      0};  ///< rollouts behind the ranking that count as failed as no worker got them done
  Ranking ranking;
};

struct Progress {
  int done{0};                      ///< rollouts that are in; those beyond a gap included
  int total{0};                     ///< rollouts * alternatives: an early stop comes before
  double fraction{0.0};             ///< done / total; 1 once finished
  std::optional<double> time_left;  ///< [s] at the present pace, at most until the deadline
};

/// Time left [s] if the rest goes on at the mean pace so far; nothing known yet: no value.
/// @param elapsed  [s] in which the `done` of `total` were played.
/// @param until_deadline  [s] the answer is never longer than this.
std::optional<double> EstimateTimeLeft(int done, int total, double elapsed,
                                       std::optional<double> until_deadline);

/// The first look that lies beyond `num_rollouts`: first_look * 2^k, but never beyond `rollouts`.
int NextLook(int num_rollouts, const SchedulerParams& params);

/// Spreads the rollouts of several alternatives over workers that come and go, and stops when the
/// answer is known. A state machine: events and time [s, any steady clock] come in, commands come
/// out, it has no thread and no clock.
///
/// Rollout i of every alternative has the same seed, so alternatives are compared by pairs.
/// Rollouts are played in rounds: under kRisk and kThesis from look to look, equally many of each
/// alternative; under kCost as NextRound splits them. A decision is taken after complete rounds
/// alone; what came beyond is thrown away. Hence the answer is the same for any number of workers,
/// any order of arrival and any loss of workers, unless the deadline, a lack of workers or Cancel()
/// cut it short; then it rests on the longest prefix that all alternatives have; under kCost with
/// an early stop on that of each.
///
/// Work is given out by round, then index, then alternative, in small batches (single rollouts at
/// first, so that there is a ranking soon, and towards the end of a round, so that all workers end
/// together). Who has nothing to do in the present round begins the next one, but none beyond it;
/// under kCost the next one is assumed to be as the present one.
///
/// A single alternative is played to the end; under kCost its first round is four times first_look,
/// and it ends once success is decided. Several stop early only where the answer is decided (see
/// Decided, NextRound): an order that is settled, while it is unknown whether the first is good
/// enough, is not.
///
/// Intervals are Clopper-Pearson's where the number of rollouts was fixed beforehand and all were
/// played (no early stop, one alternative but for kCost, or no look before the last), else
/// confidence sequences, each valid at its alternative's own number of rollouts.
class Scheduler {
 public:
  /// @param now  [s] start; the deadline counts from here.
  /// @pre num_alternatives >= 1.  @throws base::ConfigError if the params are out of range.
  Scheduler(const SchedulerParams& params, int num_alternatives, double now);

  /// One event, after Tick(now). Once finished, nothing matters and nothing is commanded.
  /// Events that contradict what was assigned are ignored (late, twice) or take the worker out of
  /// use (it answered what it was not asked, or with numbers that are none).
  std::vector<Command> Handle(const Event& event, double now);

  /// Looks at the clock alone. Call it at WakeAt() if no event comes before.
  std::vector<Command> Tick(double now);

  /// The client does not want the answer any more.
  std::vector<Command> Cancel(double now);

  /// When Tick() will have something to do without an event: deadline, or end of waiting for
  /// workers.
  std::optional<double> WakeAt() const;

  const SchedulerParams& params() const { return params_; }
  bool finished() const { return result_.has_value(); }
  const std::optional<SchedulerResult>& result() const { return result_; }

  /// The ranking over the longest prefix that all alternatives have now; under kCost, each has.
  Ranking RankingSoFar() const;
  Progress ProgressAt(double now) const;

  /// Rollouts of one alternative from index 0 without a gap; after the end those behind the result.
  const std::vector<RolloutResult>& Prefix(int alternative) const;

  /// Why workers were taken out of use, for people: "worker 3: world differs".
  const std::vector<std::string>& worker_problems() const { return worker_problems_; }
  /// Rollouts that came twice and differed: a sign that some worker is not deterministic.
  int num_mismatches() const { return num_mismatches_; }

 private:
  struct Worker {
    bool is_usable{true};
    int failures_in_a_row{0};
    std::optional<int> assignment;
  };
  struct Assignment {
    int worker;
    int alternative;
    int first_index;
    int count;
    std::set<int> owed;
  };
  /// One alternative's rollouts: done without a gap, done beyond a gap, given back, never given
  /// out.
  struct Alternative {
    std::vector<RolloutResult> prefix;
    std::map<int, RolloutResult> ahead;
    std::set<int> given_back;
    int next_fresh{0};
    std::map<int, int> attempts;  // failed ones, by index
    std::set<int> unplayable;

    const RolloutResult* Find(int index) const;
    int FirstOpen() const;
    bool TakeOpen(int index);
    int NumOpenBelow(int end) const;
    void Put(int index, RolloutResult result);
  };

  void On(const WorkerJoined& event);
  void On(const WorkerLost& event);
  void On(const RolloutFinished& event);
  void On(const AssignmentFinished& event);
  void On(const AssignmentFailed& event);

  void DropWorker(int worker);
  void Close(int assignment, bool was_tried);
  void CountAttempt(Alternative* alternative, int index);
  void SetAside(int worker, const std::string& reason);
  void CountFailure(int worker, const std::string& reason);
  void CheckRepeated(const RolloutFinished& event);

  bool IsAdaptive() const;
  void Decide();
  std::vector<int> Prefixes() const;
  int FirstRound() const;
  std::vector<int> AfterRound(const Ranking& ranking) const;
  IntervalKind KindAt(const std::vector<int>& counts) const;
  std::vector<int> EndsOfNextRound() const;
  void AssignToAll(double now);
  bool AssignTo(int worker, const std::vector<int>& ends);
  int BatchSize(int first_index, const std::vector<int>& ends) const;
  bool HasUsableWorker() const;
  void NoteWorkers(double now);

  Ranking RankFirst(const std::vector<int>& counts) const;
  ImaginationOutcome OutcomeOf(const Ranking& ranking) const;
  void CutShort(ImaginationOutcome if_nothing, const std::string& by);
  void Finish(ImaginationOutcome outcome, bool complete, Ranking ranking,
              const std::string& stopped_by = "");
  std::optional<double> DeadlineAt() const;
  std::vector<Command> TakeCommands();

  SchedulerParams params_;
  double start_;
  std::vector<Alternative> alternatives_;
  std::map<int, Worker> workers_;
  std::map<int, Assignment> assignments_;
  int next_assignment_{1};
  std::vector<int> ends_;                  // of the present round, per alternative
  std::vector<int> begins_;                // the rollouts of each before it
  std::optional<double> without_workers_;  // since when
  std::optional<double> work_began_;
  std::vector<Command> commands_;
  std::vector<std::string> worker_problems_;
  int num_mismatches_{0};
  std::optional<SchedulerResult> result_;
};

}  // namespace hires::imagination
