#pragma once

#include <string>
#include <vector>

#include "lab/src/publish/publish_catalogue.h"
#include "lab/src/reproduce/play_runner.h"
#include "lab/src/reproduce/play_store.h"

namespace hires::lab {

/// Writes docs/results.md and lab/docs/results_details.md of the package from its newest results.
/// @return the paths of results, which are read, page and details.
/// @throws base::ConfigError for results that lack what the rows name.
std::vector<std::string> WritePages(const PublishCatalogue& catalogue, const std::string& package);

/// What is published while answers are missing.
enum class Unfinished {
  kIsPlayed,   ///< nothing, before all of it is played
  kIsWritten,  ///< what there is, and that the rest was not played; nothing is played
};

/// Plays what has no answer; once all have one, writes lab/results/<version>.json of the order's
/// package, and the pages.  @throws base::ConfigError if a file cannot be written, before anything
/// is played, or an answer lacks a number.
PlaysDone Publish(const PublishCatalogue& catalogue, const PlaysOrder& order,
                  const std::string& version, PlayStore* store,
                  Unfinished unfinished = Unfinished::kIsPlayed);

}  // namespace hires::lab
