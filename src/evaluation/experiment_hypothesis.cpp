#include "hires/evaluation/experiment_hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/evaluation/timeline.h"

namespace hires::evaluation {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kLargestSeed = 0x7fffffff;  // ROS parameters have 32 bits and a sign
constexpr double kUpright = 0.1;                    // [rad]
constexpr double kTouching = 0.02;                  // [m] between underside and top

std::vector<std::string> ReadObjects(base::ParamReader* in) {
  std::vector<std::string> objects;
  for (const std::string& name : in->GetStrings("objects")) objects.push_back(base::ToLower(name));
  if (objects.empty()) in->Fail("objects", "wanted at least one object");
  return objects;
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

const world::StaticBody& FurnitureOf(const HypothesisGoal& goal, const world::World& world) {
  std::vector<std::string> names;
  for (const world::StaticBody& body : world.statics) {
    if (base::ToLower(body.name) == base::ToLower(goal.furniture)) return body;
    names.push_back(body.name);
  }
  throw base::ConfigError(fmt::format("world '{}': {}", world.name,
                                      base::UnknownName("furniture", goal.furniture, names)));
}

/// Objects of the goal that fell, as a sentence; "" for none.
std::string FallsOf(const HypothesisGoal& goal, const RunTruth& truth) {
  std::vector<std::string> fallen;
  for (const auto& [name, falls] : truth.falls) {
    const bool is_wanted =
        std::count(goal.objects.begin(), goal.objects.end(), base::ToLower(name));
    if (is_wanted && falls > 0) fallen.push_back(name);
  }
  return fallen.empty() ? "" : base::Join(fallen, " and ") + " fell";
}

std::string StandingOf(const HypothesisGoal& goal, const world::StaticBody& body,
                       const world::WorldState& state) {
  for (const std::string& name : goal.objects) {
    const world::ObjectState* object = state.Find(name);
    if (object != nullptr && StandsOn(body, *object)) return name;
  }
  return "";
}

/// Whether it was carried through: not cancelled, refused or asked again.
bool HasVerdict(const ImaginedStep& step) {
  return step.answered && !step.predictions.empty() && step.outcome != ImaginedOutcome::kCancelled;
}

std::string RecommendationOf(const ImaginedStep& step) {
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
    goal.objects = ReadObjects(&entry);
    goal.furniture = entry.GetString("furniture");
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
  return base::Rng(seed).Fork(static_cast<std::uint64_t>(run)).seed() & kLargestSeed;
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

bool StandsOn(const world::StaticBody& body, const world::ObjectState& object) {
  if (!object.attached_to.empty() || !object.X_MO.IsFinite()) return false;
  if (geometry::TiltOf(object.X_MO.rotation) >= kUpright) return false;
  const Eigen::Vector3d& p_MO = object.X_MO.translation;
  return std::any_of(body.collisions.begin(), body.collisions.end(),
                     [&](const geometry::Collision& collision) {
                       const geometry::Aabb bounds =
                           geometry::BoundsOf(collision.shape, body.X_MB * collision.X_BS);
                       return p_MO.x() >= bounds.lower.x() && p_MO.x() <= bounds.upper.x() &&
                              p_MO.y() >= bounds.lower.y() && p_MO.y() <= bounds.upper.y() &&
                              std::abs(p_MO.z() - bounds.upper.z()) <= kTouching;
                     });
}

void Judge(const HypothesisGoal& goal, const world::World& world, const RunTruth& truth,
           HypothesisRun* run) {
  const std::string standing = StandingOf(goal, FurnitureOf(goal, world), truth.state);
  const std::string fallen = FallsOf(goal, truth);
  run->success = !standing.empty() && fallen.empty();
  run->verdict = standing.empty() ? fmt::format("no {} stands on {}",
                                                base::Join(goal.objects, " or "), goal.furniture)
                                  : fmt::format("{} stands on {}", standing, goal.furniture);
  if (!fallen.empty()) run->verdict += ", " + fallen;
  run->falls = 0;
  for (const auto& [name, falls] : truth.falls) run->falls += falls;
  run->contact = truth.contact;
}

void CountReport(const AchieveReport& report, HypothesisRun* run) {
  run->outcome = ToString(report.outcome);
  run->reason = report.reason;
  run->duration = MakeTimeline(report).duration;
  run->replans = report.status.replans;
  run->steps = static_cast<int>(
      std::count_if(report.status.steps.begin(), report.status.steps.end(),
                    [](const execution::StepStatus& step) { return step.started.has_value(); }));
  run->imaginations = static_cast<int>(report.status.imaginations.size());
  // Of steps that were begun. One that a repair took over may stand in several plans; what was
  // asked last counts, for it is asked again where an answer counts no more.
  std::map<std::pair<double, std::string>, bool> is_answered;
  for (const ImaginedStep& step : report.status.imaginations) {
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

}  // namespace hires::evaluation
