#include "lab/src/series/series_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;
using Table = std::vector<std::vector<std::string>>;

constexpr std::size_t kBeginOfCause = 30, kEndOfCause = 60;  // characters in a table's cell

double PerSecond(double count, double seconds) { return seconds > 0.0 ? count / seconds : 0.0; }

std::string InfoLine(const std::string& text) { return "=[ INFO]: " + text + '\n'; }

bool Is(const SeriesRun& run, SeriesOutcome outcome) { return run.outcome == ToString(outcome); }

/// The execution monitor says so, and what really happened agrees.
bool IsDone(const SeriesRun& run) {
  return Is(run, SeriesOutcome::kSucceeded) && run.fallen.empty() && run.touched.empty();
}

/// What the execution monitor does not know.
std::string TruthText(const SeriesRun& run) {
  std::string text = run.touched;
  for (const std::string& thing : run.fallen) text += (text.empty() ? "" : "; ") + thing + " fell";
  return text;
}

std::vector<std::string> Episodes(const SeriesReport& report) {
  std::vector<std::string> names;
  for (const SeriesRun& run : report.runs) {
    if (!run.episode.empty()) names.push_back(run.episode);
  }
  return names;
}

std::vector<SeriesRun> Succeeded(const SeriesReport& report) {
  std::vector<SeriesRun> succeeded;
  std::copy_if(report.runs.begin(), report.runs.end(), std::back_inserter(succeeded),
               [](const SeriesRun& run) { return Is(run, SeriesOutcome::kSucceeded); });
  return succeeded;
}

std::string NumberOrUnknown(const std::optional<double>& number, int decimals) {
  return number ? fmt::format("{:.{}f}", *number, decimals) : "unknown";
}

std::string AveragesTable(const SeriesReport& report) {
  Table table{
      {"averages over", "runs", "simulated", "fluents", "a second", "new fluents", "a second"}};
  const auto add = [&](const std::string& which, const SeriesAverages& averages) {
    table.push_back({which, std::to_string(averages.runs),
                     fmt::format("{:.1f} s", averages.simulated_seconds),
                     fmt::format("{:.1f}", averages.fluents),
                     fmt::format("{:.2f}", averages.fluents_per_second),
                     NumberOrUnknown(averages.new_fluents, 1),
                     NumberOrUnknown(averages.new_fluents_per_second, 2)});
  };
  add("all runs", AveragesOf(report.runs));
  add("those that succeeded", AveragesOf(Succeeded(report)));
  return reports::FormatTable(table) +
         "(a second: fluents of all these runs / their simulated time; new: without those that "
         "were known before the run)\n";
}

/// "0 2"
std::string ChoicesText(const std::vector<int>& choices) {
  std::vector<std::string> words;
  for (const int choice : choices) words.push_back(std::to_string(choice));
  return base::Join(words, " ");
}

/// What was first and what was last: the last reason is the one that counts.
std::string Short(const std::string& text) {
  if (text.size() <= kBeginOfCause + kEndOfCause) return text;
  return text.substr(0, kBeginOfCause) + " ... " + text.substr(text.size() - kEndOfCause);
}

std::string RestartsText(const SeriesRun& run) {
  const std::size_t restarts = run.broken_tries.size() - (Is(run, SeriesOutcome::kBroken) ? 1 : 0);
  return restarts == 0 ? "" : std::to_string(restarts);
}

std::string RunTable(const SeriesReport& report) {
  Table table{{"run", "choices", "seed", "outcome", "simulated", "fluents", "restarts", "cause",
               "in truth"}};
  for (const SeriesRun& run : report.runs) {
    table.push_back({std::to_string(run.run), ChoicesText(run.choices), std::to_string(run.seed),
                     run.outcome, fmt::format("{:.1f} s", run.simulated_seconds),
                     std::to_string(run.fluents), RestartsText(run), Short(run.cause),
                     Short(TruthText(run))});
  }
  return reports::FormatTable(table);
}

int CountOf(const SeriesReport& report, SeriesOutcome outcome) {
  return static_cast<int>(std::count_if(report.runs.begin(), report.runs.end(),
                                        [&](const SeriesRun& run) { return Is(run, outcome); }));
}

const std::vector<SeriesOutcome>& AllOutcomes() {
  static const std::vector<SeriesOutcome> all{SeriesOutcome::kSucceeded, SeriesOutcome::kFailed,
                                              SeriesOutcome::kImpossible, SeriesOutcome::kBroken};
  return all;
}

int CountDone(const SeriesReport& report) {
  return static_cast<int>(std::count_if(report.runs.begin(), report.runs.end(), IsDone));
}

std::string OutcomeTable(const SeriesReport& report) {
  Table table{{"outcome", "runs", "share", "95 % interval (Wilson)"}};
  const int all = static_cast<int>(report.runs.size());
  const auto add = [&](const std::string& what, int count) {
    const Interval share = WilsonInterval(count, all);
    table.push_back({what, std::to_string(count), fmt::format("{:.0f} %", 100.0 * share.estimate),
                     fmt::format("{:.0f} .. {:.0f} %", 100.0 * share.lower, 100.0 * share.upper)});
  };
  for (const SeriesOutcome outcome : AllOutcomes())
    add(ToString(outcome), CountOf(report, outcome));
  add("succeeded, and in truth nothing fell or was touched", CountDone(report));
  return reports::FormatTable(table);
}

std::string ChoiceTable(const SeriesReport& report) {
  Table table{{"group", "choice", "succeeded in truth", "of", "share", "95 % interval (Wilson)",
               "which is"}};
  for (const ChoiceShare& each : SharesByChoice(report)) {
    table.push_back(
        {each.group, std::to_string(each.choice), std::to_string(each.succeeded),
         std::to_string(each.played), fmt::format("{:.0f} %", 100.0 * each.share.estimate),
         fmt::format("{:.0f} .. {:.0f} %", 100.0 * each.share.lower, 100.0 * each.share.upper),
         base::Join(each.members, "; ")});
  }
  return reports::FormatTable(table);
}

/// "poseTable1 hasX 1 hasY -2"; zeros are left out.
std::string MemberText(const knowledge::PoseModification& modification, std::size_t choice) {
  std::string text = modification.instance;
  for (const auto& delta : modification.modifications) {
    if (delta.choices[choice] != 0.0) {
      text += fmt::format(" {} {:g}", delta.property, delta.choices[choice]);
    }
  }
  return text == modification.instance ? text + " as it is" : text;
}

std::vector<std::string> MembersOf(const ScenarioSeries& series, const SeriesGroup& group,
                                   std::size_t choice) {
  std::vector<std::string> members;
  for (const auto& modification : series.modifications) {
    if (modification.group == group.name) members.push_back(MemberText(modification, choice));
  }
  for (const auto& setting : series.settings) {
    if (setting.group != group.name) continue;
    for (const auto& [key, texts] : setting.values) members.push_back(key + " " + texts[choice]);
  }
  return members;
}

ordered_json AveragesJson(const SeriesAverages& averages) {
  const auto number = [&](const std::optional<double>& value) {
    return value && averages.runs > 0 ? ordered_json(*value) : ordered_json();
  };
  return {{"runs", averages.runs},
          {"mean_simulated_seconds", number(averages.simulated_seconds)},
          {"mean_fluents", number(averages.fluents)},
          {"fluents_per_second", number(averages.fluents_per_second)},
          {"mean_new_fluents", number(averages.new_fluents)},
          {"new_fluents_per_second", number(averages.new_fluents_per_second)}};
}

ordered_json ShareJson(const ChoiceShare& each) {
  return {{"group", each.group},         {"choice", each.choice},    {"members", each.members},
          {"succeeded", each.succeeded}, {"played", each.played},    {"share", each.share.estimate},
          {"lower", each.share.lower},   {"upper", each.share.upper}};
}

std::string CsvCell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

}  // namespace

SeriesAverages AveragesOf(const std::vector<SeriesRun>& runs) {
  SeriesAverages averages;
  double seconds = 0.0, fluents = 0.0, known = 0.0;
  bool tell_all = true;
  for (const SeriesRun& run : runs) {
    if (run.episode.empty()) continue;
    ++averages.runs;
    seconds += run.simulated_seconds;
    fluents += static_cast<double>(run.fluents);
    known += static_cast<double>(run.known_fluents.value_or(0));
    tell_all = tell_all && run.known_fluents.has_value();
  }
  const double num = std::max(1, averages.runs);
  averages.simulated_seconds = seconds / num;
  averages.fluents = fluents / num;
  averages.fluents_per_second = PerSecond(fluents, seconds);
  if (tell_all) {
    averages.new_fluents = (fluents - known) / num;
    averages.new_fluents_per_second = PerSecond(fluents - known, seconds);
  }
  return averages;
}

std::vector<ChoiceShare> SharesByChoice(const SeriesReport& report) {
  std::vector<ChoiceShare> shares;
  for (std::size_t g = 0; g < report.series.groups.size(); ++g) {
    const SeriesGroup& group = report.series.groups[g];
    std::map<int, ChoiceShare> by_choice;  // those that were played: there may be a million
    for (const SeriesRun& run : report.runs) {
      if (Is(run, SeriesOutcome::kBroken)) continue;
      ChoiceShare& share = by_choice[run.choices.at(g)];
      share.played += 1;
      share.succeeded += IsDone(run) ? 1 : 0;
    }
    for (auto& [choice, share] : by_choice) {
      share.group = group.name;
      share.choice = choice;
      share.members = MembersOf(report.series, group, static_cast<std::size_t>(choice));
      share.share = WilsonInterval(share.succeeded, share.played);
      shares.push_back(share);
    }
  }
  return shares;
}

std::string RunSummary(const SeriesRun& run) {
  std::string text = fmt::format("= RUN {} SUMMARY =\n", run.run);
  text += InfoLine(run.episode.empty() ? "Scenario episode is: none was kept"
                                       : fmt::format("Scenario episode is: '{}'", run.episode));
  text += InfoLine(fmt::format("Scenario instruction: '{}'", run.instruction));
  text += InfoLine(fmt::format("Total (sim) time used: {:.2f} seconds", run.simulated_seconds));
  text += InfoLine(fmt::format("Total number of Fluents used: {}", run.fluents));
  text += InfoLine(fmt::format("Average ratio of (Fluents/sec): {:.2f}",
                               PerSecond(static_cast<double>(run.fluents), run.simulated_seconds)));
  text += InfoLine(
      fmt::format("Outcome: {}{}", run.outcome, run.cause.empty() ? "" : ": " + run.cause));
  for (const std::string& broken : run.broken_tries)
    text += InfoLine("A try broke down: " + broken);
  return text;
}

std::string SeriesSummary(const SeriesReport& report) {
  const std::vector<std::string> episodes = Episodes(report);
  std::string text = "= TEST SUMMARY =\n=[ INFO]: ";
  text += base::Counted(episodes.size(), "episode") + " created during test with names:";
  for (const std::string& episode : episodes) text += " '" + episode + "'";
  text += '\n' + InfoLine(fmt::format("Average Fluents per episode: {:.2f}",
                                      AveragesOf(report.runs).fluents));
  text +=
      InfoLine(fmt::format("{} {} now in repository '{}'", base::Counted(report.stored, "episode"),
                           report.stored == 1 ? "is" : "are", report.repository));
  text += '\n' + AveragesTable(report) + '\n' + RunTable(report) + '\n' + OutcomeTable(report);
  if (!SharesByChoice(report).empty()) text += '\n' + ChoiceTable(report);
  return text;
}

std::string SeriesCsv(const SeriesReport& report) {
  std::string text = "run";
  for (const SeriesGroup& group : report.series.groups) text += "," + CsvCell(group.name);
  text +=
      ",seed,instruction,scenario,truth,outcome,failure,cause,restarts,episode,simulated_seconds,"
      "fluents,known_fluents,fallen,touched\n";
  for (const SeriesRun& run : report.runs) {
    text += std::to_string(run.run);
    for (const int choice : run.choices) text += fmt::format(",{}", choice);
    text += fmt::format(",{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", run.seed,
                        CsvCell(run.instruction), CsvCell(run.scenario), CsvCell(run.truth),
                        run.outcome, run.failure, CsvCell(run.cause),
                        RestartsText(run).empty() ? "0" : RestartsText(run), CsvCell(run.episode),
                        run.simulated_seconds, run.fluents,
                        run.known_fluents ? std::to_string(*run.known_fluents) : "",
                        base::Join(run.fallen, " "), CsvCell(run.touched));
  }
  return text;
}

ordered_json ToJson(const SeriesReport& report) {
  ordered_json groups = ordered_json::array(), runs = ordered_json::array(),
               shares = ordered_json::array(), outcomes = ordered_json::object();
  for (const SeriesGroup& group : report.series.groups) {
    groups.push_back(
        {{"name", group.name}, {"choices", group.choices}, {"members", group.members}});
  }
  for (const SeriesRun& run : report.runs) runs.push_back(ToJson(run));
  for (const ChoiceShare& share : SharesByChoice(report)) shares.push_back(ShareJson(share));
  for (const SeriesOutcome outcome : AllOutcomes()) {
    outcomes[ToString(outcome)] = CountOf(report, outcome);
  }
  outcomes["succeeded_in_truth"] = CountDone(report);
  const SeriesAverages all = AveragesOf(report.runs);
  return {
      {"series", report.series.name},
      {"groups", groups},
      {"outcomes", outcomes},
      {"mean_fluents", all.fluents},
      {"mean_fluents_per_second", all.fluents_per_second},
      {"mean_simulated_seconds", all.simulated_seconds},
      {"averages",
       {{"all", AveragesJson(all)}, {"succeeded", AveragesJson(AveragesOf(Succeeded(report)))}}},
      {"stored", report.stored},
      {"shares", shares},
      {"runs", runs}};
}

}  // namespace hires::lab
