#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "hires/planning/datum_reader.h"
#include "hires/planning/functions.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/term.h"
#include "planning/proof/bindings.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/prover.h"
#include "planning/proof/state.h"

namespace hires::test_support {

/// A compiled domain with a state, and one frame: the variables of its first method's head. The
/// method is (:method (t HEAD) CONDITION ()), the facts a list of atoms, oldest first.
class ProofBench {
 public:
  ProofBench(const std::string& head, const std::string& condition, const std::string& facts,
             const std::string& axioms = "")
      : domain_(planning::ReadShop2Domain(
            "(defdomain d (" + axioms + "(:method (t " + head + ") " + condition + " ())))",
            "d.lisp")),
        problem_(planning::ReadShop2Problems("(defproblem p d " + facts + " ())", "p.lisp").at(0)) {
    for (const planning::Term fact : program.facts()) state.Add(fact);
    frame = bindings.Make(method().num_slots);
  }

  const planning::CompiledMethod& method() { return *program.Methods(terms.Symbol("t")).at(0); }
  const planning::Goal* goals() { return method().branches.at(0).precondition.goals; }
  /// The items of the head behind the name, as patterns of the frame.
  const planning::Pattern& head(int item) {
    const planning::Pattern* rest = method().head->tail;
    for (; item > 0; --item) rest = rest->tail;
    return *rest->head;
  }
  planning::Term Term(const std::string& text) {
    return terms.FromDatum(planning::ReadData(text, "text").at(0));
  }
  /// A variable of the head, as in "?x".
  planning::Term Variable(const std::string& name) {
    const std::vector<std::string>& names = method().variables;
    const auto slot = std::find(names.begin(), names.end(), name) - names.begin();
    return planning::Instantiator::Variable(frame, static_cast<std::uint32_t>(slot));
  }
  /// What it stands for, as text.
  std::string Value(const std::string& name) {
    return terms.ToString(bindings.Resolve(Variable(name)));
  }
  /// Values of ?x over all solutions, in their order: "a b c".
  std::string Solutions(bool newest_first) {
    std::string text;
    bool found = prover.Solve(goals(), frame, newest_first);
    for (; found; found = prover.num_choices() > 0 && prover.Next(0)) {
      text += (text.empty() ? "" : " ") + Value("?x");
    }
    return text;
  }

 private:
  planning::Domain domain_;
  planning::Problem problem_;

 public:
  planning::TermTable terms;
  planning::Program program{domain_, problem_, planning::Functions::Standard(), &terms};
  planning::State state{&terms};
  planning::Bindings bindings{&terms};
  planning::Instantiator instances{&terms, &bindings};
  planning::Prover prover{program, &terms, &bindings, &instances, &state};
  std::uint32_t frame{0};
};

}  // namespace hires::test_support
