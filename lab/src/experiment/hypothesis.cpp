#include "lab/src/experiment/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "lab/src/seed.h"
#include "hires/base/error.h"
#include "hires/base/failure.h"
#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "reports/task/timeline.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr double kTouching = 0.02;  // [m] between underside and top

std::vector<std::string> ReadNames(base::ParamReader* in, const std::string& key) {
  std::vector<std::string> names;
  for (const std::string& name : in->GetStrings(key)) names.push_back(base::ToLower(name));
  if (names.empty()) in->Fail(key, "wanted at least one name");
  return names;
}

template <typename T>
void Take(const ordered_json& json, const char* key, const std::string& where, T* value) {
  try {
    *value = json.at(key).get<T>();
  } catch (const ordered_json::exception& error) {
    throw base::ConfigError(fmt::format("{}: field '{}': {}", where, key, error.what()));
  }
}

/// Calls `visit` with the name and place of every field, so that writing and reading agree.
template <typename Run, typename Visitor>
void VisitFields(Run* run, const Visitor& visit) {
  visit("run", &run->run);
  visit("imagination", &run->imagines);
  visit("seed", &run->seed);
  visit("complete", &run->is_complete);
  visit("outcome", &run->outcome);
  visit("reason", &run->reason);
  visit("success", &run->success);
  visit("verdict", &run->verdict);
  visit("broken_rules", &run->broken_rules);
  visit("falls", &run->falls);
  visit("contact", &run->contact);
  visit("duration", &run->duration);
  visit("steps", &run->steps);
  visit("replans", &run->replans);
  visit("imaginations", &run->imaginations);
  visit("dispatched", &run->dispatched);
  visit("in_time", &run->in_time);
  visit("imagination_wall", &run->imagination_wall);
  visit("imagination_simulated", &run->imagination_simulated);
  visit("recommended", &run->recommended);
  visit("wall_seconds", &run->wall_seconds);
}

bool IsWanted(const HypothesisGoal& goal, const std::string& object) {
  return std::count(goal.objects.begin(), goal.objects.end(), object) > 0;
}

/// A broken rule with what is to be said of it.
struct Breach {
  JudgeRule rule;
  std::string text;
};

void AddFalls(const HypothesisGoal& goal, const simulation::RunTruth& truth,
              std::vector<Breach>* breaches) {
  std::vector<std::string> fell, knocked_over;
  for (const auto& [name, object] : truth.objects) {
    if (object.falls > 0) (IsWanted(goal, name) ? fell : knocked_over).push_back(name);
  }
  if (!fell.empty()) {
    breaches->push_back({JudgeRule::kFell, base::Join(fell, " and ") + " fell"});
  }
  if (!knocked_over.empty()) {
    breaches->push_back(
        {JudgeRule::kKnockedOver, base::Join(knocked_over, " and ") + " knocked over"});
  }
}

/// "mug1 stands on placingareawestrighttable1", or "" where no wanted object stands at a place.
std::string StandingOf(const HypothesisGoal& goal, const std::vector<WantedPlace>& places,
                       const simulation::RunTruth& truth) {
  for (const std::string& name : goal.objects) {
    const auto object = truth.objects.find(name);
    if (object == truth.objects.end()) continue;
    for (const WantedPlace& place : places) {
      if (StandsAt(place, object->second)) return name + " stands on " + place.name;
    }
  }
  return "";
}

/// Of a run in which nothing stands where it should.
Breach NotThere(const HypothesisGoal& goal, const simulation::RunTruth& truth) {
  for (const std::string& name : goal.objects) {
    const auto object = truth.objects.find(name);
    if (object != truth.objects.end() && !object->second.attached_to.empty()) {
      return {JudgeRule::kHeld, name + " is held by " + object->second.attached_to};
    }
  }
  return {JudgeRule::kNotThere, fmt::format("no {} stands on {}", base::Join(goal.objects, " or "),
                                            base::Join(goal.areas, " or "))};
}

/// Whether it was carried through: not cancelled, refused or asked again.
bool HasVerdict(const loop::ImaginedStep& step) {
  return step.answered && !step.predictions.empty() && step.outcome != loop::ImaginedOutcome::kCancelled;
}

std::string RecommendationOf(const loop::ImaginedStep& step) {
  const auto index = static_cast<std::size_t>(step.recommended);
  if (step.recommended < 0 || index >= step.predictions.size()) return "none";
  return base::ToString(step.predictions[index].action);
}

}  // namespace

HypothesisGoal ReadHypothesisGoal(const std::string& path, const std::string& scenario) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  base::ParamReader scenarios = in.Sub("scenarios");
  HypothesisGoal wanted;
  bool is_known = false;
  for (const std::string& name : scenarios.Keys()) {
    base::ParamReader entry = scenarios.Sub(name);
    HypothesisGoal goal;
    goal.objects = ReadNames(&entry, "objects");
    goal.areas = ReadNames(&entry, "areas");
    goal.time_limit = entry.Get("time_limit", base::Between(1.0, 1e5));
    if (name == scenario) wanted = goal;
    is_known = is_known || name == scenario;
  }
  wanted.start_limit = in.Get("start_limit", base::Between(1.0, 3600.0));
  wanted.wall_limit = in.Get("wall_limit", base::Between(wanted.start_limit, 1e6));
  in.RejectUnknownKeys();
  if (is_known) return wanted;
  throw base::ConfigError(
      fmt::format("{}: {}", path, base::UnknownName("scenario", scenario, scenarios.Keys())));
}

std::uint64_t SeedOfRun(std::uint64_t seed, int run) {
  return SeedOf(base::Rng(seed).Fork(static_cast<std::uint64_t>(run)));
}

ordered_json ToJson(const HypothesisRun& run) {
  ordered_json json;
  VisitFields(&run, [&](const char* key, const auto* value) { json[key] = *value; });
  return json;
}

HypothesisRun ParseHypothesisRun(const ordered_json& json, const std::string& where) {
  HypothesisRun run;
  VisitFields(&run, [&](const char* key, auto* value) { Take(json, key, where, value); });
  return run;
}

std::string ToString(JudgeRule rule) {
  switch (rule) {
    case JudgeRule::kFell:
      return "fell";
    case JudgeRule::kKnockedOver:
      return base::ToString(base::FailureCode::kKnockedOver);
    case JudgeRule::kTouched:
      return "touched";
    case JudgeRule::kHeld:
      return "held";
    case JudgeRule::kNotThere:
      return "not_there";
  }
  return "";
}

const std::vector<JudgeRule>& AllJudgeRules() {
  static const std::vector<JudgeRule> kAll{JudgeRule::kFell, JudgeRule::kKnockedOver,
                                           JudgeRule::kTouched, JudgeRule::kHeld,
                                           JudgeRule::kNotThere};
  return kAll;
}

std::vector<WantedPlace> PlacesOf(const HypothesisGoal& goal, const world::World& world,
                                  double area_edge) {
  std::vector<WantedPlace> places;
  for (const std::string& area : goal.areas) {
    const auto X_MA = world.FindFrame(area);
    if (!X_MA) {
      throw base::ConfigError(fmt::format("world '{}': {}", world.name,
                                          base::UnknownName("area", area, world.FrameNames())));
    }
    places.push_back({area, *X_MA, world::Inset(world.ExtentOf(area), area_edge)});
  }
  return places;
}

bool StandsAt(const WantedPlace& place, const simulation::ObjectFate& object) {
  if (!object.stands || !object.attached_to.empty()) return false;
  const Eigen::Vector3d p_AO = (place.X_MA.Inverse() * object.X_MO).translation;
  return place.extent_A.contains(p_AO.head<2>().eval()) && std::abs(p_AO.z()) <= kTouching;
}

void Judge(const HypothesisGoal& goal, const std::vector<WantedPlace>& places,
           const simulation::RunTruth& truth, HypothesisRun* run) {
  std::vector<Breach> breaches;
  const std::string standing = StandingOf(goal, places, truth);
  if (standing.empty()) breaches.push_back(NotThere(goal, truth));
  AddFalls(goal, truth, &breaches);
  if (!truth.contact.empty()) breaches.push_back({JudgeRule::kTouched, truth.contact});
  std::vector<std::string> words;
  if (!standing.empty()) words.push_back(standing);
  run->broken_rules.clear();
  for (const Breach& breach : breaches) {
    run->broken_rules.push_back(ToString(breach.rule));
    words.push_back(breach.text);
  }
  run->success = breaches.empty();
  run->verdict = base::Join(words, ", ");
  run->contact = truth.contact;
  run->falls = 0;
  for (const auto& [name, object] : truth.objects) run->falls += object.falls;
}

void CountReport(const loop::AchieveReport& report, HypothesisRun* run) {
  run->outcome = ToString(report.outcome);
  run->reason = report.reason;
  run->duration = reports::MakeTimeline(report).duration;
  run->replans = report.status.replans;
  run->steps = static_cast<int>(
      std::count_if(report.status.steps.begin(), report.status.steps.end(),
                    [](const execution::StepStatus& step) { return step.started.has_value(); }));
  run->imaginations = static_cast<int>(report.status.imaginations.size());
  // Of steps that were begun. One that a repair took over may stand in several plans; what was
  // asked last counts, for it is asked again where an answer counts no more.
  std::map<std::pair<double, std::string>, bool> is_answered;
  for (const loop::ImaginedStep& step : report.status.imaginations) {
    const bool in_time = HasVerdict(step) && *step.answered <= step.dispatch.value_or(-1.0);
    if (step.dispatch)
      is_answered[{*step.dispatch, base::CanonicalName(step.action.name)}] = in_time;
    run->imagination_wall += step.wall_seconds;
    run->imagination_simulated += step.simulated_seconds;
    run->recommended.push_back(RecommendationOf(step));
  }
  run->dispatched = static_cast<int>(is_answered.size());
  for (const auto& [step, in_time] : is_answered) run->in_time += in_time ? 1 : 0;
}

}  // namespace hires::lab
