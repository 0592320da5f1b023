#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/datum.h"
#include "hires/planning/term.h"

namespace hires::planning {

/// What a function does not do: the text says which function, what came and what was wanted.
class EvaluationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A function that expressions of a domain may call, by name. It sees ground terms, makes its
/// answer in `terms`, has no side effects and gives the same answer for the same arguments.
/// @throws EvaluationError where the arguments are not what it takes.
using Function = std::function<Term(TermTable* terms, const std::vector<Term>& arguments)>;

/// The functions a domain may call; there is no other way out of a domain file. C++ code adds its
/// own (spatial tests, costs).
class Functions {
 public:
  /// Arithmetic (+ - * / mod rem abs min max floor ceiling round sqrt expt 1+ 1-), comparison
  /// (< <= > >= = /= eq eql equal equalp), logic (not null), lists (list cons car cdr first second
  /// third fourth fifth rest last butlast nth length append reverse member assoc remove union
  /// intersection set-difference subsetp remove-duplicates), type tests (numberp symbolp listp
  /// consp atom stringp zerop plusp minusp evenp oddp) as Common Lisp defines them, and SHOP3's
  /// print-current-state, which holds and prints nothing.
  static const Functions& Standard();

  /// @param min_arguments, max_arguments  Checked when a domain is read; -1: any number.
  /// @throws std::logic_error if the name is taken.
  void Add(std::string name, int min_arguments, int max_arguments, Function function);

  struct Entry {
    std::string name;
    int min_arguments;
    int max_arguments;
    Function function;
  };
  const Entry* Find(std::string_view name) const;  ///< null if there is none
  std::vector<std::string> Names() const;          ///< sorted

 private:
  std::vector<Entry> entries_;  ///< sorted by name
};

struct CompiledExpression;  // expression_node.h

/// Gives the values of a domain's variables while an expression is evaluated.
class VariableValues {
 public:
  virtual ~VariableValues() = default;
  /// The value of the variable in `slot`, resolved. May be or contain an unbound variable.
  virtual Term Value(int slot) = 0;
};

/// An expression of a domain, checked and ready to run: constants, variables, calls of functions,
/// and the forms quote, backquote with unquote, if, cond, when, unless, and, or, let, let*,
/// function. A
/// `?variable` stands for its value, quoted or not (as SHOP substitutes before Lisp evaluates).
class Expression {
 public:
  /// @param terms    The table that every evaluation uses; the expression keeps terms of it.
  /// @param slot_of  Number of a variable `?x` of the surrounding clause.
  /// @param source   File, for messages.
  /// @param unknown  takes what is wrong with each call of an unknown function, which then fails
  ///   where it is evaluated; null: it is an error here.
  /// @throws ConfigError naming file, line and column: unknown function (with the nearest names),
  ///   wrong number of arguments, malformed form, unknown name.
  Expression(const Datum& datum, const std::function<int(const std::string&)>& slot_of,
             const Functions& functions, TermTable* terms, const std::string& source,
             std::vector<std::string>* unknown = nullptr);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// One evaluation at a time.
  /// @throws ConfigError naming file, line and column where a function refuses its arguments, a
  ///   variable that it needs is unbound, or the expression nests or grows beyond all measure.
  Term Evaluate(TermTable* terms, VariableValues* variables) const;

 private:
  std::unique_ptr<CompiledExpression> compiled_;
};

}  // namespace hires::planning
