#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/publish/publish_catalogue.h"
#include "lab/src/reproduce/play_runner.h"

namespace hires::lab {

/// What is published of a version.
struct PublishedResults {
  std::string version;  ///< "0.2.0"
  std::vector<PublishedNumber> numbers;
};

/// The latest day on which a number was played for this version; empty: none was.
std::string DateOf(const PublishedResults& results);

/// Numbers of the answers, in the catalogue's order, and the kept ones. Those of plays that have no
/// answer have no value.
/// @throws base::ConfigError naming all fields that answers lack.
PublishedResults ResultsOf(const PublishCatalogue& catalogue, const PlaysDone& done,
                           const std::string& version);

/// A play's command as one types it: without where its answer is written.
std::string TypedCommand(const Play& play);

nlohmann::ordered_json ToJson(const PublishedResults& results);

/// What ToJson() wrote.  @throws base::ConfigError naming file and entry.
PublishedResults ReadResults(const std::string& path);

/// lab/results/<version>.json of a package.
std::string ResultsPath(const std::string& package, const std::string& version);

/// The results of the latest version that has some.
/// @throws base::ConfigError if there are none.
std::string NewestResults(const std::string& package);

}  // namespace hires::lab
