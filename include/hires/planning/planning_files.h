#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning {

/// The language of a planning file by its first word, HDDL's (define ...), or by any form of
/// SHOP2's in it: (defdomain ...), (defproblem ...), (make-problem ...), (in-package ...).
/// @throws base::ConfigError if there is none of them.
Domain::Language LanguageOf(std::string_view text, const std::string& source);

/// The domain in a file of either language. Whether the order of its subtasks is kept is taken from
/// its sidecar, if there is one beside it: d.yaml for d.lisp.
/// @throws base::ConfigError naming file, line, column and remedy.
Domain LoadDomain(const std::string& path);

/// Looks at the sidecar beside the domain, if there is one, as those who carry plans out will; one
/// that says nothing but the order of subtasks is for planning alone.
/// @throws ConfigError as LoadOperatorData.
void CheckSidecar(const std::string& domain_path, const Domain& domain);

/// The problems in a file of the language of `domain`: one in HDDL, one or more in SHOP2. Their
/// tasks are checked against the domain; one written for a domain of another name has a warning. A
/// problem that is wrong has its fault, and the others a warning of it; where all are wrong:
/// @throws base::ConfigError as above, also where file and domain are of different languages.
std::vector<Problem> LoadProblems(const std::string& path, const Domain& domain);

}  // namespace hires::planning
