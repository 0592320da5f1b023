#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning {

/// Tasks as people and messages write them: `serve_coffee guest1`, `(serve_coffee guest1)`, or a
/// SHOP2 task network: `(:unordered (a x) (b y))`, `(a x) (b y)` (one after the other).
/// @param source  What the text is, for messages.
/// @throws base::ConfigError naming source:line:column, what came and what was wanted.
TaskNetwork ReadTasks(std::string_view text, const std::string& source);

/// The network as ReadTasks reads it back: the same tasks with the same order between them, nested
/// otherwise where that is needed. SHOP2 can only nest `:ordered` and `:unordered`; nothing where
/// that cannot say it (a before c, b before c and d), or where a nested network is immediate.
std::optional<std::string> ToShop2Tasks(const TaskNetwork& network);

/// Exactly one term without variables: `mug1`, `-1.5`, `(mug1 mug2)`.
/// @throws base::ConfigError as above.
Datum ReadGroundTerm(std::string_view text, const std::string& source);

/// The problem of that name, without regard to case.
/// @throws base::ConfigError that names the ones there are, or says what is wrong with it.
const Problem& FindProblem(const std::vector<Problem>& problems, const std::string& name);

}  // namespace hires::planning
