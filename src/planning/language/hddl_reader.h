#pragma once

#include <string>
#include <string_view>

#include "hires/planning/domain.h"

namespace hires::planning {

/// The only domain of an HDDL text [Hoeller et al. 2020, AAAI 34:9883-9891], as the International
/// Planning Competition 2020 uses it, with action costs; problems beside it are left alone.
///
/// What becomes of it: an action `drive` is the operator `!drive`, a task keeps its name. Each type
/// is a predicate `%type-<name>` that holds for its objects, those of its subtypes included, and
/// each parameter is checked by it. The precondition of a method is ordered so that every goal but
/// the first finds variables bound; it binds every parameter in the end. A function is a predicate
/// `%value-<name>` with its value as last argument; an action costs what it adds to (total-cost), 0
/// if it adds nothing, 1 in a domain without (total-cost). A positive precondition of an action
/// that no action can change is asked by the methods that use the action too: they would fail
/// later.
///
/// @param source  File, for messages.
/// @throws base::ConfigError naming source:line:column, the construct ("method 'm_go'"), what came,
///   what was wanted and the nearest names: forms, undeclared or doubled names, numbers of
///   arguments, constants of the wrong type, types that contain themselves, subtasks that would
///   come before themselves, effects on numbers other than (increase (total-cost) ...). An object
///   that is not declared here may be declared by the problem, so the reader of problems tells.
Domain ReadHddlDomain(std::string_view text, const std::string& source);

/// The only problem of an HDDL text, checked against its domain; a domain beside it is left alone.
/// @pre `domain` was read by ReadHddlDomain.
/// @throws base::ConfigError as above.
Problem ReadHddlProblem(std::string_view text, const std::string& source, const Domain& domain);

}  // namespace hires::planning
