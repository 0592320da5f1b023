#include "lab/src/verbs/publish_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/exit_code.h"
#include "cli/report_output.h"
#include "hires/base/files/writer_lock.h"
#include "lab/src/product_program.h"
#include "lab/src/publish/publish.h"
#include "lab/src/verbs/plays_display.h"

namespace hires::lab {
namespace {

PlaysDone PublishShown(const PublishCatalogue& catalogue, PlaysOrder order,
                       const PublishOptions& options, PlayStore* store) {
  PlaysDisplay display;
  if (!options.quiet) {
    order.on_progress = [&](const PlaysProgress& progress) { display.Show(progress); };
  }
  PlaysDone done = Publish(catalogue, order, HIRES_VERSION, store,
                           options.is_unfinished ? Unfinished::kIsWritten : Unfinished::kIsPlayed);
  display.Clear();
  return done;
}

}  // namespace

void AddPublishVerb(CLI::App* app, PublishOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "publish", "play what this version publishes, and write lab/results and docs/results.md");
  verb->add_flag("--page-only", options->is_page_only,
                 "play nothing: write the pages again from the newest lab/results");
  verb->add_flag("--unfinished", options->is_unfinished,
                 "play nothing: write what has an answer, and that the rest was not played");
  verb->add_option("--results", options->results,
                   "folder of the answers; default: hires/results among the user's caches");
  verb->add_option("--catalogue", options->catalogue,
                   "another file instead of lab/config/publish.yaml");
  verb->add_flag("--again", options->again, "play anew what has an answer");
  verb->add_flag("--list", options->is_list, "say what is played, and how long it takes");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunPublishVerb(const PublishOptions& options, const std::string& package_folder,
                   const std::function<bool()>& cancelled) {
  const PublishCatalogue catalogue = ReadPublishCatalogue(
      options.catalogue.empty() ? package_folder + "/lab/config/publish.yaml" : options.catalogue);
  if (options.is_page_only) {
    const std::vector<std::string> paths = WritePages(catalogue, package_folder);
    std::cout << "from " << paths[0] << '\n';
    cli::SaySaved({paths[1], paths[2]});
    return cli::kExitRecommended;
  }
  PlaysOrder order;
  order.plays = PlaysOf(catalogue);
  order.lab_program = std::filesystem::read_symlink("/proc/self/exe").string();
  order.program = ProductProgram();
  order.package = package_folder;
  order.again = options.again;
  order.cancelled = cancelled;
  const std::string results = PlaysFolder("publish", options.results);
  PlayStore store({results, package_folder, HashOfFile(order.lab_program)});
  if (options.is_list) {
    PrintPlays(order.plays, &store);
    return cli::kExitRecommended;
  }
  const base::WriterLock lock(results + "/results", "name another folder with --results");
  const PlaysDone done = PublishShown(catalogue, std::move(order), options, &store);
  for (const auto& [play, why] : done.missing) std::cout << fmt::format("{}: {}\n", play, why);
  SayOtherBuilds(done, store.build());
  if (done.is_cancelled) return cli::kExitCancelled;
  if (done.missing.empty()) return cli::kExitRecommended;
  std::cout << "nothing was written: results are published whole\n";
  return cli::kExitNoWorker;
}

}  // namespace hires::lab
