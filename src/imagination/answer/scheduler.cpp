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
/// A worker that fails so often without one finished rollout in between is the problem itself. Less
/// than the usual max_attempts, so that one broken worker alone condemns no rollout.
constexpr int kFailuresInARow = 2;

template <typename T>
void CheckField(const char* name, T value, T lower, T upper) {
  if (value >= lower && value <= upper) return;  // false for NaN
  throw base::ConfigError(
      fmt::format("scheduler: {} is {}, wanted between {} and {}", name, value, lower, upper));
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
  params.settle.alpha = in.Get("alpha", share);
  params.settle.indifference = in.Get("indifference", share);
  params.settle.only_best = in.GetBool("only_best");
  in.RejectUnknownKeys();
  return params;
}

std::string ToString(ImaginationOutcome outcome) {
  switch (outcome) {
    case ImaginationOutcome::kRanked:
      return "ranked";
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
    CutShort(HasUsableWorker() ? ImaginationOutcome::kNothingFinished
                               : ImaginationOutcome::kNoWorker);
  } else if (without_workers_ && now >= *without_workers_ + params_.worker_wait) {
    CutShort(ImaginationOutcome::kNoWorker);
  }
  return TakeCommands();
}

std::vector<Command> Scheduler::Cancel(double /*now*/) {
  if (!finished()) {
    CutShort(ImaginationOutcome::kCancelled);
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

int Scheduler::CommonPrefix() const {
  std::size_t common = alternatives_.front().prefix.size();
  for (const auto& alternative : alternatives_)
    common = std::min(common, alternative.prefix.size());
  return static_cast<int>(common);
}

void Scheduler::Decide() {
  const int common = CommonPrefix();
  while (!finished()) {
    const int look = NextLook(decided_, params_);
    if (look > common) return;
    if (look == params_.rollouts || IsDecidedAt(look)) FinishWith(look, true);
    decided_ = look;
  }
}

bool Scheduler::IsDecidedAt(int look) const {
  if (!params_.early_stop || alternatives_.size() < 2) return false;
  std::vector<const std::vector<RolloutResult>*> prefixes;
  prefixes.reserve(alternatives_.size());
  for (const Alternative& alternative : alternatives_) prefixes.push_back(&alternative.prefix);
  return Decided(prefixes, look, params_.criteria, params_.settle);
}

IntervalKind Scheduler::KindAt(int num_rollouts) const {
  const bool is_fixed =
      !params_.early_stop || alternatives_.size() < 2 || NextLook(0, params_) == params_.rollouts;
  return is_fixed && num_rollouts == params_.rollouts ? IntervalKind::kClopperPearson
                                                      : IntervalKind::kConfidenceSequence;
}

Ranking Scheduler::RankFirst(int num_rollouts) const {
  Ranking ranking;
  ranking.num_rollouts = num_rollouts;
  for (const Alternative& alternative : alternatives_) {
    ranking.evidence.push_back(
        SumUp(alternative.prefix, num_rollouts, KindAt(num_rollouts), params_.criteria.prices));
  }
  ranking.order = Rank(ranking.evidence, params_.criteria);
  ranking.recommended = Recommended(ranking.evidence, params_.criteria);
  return ranking;
}

Ranking Scheduler::RankingSoFar() const {
  return finished() ? result_->ranking : RankFirst(CommonPrefix());
}

void Scheduler::FinishWith(int num_rollouts, bool complete) {
  const Ranking ranking = RankFirst(num_rollouts);
  const bool all_fail = AllFail(ranking.evidence, params_.criteria);
  Finish(ranking.recommended ? ImaginationOutcome::kRanked
         : all_fail          ? ImaginationOutcome::kAllFailed
                             : ImaginationOutcome::kUndecided,
         complete, num_rollouts);
}

void Scheduler::CutShort(ImaginationOutcome if_nothing) {
  const int common = CommonPrefix();
  if (common == 0) return Finish(if_nothing, false, 0);
  FinishWith(common, false);
}

void Scheduler::Finish(ImaginationOutcome outcome, bool complete, int num_rollouts) {
  SchedulerResult result{outcome, outcome, complete, 0, RankFirst(num_rollouts)};
  for (Alternative& alternative : alternatives_) {
    const auto& unplayable = alternative.unplayable;
    result.num_unplayable +=
        static_cast<int>(std::distance(unplayable.begin(), unplayable.lower_bound(num_rollouts)));
    alternative.prefix.resize(num_rollouts);
    alternative.ahead.clear();
  }
  for (const auto& [id, assignment] : assignments_) {
    commands_.push_back(CancelAssignment{assignment.worker, id});
  }
  assignments_.clear();
  result_ = std::move(result);
}

// ---------------------------------------------------------------- work

int Scheduler::EndOfWork() const {
  if (!params_.early_stop) return params_.rollouts;
  return NextLook(NextLook(decided_, params_), params_);
}

void Scheduler::AssignToAll(double now) {
  for (const auto& [id, worker] : workers_) {
    if (!worker.is_usable || worker.assignment) continue;
    if (!AssignTo(id)) return;
    if (!work_began_) work_began_ = now;
  }
}

bool Scheduler::AssignTo(int worker) {
  // min_element keeps the first of equals: by index, then by alternative.
  const auto next = std::min_element(
      alternatives_.begin(), alternatives_.end(),
      [](const Alternative& a, const Alternative& b) { return a.FirstOpen() < b.FirstOpen(); });
  const int first = next->FirstOpen();
  if (first >= EndOfWork()) return false;
  const int end = NextLook(first, params_);
  const int most = BatchSize(first, end);
  Assignment assignment{worker, static_cast<int>(next - alternatives_.begin()), first, 0, {}};
  while (assignment.count < most && first + assignment.count < end &&
         next->TakeOpen(first + assignment.count)) {
    assignment.owed.insert(first + assignment.count++);
  }
  commands_.push_back(
      Assign{worker, next_assignment_, assignment.alternative, first, assignment.count});
  workers_[worker].assignment = next_assignment_;
  assignments_.emplace(next_assignment_++, std::move(assignment));
  return true;
}

int Scheduler::BatchSize(int first_index, int end_of_look) const {
  int num_open = 0;
  for (const Alternative& alternative : alternatives_) {
    num_open += alternative.NumOpenBelow(end_of_look);
  }
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
