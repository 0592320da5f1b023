#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hires/planning/datum.h"
#include "hires/planning/functions.h"
#include "hires/planning/term.h"
#include "planning/functions/expression_node.h"

namespace hires::planning {

/// Checks an expression and makes it ready to run; see Expression for arguments and errors.
std::unique_ptr<CompiledExpression> CompileExpression(
    const Datum& datum, const std::function<int(const std::string&)>& slot_of,
    const Functions& functions, TermTable* terms, const std::string& source,
    std::vector<std::string>* unknown);

/// "function 'f' is unknown; did you mean ...", with what may be done.
std::string UnknownFunctionText(const std::string& name, const Functions& functions);

}  // namespace hires::planning
