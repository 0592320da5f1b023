#include "lab/src/publish/publish.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "lab/src/publish/published_results.h"
#include "lab/src/publish/results_page.h"

namespace hires::lab {
namespace {

std::string PagePath(const std::string& package) { return package + "/docs/results.md"; }
std::string DetailsPath(const std::string& package) {
  return package + "/lab/docs/results_details.md";
}

/// An hour of playing must not end at a file that cannot be written.
void RequireWritable(const std::string& package, const std::string& version) {
  const std::string folder = package + "/lab/results";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw base::ConfigError(folder + ": cannot be made: " + error.message());
  for (const std::string& path :
       {ResultsPath(package, version), PagePath(package), DetailsPath(package)}) {
    base::RequireReplaceable(path);
  }
}

/// Without the plays that would be played.
PlaysOrder WithAnswers(PlaysOrder order, PlayStore* store) {
  std::vector<Play> there;
  for (const Play& play : order.plays) {
    store->KeyOf(play);
    if (store->Find(play)) there.push_back(play);
  }
  order.plays = std::move(there);
  order.again = false;
  return order;
}

}  // namespace

std::vector<std::string> WritePages(const PublishCatalogue& catalogue, const std::string& package) {
  const std::string path = NewestResults(package);
  const PublishedResults results = ReadResults(path);
  const std::string page = ResultsPage(catalogue, results);
  base::ReplaceTextFile(DetailsPath(package), DetailsPage(catalogue, results));
  base::ReplaceTextFile(PagePath(package), page);
  return {path, PagePath(package), DetailsPath(package)};
}

PlaysDone Publish(const PublishCatalogue& catalogue, const PlaysOrder& order,
                  const std::string& version, PlayStore* store, Unfinished unfinished) {
  RequireWritable(order.package, version);
  const bool is_all = unfinished == Unfinished::kIsPlayed;
  PlaysDone done = PlayAll(is_all ? order : WithAnswers(order, store), store);
  if (done.is_cancelled || !done.missing.empty()) return done;
  const PublishedResults results = ResultsOf(catalogue, done, version);
  base::ReplaceTextFile(ResultsPath(order.package, version), ToJson(results).dump(1) + "\n");
  WritePages(catalogue, order.package);
  return done;
}

}  // namespace hires::lab
