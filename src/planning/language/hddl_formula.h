#pragma once

#include <set>
#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "planning/language/hddl_vocabulary.h"

namespace hires::planning::hddl {

/// What surrounds a formula: where it stands and which variables it may use.
struct HddlScope {
  HddlSpot spot;
  HddlVocabulary* vocabulary{nullptr};
  HddlVariables variables;
  int num_renamed{0};  ///< quantified variables that hid another one and got a name of their own
};

Formula MakeAtom(Datum term);
Formula MakeSequence(std::vector<Formula> parts);  ///< of none: always true
Formula TypeAtom(const HddlVocabulary& vocabulary, const std::string& variable, int type);

/// One of the words with which HDDL asks for the type of a variable: (sortof ?x - type).
bool IsSortWord(std::string_view word);

/// A condition as it is written, checked: (and ...), (or ...), (not ...), (imply ...),
/// (forall (...) ...), (exists (...) ...), (= a b), (sortof ?x - type), atoms and (). Quantifiers
/// have the types of their variables as parts[0].
/// @throws ConfigError for undeclared names, wrong numbers and types of arguments, wrong forms.
Formula ReadCondition(const Datum& datum, HddlScope* scope);

/// Declares the variables `(?x - type ...)` of a quantifier in `scope`; one that would hide another
/// gets a name of its own.
/// @param body  What stands under the quantifier; comes back with the new names.
struct HddlQuantified {
  std::vector<std::string> names;
  std::vector<Formula> type_atoms;
  Datum body;
};
HddlQuantified DeclareQuantified(const Datum& list, const Datum& body, HddlScope* scope);

Datum Substitute(const Datum& datum, const std::map<std::string, Datum>& values);

/// The parts of nested conjunctions, double negations undone.
void AppendConjuncts(Formula formula, std::vector<Formula>* parts);

std::set<std::string> FreeVariables(const Formula& formula);

/// Orders a conjunction so that a search from left to right binds all its variables early and asks
/// nothing before its variables are bound but positive atoms:
///  1. atoms whose variables are all bound, as written;
///  2. types, then conditions of other kinds, as soon as their variables are bound;
///  3. of the other atoms the first that has a bound variable, else the first;
///  4. where none is left, the type of the next variable that nothing binds, which tries all its
///     objects.
/// @param conjuncts   Conditions as ReadCondition gives them.
/// @param type_atoms  Of the variables to be bound in the end, in the order of 4.
/// @param bound       Variables that are bound before.
Formula ArrangeConjunction(std::vector<Formula> conjuncts, std::vector<Formula> type_atoms,
                           const std::set<std::string>& bound);

}  // namespace hires::planning::hddl
