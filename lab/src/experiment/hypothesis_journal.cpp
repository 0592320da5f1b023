#include "lab/src/experiment/hypothesis_journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr char kKind[] = "hires hypothesis 3";

ordered_json HeadOf(const HypothesisSetting& setting) {
  return {{"journal", kKind},       {"scenario", setting.scenario}, {"runs", setting.runs},
          {"seed", setting.seed},   {"pace", setting.pace},         {"workers", setting.workers},
          {"files", setting.files}, {"local", setting.is_local},    {"truth", setting.truth}};
}

}  // namespace

HypothesisJournal::HypothesisJournal(const std::string& path, const HypothesisSetting& setting)
    : journal_(path, HeadOf(setting), [&](const ordered_json& json, const std::string& where) {
        Load(setting, ParseHypothesisRun(json, where), where);
      }) {}

void HypothesisJournal::Load(const HypothesisSetting& setting, const HypothesisRun& run,
                             const std::string& where) {
  const bool fits = run.run >= 1 && run.run <= setting.runs && !Has(run.run, run.imagines) &&
                    run.seed == SeedOfRun(setting.seed, run.run);
  if (!fits) {
    throw base::ConfigError(
        fmt::format("{}: run {} {} imagination is there twice, or is not among this experiment's "
                    "{} runs; move the "
                    "journal away or remove this line",
                    where, run.run, run.imagines ? "with" : "without", setting.runs));
  }
  runs_.push_back(run);
}

bool HypothesisJournal::Has(int run, bool imagines) const {
  return std::any_of(runs_.begin(), runs_.end(), [&](const HypothesisRun& other) {
    return other.run == run && other.imagines == imagines;
  });
}

void HypothesisJournal::Append(const HypothesisRun& run) {
  journal_.Append(ToJson(run));
  runs_.push_back(run);
}

}  // namespace hires::lab
