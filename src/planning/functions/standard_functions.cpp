#include "planning/functions/standard_functions.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/base/text.h"

namespace hires::planning {
namespace {

constexpr int kMaxDepth = 256;        // of a list that equalp looks into
constexpr int kMaxSteps = 1'000'000;  // elements that equalp looks at
constexpr double kTwoTo63 = 9223372036854775808.0;

/// Rewrites a value so that what is equalp becomes identical: reals that are whole become integers,
/// letters of strings small.
class Folding {
 public:
  explicit Folding(TermTable* terms) : terms_(terms) {}

  Term Fold(Term value, int depth) {
    if (++steps_ > kMaxSteps || depth > kMaxDepth) {
      throw EvaluationError(
          fmt::format("equalp looks at {} elements and {} levels at most, this is more; use equal",
                      kMaxSteps, kMaxDepth));
    }
    if (value.kind() == Term::Kind::kReal) return FoldReal(value);
    if (value.kind() == Term::Kind::kString) {
      return terms_->String(base::ToLower(terms_->text(value)));
    }
    return value.IsPair() ? FoldList(value, depth) : value;
  }

 private:
  Term FoldReal(Term value) {
    const double real = terms_->number(value);
    if (real != std::floor(real) || std::fabs(real) >= kTwoTo63) return value;
    return terms_->Integer(static_cast<std::int64_t>(real));
  }

  Term FoldList(Term value, int depth) {
    std::vector<Term> folded;
    for (; value.IsPair(); value = terms_->tail(value)) {
      folded.push_back(Fold(terms_->head(value), depth + 1));
    }
    Term list = Fold(value, depth + 1);
    for (std::size_t i = folded.size(); i-- > 0;) list = terms_->Pair(folded[i], list);
    return list;
  }

  TermTable* terms_;
  int steps_{0};
};

}  // namespace

Term StandardFunction::operator()(TermTable* terms, const std::vector<Term>& arguments) const {
  return function({name, terms, arguments});
}

Term StandardPredicate::operator()(TermTable* terms, const std::vector<Term>& arguments) const {
  return predicate({name, terms, arguments}) ? terms->Symbol("t") : Term();
}

std::string ShortText(const TermTable& terms, Term term) {
  constexpr int kElements = 8;
  constexpr std::size_t kCharacters = 60;
  if (term.IsVariable()) return "a variable without a value";
  std::string text;
  int shown = 0;
  Term rest = term;
  for (; rest.IsPair() && shown < kElements; rest = terms.tail(rest), ++shown) {
    const Term head = terms.head(rest);
    text += (shown > 0 ? " " : "") + (head.IsPair() ? "(...)" : terms.ToString(head));
  }
  if (!term.IsPair()) text = terms.ToString(term);
  if (text.size() > kCharacters) text = text.substr(0, kCharacters) + "...";
  if (!term.IsPair()) return text;
  if (rest.IsPair()) return "(" + text + " ...)";
  return "(" + text + (rest.IsNil() ? "" : " . " + ShortText(terms, rest)) + ")";
}

void RefuseArgument(const Call& call, std::size_t i, std::string_view wanted) {
  throw EvaluationError(fmt::format("'{}' got {} as argument {}, wanted {}", call.name,
                                    ShortText(*call.terms, call[i]), i + 1, wanted));
}

std::vector<Term> Elements(const Call& call, std::size_t i) {
  std::vector<Term> elements;
  Term rest = call[i];
  for (; rest.IsPair(); rest = call.terms->tail(rest)) elements.push_back(call.terms->head(rest));
  if (!rest.IsNil()) RefuseArgument(call, i, "a list");
  return elements;
}

Term MakeBoundedList(const Call& call, const std::vector<Term>& elements, Term tail) {
  if (elements.size() > kMaxListElements) {
    throw EvaluationError(fmt::format("'{}' makes a list of {} elements, wanted at most {}",
                                      call.name, elements.size(), kMaxListElements));
  }
  Term list = tail;
  for (std::size_t i = elements.size(); i-- > 0;) list = call.terms->Pair(elements[i], list);
  return list;
}

Number ToNumber(const TermTable& terms, Term number) {
  if (number.kind() == Term::Kind::kReal) return {false, 0, terms.number(number)};
  return {true, terms.integer(number), terms.number(number)};
}

Number NumberAt(const Call& call, std::size_t i) {
  if (!call[i].IsNumber()) RefuseArgument(call, i, "a number");
  const Number number = ToNumber(*call.terms, call[i]);
  if (!std::isfinite(number.real)) RefuseArgument(call, i, "a finite number");
  return number;
}

std::int64_t IntegerAt(const Call& call, std::size_t i) {
  if (call[i].kind() != Term::Kind::kInteger) RefuseArgument(call, i, "an integer");
  return call.terms->integer(call[i]);
}

namespace {

template <typename T>
int ThreeWay(T a, T b) {
  return a < b ? -1 : (b < a ? 1 : 0);
}

// A conversion to double would round integers beyond 2^53.
int CompareMixed(std::int64_t integer, double real) {
  if (real >= kTwoTo63) return -1;
  if (real < -kTwoTo63) return 1;
  const auto whole = static_cast<std::int64_t>(real);
  if (integer != whole) return integer < whole ? -1 : 1;
  return ThreeWay(0.0, real - static_cast<double>(whole));
}

}  // namespace

int Compare(const Number& a, const Number& b) {
  if (a.is_integer && b.is_integer) return ThreeWay(a.integer, b.integer);
  if (a.is_integer) return CompareMixed(a.integer, b.real);
  if (b.is_integer) return -CompareMixed(b.integer, a.real);
  return ThreeWay(a.real, b.real);
}

std::optional<Term> KeyUnder(Sameness sameness, TermTable* terms, Term value) {
  const bool has_identity = value.kind() == Term::Kind::kSymbol ||
                            value.kind() == Term::Kind::kInteger ||
                            (value.kind() == Term::Kind::kReal && sameness == Sameness::kEql);
  if (has_identity || sameness == Sameness::kEqual) return value;
  if (sameness == Sameness::kEqualp) return Folding(terms).Fold(value, 0);
  return std::nullopt;
}

Sameness TestAt(const Call& call, std::size_t first) {
  if (call.size() <= first) return Sameness::kEql;
  const TermTable& terms = *call.terms;
  const auto is_symbol = [&](std::size_t i, std::string_view name) {
    return call[i].kind() == Term::Kind::kSymbol && terms.text(call[i]) == name;
  };
  if (!is_symbol(first, ":test")) RefuseArgument(call, first, ":test or nothing");
  if (call.size() != first + 2) RefuseArgument(call, first, "one function after :test");
  if (is_symbol(first + 1, "eq")) return Sameness::kEq;
  if (is_symbol(first + 1, "eql")) return Sameness::kEql;
  if (is_symbol(first + 1, "equal")) return Sameness::kEqual;
  if (is_symbol(first + 1, "equalp")) return Sameness::kEqualp;
  RefuseArgument(call, first + 1, "#'eq, #'eql, #'equal or #'equalp");
}

}  // namespace hires::planning
