#include "hires/imagination/scheduler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"

namespace hires::imagination {
namespace {

constexpr double kLeastSuccess = 0.001, kMostSuccess = 0.999;  // more would need thousands
constexpr int kLargestBatch = 1000;
constexpr int kMostAttempts = 100;
constexpr double kLongestWait = 1e7;     // [s]
constexpr double kSmallestShare = 1e-6;  // of alpha and indifference
constexpr int kRoundsOfOne = 4;  // first_look so many times, where there is only one alternative
/// A worker that fails so often without one finished rollout in between is the problem itself. Less
/// than the usual max_attempts, so that one broken worker alone condemns no rollout.
constexpr int kFailuresInARow = 2;

template <typename T>
void CheckField(const char* name, T value, T lower, T upper) {
  if (value >= lower && value <= upper) return;  // false for NaN
  throw base::ConfigError(
      fmt::format("scheduler: {} is {}, wanted between {} and {}", name, value, lower, upper));
}

/// For one version: keys that every file had, and that now only the other rankings read.
void WarnOfUnusedKeys(const base::ParamReader& in) {
  for (const char* key : {"alpha", "indifference", "only_best"}) {
    if (!in.Has(key)) continue;
    base::Log(base::LogLevel::kWarn,
              fmt::format("scheduler: {} does not affect `ranking: cost`, which stops by "
                          "max_regret; remove it, unless requests rank by risk or thesis",
                          key));
  }
}

RolloutResult Unplayable() {
  RolloutResult result;
  result.failure = base::FailureCode::kUnplayable;
  return result;
}

}  // namespace

// ---------------------------------------------------------------- parameters and pure functions

void CheckParams(const SchedulerParams& params) {
  CheckField("rollouts", params.rollouts, 1, kMostRollouts);
  CheckField("deadline", params.deadline, 0.0, kLongestWait);
  CheckField("worker_wait", params.worker_wait, 0.0, kLongestWait);
  CheckField("first_look", params.first_look, 1, kMostRollouts);
  CheckField("batch", params.batch, 1, kLargestBatch);
  CheckField("max_attempts", params.max_attempts, 1, kMostAttempts);
  if (params.criteria.rule == RankingRule::kCost && params.criteria.prices.empty()) {
    throw base::ConfigError(
        "scheduler: ranking is cost, which needs prices; read them from config/prices.yaml "
        "(ReadPrices; ReadClientConfig does), or rank by risk");
  }
  CheckField("min_success", params.criteria.min_success, kLeastSuccess, kMostSuccess);
  CheckField("max_regret", params.criteria.max_regret, 0.0, kHighestPrice);
  CheckField("alpha", params.settle.alpha, kSmallestShare, 1.0 - kSmallestShare);
  CheckField("indifference", params.settle.indifference, kSmallestShare, 1.0 - kSmallestShare);
}

SchedulerParams ReadSchedulerParams(base::ParamReader in) {
  SchedulerParams params;
  const auto share = base::Between(kSmallestShare, 1.0 - kSmallestShare);
  params.rollouts = in.Get("rollouts", base::Between(1, kMostRollouts));
  params.deadline = in.Get("deadline", base::Between(0.0, kLongestWait));
  params.worker_wait = in.Get("worker_wait", base::Between(0.0, kLongestWait));
  params.early_stop = in.GetBool("early_stop");
  params.criteria.rule =
      ParseRankingRule(in.Get("ranking", base::OneOf({"cost", "risk", "thesis"})));
  params.criteria.min_success = in.Get("min_success", base::Between(kLeastSuccess, kMostSuccess));
  params.first_look = in.Get("first_look", base::Between(1, kMostRollouts));
  params.batch = in.Get("batch", base::Between(1, kLargestBatch));
  params.max_attempts = in.Get("max_attempts", base::Between(1, kMostAttempts));
  if (in.Has("max_regret")) {
    params.criteria.max_regret = in.Get("max_regret", base::Between(0.0, kHighestPrice));
  }
  if (params.criteria.rule == RankingRule::kCost) WarnOfUnusedKeys(in);
  if (in.Has("alpha")) params.settle.alpha = in.Get("alpha", share);
  if (in.Has("indifference")) params.settle.indifference = in.Get("indifference", share);
  if (in.Has("only_best")) params.settle.only_best = in.GetBool("only_best");
  in.RejectUnknownKeys();
  return params;
}

std::string ToString(ImaginationOutcome outcome) {
  switch (outcome) {
    case ImaginationOutcome::kRanked:
      return "ranked";
    case ImaginationOutcome::kClose:
      return "close";
    case ImaginationOutcome::kAllFailed:
      return "all_failed";
    case ImaginationOutcome::kUndecided:
      return "undecided";
    case ImaginationOutcome::kNoWorker:
      return "no_worker";
    case ImaginationOutcome::kNothingFinished:
      return "nothing_finished";
    case ImaginationOutcome::kCancelled:
      return "cancelled";
  }
  HIRES_CHECK(false, "an outcome has no name");
  return {};
}

std::optional<double> EstimateTimeLeft(int done, int total, double elapsed,
                                       std::optional<double> until_deadline) {
  HIRES_CHECK(done >= 0 && done <= total, "the number of rollouts done lies outside of 0 .. total");
  std::optional<double> left = until_deadline;
  if (done == total) {
    left = 0.0;
  } else if (done > 0) {
    const double at_this_pace = std::max(elapsed, 0.0) / done * (total - done);
    left = std::min(at_this_pace, until_deadline.value_or(at_this_pace));
  }
  if (left) left = std::max(*left, 0.0);
  return left;
}

int NextLook(int num_rollouts, const SchedulerParams& params) {
  int look = std::min(params.first_look, params.rollouts);
  while (look <= num_rollouts && look < params.rollouts) {
    look = look > params.rollouts / 2 ? params.rollouts : 2 * look;
  }
  return look;
}

// ---------------------------------------------------------------- one alternative

const RolloutResult* Scheduler::Alternative::Find(int index) const {
  if (index < static_cast<int>(prefix.size())) return &prefix[index];
  const auto found = ahead.find(index);
  return found == ahead.end() ? nullptr : &found->second;
}

int Scheduler::Alternative::FirstOpen() const {
  return given_back.empty() ? next_fresh : *given_back.begin();
}

bool Scheduler::Alternative::TakeOpen(int index) {
  if (given_back.erase(index) > 0) return true;
  if (index != next_fresh) return false;
  ++next_fresh;
  return true;
}

int Scheduler::Alternative::NumOpenBelow(int end) const {
  const auto back = std::distance(given_back.begin(), given_back.lower_bound(end));
  return static_cast<int>(back) + std::max(0, end - next_fresh);
}

void Scheduler::Alternative::Put(int index, RolloutResult result) {
  ahead.emplace(index, std::move(result));
  auto next = ahead.find(static_cast<int>(prefix.size()));
  while (next != ahead.end() && next->first == static_cast<int>(prefix.size())) {
    prefix.push_back(std::move(next->second));
    next = ahead.erase(next);
  }
}

// ---------------------------------------------------------------- in and out

Scheduler::Scheduler(const SchedulerParams& params, int num_alternatives, double now)
    : params_(params), start_(now), without_workers_(now) {
  CheckParams(params);
  HIRES_CHECK(num_alternatives >= 1, "there is no alternative to imagine");
  HIRES_CHECK(num_alternatives <= std::numeric_limits<int>::max() / kMostRollouts,
              "there are more alternatives than can be counted");
  alternatives_.resize(num_alternatives);
  begins_.assign(num_alternatives, 0);
  ends_.assign(num_alternatives, FirstRound());
}

std::vector<Command> Scheduler::Handle(const Event& event, double now) {
  std::vector<Command> commands = Tick(now);
  if (finished()) return commands;
  std::visit([this](const auto& happened) { On(happened); }, event);
  Decide();
  NoteWorkers(now);
  if (!finished()) AssignToAll(now);
  for (const Command& command : TakeCommands()) commands.push_back(command);
  return commands;
}

std::vector<Command> Scheduler::Tick(double now) {
  if (finished()) return {};
  if (const auto deadline = DeadlineAt(); deadline && now >= *deadline) {
    CutShort(
        HasUsableWorker() ? ImaginationOutcome::kNothingFinished : ImaginationOutcome::kNoWorker,
        "the deadline");
  } else if (without_workers_ && now >= *without_workers_ + params_.worker_wait) {
    CutShort(ImaginationOutcome::kNoWorker, "the loss of all workers");
  }
  return TakeCommands();
}

std::vector<Command> Scheduler::Cancel(double /*now*/) {
  if (!finished()) {
    CutShort(ImaginationOutcome::kCancelled, "a cancellation");
    result_->outcome = ImaginationOutcome::kCancelled;
  }
  return TakeCommands();
}

std::optional<double> Scheduler::WakeAt() const {
  if (finished()) return std::nullopt;
  std::optional<double> wake = DeadlineAt();
  if (without_workers_) {
    const double give_up = *without_workers_ + params_.worker_wait;
    wake = std::min(wake.value_or(give_up), give_up);
  }
  return wake;
}

std::optional<double> Scheduler::DeadlineAt() const {
  return params_.deadline > 0.0 ? std::make_optional(start_ + params_.deadline) : std::nullopt;
}

std::vector<Command> Scheduler::TakeCommands() { return std::exchange(commands_, {}); }

// ---------------------------------------------------------------- events

void Scheduler::On(const WorkerJoined& event) {
  DropWorker(event.worker);
  workers_[event.worker] = Worker{};
}

void Scheduler::On(const WorkerLost& event) { DropWorker(event.worker); }

void Scheduler::On(const RolloutFinished& event) {
  const auto found = assignments_.find(event.assignment);
  if (found == assignments_.end()) return CheckRepeated(event);  // late: given back, maybe redone
  Assignment& assignment = found->second;
  const bool was_asked = assignment.worker == event.worker &&
                         assignment.alternative == event.alternative &&
                         event.index >= assignment.first_index &&
                         event.index < assignment.first_index + assignment.count;
  if (!was_asked) {
    return SetAside(event.worker, fmt::format("answered rollout {} of alternative {} in assignment "
                                              "{}, which it was not asked",
                                              event.index, event.alternative, event.assignment));
  }
  if (const std::string defect = Defect(event.result); !defect.empty()) {
    return SetAside(event.worker, fmt::format("rollout {} of alternative {}: {}", event.index,
                                              event.alternative, defect));
  }
  if (assignment.owed.erase(event.index) == 0) return CheckRepeated(event);
  workers_[event.worker].failures_in_a_row = 0;
  alternatives_[event.alternative].Put(event.index, event.result);
}

void Scheduler::On(const AssignmentFinished& event) {
  const auto found = assignments_.find(event.assignment);
  if (found == assignments_.end() || found->second.worker != event.worker) return;
  const std::size_t missing = found->second.owed.size();
  if (missing > 0) {
    CountFailure(event.worker, fmt::format("finished assignment {} with {} of {} rollouts missing",
                                           event.assignment, missing, found->second.count));
  }
  Close(event.assignment, missing > 0);
}

void Scheduler::On(const AssignmentFailed& event) {
  const auto found = assignments_.find(event.assignment);
  if (found == assignments_.end() || found->second.worker != event.worker) return;
  Close(event.assignment, !event.is_worker_unusable);
  if (event.is_worker_unusable) return SetAside(event.worker, event.reason);
  CountFailure(event.worker, event.reason);
}

void Scheduler::DropWorker(int worker) {
  const auto found = workers_.find(worker);
  if (found == workers_.end()) return;
  if (found->second.assignment) Close(*found->second.assignment, true);
  workers_.erase(worker);
}

/// Takes an assignment from its worker; what is owed is open again.
/// @param was_tried  whether the first rollout owed may be the reason of the end.
void Scheduler::Close(int assignment, bool was_tried) {
  const Assignment closed = assignments_.at(assignment);
  assignments_.erase(assignment);
  workers_.at(closed.worker).assignment.reset();
  Alternative& alternative = alternatives_[closed.alternative];
  alternative.given_back.insert(closed.owed.begin(), closed.owed.end());
  if (was_tried && !closed.owed.empty()) CountAttempt(&alternative, *closed.owed.begin());
}

void Scheduler::CountAttempt(Alternative* alternative, int index) {
  if (++alternative->attempts[index] < params_.max_attempts) return;
  base::Log(base::LogLevel::kError,
            fmt::format("rollout={} alternative={} attempts={} outcome=unplayable", index,
                        alternative - alternatives_.data(), params_.max_attempts));
  alternative->given_back.erase(index);
  alternative->unplayable.insert(index);
  alternative->Put(index, Unplayable());
}

void Scheduler::SetAside(int worker, const std::string& reason) {
  const auto found = workers_.find(worker);
  if (found == workers_.end() || !found->second.is_usable) return;
  worker_problems_.push_back(fmt::format("worker {}: {}", worker, reason));
  base::Log(base::LogLevel::kWarn, fmt::format("worker={} unusable reason='{}'", worker, reason));
  found->second.is_usable = false;
  if (const auto assignment = found->second.assignment) {
    commands_.push_back(CancelAssignment{worker, *assignment});
    Close(*assignment, false);
  }
}

void Scheduler::CountFailure(int worker, const std::string& reason) {
  Worker& failed = workers_.at(worker);
  if (++failed.failures_in_a_row < kFailuresInARow) return;
  worker_problems_.push_back(fmt::format("worker {}: failed {} times in a row, last: {}", worker,
                                         failed.failures_in_a_row, reason));
  base::Log(base::LogLevel::kWarn, fmt::format("worker={} unusable reason='{}'", worker, reason));
  failed.is_usable = false;
}

void Scheduler::CheckRepeated(const RolloutFinished& event) {
  const bool exists = event.alternative >= 0 &&
                      event.alternative < static_cast<int>(alternatives_.size()) &&
                      event.index >= 0;
  const RolloutResult* known =
      exists ? alternatives_[event.alternative].Find(event.index) : nullptr;
  if (known == nullptr || alternatives_[event.alternative].unplayable.count(event.index) > 0)
    return;
  if (SameOutcome(*known, event.result)) return;
  ++num_mismatches_;
  base::Log(base::LogLevel::kWarn,
            fmt::format("rollout={} alternative={} worker={} outcome=differs_from_first_play",
                        event.index, event.alternative, event.worker));
}

// ---------------------------------------------------------------- decisions

bool Scheduler::IsAdaptive() const {
  return params_.early_stop && params_.criteria.rule == RankingRule::kCost;
}

/// Rollouts of each alternative that a ranking may rest on now.
std::vector<int> Scheduler::Prefixes() const {
  std::vector<int> counts;
  for (const auto& alternative : alternatives_) {
    counts.push_back(static_cast<int>(alternative.prefix.size()));
  }
  const int common = *std::min_element(counts.begin(), counts.end());
  if (!IsAdaptive() || common == 0) counts.assign(counts.size(), common);
  return counts;
}

int Scheduler::FirstRound() const {
  if (!params_.early_stop) return params_.rollouts;
  const int rounds = IsAdaptive() && alternatives_.size() == 1 ? kRoundsOfOne : 1;
  return std::min(rounds * params_.first_look, params_.rollouts);
}

/// Where the round ends that follows on one with this ranking; where it ended: the answer is
/// decided, or all is played.
std::vector<int> Scheduler::AfterRound(const Ranking& ranking) const {
  std::vector<int> ends = ends_;
  if (IsAdaptive()) {
    const std::vector<int> more = NextRound(ranking.evidence, params_.criteria, params_.rollouts);
    for (std::size_t i = 0; i < ends.size(); ++i) ends[i] += more[i];
    return ends;
  }
  if (params_.early_stop && alternatives_.size() > 1) {
    std::vector<const std::vector<RolloutResult>*> prefixes;
    for (const Alternative& alternative : alternatives_) prefixes.push_back(&alternative.prefix);
    if (Decided(prefixes, ends_.front(), params_.criteria, params_.settle)) return ends;
  }
  ends.assign(ends.size(), NextLook(ends_.front(), params_));
  return ends;
}

void Scheduler::Decide() {
  while (!finished()) {
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (static_cast<int>(alternatives_[i].prefix.size()) < ends_[i]) return;
    }
    const Ranking ranking = RankFirst(ends_);
    std::vector<int> next = AfterRound(ranking);
    if (next == ends_) return Finish(OutcomeOf(ranking), true, ranking);
    begins_ = std::exchange(ends_, std::move(next));
  }
}

IntervalKind Scheduler::KindAt(const std::vector<int>& counts) const {
  const bool is_fixed =
      FirstRound() == params_.rollouts || (alternatives_.size() < 2 && !IsAdaptive());
  const bool are_all = std::all_of(counts.begin(), counts.end(),
                                   [&](int count) { return count == params_.rollouts; });
  return is_fixed && are_all ? IntervalKind::kClopperPearson : IntervalKind::kConfidenceSequence;
}

Ranking Scheduler::RankFirst(const std::vector<int>& counts) const {
  std::vector<RolloutPrefix> prefixes;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    prefixes.push_back({&alternatives_[i].prefix, counts[i]});
  }
  Ranking ranking;
  ranking.num_rollouts = *std::min_element(counts.begin(), counts.end());
  ranking.evidence = SumUpRequest(prefixes, KindAt(counts), params_.criteria.prices);
  ranking.order = Rank(ranking.evidence, params_.criteria);
  ranking.recommended = Recommended(ranking.evidence, params_.criteria);
  return ranking;
}

Ranking Scheduler::RankingSoFar() const {
  return finished() ? result_->ranking : RankFirst(Prefixes());
}

/// @pre something was played.
ImaginationOutcome Scheduler::OutcomeOf(const Ranking& ranking) const {
  const Criteria& criteria = params_.criteria;
  if (ranking.recommended) {
    const bool is_close = criteria.rule == RankingRule::kCost &&
                          CostOddsOf(ranking.evidence, criteria, *ranking.recommended).probability <
                              kSettledProbability;
    return is_close ? ImaginationOutcome::kClose : ImaginationOutcome::kRanked;
  }
  return AllFail(ranking.evidence, criteria) ? ImaginationOutcome::kAllFailed
                                             : ImaginationOutcome::kUndecided;
}

void Scheduler::CutShort(ImaginationOutcome if_nothing, const std::string& by) {
  Ranking ranking = RankFirst(Prefixes());
  const auto outcome = ranking.num_rollouts == 0 ? if_nothing : OutcomeOf(ranking);
  Finish(outcome, false, std::move(ranking), by);
}

void Scheduler::Finish(ImaginationOutcome outcome, bool complete, Ranking ranking,
                       const std::string& stopped_by) {
  SchedulerResult result{outcome, outcome, complete, stopped_by, 0, std::move(ranking)};
  for (std::size_t i = 0; i < alternatives_.size(); ++i) {
    Alternative& alternative = alternatives_[i];
    const int count = result.ranking.evidence[i].num_rollouts;
    const auto& unplayable = alternative.unplayable;
    result.num_unplayable +=
        static_cast<int>(std::distance(unplayable.begin(), unplayable.lower_bound(count)));
    alternative.prefix.resize(static_cast<std::size_t>(count));
    alternative.ahead.clear();
  }
  for (const auto& [id, assignment] : assignments_) {
    commands_.push_back(CancelAssignment{assignment.worker, id});
  }
  assignments_.clear();
  result_ = std::move(result);
}

// ---------------------------------------------------------------- work

/// How far workers go that have nothing to do in the present round.
std::vector<int> Scheduler::EndsOfNextRound() const {
  std::vector<int> ends;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    ends.push_back(IsAdaptive() ? std::min(2 * ends_[i] - begins_[i], params_.rollouts)
                                : NextLook(ends_[i], params_));
  }
  return ends;
}

void Scheduler::AssignToAll(double now) {
  const std::vector<int> next = EndsOfNextRound();
  for (const auto& [id, worker] : workers_) {
    if (!worker.is_usable || worker.assignment) continue;
    if (!AssignTo(id, ends_) && !AssignTo(id, next)) return;
    if (!work_began_) work_began_ = now;
  }
}

bool Scheduler::AssignTo(int worker, const std::vector<int>& ends) {
  // By index, then by alternative.
  std::size_t next = ends.size();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const int open = alternatives_[i].FirstOpen();
    if (open >= ends[i]) continue;
    if (next == ends.size() || open < alternatives_[next].FirstOpen()) next = i;
  }
  if (next == ends.size()) return false;
  Alternative& alternative = alternatives_[next];
  const int first = alternative.FirstOpen();
  const int most = BatchSize(first, ends);
  Assignment assignment{worker, static_cast<int>(next), first, 0, {}};
  while (assignment.count < most && first + assignment.count < ends[next] &&
         alternative.TakeOpen(first + assignment.count)) {
    assignment.owed.insert(first + assignment.count++);
  }
  commands_.push_back(
      Assign{worker, next_assignment_, assignment.alternative, first, assignment.count});
  workers_[worker].assignment = next_assignment_;
  assignments_.emplace(next_assignment_++, std::move(assignment));
  return true;
}

int Scheduler::BatchSize(int first_index, const std::vector<int>& ends) const {
  int num_open = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) num_open += alternatives_[i].NumOpenBelow(ends[i]);
  const int from_the_start = 1 + first_index / 4;
  const int to_the_end = 1 + num_open / (2 * static_cast<int>(workers_.size()));
  return std::min({params_.batch, from_the_start, to_the_end});
}

bool Scheduler::HasUsableWorker() const {
  return std::any_of(workers_.begin(), workers_.end(),
                     [](const auto& worker) { return worker.second.is_usable; });
}

void Scheduler::NoteWorkers(double now) {
  if (HasUsableWorker()) {
    without_workers_.reset();
  } else if (!without_workers_) {
    without_workers_ = now;
  }
}

// ---------------------------------------------------------------- what people see

Progress Scheduler::ProgressAt(double now) const {
  Progress progress;
  progress.total = params_.rollouts * static_cast<int>(alternatives_.size());
  for (const Alternative& alternative : alternatives_) {
    progress.done += static_cast<int>(alternative.prefix.size() + alternative.ahead.size());
  }
  progress.fraction = finished() ? 1.0 : static_cast<double>(progress.done) / progress.total;
  if (finished()) {
    progress.time_left = 0.0;
    return progress;
  }
  std::optional<double> until_deadline = DeadlineAt();
  if (until_deadline) *until_deadline -= now;
  progress.time_left = EstimateTimeLeft(progress.done, progress.total,
                                        now - work_began_.value_or(now), until_deadline);
  return progress;
}

const std::vector<RolloutResult>& Scheduler::Prefix(int alternative) const {
  HIRES_CHECK(alternative >= 0 && alternative < static_cast<int>(alternatives_.size()),
              "there is no such alternative");
  return alternatives_[alternative].prefix;
}

}  // namespace hires::imagination
