#pragma once

#include <string>
#include <vector>

#include "hires/planning/datum_reader.h"
#include "hires/planning/domain.h"
#include "hires/planning/fact_history.h"
#include "hires/planning/reference_prover.h"
#include "hires/planning/shop2_reader.h"

namespace hires::test_support {

/// The one datum of a text.
inline planning::Datum Read(const std::string& text) {
  return planning::ReadData(text, "text").at(0);
}

/// A state from a list of atoms, oldest first.
inline planning::FactHistory FactsOf(const std::string& atoms) {
  planning::FactHistory facts;
  for (const planning::Datum& atom : Read(atoms).items) facts.Add(atom, 0);
  return facts;
}

inline std::string Text(const std::vector<planning::Datum>& data) {
  std::string text;
  for (const planning::Datum& datum : data) text += (text.empty() ? "" : " ") + ToString(datum);
  return text;
}

/// "(p a) not(q ?x)"
inline std::string Text(const std::vector<planning::Literal>& literals) {
  std::string text;
  for (const planning::Literal& literal : literals) {
    if (!text.empty()) text += ' ';
    text += literal.holds ? ToString(literal.atom) : "not" + ToString(literal.atom);
  }
  return text;
}

/// A condition with axioms, as SHOP2 writes both, and the facts it is asked of.
struct Condition {
  Condition(const std::string& condition, const std::string& atoms, const std::string& axioms = "")
      : domain(planning::ReadShop2Domain(
            "(defdomain d ((:method (t) " + condition + " ()) " + axioms + "))", "d.lisp")),
        facts(FactsOf(atoms)) {}

  const planning::Formula& formula() const {
    return domain.methods.at(0).branches.at(0).precondition.condition;
  }
  planning::ProofQuestion Question() const {
    planning::ProofQuestion question{formula(), facts};
    question.explain = true;
    return question;
  }
  planning::ReferenceProver Prover() const { return {domain, planning::Functions::Standard()}; }
  std::vector<planning::Proof> All() const {
    planning::ReferenceProver prover = Prover();
    return prover.AllProofs(Question());
  }
  /// Values of a variable in all proofs.
  std::vector<std::string> Values(const std::string& variable) const {
    std::vector<std::string> values;
    for (const planning::Proof& proof : All()) {
      const auto found = proof.values.find(variable);
      values.push_back(found == proof.values.end() ? "" : ToString(found->second));
    }
    return values;
  }
  bool Holds() const { return !All().empty(); }

  planning::Domain domain;
  planning::FactHistory facts;
};

}  // namespace hires::test_support
