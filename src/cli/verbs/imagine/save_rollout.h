#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/outputs.h"
#include "cli/verbs/imagine/imagine_query.h"
#include "cli/verbs/imagine/query_scene.h"
#include "hires/imagination/rollout_recording.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// One rollout of an answer, to be looked at.
struct SaveRolloutOptions {
  std::string which, csv, bag, gif, beside, strip;
  int strip_pictures{6};
};
void AddSaveRolloutOptions(CLI::App* app, SaveRolloutOptions* options);

/// The files that it is saved to, by their options.
std::vector<VerbFile> FilesOf(const SaveRolloutOptions& options);

/// Before anything is imagined.  @throws base::ConfigError: no such choice, a rollout
/// or an alternative that the query does not have, nowhere to save it to, a picture whose file ends
/// like another format, a bag that this build cannot write.
void CheckSaveRollout(const SaveRolloutOptions& options, const ImagineQuery& query,
                      const MakeRolloutBag& make_bag);

/// Plays the rollout again in the query's scene and saves it. Says where.
/// @throws base::ConfigError if the answer has no such rollout, or if what is played is none of
/// those that were imagined (workers with other files); then nothing is written.
void SaveRollout(const SaveRolloutOptions& options, int threads, QueryScene* scene,
                 const imagination::Report& report, const MakeRolloutBag& make_bag,
                 const std::function<bool()>& cancelled);

/// Pictures for a page.
struct Strip {
  std::string caption;
  std::string file;  ///< PNG, beside the page
};

/// Draws the worst rollout of all and the median one of the first alternative beside the page:
/// page.html gets page_worst.png and page_median.png. Nothing once it is cancelled.
/// @pre something was played.  @throws base::ConfigError as SaveRollout.
std::vector<Strip> WriteStrips(const std::string& html, int threads, QueryScene* scene,
                               const imagination::Report& report,
                               const std::function<bool()>& cancelled);

/// The files that WriteStrips() may write.
/// @param html  empty: no page, and no pictures.
std::vector<std::string> StripFiles(const std::string& html);

}  // namespace hires::cli
