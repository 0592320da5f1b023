#include "planning/proof/goal_trace.h"

#include <fmt/format.h>

#include "planning/language/hddl_vocabulary.h"

namespace hires::planning {
namespace {

/// Replaces the numbers of unbound variables by their names in the file.
void NameVariables(const std::vector<std::string>& names, std::uint32_t frame, Datum* datum) {
  if (datum->kind == Datum::Kind::kVariable) {
    const std::size_t slot = std::stoul(datum->text.substr(1)) - frame;
    if (slot < names.size()) datum->text = names[slot];
  }
  for (Datum& item : datum->items) NameVariables(names, frame, &item);
  for (Datum& item : datum->tail) NameVariables(names, frame, &item);
}

}  // namespace

void GoalTrace::Begin(std::uint32_t frame) {
  frame_ = frame;
  furthest_number_ = 0;
  furthest_.clear();
}

void GoalTrace::Note(const ProofStack::Position& at) {
  if (at.frame != frame_ || at.depth != 0 || at.goal->number <= furthest_number_) return;
  furthest_number_ = at.goal->number;
  furthest_ = fmt::format("goal {} {}", at.goal->number, Text(at.goal));
}

std::string GoalTrace::Text(const Goal* goal) {
  if (goal->kind == Goal::Kind::kNot && goal->bodies[0] != nullptr &&
      goal->source->kind == Formula::Kind::kNot) {
    return "(not " + Text(goal->bodies[0]) + ")";
  }
  if (goal->kind != Goal::Kind::kAtom) {
    static const char* const kWords[] = {
        "",        "a variable goal", "(and ...)",     "(or ...)",   "(not ...)",  "(imply ...)",
        "(= ...)", "(assign ...)",    "(assign* ...)", "(eval ...)", "(setof ...)"};
    return fmt::format("{} in line {}", kWords[static_cast<int>(goal->kind)],
                       goal->source->place.line);
  }
  Datum atom = MakeList({terms_.ToDatum(goal->predicate)});
  for (const Pattern* pattern : goal->patterns) {
    atom.items.push_back(terms_.ToDatum(instances_.Build(*pattern, frame_)));
  }
  NameVariables(*names_, frame_, &atom);
  return hddl::AsWritten(atom);
}

}  // namespace hires::planning
