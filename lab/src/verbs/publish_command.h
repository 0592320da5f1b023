#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab publish`.
struct PublishOptions {
  std::string catalogue, results;
  bool is_page_only{false}, is_unfinished{false}, again{false}, is_list{false}, quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddPublishVerb(CLI::App* app, PublishOptions* options);

/// Plays what this version publishes and has no answer yet, and writes results and pages.
/// @return kExitRecommended: they are written; kExitNoWorker: a play failed, and nothing is;
/// kExitCancelled.  @throws base::ConfigError for bad input.
int RunPublishVerb(const PublishOptions& options, const std::string& package_folder,
                   const std::function<bool()>& cancelled);

}  // namespace hires::lab
