#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/src/experience/experience_pictures.h"
#include "lab/src/experience/experience_runs.h"
#include "lab/src/experience/fall_prediction.h"
#include "lab/src/experience/filter_trial.h"
#include "hires/base/error.h"
#include "lab/src/experience/experience_report.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kLeastParts = 1000;

std::string Text(const ordered_json& number, int digits = 3) {
  return number.is_null() ? "no value" : fmt::format("{:.{}f}", number.get<double>(), digits);
}

std::string IntervalText(const ordered_json& interval) {
  return fmt::format("{} ({} .. {})", Text(interval.at("estimate")), Text(interval.at("lower")),
                     Text(interval.at("upper")));
}

std::string FilterTable(const ordered_json& trial) {
  std::vector<std::vector<std::string>> rows{{"filter", "phase", "rms error v [m/s]", "a [m/s^2]",
                                              "j [m/s^3]", "delay [s]",
                                              "shaking told from not toppling by |a|"}};
  for (const ordered_json& row : trial.at("filters")) {
    const ordered_json& error = row.at("rms_error");
    rows.push_back({row.at("filter").get<std::string>(),
                    row.at("causal").get<bool>() ? "causal" : "zero", Text(error.at("v")),
                    Text(error.at("a")), Text(error.at("j")), Text(row.at("delay")),
                    IntervalText(row.at("separation"))});
  }
  return fmt::format(
      "Base measured with {:g} m of white noise at 20 Hz; window {} samples, cutoff {:.2f} Hz, "
      "from the "
      "autocorrelation\n{}",
      trial.at("noise").get<double>(), trial.at("window").get<std::size_t>(),
      trial.at("cutoff").get<double>(), reports::FormatTable(rows));
}

std::string MotionSetTable(const ordered_json& sets) {
  std::vector<std::vector<std::string>> rows{{"motion set", "runs", "falls", "windows without"}};
  for (const ordered_json& set : sets) {
    const auto whole = [&](const char* key) {
      return fmt::format("{}", set.at(key).get<std::size_t>());
    };
    rows.push_back({set.at("motion_set").get<std::string>(), whole("runs"), whole("falls"),
                    whole("calm_windows")});
  }
  return reports::FormatTable(rows);
}

std::string PredictionTable(const ordered_json& prediction) {
  std::vector<std::vector<std::string>> rows{{"feature", "area under the curve (95 %)",
                                              "within a motion set", "threshold", "hits",
                                              "false alarms"}};
  for (const ordered_json& row : prediction.at("features")) {
    const ordered_json& judged = row.at("judged");
    rows.push_back({row.at("feature").get<std::string>(), IntervalText(row.at("area")),
                    IntervalText(row.at("area_within")), Text(judged.at("threshold"), 4),
                    Text(judged.at("hits")), Text(judged.at("false_alarms"))});
  }
  return fmt::format(
      "{} falls ({} others came in the first second of a drive) and {} windows without, {:g} s "
      "ahead; thresholds chosen on every other run, judged on the rest\n{}\n{}",
      prediction.at("falls").get<std::size_t>(),
      prediction.at("falls_too_early").get<std::size_t>(),
      prediction.at("calm_windows").get<std::size_t>(), prediction.at("ahead").get<double>(),
      MotionSetTable(prediction.at("motion_sets")), reports::FormatTable(rows));
}

}  // namespace

ordered_json AnalysisOf(const knowledge::ExperienceStore& store, std::uint64_t seed,
                        std::string* text) {
  enum Streams : std::uint64_t { kFilters, kPrediction };
  if (store.num_parts() < kLeastParts) {
    throw base::ConfigError(
        fmt::format("the store has {} parts; wanted at least {}: 50 s of experiences",
                    store.num_parts(), kLeastParts));
  }
  const std::vector<ExperienceRun> runs = RunsOf(store);
  const base::Rng rng(seed);
  ordered_json analysis{{"schema", "hires/experience_analysis"},
                        {"version", 1},
                        {"parts", store.num_parts()},
                        {"runs", runs.size()},
                        {"filter_trial", TryFilters(runs, rng.Fork(kFilters))},
                        {"prediction", PredictFalls(runs, rng.Fork(kPrediction))},
                        {"pictures", PicturesOf(runs)}};
  *text =
      FilterTable(analysis.at("filter_trial")) + "\n" + PredictionTable(analysis.at("prediction"));
  return analysis;
}

}  // namespace hires::lab
