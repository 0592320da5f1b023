#include "lab/src/verbs/experiences_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/whole_number.h"
#include "lab/src/experience/experience_report.h"
#include "reports/text/report_json.h"
#include "hires/knowledge/experience.h"

namespace hires::lab {
namespace {

using knowledge::ExperienceStore;

constexpr double kLatest = 1e10;  // [s], later than any clock

CLI::App* AddInner(CLI::App* verb, const char* name, const char* help,
                   ExperiencesOptions* options) {
  CLI::App* inner = verb->add_subcommand(name, help);
  inner->add_option("store", options->store, "file of experiences")->required();
  return inner;
}

knowledge::ExperienceQuery QueryOf(const ExperiencesOptions& options) {
  knowledge::ExperienceQuery query;
  if (!options.state.empty()) query.state = knowledge::ParseToppleState(options.state);
  if (options.episode >= 0) query.episode = static_cast<std::uint32_t>(options.episode);
  if (options.export_verb->count("--from") > 0) query.from = options.from;
  if (options.export_verb->count("--to") > 0) query.to = options.to;
  if (query.from > query.to) {
    throw base::ConfigError(fmt::format("--from {} is later than --to {}; wanted a time span [s]",
                                        query.from, query.to));
  }
  query.action = options.action;
  query.run = options.run;
  return query;
}

/// What parts of a run, or of all, can be asked for by.
struct NamesOfParts {
  std::set<std::string> runs;  // of all parts
  std::set<std::string> actions;
  std::set<std::uint32_t> episodes;
};

NamesOfParts NamesIn(const ExperienceStore& store, const std::string& run) {
  NamesOfParts names;
  store.ForEach({}, [&](const ExperienceStore::Stored& stored) {
    names.runs.insert(*stored.run);
    if (!run.empty() && *stored.run != run) return;
    if (!stored.action->empty()) names.actions.insert(*stored.action);
    names.episodes.insert(stored.part.episode);
  });
  return names;
}

[[noreturn]] void FailWithout(const ExperiencesOptions& options, const std::string& option,
                              const std::string& why) {
  throw base::ConfigError(fmt::format("{}: {}: {}", options.store, option, why));
}

/// Where no part was found: refuses a run that is not in the store, and an action or an episode
/// that is not in it, or not in that run. Each of these may be there with no part that has them
/// all, the state and the time: that is an answer.
void CheckNames(const ExperienceStore& store, const ExperiencesOptions& options) {
  const NamesOfParts names = NamesIn(store, options.run);
  const std::string of_run = options.run.empty() ? "" : fmt::format(" of run '{}'", options.run);
  if (!options.run.empty() && names.runs.count(options.run) == 0) {
    FailWithout(options, "--run",
                base::UnknownName("run", options.run, {names.runs.begin(), names.runs.end()}));
  }
  const bool has_action = std::any_of(
      names.actions.begin(), names.actions.end(),
      [&](const std::string& action) { return action.find(options.action) != std::string::npos; });
  if (!options.action.empty() && !has_action) {
    FailWithout(
        options, "--action" + of_run,
        base::UnknownName("action", options.action, {names.actions.begin(), names.actions.end()}));
  }
  const bool has_episode =
      options.episode < 0 || names.episodes.count(static_cast<std::uint32_t>(options.episode)) > 0;
  if (has_episode) return;
  FailWithout(
      options, "--episode" + of_run,
      names.episodes.empty()
          ? fmt::format("no part is of episode {}; the store has none", options.episode)
          : fmt::format("no part is of episode {}; wanted one from {} to {}", options.episode,
                        *names.episodes.begin(), *names.episodes.rbegin()));
}

int Export(const ExperiencesOptions& options) {
  const ExperienceStore store(options.store, ExperienceStore::Mode::kRead);
  std::string text;
  std::size_t lines = 0;
  store.ForEach(QueryOf(options), [&](const ExperienceStore::Stored& stored) {
    text += knowledge::CsvOf(stored.part);
    text += '\n';
    ++lines;
  });
  if (lines == 0) CheckNames(store, options);
  base::ReplaceTextFile(options.csv, text);
  std::cout << fmt::format("{} parts in {}\n", lines, options.csv);
  return cli::kExitRecommended;
}

int Told(const ExperiencesOptions& options, const std::string& text,
         const nlohmann::ordered_json& json) {
  std::cout << text;
  if (!options.json.empty()) reports::WriteJson(json, options.json);
  return cli::kExitRecommended;
}

}  // namespace

void AddExperiencesVerb(CLI::App* app, ExperiencesOptions* o) {
  o->verb = app->add_subcommand("experiences",
                                "what loads on the tray went through: export, count, analyse");
  o->verb->require_subcommand(1);
  o->export_verb = AddInner(o->verb, "export", "write parts as CSV (dissertation, Listing 5.4)", o);
  o->export_verb->add_option("--csv", o->csv, "file to write, or to replace when it is whole")
      ->required();
  o->export_verb->add_option("--state", o->state, "notopple, shaking or topple");
  for (const auto& [option, bound] : {std::pair("--from", &o->from), std::pair("--to", &o->to)}) {
    o->export_verb->add_option(option, *bound, "[s] of the run, included")
        ->check(cli::NumberBetween(-kLatest, kLatest));
  }
  o->export_verb->add_option("--action", o->action, "any part of the action's text");
  o->export_verb->add_option("--run", o->run, "such as fast/3");
  o->export_verb->add_option("--episode", o->episode, "of each run")
      ->check(cli::NumberBetween(0, 1000000000));
  o->stats_verb = AddInner(o->verb, "stats", "parts by action and state, falls, episodes, size", o);
  o->stats_verb->add_option("--json", o->json, "write everything to this file, for machines");
  o->analyse_verb =
      AddInner(o->verb, "analyse", "what filters do, and which dynamics predict a fall", o);
  o->analyse_verb->add_option("--json", o->json, "write everything to this file, for machines");
  o->analyse_verb->add_option("--seed", o->seed, "of noise and resampling")->check(cli::WholeNumber());
}

int RunExperiencesVerb(const ExperiencesOptions& options) {
  cli::CheckOutputs({{"--csv", options.csv}, {"--json", options.json}},
                    {{"store", options.store}});
  if (*options.export_verb) return Export(options);
  const ExperienceStore store(options.store, ExperienceStore::Mode::kRead);
  std::string text;
  const nlohmann::ordered_json json = *options.stats_verb
                                          ? StatsOf(store, &text)
                                          : AnalysisOf(store, options.seed, &text);
  return Told(options, text, json);
}

}  // namespace hires::lab
