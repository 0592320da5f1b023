#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/datum.h"
#include "hires/planning/functions.h"
#include "hires/planning/term.h"
#include "planning/functions/standard_functions.h"

/// The compiled shape of an Expression. Its parts are expression_compiler.cpp, which builds it, and
/// expression.cpp, which runs it.
namespace hires::planning {

/// Expressions may nest this deep.
constexpr int kMaxExpressionDepth = 256;

/// Forms that take a function and a list.
enum class ListForm {
  kMapcar,
  kSome,
  kEvery,
  kFindIf,
  kCountIf,
  kRemoveIf,
  kRemoveIfNot,
  kReduce,
  kSort,
  kApply,
  kFuncall
};

/// Whether a name is a form of the language (if, let, mapcar, ...), so no function can have it.
bool IsForm(std::string_view name);
std::vector<std::string> FormNames();

/// A function as an expression calls it.
struct Callable {
  std::string name;
  int min_arguments{0};
  int max_arguments{-1};
  bool (*predicate)(const Call&){nullptr};  ///< of a standard test: the short way to its answer
  Function function;                        ///< of all others

  bool Takes(std::size_t count) const;
  Term operator()(TermTable* terms, const std::vector<Term>& arguments, Term true_term) const;
};

struct ExpressionNode {
  enum class Kind {
    kConstant,
    kVariable,        ///< must have a value
    kQuotedVariable,  ///< may be without
    kLocal,           ///< bound by let
    kTemplate,        ///< a quoted list with variables: parts, the last one its tail
    kCall,            ///< of `callable` with parts
    kListForm,        ///< `list_form` of `callable` with parts
    kCond,            ///< parts are kSequence: a test, then what follows from it
    kAnd,
    kOr,
    kSequence,  ///< the value of the last part
    kLet,       ///< values for the local slots from `slot` on, then the body
  };

  Kind kind{Kind::kConstant};
  Term constant;              ///< of kConstant
  int slot{0};                ///< of a variable of the clause, of a local one
  bool takes_unbound{false};  ///< the call lets variables without a value through (list, cons)
  ListForm list_form{ListForm::kMapcar};
  Callable callable;
  std::vector<ExpressionNode> parts;
  const Datum* datum{nullptr};  ///< what it was made of, for messages
  /// Arguments of the call that is under way. There is at most one, since nothing is recursive;
  /// kept, so that an evaluation allocates no memory.
  mutable std::vector<Term> arguments;
};

/// A compiled expression with all that it refers to.
struct CompiledExpression {
  Datum datum;
  ExpressionNode root;
  int num_locals{0};
  Term true_term;
  std::string source;
};

/// Applies `form` to its evaluated arguments, without the function itself.
/// @throws EvaluationError where they do not fit.
Term ApplyListForm(ListForm form, const Callable& callable, TermTable* terms,
                   const std::vector<Term>& arguments, Term true_term);

}  // namespace hires::planning
