#pragma once

#include <hires/ImagineGoal.h>
#include <hires/ImagineResult.h>

#include <functional>

#include "cli/verbs/imagine/imagine_query.h"
#include "hires/imagination/report.h"

namespace hires_ros {

/// Asks the running imagination client (action `imagine`).
/// @throws hires::base::ConfigError if there is no master or no client, the request is refused, or
/// it needs another world than the running one.
hires::imagination::Report ImagineRemotely(const hires::cli::ImagineQuery& query,
                                           const hires::imagination::OnInterim& on_interim,
                                           const std::function<bool()>& cancelled);

/// The same with a goal as it is, answered by a result as it comes, INVALID included.
/// @throws hires::base::ConfigError if there is no master or no client, or the client goes away.
hires::ImagineResult AskImaginationClient(const hires::ImagineGoal& goal,
                                          const hires::imagination::OnInterim& on_interim,
                                          const std::function<bool()>& cancelled);

}  // namespace hires_ros
