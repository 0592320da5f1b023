#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "planning/functions/expression_node.h"

// The forms that apply a function to the elements of lists.
namespace hires::planning {
namespace {

/// A function with all that its calls need.
class Applied {
 public:
  Applied(const Callable& callable, TermTable* terms, Term true_term)
      : callable_(callable), terms_(terms), true_term_(true_term) {}

  Term operator()(const std::vector<Term>& arguments) const {
    for (const Term argument : arguments) {
      if (!terms_->IsGround(argument)) {
        throw EvaluationError(fmt::format("'{}' got a variable without a value", callable_.name));
      }
    }
    return callable_(terms_, arguments, true_term_);
  }
  bool Holds(Term value) const { return !(*this)({value}).IsNil(); }
  bool Holds(Term a, Term b) const { return !(*this)({a, b}).IsNil(); }
  const Callable& callable() const { return callable_; }

 private:
  const Callable& callable_;
  TermTable* terms_;
  Term true_term_;
};

/// The i-th elements of all argument lists; false behind the end of the shortest.
class Rows {
 public:
  explicit Rows(const Call& call) : call_(call), rests_(call.arguments) {}

  bool Next(std::vector<Term>* row) {
    row->clear();
    for (std::size_t i = 0; i < rests_.size(); ++i) {
      if (rests_[i].IsNil()) return false;
      if (!rests_[i].IsPair()) RefuseArgument(call_, i, "a list");
      row->push_back(call_.terms->head(rests_[i]));
      rests_[i] = call_.terms->tail(rests_[i]);
    }
    return true;
  }

 private:
  const Call& call_;
  std::vector<Term> rests_;
};

Term Mapcar(const Call& call, const Applied& function) {
  std::vector<Term> row, results;
  for (Rows rows(call); rows.Next(&row) && results.size() <= kMaxListElements;) {
    results.push_back(function(row));
  }
  return MakeBoundedList(call, results);
}

Term Some(const Call& call, const Applied& function) {
  std::vector<Term> row;
  for (Rows rows(call); rows.Next(&row);) {
    const Term result = function(row);
    if (!result.IsNil()) return result;
  }
  return {};
}

Term Every(const Call& call, const Applied& function, Term true_term) {
  std::vector<Term> row;
  for (Rows rows(call); rows.Next(&row);) {
    if (function(row).IsNil()) return {};
  }
  return true_term;
}

Term FindIf(const Call& call, const Applied& function) {
  for (const Term element : Elements(call, 0)) {
    if (function.Holds(element)) return element;
  }
  return {};
}

Term Keep(const Call& call, const Applied& function, bool wanted) {
  std::vector<Term> kept;
  for (const Term element : Elements(call, 0)) {
    if (function.Holds(element) == wanted) kept.push_back(element);
  }
  return MakeBoundedList(call, kept);
}

Term CountIf(const Call& call, const Applied& function) {
  const std::vector<Term> elements = Elements(call, 0);
  return call.terms->Integer(std::count_if(elements.begin(), elements.end(),
                                           [&](Term value) { return function.Holds(value); }));
}

// The bounded merges of std::stable_sort stay within the list even where the function is no order.
Term Sort(const Call& call, const Applied& function) {
  std::vector<Term> elements = Elements(call, 0);
  std::stable_sort(elements.begin(), elements.end(),
                   [&](Term a, Term b) { return function.Holds(a, b); });
  return MakeBoundedList(call, elements);
}

/// The list with the value of `:initial-value` in front, where there is one.
std::vector<Term> ReducedElements(const Call& call) {
  std::vector<Term> elements = Elements(call, 0);
  if (call.size() == 1) return elements;
  const bool is_key =
      call[1].kind() == Term::Kind::kSymbol && call.terms->text(call[1]) == ":initial-value";
  if (!is_key || call.size() != 3) RefuseArgument(call, 1, ":initial-value and a value");
  elements.insert(elements.begin(), call[2]);
  return elements;
}

Term Reduce(const Call& call, const Applied& function) {
  const std::vector<Term> elements = ReducedElements(call);
  if (elements.empty() && !function.callable().Takes(0)) {
    throw EvaluationError(
        fmt::format("'reduce' got an empty list, '{}' needs arguments; give an "
                    ":initial-value",
                    function.callable().name));
  }
  if (elements.empty()) return function({});
  Term result = elements.front();
  for (std::size_t i = 1; i < elements.size(); ++i) result = function({result, elements[i]});
  return result;
}

Term Apply(const Call& call, const Applied& function) {
  std::vector<Term> arguments(call.arguments.begin(), call.arguments.end() - 1);
  const std::vector<Term> last = Elements(call, call.size() - 1);
  arguments.insert(arguments.end(), last.begin(), last.end());
  if (!function.callable().Takes(arguments.size())) {
    throw EvaluationError(
        fmt::format("'apply' has {} arguments for '{}', which takes another "
                    "number of them",
                    arguments.size(), function.callable().name));
  }
  return function(arguments);
}

const char* NameOf(ListForm form) {
  switch (form) {
    case ListForm::kMapcar:
      return "mapcar";
    case ListForm::kSome:
      return "some";
    case ListForm::kEvery:
      return "every";
    case ListForm::kFindIf:
      return "find-if";
    case ListForm::kCountIf:
      return "count-if";
    case ListForm::kRemoveIf:
      return "remove-if";
    case ListForm::kRemoveIfNot:
      return "remove-if-not";
    case ListForm::kReduce:
      return "reduce";
    case ListForm::kSort:
      return "sort";
    case ListForm::kApply:
      return "apply";
    case ListForm::kFuncall:
      return "funcall";
  }
  return "";
}

}  // namespace

Term Callable::operator()(TermTable* terms, const std::vector<Term>& arguments,
                          Term true_term) const {
  if (predicate != nullptr) return predicate({name, terms, arguments}) ? true_term : Term();
  return function(terms, arguments);
}

Term ApplyListForm(ListForm form, const Callable& callable, TermTable* terms,
                   const std::vector<Term>& arguments, Term true_term) {
  const Call call{NameOf(form), terms, arguments};
  const Applied function(callable, terms, true_term);
  switch (form) {
    case ListForm::kMapcar:
      return Mapcar(call, function);
    case ListForm::kSome:
      return Some(call, function);
    case ListForm::kEvery:
      return Every(call, function, true_term);
    case ListForm::kFindIf:
      return FindIf(call, function);
    case ListForm::kCountIf:
      return CountIf(call, function);
    case ListForm::kRemoveIf:
      return Keep(call, function, false);
    case ListForm::kRemoveIfNot:
      return Keep(call, function, true);
    case ListForm::kReduce:
      return Reduce(call, function);
    case ListForm::kSort:
      return Sort(call, function);
    case ListForm::kApply:
      return Apply(call, function);
    case ListForm::kFuncall:
      return function(arguments);
  }
  return {};
}

}  // namespace hires::planning
