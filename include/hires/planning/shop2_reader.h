#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning {

/// Whether a text holds any form of SHOP2's language, among others of Lisp or alone.
/// @throws base::ConfigError where it is no Lisp.
bool IsShop2File(std::string_view text, const std::string& source);

/// The only `defdomain` of a text in SHOP2's language; problems beside it are left alone, and so
/// are other forms of Lisp, with a warning. It may stand within (progn ...) and its like. Data of
/// the file cannot run anything. All errors are base::ConfigError and name source:line:column, the
/// construct ("method 'serve_cup', branch 2"), what came, what was wanted and what to do: wrong
/// forms, names of operators and methods, doubled operators, tasks that come with the wrong number
/// of arguments, adds whose variables nothing binds. Tasks that nothing handles are noted in the
/// domain: files as they are found have such in methods that are never reached.
Domain ReadShop2Domain(std::string_view text, const std::string& source);

/// All problems (`defproblem`, `make-problem`) of a text, in its order; a domain beside them is
/// left alone, other forms are as above. Facts must be ground. Whether the tasks exist is told by
/// CheckTasks. A form with several pairs of facts and tasks, as JSHOP2 has them, holds problems
/// NAME, NAME-2, ... One that is wrong among others is there with its fault.
/// @throws base::ConfigError as above, also where there is no problem at all.
std::vector<Problem> ReadShop2Problems(std::string_view text, const std::string& source);

/// @throws base::ConfigError with the faults of all problems where each has one, and there are
/// some.
void RequireOneWithoutFault(const std::vector<Problem>& problems);

/// Every task of `problem` has an operator or a method in `domain` that takes its arguments.
/// @throws base::ConfigError naming the task and the nearest names.
void CheckTasks(const Problem& problem, const Domain& domain);

}  // namespace hires::planning
