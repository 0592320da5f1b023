#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/functions.h"
#include "hires/planning/term.h"

/// What the functions of Functions::Standard() have in common. Other code adds its own by
/// Functions::Add and needs none of this.
namespace hires::planning {

/// One call of a function: ground arguments, their number checked.
struct Call {
  std::string_view name;
  TermTable* terms;
  const std::vector<Term>& arguments;

  std::size_t size() const { return arguments.size(); }
  Term operator[](std::size_t i) const { return arguments[i]; }
};

constexpr int kAnyNumber = -1;  ///< of arguments, as the highest number that a function takes

/// Functions and tests of the standard set. Their types differ from other callables, so that an
/// expression can recognise a test and answer t without looking the symbol up.
struct StandardFunction {
  const char* name;
  Term (*function)(const Call&);
  Term operator()(TermTable* terms, const std::vector<Term>& arguments) const;
};
struct StandardPredicate {
  const char* name;
  bool (*predicate)(const Call&);
  Term operator()(TermTable* terms, const std::vector<Term>& arguments) const;
};

void AddNumberFunctions(Functions* functions);
void AddListFunctions(Functions* functions);
void AddTests(Functions* functions);  ///< logic, equality and type tests

/// Lists that a function makes may have this many elements.
constexpr std::size_t kMaxListElements = 1'000'000;

/// An argument as text for messages, cut to a line.
std::string ShortText(const TermTable& terms, Term term);

/// "'floor' got b1 as argument 2, wanted a number".
[[noreturn]] void RefuseArgument(const Call& call, std::size_t i, std::string_view wanted);

/// The elements of a proper list.  @throws EvaluationError for anything else.
std::vector<Term> Elements(const Call& call, std::size_t i);

/// @throws EvaluationError if there are more than kMaxListElements.
Term MakeBoundedList(const Call& call, const std::vector<Term>& elements, Term tail = {});

/// A number: 64 bit integer, or real. `real` is set for both.
struct Number {
  bool is_integer{true};
  std::int64_t integer{0};
  double real{0.0};
};
Number NumberAt(const Call& call, std::size_t i);         ///< finite
std::int64_t IntegerAt(const Call& call, std::size_t i);  ///< whole
Number ToNumber(const TermTable& terms, Term number);     ///< @pre a number
int Compare(const Number& a, const Number& b);            ///< -1, 0, 1; exact, without rounding

/// Common Lisp's four ways of being the same. Terms have no identity; where Lisp asks for it (eq of
/// reals, eq and eql of lists and strings) the answer is no, as for objects made apart.
enum class Sameness { kEq, kEql, kEqual, kEqualp };

/// A term that two values share exactly if they are the same; none if the value is not even the
/// same as itself.  @throws EvaluationError where a list nests too deep or is too long for equalp.
std::optional<Term> KeyUnder(Sameness sameness, TermTable* terms, Term value);

/// The sameness that a call's `:test` names, arguments `first` and `first` + 1; eql without them.
Sameness TestAt(const Call& call, std::size_t first);

}  // namespace hires::planning
