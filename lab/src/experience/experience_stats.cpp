#include <fmt/format.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "lab/src/experience/experience_runs.h"
#include "lab/src/experience/experience_report.h"
#include "reports/text/report_table.h"
#include "hires/imagination/evidence.h"

namespace hires::lab {
namespace {

using knowledge::ToppleState;
using nlohmann::ordered_json;

struct ActionCounts {
  imagination::OutcomeCounts counts;
  int falls{0};
  double time{0.0};  // [s]
};

void Count(const Stretch& stretch, ActionCounts* into) {
  for (const knowledge::ToppleEpisodePart& part : stretch) {
    into->counts.notopple += part.state == ToppleState::kNoTopple;
    into->counts.shaking += part.state == ToppleState::kShaking;
    into->counts.topple += part.state == ToppleState::kTopple;
  }
  into->falls += static_cast<int>(OnsetsOf(stretch).size());
  into->time += knowledge::kExperiencePeriod * static_cast<double>(stretch.size());
}

/// [1/s] of parts by their time stamps; null where none follows another. What lasts longer than a
/// second is a pause, and no time in which parts are missing.
ordered_json RateOf(const std::vector<ExperienceRun>& runs) {
  constexpr double kPause = 1.0;  // [s]
  double span = 0.0, steps = 0.0;
  for (const ExperienceRun& run : runs) {
    double last = std::numeric_limits<double>::infinity();
    for (const Stretch& stretch : run.stretches) {
      for (const knowledge::ToppleEpisodePart& part : stretch) {
        const double step = part.time - last;
        last = part.time;
        if (!(step > 0.0 && step <= kPause)) continue;
        span += step;
        steps += 1.0;
      }
    }
  }
  return span > 0.0 ? ordered_json(steps / span) : ordered_json();
}

ordered_json ActionJson(const std::string& action, const ActionCounts& found) {
  const imagination::OutcomeCounts& counts = found.counts;
  return {{"action", action},
          {"parts", counts.total()},
          {"notopple", counts.notopple},
          {"shaking", counts.shaking},
          {"topple", counts.topple},
          {"falls", found.falls},
          {"time", found.time},
          {"confidence",
           counts.total() > 0 ? ordered_json(imagination::Confidence(counts)) : ordered_json()}};
}

std::string TextOf(const ordered_json& stats) {
  std::vector<std::vector<std::string>> rows{
      {"action", "parts", "notopple", "shaking", "topple", "falls", "time [s]", "confidence"}};
  for (const ordered_json& row : stats.at("actions")) {
    const auto whole = [&](const char* key) { return fmt::format("{}", row.at(key).get<int>()); };
    rows.push_back({row.at("action").get<std::string>(), whole("parts"), whole("notopple"),
                    whole("shaking"), whole("topple"), whole("falls"),
                    fmt::format("{:.0f}", row.at("time").get<double>()),
                    row.at("confidence").is_null()
                        ? ""
                        : fmt::format("{:.3f}", row.at("confidence").get<double>())});
  }
  return fmt::format("{}\n{} parts of {} runs, {} episodes, {:.1f} bytes each\n", reports::FormatTable(rows),
                     stats.at("parts").get<std::uint64_t>(), stats.at("runs").get<std::size_t>(),
                     stats.at("episodes").get<std::size_t>(),
                     stats.at("bytes_per_part").get<double>());
}

}  // namespace

ordered_json StatsOf(const knowledge::ExperienceStore& store, std::string* text) {
  std::map<std::string, ActionCounts> by_action;
  std::size_t episodes = 0;
  const std::vector<ExperienceRun> runs = RunsOf(store);
  for (const ExperienceRun& run : runs) {
    for (std::size_t i = 0; i < run.stretches.size(); ++i) {
      Count(run.stretches[i], &by_action[run.actions[i]]);
    }
    episodes += run.stretches.back().back().episode + 1;
  }
  ordered_json actions = ordered_json::array();
  for (const auto& [action, counts] : by_action) actions.push_back(ActionJson(action, counts));
  const std::uint64_t parts = store.num_parts();
  const double per_part =
      parts > 0 ? static_cast<double>(store.bytes()) / static_cast<double>(parts) : 0.0;
  ordered_json stats{{"schema", "hires/experience_stats"},
                     {"version", 1},
                     {"parts", parts},
                     {"runs", runs.size()},
                     {"episodes", episodes},
                     {"bytes_per_part", per_part},
                     {"samples_per_second", RateOf(runs)},
                     {"actions", actions}};
  *text = TextOf(stats);
  return stats;
}

}  // namespace hires::lab
