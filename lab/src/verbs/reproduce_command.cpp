#include "lab/src/verbs/reproduce_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/exit_code.h"
#include "hires/base/error.h"
#include "hires/base/files/writer_lock.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "lab/src/product_program.h"
#include "lab/src/reproduce/catalogue.h"
#include "lab/src/reproduce/judge.h"
#include "lab/src/reproduce/play_runner.h"
#include "lab/src/reproduce/play_store.h"
#include "lab/src/verbs/plays_display.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

std::string CataloguePath(const ReproduceOptions& options, const std::string& package) {
  return options.catalogue.empty() ? package + "/lab/config/reproduce.yaml" : options.catalogue;
}

int List(const std::vector<CatalogueItem>& items, const std::vector<Play>& plays,
         PlayStore* store) {
  std::vector<std::vector<std::string>> rows{{"section", "what", "title", "plays"}};
  for (const CatalogueItem& item : items) {
    rows.push_back({item.section, item.name, item.title, base::Join(item.plays, ", ")});
  }
  std::cout << reports::FormatTable(rows) << '\n';
  PrintPlays(plays, store);
  return cli::kExitRecommended;
}

std::map<std::string, int> CountVerdicts(const std::vector<JudgedItem>& items) {
  std::map<std::string, int> counts;
  for (const JudgedItem& item : items) ++counts[ToString(item.verdict)];
  return counts;
}

ordered_json PlaysJson(const PlaysDone& done, const std::string& build) {
  ordered_json plays = ordered_json::object();
  for (const auto& [name, answer] : done.answers) {
    plays[name] = {{"command", answer.command},      {"key", answer.key},
                   {"build", answer.build},          {"this_build", answer.build == build},
                   {"wall_seconds", answer.seconds}, {"answer", answer.content}};
  }
  return plays;
}

ordered_json AnswerJson(const std::vector<JudgedItem>& items, const PlaysDone& done,
                        const std::string& build) {
  return {{"verdicts", CountVerdicts(items)},
          {"items", ToJson(items)},
          {"missing", done.missing},
          {"plays", PlaysJson(done, build)}};
}

void Print(const std::vector<JudgedItem>& items, const PlaysDone& done, const std::string& build) {
  std::cout << VerdictTable(items) << '\n';
  std::vector<std::string> counts;
  for (const auto& [verdict, count] : CountVerdicts(items)) {
    counts.push_back(fmt::format("{} {}", count, verdict));
  }
  std::cout << fmt::format(
      "{} {}: {}\n", items.size(),
      items.size() == 1 ? "table, figure or section" : "tables, figures and sections",
      base::Join(counts, ", "));
  for (const auto& [play, why] : done.missing) std::cout << fmt::format("{}: {}\n", play, why);
  SayOtherBuilds(done, build);
}

}  // namespace

void AddReproduceVerb(CLI::App* app, ReproduceOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "reproduce", "play the dissertation's experiments and put each result beside the published");
  verb->add_option("what", options->wanted,
                   "all, sections (6.1), or tables, figures and listings ('Table 6.5'), as --list "
                   "names them; default: all");
  cli::AddReportOptions(verb, &options->report);
  verb->add_option("--results", options->results,
                   "folder of the answers; default: hires/results among the user's caches");
  verb->add_option("--catalogue", options->catalogue,
                   "another file instead of lab/config/reproduce.yaml");
  verb->add_flag("--again", options->again, "play anew what has an answer");
  verb->add_flag("--list", options->is_list, "say what there is and what is played for it");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunReproduceVerb(const ReproduceOptions& options, const std::string& package_folder,
                     const std::function<bool()>& cancelled) {
  const std::string path = CataloguePath(options, package_folder);
  const Catalogue catalogue = ReadCatalogue(path);
  const std::vector<CatalogueItem> items =
      ItemsOf(catalogue, options.wanted.empty() ? std::vector<std::string>{"all"} : options.wanted);
  PlaysOrder order;
  order.plays = PlaysFor(catalogue, items);
  order.lab_program = std::filesystem::read_symlink("/proc/self/exe").string();
  order.program = ProductProgram();
  const std::string results = PlaysFolder("reproduce", options.results);
  PlayStore store({results, package_folder, HashOfFile(order.lab_program)});
  if (options.is_list) return List(items, order.plays, &store);
  const base::WriterLock lock(results + "/results", "name another folder with --results");
  cli::CheckReport(options.report, {{"catalogue", path}});
  cli::ReportOrigin origin;
  origin.verb = "reproduce";
  if (cli::IsWanted(options.report)) origin.inputs = {{"catalogue", path}};
  order.package = package_folder;
  order.again = options.again;
  order.cancelled = cancelled;
  PlaysDisplay display;
  if (!options.quiet) {
    order.on_progress = [&](const PlaysProgress& progress) { display.Show(progress); };
  }
  const PlaysDone done = PlayAll(order, &store);
  display.Clear();
  std::map<std::string, ordered_json> answers;
  for (const auto& [name, answer] : done.answers) answers[name] = answer.content;
  std::vector<JudgedItem> judged;
  for (const CatalogueItem& item : items) {
    judged.push_back(Judge(item, answers, done.missing));
  }
  Print(judged, done, store.build());
  if (done.is_cancelled) return cli::kExitCancelled;
  cli::WriteReport(options.report, origin, AnswerJson(judged, done, store.build()));
  const bool is_whole = std::none_of(judged.begin(), judged.end(), [](const JudgedItem& item) {
    return item.verdict == Verdict::kNotPlayed;
  });
  return is_whole ? cli::kExitRecommended : cli::kExitNoWorker;
}

}  // namespace hires::lab
