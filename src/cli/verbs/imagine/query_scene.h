#pragma once

#include <optional>

#include "cli/verbs/imagine/imagine_query.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/start_state.h"

namespace hires::cli {

/// What a query is imagined in, from the files that it names: read when it is asked for first, and
/// once.  @throws base::ConfigError as imagination::LoadImaginationSetup and MakeStartState.
class QueryScene {
 public:
  explicit QueryScene(const ImagineQuery& query) : query_(query) {}  ///< @pre `query` stays

  const imagination::ImaginationSetup& setup();
  const imagination::RolloutSetup& rollouts();

 private:
  const ImagineQuery& query_;
  std::optional<imagination::ImaginationSetup> setup_;
  std::optional<imagination::RolloutSetup> rollouts_;
};

/// @throws base::ConfigError naming all that a query names and nothing has: areas, objects,
/// arguments of the action.
void RequireNames(const ImagineQuery& query, QueryScene* scene);

/// Imagines in this process, as `hires imagine --local`.
imagination::Report ImagineInThisProcess(const ImagineQuery& query, QueryScene* scene,
                                         const imagination::OnInterim& on_interim,
                                         const std::function<bool()>& cancelled);

}  // namespace hires::cli
