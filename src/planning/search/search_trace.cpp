#include "planning/search/search_trace.h"

#include <fmt/format.h>

#include <algorithm>

namespace hires::planning {
namespace {

constexpr std::size_t kMostDeepest = 5;  // as planner.h says

}  // namespace

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
  const std::string text =
      task.IsNil() ? "" : path_.terms().ToString(path_.bindings().Resolve(task));
  const TraceEntry entry{path_.depth(), text, where, reason};
  if (IsAmongDeepest()) NoteDeepest(entry);
  if (size_ == 0) return;
  if (entries_.size() == size_) entries_.pop_front();
  entries_.push_back(entry);
}

void SearchTrace::NoteDeepest(const TraceEntry& entry) {
  if (!deepest_.empty() && entry.depth > deepest_.front().depth) deepest_.clear();
  const bool is_known = std::any_of(deepest_.begin(), deepest_.end(), [&](const TraceEntry& other) {
    return other.task == entry.task && other.where == entry.where && other.reason == entry.reason;
  });
  if (!is_known && deepest_.size() < kMostDeepest) deepest_.push_back(entry);
}

}  // namespace hires::planning
