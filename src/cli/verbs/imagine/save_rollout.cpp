#include "cli/verbs/imagine/save_rollout.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/imagination/rollout_choice.h"
#include "reports/film/rollout_film.h"

namespace hires::cli {
namespace {

using imagination::RolloutRecording;

constexpr int kStripPictures = 6;  // of pages; of --strip by default

std::string StripFile(const std::string& html, const std::string& which) {
  const std::string stem = std::filesystem::path(html).replace_extension().string();
  return fmt::format("{}_{}.png", stem, which);
}

/// @throws base::ConfigError for one that no answer to the query has.
void RequireRollout(const std::string& option, const std::string& which,
                    const ImagineQuery& query) {
  try {
    imagination::RequireRollout(imagination::ParseRolloutChoice(which),
                                base::Combinations(query.action).size(), query.scheduler.rollouts);
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(fmt::format("{} {}: {}", option, which, error.what()));
  }
}

/// What is written has one format, whatever the file is called.
void RequireEnding(const std::string& option, const std::string& file, const std::string& ending) {
  const std::string its = std::filesystem::path(file).extension().string();
  if (its.empty() || base::ToLower(its) == ending) return;  // /dev/null has none
  throw base::ConfigError(fmt::format(
      "{0} {1}: ends in {2}, wanted {3}, the format that {0} writes; give it {4}", option, file,
      its, ending, std::filesystem::path(file).replace_extension(ending).string()));
}

/// A rollout of an answer, played again.
struct Replayed {
  imagination::PickedRollout picked;
  RolloutRecording recording;
};

/// Nothing if it was cancelled.
std::optional<Replayed> Replay(const std::string& which, const imagination::Report& report,
                               const imagination::RolloutSetup& setup,
                               const std::function<bool()>& cancelled,
                               imagination::RolloutWatcher* watcher) {
  try {
    const imagination::PickedRollout picked = imagination::PickRollout(
        imagination::ParseRolloutChoice(which), report.ranking, imagination::TiltsIn(setup));
    auto recording = imagination::ReplayRollout(setup, report.ranking[picked.rank - 1],
                                                picked.index, cancelled, watcher);
    if (!recording) return std::nullopt;
    return Replayed{picked, std::move(*recording)};
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(std::string("--save-rollout: ") + error.what());
  }
}

/// @param beside  may be null.
void WritePictures(const SaveRolloutOptions& options, const imagination::RolloutSetup& setup,
                   const RolloutRecording& recording, const RolloutRecording* beside, int threads) {
  if (options.gif.empty() && options.strip.empty()) return;
  reports::FilmParams params;
  params.threads = threads;
  const reports::RolloutFilm film(setup, recording, params);
  if (beside != nullptr) {
    reports::WriteGif(film, reports::RolloutFilm(setup, *beside, params), options.gif);
  } else if (!options.gif.empty()) {
    reports::WriteGif(film, options.gif);
  }
  if (!options.strip.empty()) {
    reports::WriteStrip(film, options.strip_pictures, options.strip);
  }
}

void Print(const Replayed& replayed) {
  const RolloutRecording& recording = replayed.recording;
  std::cout << fmt::format("rollout {} of {} (alternative {}), seed {}:\n", recording.index,
                           ToString(recording.action), replayed.picked.rank, recording.seed);
  const base::Failure failure = imagination::FailureOf(recording.result);
  if (failure) std::cout << fmt::format("  {}\n", ToString(failure));
  for (const imagination::RolloutEvent& event : recording.events) {
    std::cout << fmt::format("{:8.2f} s  {}\n", event.time, event.text);
  }
}

}  // namespace

void AddSaveRolloutOptions(CLI::App* app, SaveRolloutOptions* o) {
  CLI::Option* which = app->add_option(
      "--save-rollout", o->which,
      "play one rollout again and save it: worst (of all), median, first_fall, or its number, of "
      "the first alternative in the table; of the third: worst@3");
  app->add_option("--csv", o->csv, "with --save-rollout: to this table, for plotting")
      ->needs(which);
  app->add_option(
         "--bag", o->bag,
         "with --save-rollout: to this bag, with the topics of a PR2 and markers, for `hires "
         "watch`, RViz, PlotJuggler, Foxglove")
      ->needs(which);
  CLI::Option* gif =
      app->add_option("--gif", o->gif, "with --save-rollout: as moving picture from two sides")
          ->needs(which);
  app->add_option("--beside", o->beside,
                  "with --gif: instead of the second side another rollout, named as the first")
      ->needs(gif);
  CLI::Option* strip =
      app->add_option("--strip", o->strip, "with --save-rollout: as PNG of moments side by side")
          ->needs(which);
  app->add_option("--strip-pictures", o->strip_pictures, "how many; default 6")
      ->check(NumberBetween(2, 24))
      ->needs(strip);
}

std::vector<VerbFile> FilesOf(const SaveRolloutOptions& options) {
  std::vector<VerbFile> files;
  for (const VerbFile& file :
       {VerbFile{"--csv", options.csv}, VerbFile{"--bag", options.bag},
        VerbFile{"--gif", options.gif}, VerbFile{"--strip", options.strip}}) {
    if (!file.path.empty()) files.push_back(file);
  }
  return files;
}

std::vector<std::string> StripFiles(const std::string& html) {
  std::error_code none_there;
  const bool is_device = std::filesystem::exists(html, none_there) &&
                         !std::filesystem::is_regular_file(html, none_there);
  if (html.empty() || is_device) return {};  // beside a device there is no room for pictures
  return {StripFile(html, "worst"), StripFile(html, "median")};
}

void CheckSaveRollout(const SaveRolloutOptions& options, const ImagineQuery& query,
                      const MakeRolloutBag& make_bag) {
  if (options.which.empty()) return;
  RequireEnding("--gif", options.gif, ".gif");
  RequireEnding("--strip", options.strip, ".png");
  RequireRollout("--save-rollout", options.which, query);
  if (!options.beside.empty()) RequireRollout("--beside", options.beside, query);
  if (FilesOf(options).empty()) {
    throw base::ConfigError(
        "--save-rollout: nowhere to save it to; add --gif FILE, --strip FILE, --csv FILE or --bag "
        "FILE");
  }
  if (!options.bag.empty() && !make_bag) {
    throw base::ConfigError("--bag: this build has no ROS to write bags with; use --csv FILE");
  }
}

void SaveRollout(const SaveRolloutOptions& options, int threads, QueryScene* scene,
                 const imagination::Report& report, const MakeRolloutBag& make_bag,
                 const std::function<bool()>& cancelled) {
  if (options.which.empty()) return;
  const imagination::RolloutSetup& setup = scene->rollouts();
  const std::unique_ptr<imagination::RolloutSaver> bag =
      options.bag.empty() ? nullptr : make_bag(options.bag, setup);
  const auto replayed = Replay(options.which, report, setup, cancelled, bag.get());
  std::optional<Replayed> beside;
  if (!options.beside.empty()) beside = Replay(options.beside, report, setup, cancelled, nullptr);
  if (!replayed || beside.has_value() == options.beside.empty()) return;
  const RolloutRecording& recording = replayed->recording;
  if (!options.csv.empty()) base::ReplaceTextFile(options.csv, imagination::ToCsv(recording));
  if (bag) bag->Save(recording);
  WritePictures(options, setup, recording, beside ? &beside->recording : nullptr, threads);
  Print(*replayed);
  if (beside) Print(*beside);
  for (const VerbFile& file : FilesOf(options)) std::cout << "saved to " << file.path << '\n';
}

std::vector<Strip> WriteStrips(const std::string& html, int threads, QueryScene* scene,
                               const imagination::Report& report,
                               const std::function<bool()>& cancelled) {
  if (StripFiles(html).empty()) return {};
  const imagination::RolloutSetup& setup = scene->rollouts();
  reports::FilmParams params;
  params.threads = threads;
  std::vector<Strip> strips;
  for (const auto& [which, what] : {std::pair{"worst", "The worst of all"},
                                    std::pair{"median", "The median of the first alternative"}}) {
    const bool has_median = report.ranking.front().evidence.median_rollout >= 0;
    if (which == std::string("median") && !has_median) continue;  // none came to its end
    const auto replayed = Replay(which, report, setup, cancelled, nullptr);
    if (!replayed) return {};
    const RolloutRecording& recording = replayed->recording;
    if (recording.samples.empty()) continue;  // it could not begin
    const std::string caption =
        fmt::format("{}: rollout {} of {}{}{}", what, recording.index, ToString(recording.action),
                    recording.events.empty() ? "" : "; last ",
                    recording.events.empty() ? "" : recording.events.back().text);
    strips.push_back({caption, StripFile(html, which)});
    reports::WriteStrip({setup, recording, params}, kStripPictures, strips.back().file);
  }
  return strips;
}

}  // namespace hires::cli
