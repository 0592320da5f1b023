#include "hires/planning/reference_prover.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "planning/check/reference_solver.h"

namespace hires::planning {
namespace {

void CollectVariablesOf(const Formula& formula, std::set<std::string>* names) {
  for (const Formula& part : formula.parts) CollectVariablesOf(part, names);
  CollectVariables(formula.term, names);
  CollectVariables(formula.expression, names);
}

void CollectBoundBy(const Formula& formula, std::set<std::string>* names) {
  switch (formula.kind) {
    case Formula::Kind::kNot:
    case Formula::Kind::kForall:
    case Formula::Kind::kExists:
    case Formula::Kind::kEval:
      return;
    case Formula::Kind::kImply:
      return CollectBoundBy(formula.parts.at(1), names);
    case Formula::Kind::kSetOf:
    case Formula::Kind::kBagOf:
      return CollectVariables(formula.expression, names);
    default:
      CollectVariables(formula.term, names);
      for (const Formula& part : formula.parts) CollectBoundBy(part, names);
  }
}

/// Without the numbers that copies of clauses put behind the names of their variables, where the
/// names still tell them apart.
Datum Readable(const Datum& atom) {
  if (IsGround(atom)) return atom;
  std::set<std::string> names;
  CollectVariables(atom, &names);
  std::set<std::string> bare_names;
  Substitution bare;
  for (const std::string& name : names) {
    const std::size_t end = name.find('#', 2);  // "?_#1" is a reader's name
    const std::string bare_name = name.substr(0, end);
    bare_names.insert(bare_name);
    if (bare_name != name) bare.Unify(MakeVariable(name), MakeVariable(bare_name));
  }
  return bare_names.size() == names.size() ? bare.Apply(atom) : atom;
}

std::vector<Literal> EachOnce(const std::vector<Literal>& literals) {
  std::set<std::pair<std::string, bool>> seen;
  std::vector<Literal> result;
  for (const Literal& literal : literals) {
    const Datum atom = Readable(literal.atom);
    if (seen.emplace(ToString(atom), literal.holds).second) result.push_back({atom, literal.holds});
  }
  return result;
}

std::vector<Datum> EachReadableOnce(const std::vector<Datum>& atoms) {
  std::set<std::string> seen;
  std::vector<Datum> result;
  for (const Datum& each : atoms) {
    const Datum atom = Readable(each);
    if (seen.insert(ToString(atom)).second) result.push_back(atom);
  }
  return result;
}

ValueMap ValuesOf(const std::set<std::string>& variables, const Substitution& values) {
  ValueMap result;
  for (const std::string& variable : variables) {
    if (values.IsBound(variable)) result[variable] = values.Apply(MakeVariable(variable));
  }
  return result;
}

}  // namespace

ReferenceProver::ReferenceProver(const Domain& domain, const Functions& functions)
    : ReferenceProver(domain, functions, Limits()) {}

ReferenceProver::ReferenceProver(const Domain& domain, const Functions& functions,
                                 const Limits& limits)
    : domain_(domain), limits_(limits), evaluator_(functions, domain.source) {
  for (const Axiom& axiom : domain.axioms) {
    axioms_[std::string(axiom.head.Head())].push_back(&axiom);
  }
}

const std::vector<const Axiom*>& ReferenceProver::AxiomsFor(const std::string& predicate) const {
  static const std::vector<const Axiom*> kNone;
  const auto found = axioms_.find(predicate);
  return found == axioms_.end() ? kNone : found->second;
}

std::vector<Proof> ReferenceProver::Find(const ProofQuestion& question, std::size_t at_most,
                                         std::vector<Datum>* reads) {
  ProofSession session{*this, question.facts, question.moment, question.explain,
                       question.reads_all ? 1 : 0};
  std::set<std::string> variables = VariablesOf(question.formula);
  for (const auto& [variable, value] : question.known) {
    session.values.Unify(MakeVariable(variable), value);
    variables.insert(variable);
  }
  std::vector<Proof> proofs;
  ReferenceSolver solver(&session, question.formula, question.newest_first, 0, &question.expected);
  while (proofs.size() < at_most && solver.Next()) {
    proofs.push_back({ValuesOf(variables, session.values), EachOnce(session.support),
                      EachReadableOnce(session.reads)});
  }
  if (reads != nullptr) {
    const std::vector<Datum> asked = EachReadableOnce(session.reads);
    reads->insert(reads->end(), asked.begin(), asked.end());
  }
  return proofs;
}

std::optional<Proof> ReferenceProver::FirstProof(const ProofQuestion& question) {
  std::vector<Proof> proofs = Find(question, 1, nullptr);
  if (proofs.empty()) return std::nullopt;
  return std::move(proofs.front());
}

std::vector<Proof> ReferenceProver::AllProofs(const ProofQuestion& question,
                                              std::vector<Datum>* reads) {
  return Find(question, std::numeric_limits<std::size_t>::max(), reads);
}

bool ReferenceProver::Holds(const ProofQuestion& question) {
  return !Find(question, 1, nullptr).empty();
}

Formula MakeAtom(Datum atom) {
  Formula formula;
  formula.kind = Formula::Kind::kAtom;
  formula.place = atom.place;
  formula.term = std::move(atom);
  return formula;
}

std::set<std::string> VariablesOf(const Formula& formula) {
  std::set<std::string> names;
  CollectVariablesOf(formula, &names);
  return names;
}

std::set<std::string> VariablesBoundBy(const Formula& formula) {
  std::set<std::string> names;
  CollectBoundBy(formula, &names);
  return names;
}

std::string At(const std::string& source, Place place) {
  if (place.line == 0) return source.empty() ? "" : source + ": ";
  return fmt::format("{}:{}:{}: ", source, place.line, place.column);
}

}  // namespace hires::planning
