#include "lab/src/series/series_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hires/base/check.h"
#include "hires/base/error.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr char kKind[] = "hires_lab scenarios 1";
constexpr char kKnownFluents[] = "known_fluents";

/// The same for writing and reading.
template <typename Run, typename Visitor>
void VisitFields(Run* run, const Visitor& visit) {
  visit("run", &run->run);
  visit("choices", &run->choices);
  visit("seed", &run->seed);
  visit("instruction", &run->instruction);
  visit("scenario", &run->scenario);
  visit("truth", &run->truth);
  visit("outcome", &run->outcome);
  visit("cause", &run->cause);
  visit("failure", &run->failure);
  visit("broken_tries", &run->broken_tries);
  visit("episode", &run->episode);
  visit("simulated_seconds", &run->simulated_seconds);
  visit("fluents", &run->fluents);
  visit("fallen", &run->fallen);
  visit("touched", &run->touched);
}

template <typename T>
void Take(const ordered_json& json, const char* key, const std::string& where, T* value) {
  try {
    *value = json.at(key).get<T>();
  } catch (const ordered_json::exception& error) {
    throw base::ConfigError(fmt::format("{}: field '{}': {}", where, key, error.what()));
  }
}

bool HasBegun(const ordered_json& steps) {
  return std::any_of(steps.begin(), steps.end(), [](const ordered_json& step) {
    return step.value("action", "") != "imagine" && step.contains("started") &&
           !step["started"].is_null();
  });
}

SeriesOutcome OutcomeOf(const std::string& word, const ordered_json& steps) {
  if (word == "succeeded") return SeriesOutcome::kSucceeded;
  if (word == "no_plan" && !HasBegun(steps)) return SeriesOutcome::kImpossible;
  if (word == "no_plan" || word == "failed") return SeriesOutcome::kFailed;
  return SeriesOutcome::kBroken;  // preempted, invalid, busy: nobody may have asked for that
}

void TakeTruth(const ordered_json& json, const std::string& where, SeriesRun* run) {
  Take(json, "virtual_seconds", where, &run->simulated_seconds);
  Take(json, "touched", where, &run->touched);
  ordered_json objects;
  Take(json, "objects", where, &objects);
  for (const auto& [name, object] : objects.items()) {
    if (object.value("falls", 0) > 0) run->fallen.push_back(name);
  }
}

/// Fluents that were loaded as knowledge, which happens before a run begins.
std::uint64_t NumKnown(const knowledge::Store& store) {
  constexpr std::size_t kPage = 1000;
  std::uint64_t known = 0, sequence = 0;
  while (true) {
    const std::vector<knowledge::Change> changes = store.ChangesSince(sequence, kPage);
    if (changes.empty()) return known;
    for (const knowledge::Change& change : changes) {
      const bool has_opened = change.kind != knowledge::Change::Kind::kRemoved;
      known += has_opened && change.source == knowledge::Source::kKnowledge ? 1 : 0;
    }
    sequence = changes.back().sequence;
  }
}

}  // namespace

std::string ToString(SeriesOutcome outcome) {
  switch (outcome) {
    case SeriesOutcome::kSucceeded:
      return "succeeded";
    case SeriesOutcome::kFailed:
      return "failed";
    case SeriesOutcome::kImpossible:
      return "impossible";
    case SeriesOutcome::kBroken:
      return "broken";
  }
  HIRES_CHECK(false, "an outcome without a name");
  return "";
}

ordered_json ToJson(const SeriesRun& run) {
  ordered_json json;
  VisitFields(&run, [&](const char* key, const auto* value) { json[key] = *value; });
  json[kKnownFluents] = run.known_fluents ? ordered_json(*run.known_fluents) : ordered_json();
  return json;
}

SeriesRun ParseSeriesRun(const ordered_json& json, const std::string& where) {
  SeriesRun run;
  VisitFields(&run, [&](const char* key, auto* value) { Take(json, key, where, value); });
  if (json.contains(kKnownFluents) && !json[kKnownFluents].is_null()) {
    Take(json, kKnownFluents, where, &run.known_fluents.emplace());
  }
  return run;
}

void TakeAchieveReport(const ordered_json& json, const std::string& where, SeriesRun* run) {
  std::string word;
  ordered_json steps;
  Take(json, "outcome", where, &word);
  Take(json, "steps", where, &steps);
  Take(json, "reason", where, &run->cause);
  Take(json, "duration", where, &run->simulated_seconds);
  const SeriesOutcome outcome = OutcomeOf(word, steps);
  run->outcome = ToString(outcome);
  if (outcome == SeriesOutcome::kSucceeded) run->cause.clear();
  if (outcome == SeriesOutcome::kBroken) run->cause = word + ": " + run->cause;
  const ordered_json failure = json.value("failure", ordered_json());
  if (failure.is_object()) run->failure = failure.value("failure", "");
  if (json.contains("in_truth")) TakeTruth(json["in_truth"], where + ": in_truth", run);
}

void TakeBlackboard(const knowledge::Store& store, SeriesRun* run) {
  run->fluents = store.Stats().fluents;
  run->known_fluents = NumKnown(store);
}

SeriesJournal::SeriesJournal(const std::string& path, const ordered_json& setting)
    : journal_(
          path,
          [&] {
            ordered_json head{{"journal", kKind}};
            head.update(setting);
            return head;
          }(),
          [&](const ordered_json& json, const std::string& where) {
            Load(ParseSeriesRun(json, where), where);
          }) {}

void SeriesJournal::Load(const SeriesRun& run, const std::string& where) {
  const std::size_t wanted = runs_.size() + 1;
  if (run.run != static_cast<int>(wanted)) {
    throw base::ConfigError(
        fmt::format("{}: is run {}, wanted run {}; runs are played one after the other. Move the "
                    "journal away or repair this line",
                    where, run.run, wanted));
  }
  runs_.push_back(run);
}

void SeriesJournal::Append(const SeriesRun& run) {
  journal_.Append(ToJson(run));
  runs_.push_back(run);
}

}  // namespace hires::lab
