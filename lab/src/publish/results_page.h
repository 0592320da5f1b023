#pragma once

#include <string>

#include "lab/src/publish/publish_catalogue.h"
#include "lab/src/publish/published_results.h"

namespace hires::lab {

/// docs/results.md: the introduction, one table, remarks. All numbers come from the results.
/// @throws base::ConfigError for rows that name what the results lack.
std::string ResultsPage(const PublishCatalogue& catalogue, const PublishedResults& results);

/// lab/docs/results_details.md: every number, below the row that it stands in, and how it came
/// about.  @throws base::ConfigError likewise.
std::string DetailsPage(const PublishCatalogue& catalogue, const PublishedResults& results);

}  // namespace hires::lab
