#include "planning/search/search_trace.h"

#include <fmt/format.h>

namespace hires::planning {

std::string SearchTrace::Where(const CompiledMethod& method, std::uint32_t branch) const {
  if (method.source == nullptr) return program_.problem().source;
  const Branch& tried = *method.branches[branch].source;
  return fmt::format("{}:{}: method {}, branch {}{}", program_.domain().source, tried.place.line,
                     method.source->head.Head(), branch + 1,
                     tried.label.empty() ? "" : " '" + tried.label + "'");
}

std::string SearchTrace::Where(const CompiledOperator& applied) const {
  return fmt::format("{}:{}: operator {}", program_.domain().source, applied.source->place.line,
                     applied.source->head.Head());
}

void SearchTrace::Note(Term task, const std::string& where, const std::string& reason) {
  if (!active()) return;
  if (entries_.size() == size_) entries_.pop_front();
  const std::string text =
      task.IsNil() ? "" : path_.terms().ToString(path_.bindings().Resolve(task));
  entries_.push_back({path_.depth(), text, where, reason});
}

}  // namespace hires::planning
