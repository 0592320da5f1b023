#include <fmt/format.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/functions.h"
#include "planning/functions/expression_compiler.h"
#include "planning/functions/expression_node.h"

namespace hires::planning {
namespace {

using Node = ExpressionNode;

// What one evaluation may make; a list of kMaxListElements fits several times.
constexpr std::size_t kMaxPairs = 8 * kMaxListElements;

/// One evaluation. Its depth is that of the expression, which the compiler bounds.
class Evaluation {
 public:
  Evaluation(const CompiledExpression& expression, TermTable* terms, VariableValues* variables)
      : expression_(expression),
        terms_(terms),
        variables_(variables),
        max_mark_(terms->Mark() + kMaxPairs),
        locals_(static_cast<std::size_t>(expression.num_locals)) {}

  Term Run(const Node& node) {
    switch (node.kind) {
      case Node::Kind::kConstant:
        return node.constant;
      case Node::Kind::kVariable:
        return Bound(node, variables_->Value(node.slot));
      case Node::Kind::kQuotedVariable:
        return variables_->Value(node.slot);
      case Node::Kind::kLocal:
        return locals_[static_cast<std::size_t>(node.slot)];
      case Node::Kind::kTemplate:
        return Fill(node);
      case Node::Kind::kCall:
      case Node::Kind::kListForm:
        return CallOf(node);
      case Node::Kind::kCond:
        return Cond(node);
      case Node::Kind::kAnd:
        return And(node);
      case Node::Kind::kOr:
        return Or(node);
      case Node::Kind::kSequence:
        return RunFrom(node, 0);
      case Node::Kind::kLet:
        return Let(node);
    }
    return {};
  }

 private:
  [[noreturn]] void Fail(const Node& node, const std::string& text) const {
    FailAt(expression_.source, node.datum->place,
           fmt::format("{}: {}", Excerpt(*node.datum), text));
  }

  Term Bound(const Node& node, Term value) const {
    if (value.IsVariable()) {
      Fail(node,
           "the variable has no value here; bind it in an earlier goal, or quote it where "
           "the variable itself is meant");
    }
    return value;
  }

  bool Holds(const Node& node) { return !Bound(node, Run(node)).IsNil(); }

  Term Fill(const Node& node) {
    std::vector<Term> values;
    values.reserve(node.parts.size());
    for (const Node& part : node.parts) values.push_back(Run(part));
    Term list = values.back();
    for (std::size_t i = values.size() - 1; i-- > 0;) list = terms_->Pair(values[i], list);
    return list;
  }

  Term CallOf(const Node& node) {
    node.arguments.clear();
    for (const Node& part : node.parts) node.arguments.push_back(Argument(node, part));
    const Term value = Call(node);
    if (terms_->Mark() > max_mark_) {
      Fail(node,
           fmt::format("the expression makes lists of more than {} elements in all", kMaxPairs));
    }
    return value;
  }

  Term Argument(const Node& call, const Node& part) {
    const Term value = Run(part);
    if (!call.takes_unbound && !terms_->IsGround(value)) {
      Fail(call, fmt::format("'{}' got {} with a variable that has no value here; bind it in an "
                             "earlier goal",
                             call.callable.name, Excerpt(*part.datum)));
    }
    return value;
  }

  Term Call(const Node& node) const {
    try {
      return node.kind == Node::Kind::kCall
                 ? node.callable(terms_, node.arguments, expression_.true_term)
                 : ApplyListForm(node.list_form, node.callable, terms_, node.arguments,
                                 expression_.true_term);
    } catch (const EvaluationError& error) {
      Fail(node, error.what());
    } catch (const base::ConfigError& error) {  // of the terms: lists that nest too deep
      Fail(node, error.what());
    }
  }

  Term Cond(const Node& node) {
    for (const Node& clause : node.parts) {
      const Term test = Bound(clause.parts.front(), Run(clause.parts.front()));
      if (test.IsNil()) continue;
      return clause.parts.size() == 1 ? test : RunFrom(clause, 1);
    }
    return {};
  }

  Term And(const Node& node) {
    Term value = expression_.true_term;
    for (const Node& part : node.parts) {
      value = Bound(part, Run(part));
      if (value.IsNil()) break;
    }
    return value;
  }

  Term Or(const Node& node) {
    for (const Node& part : node.parts) {
      const Term value = Bound(part, Run(part));
      if (!value.IsNil()) return value;
    }
    return {};
  }

  Term RunFrom(const Node& node, std::size_t first) {
    Term value;
    for (std::size_t i = first; i < node.parts.size(); ++i) value = Run(node.parts[i]);
    return value;
  }

  Term Let(const Node& node) {
    const std::size_t count = node.parts.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
      locals_[static_cast<std::size_t>(node.slot) + i] = Run(node.parts[i]);
    }
    return Run(node.parts.back());
  }

  const CompiledExpression& expression_;
  TermTable* terms_;
  VariableValues* variables_;
  std::size_t max_mark_;
  std::vector<Term> locals_;
};

}  // namespace

Expression::Expression(const Datum& datum, const std::function<int(const std::string&)>& slot_of,
                       const Functions& functions, TermTable* terms, const std::string& source,
                       std::vector<std::string>* unknown)
    : compiled_(CompileExpression(datum, slot_of, functions, terms, source, unknown)) {}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

Term Expression::Evaluate(TermTable* terms, VariableValues* variables) const {
  return Evaluation(*compiled_, terms, variables).Run(compiled_->root);
}

}  // namespace hires::planning
