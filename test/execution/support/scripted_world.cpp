#include "support/scripted_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "hires/base/text.h"
#include "hires/planning/planner.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/reasons.h"
#include "hires/planning/step_replay.h"
#include "hires/planning/task_text.h"

namespace hires::test_support {
namespace {

using namespace execution;  // the vocabulary of events and commands
using planning::Datum;

const std::string kDomains = std::string(HIRES_SOURCE_DIR) + "/config/domains/";

planning::Problem Load(const std::string& name) {
  return planning::LoadProblems(kDomains + "problems/" + name + ".lisp", Restaurant().domain).at(0);
}

base::Atom ToAtom(const Datum& datum) {
  base::Atom atom{std::string(datum.Head()), {}};
  for (std::size_t i = 1; i < datum.items.size(); ++i) {
    atom.arguments.push_back(ToString(datum.items[i]));
  }
  return atom;
}

Datum ToDatum(const base::Atom& atom) {
  std::vector<Datum> items{planning::ReadGroundTerm(atom.predicate, "fact")};
  for (const std::string& argument : atom.arguments) {
    items.push_back(planning::ReadGroundTerm(argument, "fact"));
  }
  return planning::MakeList(std::move(items));
}

std::string KeyOf(const base::Atom& atom) { return base::ToLower(base::ToString(atom)); }

Datum TaskOf(const base::ActionCall& action) {
  return ToDatum({"!" + action.name, action.arguments});
}

std::vector<base::Atom> Values(const std::map<std::string, base::Atom>& facts) {
  std::vector<base::Atom> atoms;
  for (const auto& [key, atom] : facts) atoms.push_back(atom);
  return atoms;
}

/// Steps below one root: what breaks down into what is lost.
void Flatten(planning::Plan* plan) {
  plan->nodes.assign(1, {});
  for (planning::PlanStep& step : plan->steps) {
    planning::PlanNode node;
    node.task = step.task;
    node.parent = 0;
    node.step = node.at_step = static_cast<int>(plan->nodes.size()) - 1;
    step.bindings.clear();
    step.node = static_cast<int>(plan->nodes.size());
    plan->nodes[0].children.push_back(step.node);
    plan->nodes.push_back(node);
  }
}

}  // namespace

const planning::PlanningKnowledge& Restaurant() {
  static const planning::PlanningKnowledge knowledge{
      planning::LoadDomain(kDomains + "restaurant.lisp"), {}};
  return knowledge;
}

const planning::OperatorData& RestaurantData() {
  static const planning::OperatorData data =
      planning::LoadOperatorData(kDomains + "restaurant.yaml", Restaurant().domain);
  return data;
}

std::vector<base::Atom> FactsOf(const std::string& problem) {
  std::vector<base::Atom> atoms;
  for (const Datum& fact : Load(problem).facts) atoms.push_back(ToAtom(fact));
  return atoms;
}

std::string TaskOf(const std::string& problem) { return *ToShop2Tasks(Load(problem).tasks); }

ScriptedWorld::ScriptedWorld(Options options)
    : options_(std::move(options)),
      monitor_(options_.planning ? options_.planning : &Restaurant(),
               options_.operators ? options_.operators : &RestaurantData(), options_.monitor),
      now_(options_.start) {
  for (const base::Atom& atom : options_.facts) world_[KeyOf(atom)] = atom;
}

const planning::Domain& ScriptedWorld::domain() const {
  return (options_.planning ? options_.planning : &Restaurant())->domain;
}

const planning::OperatorData& ScriptedWorld::operators() const {
  return options_.operators ? *options_.operators : RestaurantData();
}

void ScriptedWorld::Schedule(double time, Happening happening) {
  happenings_.emplace(time, std::move(happening));
}

void ScriptedWorld::At(double time, std::function<void(ScriptedWorld*)> what) {
  Schedule(options_.start + time, [this, what = std::move(what)] { what(this); });
}

void ScriptedWorld::When(std::function<bool(const Command&)> when,
                         std::function<void(ScriptedWorld*)> what) {
  triggers_.emplace_back(std::move(when), std::move(what));
}

void ScriptedWorld::Violate(const std::string& text) {
  violations_.push_back(fmt::format("{:.2f}: {}", now_ - options_.start, text));
}

void ScriptedWorld::Log(const std::string& line) {
  log_.push_back(fmt::format("{} @{:.2f}", line, now_ - options_.start));
}

void ScriptedWorld::Post(Event event, double delay) {
  Schedule(now_ + delay, [this, event = std::move(event)] { Tell(event); });
}

void ScriptedWorld::Tell(const Event& event) {
  const bool was_over = finish_.has_value();
  const bool is_answer = std::holds_alternative<PlanArrived>(event) ||
                         std::holds_alternative<StepFinished>(event) ||
                         std::holds_alternative<ImagineAnswered>(event);
  if (is_answer) last_answer_ = event;
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Command> commands = monitor_.Handle(event, now_);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  handle_seconds_.push_back(took.count());
  if (was_over && !commands.empty()) Violate("a command after the end");
  for (const Command& command : commands) Obey(command);
}

void ScriptedWorld::Obey(const Command& command) {
  std::visit([this](const auto& c) { Do(c); }, command);
  std::vector<std::function<void(ScriptedWorld*)>> fired;
  for (auto trigger = triggers_.begin(); trigger != triggers_.end();) {
    if (!trigger->first(command)) {
      ++trigger;
      continue;
    }
    fired.push_back(std::move(trigger->second));
    trigger = triggers_.erase(trigger);
  }
  for (auto& what : fired) Schedule(now_, [this, what = std::move(what)] { what(this); });
}

Finish ScriptedWorld::Run(const std::string& task) {
  finish_.reset();
  Observe();
  Post(TaskRequested{task});
  const double end = now_ + options_.horizon;
  while (!finish_ && now_ < end) {
    const auto wake = monitor_.WakeAt();
    const bool is_tick = wake && (happenings_.empty() || *wake < happenings_.begin()->first);
    if (!is_tick && happenings_.empty()) break;
    if (is_tick) {
      if (*wake < now_ - 1e-9)
        Violate(fmt::format("wants to wake in the past: {}", *wake - options_.start));
      now_ = std::max(now_, *wake);
      Tell(ClockTicked{});
      continue;
    }
    now_ = std::max(now_, happenings_.begin()->first);
    const Happening happening = std::move(happenings_.begin()->second);
    happenings_.erase(happenings_.begin());
    happening();
  }
  if (!finish_) {
    Violate(happenings_.empty() ? "waits for nothing" : "does not come to an end");
    return {Finish::Outcome::kFailed, "never finished", {}};
  }
  const Finish finish = *finish_;
  while (!happenings_.empty()) {  // what comes late must change nothing
    now_ = std::max(now_, happenings_.begin()->first);
    const Happening happening = std::move(happenings_.begin()->second);
    happenings_.erase(happenings_.begin());
    happening();
  }
  return finish;
}

void ScriptedWorld::Observe(double delay) {
  Schedule(now_ + delay, [this] {
    observed_ = world_;
    Tell(StateObserved{Values(observed_), 0});
  });
}

void ScriptedWorld::ObserveUntilNow(double delay) { Post(ObservedUntil{now_}, delay); }

void ScriptedWorld::Set(const std::vector<base::Atom>& gone, const std::vector<base::Atom>& come) {
  for (const base::Atom& atom : gone) world_.erase(KeyOf(atom));
  for (const base::Atom& atom : come) world_[KeyOf(atom)] = atom;
}

void ScriptedWorld::ReplaceAll(const std::string& predicate, const base::Atom& by) {
  for (auto fact = world_.begin(); fact != world_.end();) {
    const bool is_one = base::ToLower(fact->second.predicate) == predicate;
    fact = is_one ? world_.erase(fact) : std::next(fact);
  }
  world_[KeyOf(by)] = by;
}

void ScriptedWorld::Repeat() {
  if (last_answer_) Post(*last_answer_);
}

bool ScriptedWorld::Holds(const base::Atom& atom) const { return world_.count(KeyOf(atom)) > 0; }

// ---------------------------------------------------------------------------------------- planning

planning::Problem ScriptedWorld::ProblemOf(const std::map<std::string, base::Atom>& facts) const {
  planning::Problem problem;
  for (const auto& [key, atom] : facts) problem.facts.push_back(ToDatum(atom));
  return problem;
}

void ScriptedWorld::Do(const StartPlanning& command) {
  Log("plan " + command.tasks);
  const int count = static_cast<int>(plannings_.size());
  plannings_.push_back(command);
  PlanArrived answer;
  if (options_.planner) {
    if (auto scripted = options_.planner(count)) {
      scripted->request = command.request;
      return Post(*scripted, options_.planner_delay);
    }
  }
  planning::Problem problem;
  for (const auto* atoms : {&command.state, &command.facts}) {
    for (const base::Atom& atom : *atoms) problem.facts.push_back(ToDatum(atom));
  }
  answer.request = command.request;
  problem.tasks = planning::ReadTasks(command.tasks, "tasks");
  planning::PlanRequest request;
  planning::PlanResult found = FindPlans(domain(), problem, request);
  if (found.plans.empty()) {
    answer.outcome = PlanArrived::Outcome::kNoPlan;
    answer.why = "there is no plan: every way was tried";
  } else {
    answer.plan = std::move(found.plans.front());
    if (options_.plans != Options::PlanForm::kWhole) Flatten(&answer.plan);
    if (options_.plans != Options::PlanForm::kSteps) {
      AddReasons(domain(), problem, &answer.plan);
    } else {
      answer.plan.nodes.clear();
    }
  }
  Post(answer, options_.planner_delay);
}

// ------------------------------------------------------------------------------------------- steps

void ScriptedWorld::CheckStart(const StartStep& command) {
  const std::string text = base::ToString(command.action);
  if (finish_) Violate("begins after the end: " + text);
  if (command.time_limit <= 0.0) Violate("no time limit: " + text);
  planning::PlanStep step;
  step.task = TaskOf(command.action);
  const planning::Problem problem = ProblemOf(observed_);
  planning::StepReplay replay(domain(), problem, planning::Functions::Standard(), true);
  const planning::ReplayedStep taken = replay.Take(step);
  for (const std::string& wrong : taken.wrong) Violate("cannot be begun: " + text + ": " + wrong);
  std::map<std::string, int> used = ResourcesOf(operators(), step);
  for (const auto& [activity, running] : running_) {
    planning::PlanStep other;
    other.task = TaskOf(running.action);
    for (const auto& [resource, units] : ResourcesOf(operators(), other)) {
      used[resource] += units;
    }
    const bool is_torso = command.action.name == "move_torso";
    if (is_torso && running.action.name == "move_torso") Violate("the torso moves twice");
  }
  for (const auto& [resource, units] : used) {
    if (units > operators().capacities.at(resource)) {
      Violate("more than there is of " + resource + ": " + text);
    }
  }
}

void ScriptedWorld::Do(const StartStep& command) {
  CheckStart(command);
  const std::string text = base::ToString(command.action);
  Log("begin " + text);
  begun_.emplace_back(text, now_ - options_.start);
  RunningStep step{command.action, {}, false};
  const int count = begun_count_[text]++;
  if (options_.step) step.script = options_.step(command.action, count);
  if (!running_.emplace(command.activity, step).second) Violate("one activity twice");
  if (step.script.ends) {
    Schedule(now_ + step.script.duration, [this, id = command.activity] { EndStep(id); });
  }
}

void ScriptedWorld::Do(const StopStep& command) {
  const auto step = running_.find(command.activity);
  if (step == running_.end()) return Log("stop of a step that has just ended");
  Log("stop " + base::ToString(step->second.action));
  if (step->second.is_stopped) Violate("stopped twice: " + base::ToString(step->second.action));
  step->second.is_stopped = true;
  if (!step->second.script.obeys) return;
  Schedule(now_ + options_.stop_delay, [this, id = command.activity] { EndStep(id); });
}

void ScriptedWorld::ApplyEffects(const RunningStep& running) {
  planning::PlanStep step;
  step.task = TaskOf(running.action);
  const planning::Problem problem = ProblemOf(world_);
  planning::StepReplay replay(domain(), problem, planning::Functions::Standard(), true);
  const planning::ReplayedStep taken = replay.Take(step);
  if (!taken.wrong.empty()) return;  // the world is another one by now: nothing comes of it
  for (const Datum& atom : taken.deletes) world_.erase(KeyOf(ToAtom(atom)));
  for (const Datum& atom : taken.adds) world_[KeyOf(ToAtom(atom))] = ToAtom(atom);
}

void ScriptedWorld::EndStep(int activity) {
  const auto found = running_.find(activity);
  if (found == running_.end()) return;
  const RunningStep step = found->second;
  running_.erase(found);
  StepFinished finished{activity, step.script.result, step.script.failure};
  if (step.is_stopped) {
    finished = {activity, StepFinished::Result::kPreempted, {}};
  } else if (finished.result == StepFinished::Result::kSucceeded && step.script.has_effects) {
    ApplyEffects(step);
  }
  Log((step.is_stopped ? "stopped " : "end ") + base::ToString(step.action));
  if (step.script.is_observed) Observe(options_.observation_delay);
  Post(finished);
}

// ------------------------------------------------------------------------------------- imagination

void ScriptedWorld::Do(const StartImagination& command) {
  Log("imagine " + command.action.name);
  imaginations_.push_back(command);
  const int count = imagined_count_[command.action.name]++;
  if (!options_.imagine) return;
  auto answer = options_.imagine(command, count);
  if (!answer) return;
  answer->request = command.request;
  Post(*answer, options_.imagine_delay);
}

void ScriptedWorld::Do(const MoveDeadline& command) {
  Log("move deadline");
  moves_.push_back(command);
}

void ScriptedWorld::Do(const Warn& command) {
  Log("warn " + command.text);
  warnings_.push_back(command.text);
}

void ScriptedWorld::Do(const Finish& command) {
  Log("finish " + command.reason);
  if (finish_) Violate("finishes twice");
  for (const auto& [activity, running] : running_) {
    if (running.script.obeys || !running.is_stopped) {
      Violate("finishes while this runs: " + base::ToString(running.action));
    }
  }
  finish_ = command;
}

// ----------------------------------------------------------------------------------- what happened

std::vector<std::string> ScriptedWorld::Begun() const {
  std::vector<std::string> begun;
  for (const auto& [text, time] : begun_) begun.push_back(text);
  return begun;
}

double ScriptedWorld::StartOf(const std::string& action) const {
  for (const auto& [text, time] : begun_) {
    if (text == action) return time;
  }
  return -1.0;
}

double ScriptedWorld::TimeOf(const std::string& word) const {
  for (const std::string& line : log_) {
    if (line.rfind(word, 0) == 0) return std::stod(line.substr(line.rfind('@') + 1));
  }
  return -1.0;
}

int ScriptedWorld::CountOf(const std::string& word) const {
  return static_cast<int>(std::count_if(
      log_.begin(), log_.end(), [&](const std::string& line) { return line.rfind(word, 0) == 0; }));
}

ImagineAnswered Ranked(const base::ActionCall& recommended, double duration) {
  ImagineAnswered answer;
  answer.recommended = recommended;
  answer.duration = duration;
  answer.duration_low = 0.9 * duration;
  answer.duration_high = 1.1 * duration;
  answer.why = "it succeeds most often";
  return answer;
}

ImagineAnswered AllFail(const StartImagination& request, const base::Failure& failure) {
  ImagineAnswered answer;
  answer.outcome = ImagineAnswered::Outcome::kAllFailed;
  answer.failed = base::Combinations(request.action);
  answer.failures.assign(answer.failed.size(), failure);
  answer.why = "every alternative fails";
  return answer;
}

}  // namespace hires::test_support
