#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/proof_stack.h"

namespace hires::planning {

/// The furthest goal of a condition that a proof has come to, for people who ask why it failed.
class GoalTrace {
 public:
  GoalTrace(const TermTable* terms, Instantiator* instances)
      : terms_(*terms), instances_(*instances) {}

  /// Names of the frame's variables; null: nothing is kept.
  void set_names(const std::vector<std::string>* names) { names_ = names; }
  bool active() const { return names_ != nullptr; }
  /// The condition's variables begin at `frame`.
  void Begin(std::uint32_t frame);
  /// The goal at hand; goals of axioms and those before the furthest are passed over. @pre active()
  void Note(const ProofStack::Position& at);
  /// The goal with its bindings when it was first reached: "goal 3 (on ?x b2)".
  const std::string& furthest() const { return furthest_; }

 private:
  std::string Text(const Goal* goal);

  const TermTable& terms_;
  Instantiator& instances_;
  const std::vector<std::string>* names_{nullptr};
  std::uint32_t frame_{0};
  int furthest_number_{0};
  std::string furthest_;
};

}  // namespace hires::planning
