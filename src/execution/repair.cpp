#include "execution/repair.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/planning/replanning.h"
#include "hires/planning/task_text.h"

namespace hires::execution {
namespace {

std::set<std::string> TextsOf(const Facts& facts) {
  std::set<std::string> texts;
  for (const auto& [text, atom] : facts.all()) texts.insert(text);
  return texts;
}

void CollectTasks(const planning::TaskNetwork& network, std::vector<const Datum*>* tasks) {
  for (const planning::TaskItem& item : network.items) {
    if (item.network.empty()) tasks->push_back(&item.task);
    for (const planning::TaskNetwork& nested : item.network) CollectTasks(nested, tasks);
  }
}

/// Whether the plan tells how the problem's tasks broke down; plans from elsewhere may just be
/// lists of steps.
bool HasDecomposition(const planning::Problem& problem, const planning::Plan& plan) {
  if (plan.nodes.empty()) return false;
  std::vector<const Datum*> tasks;
  CollectTasks(problem.tasks, &tasks);
  const std::vector<int>& children = plan.nodes[0].children;
  return std::equal(tasks.begin(), tasks.end(), children.begin(), children.end(),
                    [&](const Datum* task, int child) {
                      const planning::PlanNode& node = plan.nodes[static_cast<std::size_t>(child)];
                      return CanMatch(*task, node.task) && (node.method >= 0 || node.step >= 0);
                    });
}

/// Not who carries it out has failed, nor what was expected of it, but the way that it took.
bool MayGoAnotherWay(const Violation& violation) {
  return violation.kind == Violation::Kind::kActivity &&
         base::InfoOf(violation.failure.code).scope == base::FailureScope::kAction;
}

}  // namespace

void Repair::BeginTask(const planning::Problem& task) {
  task_ = task;
  count_ = 0;
  last_.reset();
  last_state_.clear();
  is_asking_ = false;
}

/// The same went wrong as the last time, and nothing else has changed.
bool Repair::IsRepetition(const Violation& violation, const std::set<std::string>& state) const {
  return violation.kind != Violation::Kind::kImagined && last_ && IsSame(*last_, violation) &&
         state == last_state_;
}

std::string Repair::Begin(const Violation& violation) {
  const std::string text = ToString(violation);
  const std::set<std::string> state = TextsOf(session_.state().facts());
  const bool is_repetition = IsRepetition(violation, state);
  last_ = violation;
  last_state_ = state;
  if (is_repetition) {
    if (!MayGoAnotherWay(violation)) return text + " (twice in a row, and nothing has changed)";
    session_.Exclude(ExclusionFor(violation.action, violation.failure), violation.step);
  }
  if (++count_ > session_.params().max_replans) {
    return fmt::format("gave up after {} repairs; the last reason was {}", count_ - 1, text);
  }
  session_.outbox().Warning(fmt::format("{}; the plan is mended", text));
  Cancel();
  return "";
}

void Repair::Cancel() {
  if (is_asking_) quest_.Cancel();
  is_asking_ = false;
}

/// Whether it is clear which steps are done.
bool Repair::IsSettled() const {
  const PlanRun& run = session_.progress().run();
  const std::vector<int> active = run.Active();
  return std::all_of(active.begin(), active.end(), [&](int step) {
    return run.at(step).phase == StepPhase::kRunning && !run.at(step).is_stopping;
  });
}

Repair::Result Repair::Update() {
  if (is_asking_) {
    quest_.Update();
    if (quest_.is_under_way()) return Result::kUnderWay;
    const Result result = Take();
    if (result != Result::kUnderWay) return result;
  }
  if (IsSettled()) Ask();
  return Result::kUnderWay;
}

/// What is left of the problem, changing more and more of the plan. What cannot be written as text
/// or needs protections, which a request cannot carry, is left out; the whole task comes last.
std::vector<PlanQuest::Try> Repair::Tries(const Facts& state) const {
  const PlanRun& run = session_.progress().run();
  const planning::Problem& whole = run.problem();
  std::vector<PlanQuest::Try> tries;
  const auto add = [&](planning::Problem problem) {
    const auto tasks = ToShop2Tasks(problem.tasks);
    if (!tasks || problem.protections.size() > whole.protections.size()) return;
    if (!tries.empty() && tries.back().tasks == *tasks) return;
    problem.tasks = planning::ReadTasks(*tasks, "rest");  // as the planner will read it
    tries.push_back({std::move(problem), *tasks});
  };
  if (HasDecomposition(whole, run.plan())) {
    const PlanRun::DoneFirst done = run.WithDoneFirst(session_.progress().informs());
    for (int depth = DeepestKeepDepth(done.plan, done.executed); depth > 0; --depth) {
      add(RemainingProblem(session_.domain(), whole, done.plan, done.executed, state.Data(),
                           depth));
    }
  }
  for (planning::Problem again : {whole, task_}) {
    again.facts = state.Data();
    add(std::move(again));
  }
  return tries;
}

void Repair::Ask() {
  is_asking_ = true;
  assumed_ = session_.progress().run().Active();
  Facts state = session_.state().facts();
  for (auto step = assumed_.rbegin(); step != assumed_.rend(); ++step) {
    const StepRun& running = session_.progress().run().at(*step);
    TakeBack(running.disturbance, running.before, &state);
  }
  std::vector<PlanQuest::Try> tries = Tries(state);
  for (const base::Atom& atom : session_.exclusions().Atoms()) {
    for (PlanQuest::Try& one : tries) one.problem.facts.push_back(DatumOf(atom));
  }
  quest_.Begin(std::move(tries), state);
}

/// The plan begins with what runs, whatever imagination chose for it.
bool Repair::IsWanted(PlanRun* plan, int step, int running) const {
  const base::ActionCall& wanted = plan->at(step).action;
  const base::ActionCall& runs = session_.progress().run().at(running).action;
  if (!plan->at(step).after.empty() || wanted.name != runs.name) return false;
  if (wanted == runs) return true;
  const planning::OperatorEntry& entry = EntryOf(session_.operators(), wanted.name);
  if (!entry.imagine || wanted.arguments.size() != runs.arguments.size()) return false;
  for (std::size_t i = 0; i < wanted.arguments.size(); ++i) {
    const auto& chosen = entry.imagine->parameters;
    const bool may_differ =
        i < entry.arguments.size() &&
        std::find(chosen.begin(), chosen.end(), entry.arguments[i]) != chosen.end();
    if (!may_differ && wanted.arguments[i] != runs.arguments[i]) return false;
  }
  return plan->Instantiate(step, runs.arguments, session_.domain(), session_.operators()).empty();
}

std::vector<std::pair<int, int>> Repair::Match(PlanRun* plan, std::vector<int>* unwanted) const {
  std::vector<std::pair<int, int>> pairs;
  std::set<int> taken;
  for (const int running : assumed_) {
    int step = 0;
    while (step < plan->size() && (taken.count(step) > 0 || !IsWanted(plan, step, running))) ++step;
    if (step == plan->size()) {
      unwanted->push_back(running);
      continue;
    }
    taken.insert(step);
    pairs.emplace_back(step, running);
  }
  return pairs;
}

Repair::Result Repair::Take() {
  is_asking_ = false;
  std::vector<int> unwanted = assumed_;
  std::vector<std::pair<int, int>> pairs;
  std::optional<PlanRun> plan;
  if (quest_.outcome() == PlanQuest::Outcome::kFound) {
    try {
      plan.emplace(session_.progress().next_plan(), quest_.plan(), quest_.problem(),
                   session_.domain(), session_.operators());
    } catch (const base::ConfigError& error) {
      why_ = std::string("the planner's plan is of no use: ") + error.what();
      return Result::kFailed;
    }
    unwanted.clear();
    pairs = Match(&*plan, &unwanted);
  }
  const bool is_useless = quest_.outcome() == PlanQuest::Outcome::kFailed;
  if (!unwanted.empty() &&
      !is_useless) {  // ends by itself meanwhile, or is stopped; then a new plan is made
    for (const int step : unwanted) session_.progress().Stop(step);
    return Result::kUnderWay;
  }
  if (!plan) {
    why_ = fmt::format("{}; the last reason was {}", quest_.why(), last_ ? ToString(*last_) : "");
    return is_useless ? Result::kFailed : Result::kNoPlan;
  }
  std::vector<int> informs = InformedSteps(*plan);
  session_.progress().Adopt(std::move(*plan), std::move(informs), pairs);
  return Result::kMended;
}

}  // namespace hires::execution
