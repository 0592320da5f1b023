#include "execution/session.h"

#include <fmt/format.h>

#include <utility>

#include "execution/records.h"

namespace hires::execution {
namespace {

const char* ConceptOf(Violation::Kind kind) {
  switch (kind) {
    case Violation::Kind::kPrecondition:
      return "PreconditionFailure";
    case Violation::Kind::kEffect:
      return "EffectFailure";
    case Violation::Kind::kTimeout:
      return "TimeoutFailure";
    case Violation::Kind::kActivity:
    case Violation::Kind::kImagined:
      break;
  }
  return "ActivityFailure";
}

}  // namespace

std::string ToString(const Violation& violation) {
  return fmt::format("{}: {}", base::ToString(violation.action), ToString(violation.failure));
}

bool IsSame(const Violation& a, const Violation& b) {
  return a.action == b.action && a.failure == b.failure;
}

Session::Session(const planning::PlanningKnowledge* knowledge,
                 const planning::OperatorData* operators, const MonitorParams& params)
    : knowledge_(knowledge), operators_(operators), params_(params), state_(knowledge->domain) {}

void Session::EndTask() {
  progress_.EndTask();
  exclusions_.Clear();
  violation_.reset();
  state_.ForgetNotes();
}

void Session::Exclude(Exclusion exclusion, int step) {
  exclusions_.Add(std::move(exclusion), progress_.run().number(), step);
}

void Session::Report(Violation violation, int activity) {
  if (violation.kind != Violation::Kind::kImagined) {
    outbox_.Send(Failed(outbox_.NewRecord(), ConceptOf(violation.kind), activity, violation.action,
                        violation.failure));
  }
  if (!violation_) violation_ = std::move(violation);
}

}  // namespace hires::execution
