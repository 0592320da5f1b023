#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning::shop2 {

/// What is being read, for messages: "method 'serve_cup', branch 2" in a file.
struct Construct {
  const std::string& source;
  std::string name;
};

/// Throws "source:line:column: construct: text".
[[noreturn]] void Fail(const Construct& in, Place place, const std::string& text);
/// "came '(on a b)', wanted ..." at the place of `datum`.
[[noreturn]] void FailAbout(const Construct& in, const Datum& datum, std::string_view wanted);

/// Gives every anonymous variable, `?` or `?_...`, a name of its own, and so does it with variables
/// of `forall` and `exists`, which nothing else uses. New names hold a `#`.
Datum WithOwnNames(Datum item);

/// A word that means a formula, so that no fact, axiom or effect may have its name.
bool IsLogicalWord(std::string_view word);

/// Checks "(name arguments...)", possibly dotted, with a symbol as name that is no keyword.
void CheckTerm(const Construct& in, const Datum& datum, std::string_view wanted);
/// The same for atoms, whose name is no logical word either.
void CheckAtom(const Construct& in, const Datum& datum, std::string_view wanted);

/// Writes the terms of a domain in JSHOP2's language as Lisp does: the value in (assign ?x value)
/// and what a call gets are quoted, and lists made of their items. A domain in another language
/// stays as it is: one without (call ...), or one that computes by anything else.
/// @param warnings  takes one where a list was such a term that looks as if it were computed.
void WriteBareTerms(const std::string& source, Datum* domain, std::vector<std::string>* warnings);

/// An expression without SHOP's word `call`: (call + ?x 1) is (+ ?x 1).
Datum ReadExpression(Datum datum);

Precondition ReadPrecondition(const Construct& in, const Datum& datum);
/// `:op` and axioms read two goals and more as if `and` stood before them.
Precondition ReadConjunction(const Construct& in, const Datum& datum);

std::vector<Effect> ReadEffects(const Construct& in, const Datum& datum);
/// Without atoms named by a logical word, which SHOP deletes in vain: no fact has such a name.
/// @param warnings  takes one where there are any.
std::vector<Effect> ReadDeletes(const Construct& in, const Datum& datum,
                                std::vector<std::string>* warnings);
TaskNetwork ReadNetwork(const Construct& in, const Datum& datum);

/// @param warnings  takes what is passed over.
Operator ReadOperator(const std::string& source, const Datum& item,
                      std::vector<std::string>* warnings);
Method ReadMethod(const std::string& source, const Datum& item);
Axiom ReadAxiom(const std::string& source, const Datum& item);

/// A head, atom or task without quotes, which mean nothing where nothing is evaluated: (p 'a) is
/// (p a). A (call ...) keeps its own.
Datum Unquoted(Datum term);

/// Variables of a datum are appended, as often as they stand there.
void CollectVariables(const Datum& datum, std::vector<std::string>* variables);

/// Operators once each, adds bound, deletes bound or warned of, tasks handled.
void CheckDomain(Domain* domain);

}  // namespace hires::planning::shop2
