#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/planning/datum_reader.h"
#include "hires/planning/functions.h"
#include "planning/functions/expression_compiler.h"
#include "planning/language/shop2_parts.h"

// In JSHOP2's language (call f ...) alone computes, and every other term stands for itself; in
// SHOP2's the value of (assign ?x value) and what a call gets is Lisp, where names and lists are
// quoted.
namespace hires::planning::shop2 {
namespace {

bool IsCallTerm(const Datum& datum) { return datum.Head() == "call" && datum.items.size() >= 2; }

bool IsAssignment(const Datum& datum) {
  return (datum.Head() == "assign" || datum.Head() == "assign*") && datum.items.size() == 3;
}

/// The first of the items that Lisp would evaluate; their number: there is none.
std::size_t FirstTerm(const Datum& datum) {
  return IsCallTerm(datum) || IsAssignment(datum) ? 2 : datum.items.size();
}

bool IsLispFunction(std::string_view name) {
  return IsForm(name) || Functions::Standard().Find(name) != nullptr;
}

/// A value that only Lisp computes: (- ?a ?b), (length (list ?a)).
bool IsComputedByLisp(const Datum& term) {
  if (IsCallTerm(term) || !term.IsList()) return false;
  return IsLispFunction(term.Head()) ||
         std::any_of(term.items.begin(), term.items.end(), IsComputedByLisp);
}

struct Traits {
  bool calls{false}, is_lisp{false};
};

void CollectTraits(const Datum& datum, Traits* traits) {
  traits->calls = traits->calls || IsCallTerm(datum);
  for (const std::string_view word : {"eval", "quote", "backquote", "unquote", "function"}) {
    traits->is_lisp = traits->is_lisp || datum.Head() == word;
  }
  for (std::size_t i = FirstTerm(datum); i < datum.items.size(); ++i) {
    traits->is_lisp = traits->is_lisp || IsComputedByLisp(datum.items[i]);
  }
  for (const Datum& item : datum.items) CollectTraits(item, traits);
  for (const Datum& item : datum.tail) CollectTraits(item, traits);
}

class TermWriter {
 public:
  /// Terms in all calls and assignments, as Lisp writes them.
  void Write(Datum* datum) {
    const std::size_t first = FirstTerm(*datum);
    for (std::size_t i = 0; i < datum->items.size(); ++i) {
      i < first ? Write(&datum->items[i]) : WriteTerm(&datum->items[i]);
    }
    for (Datum& item : datum->tail) Write(&item);
  }

  /// The first list that begins like a call and is none.
  const Datum* like_a_call() const { return has_any_ ? &like_a_call_ : nullptr; }

 private:
  void WriteTerm(Datum* term) {
    if (IsCallTerm(*term)) return Write(term);
    if (term->IsNil()) return;
    const Place place = term->place;
    if (term->kind == Datum::Kind::kSymbol) {
      *term = MakeList({MakeSymbol("quote"), std::move(*term)});
    } else if (term->IsList()) {
      if (!has_any_ && !term->Head().empty()) like_a_call_ = *term;
      has_any_ = has_any_ || !term->Head().empty();
      WriteList(term);
    }
    term->place = place;
  }

  /// (list a b), (list* a ?rest)
  void WriteList(Datum* term) {
    std::vector<Datum> items{MakeSymbol(term->tail.empty() ? "list" : "list*")};
    for (Datum& item : term->items) items.push_back(std::move(item));
    for (Datum& item : term->tail) items.push_back(std::move(item));
    for (std::size_t i = 1; i < items.size(); ++i) WriteTerm(&items[i]);
    for (Datum& item : items) {
      if (item.place.line == 0) item.place = term->place;
    }
    *term = MakeList(std::move(items));
  }

  Datum like_a_call_;
  bool has_any_{false};
};

}  // namespace

void WriteBareTerms(const std::string& source, Datum* domain, std::vector<std::string>* warnings) {
  Traits traits;
  CollectTraits(*domain, &traits);
  if (!traits.calls || traits.is_lisp) return;
  TermWriter writer;
  writer.Write(domain);
  if (writer.like_a_call() == nullptr) return;
  const Datum& term = *writer.like_a_call();
  warnings->push_back(Located(
      source, term.place,
      fmt::format("the domain computes by (call ...) alone, as JSHOP2's language does, so that {} "
                  "and its like stand for themselves; where it is to be computed, write (call {} "
                  "...)",
                  Excerpt(term), Excerpt(term.items[0]))));
}

}  // namespace hires::planning::shop2
