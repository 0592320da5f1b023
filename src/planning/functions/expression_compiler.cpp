#include "planning/functions/expression_compiler.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"

namespace hires::planning {
namespace {

using Node = ExpressionNode;
using Kind = ExpressionNode::Kind;

/// A form that applies a function: where the function stands, and how many further arguments.
struct ListFormShape {
  ListForm form;
  std::size_t function_at;  // index among the arguments
  int min_others;
  int max_others;
};

const std::map<std::string, ListFormShape, std::less<>>& ListForms() {
  static const std::map<std::string, ListFormShape, std::less<>> forms = {
      {"mapcar", {ListForm::kMapcar, 0, 1, -1}},
      {"some", {ListForm::kSome, 0, 1, -1}},
      {"every", {ListForm::kEvery, 0, 1, -1}},
      {"find-if", {ListForm::kFindIf, 0, 1, 1}},
      {"count-if", {ListForm::kCountIf, 0, 1, 1}},
      {"remove-if", {ListForm::kRemoveIf, 0, 1, 1}},
      {"remove-if-not", {ListForm::kRemoveIfNot, 0, 1, 1}},
      {"reduce", {ListForm::kReduce, 0, 1, 3}},
      {"sort", {ListForm::kSort, 1, 1, 1}},
      {"apply", {ListForm::kApply, 0, 1, -1}},
      {"funcall", {ListForm::kFuncall, 0, 0, -1}},
  };
  return forms;
}

/// With how many arguments a form calls its function; nothing where that is known only later.
std::optional<std::size_t> InnerArguments(ListForm form, std::size_t others) {
  if (form == ListForm::kApply) return std::nullopt;
  if (form == ListForm::kReduce || form == ListForm::kSort) return 2;
  return others;
}

bool IsDeeperThan(const Datum& datum, int limit) {
  if (!datum.IsList()) return false;
  if (limit == 0) return true;
  const auto is_deeper = [&](const Datum& part) { return IsDeeperThan(part, limit - 1); };
  return std::any_of(datum.items.begin(), datum.items.end(), is_deeper) ||
         std::any_of(datum.tail.begin(), datum.tail.end(), is_deeper);
}

bool HasHead(const Datum& datum, std::string_view head) {
  return std::any_of(datum.items.begin(), datum.items.end(),
                     [&](const Datum& part) { return HasHead(part, head); }) ||
         datum.Head() == head;
}

std::string CountText(int least, int most) {
  if (most < 0) return fmt::format("{} or more", least);
  return least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
}

bool IsConstantSymbol(const Datum& datum) {
  return datum.text == "t" || datum.text == "nil" ||
         (datum.text.size() > 1 && datum.text.front() == ':');
}

class ExpressionCompiler {
 public:
  ExpressionCompiler(const std::function<int(const std::string&)>& slot_of,
                     const Functions& functions, TermTable* terms, const std::string& source,
                     std::vector<std::string>* unknown)
      : slot_of_(slot_of),
        functions_(functions),
        terms_(terms),
        source_(source),
        unknown_(unknown) {}

  using Form = Node (ExpressionCompiler::*)(const Datum&);
  static const std::map<std::string, Form, std::less<>>& Forms();

  int num_locals() const { return num_locals_; }

  Node Compile(const Datum& datum) {
    switch (datum.kind) {
      case Datum::Kind::kVariable:
        return Variable(datum, Kind::kVariable);
      case Datum::Kind::kSymbol:
        return Symbol(datum);
      case Datum::Kind::kList:
        return datum.IsNil() ? Constant(datum, Term()) : List(datum);
      default:
        return Constant(datum, terms_->FromDatum(datum));
    }
  }

 private:
  [[noreturn]] void Fail(const Datum& datum, const std::string& text) const {
    FailAt(source_, datum.place, fmt::format("{}: {}", Excerpt(datum), text));
  }

  void CheckCount(const Datum& call, std::string_view kind, int least, int most) const {
    const int count = static_cast<int>(call.items.size()) - 1;
    if (count >= least && (most < 0 || count <= most)) return;
    Fail(call, fmt::format("{} '{}' has {} argument{}, takes {}", kind, call.Head(), count,
                           count == 1 ? "" : "s", CountText(least, most)));
  }

  static Node Make(const Datum& datum, Kind kind) {
    Node node;
    node.kind = kind;
    node.datum = &datum;
    return node;
  }

  static Node Constant(const Datum& datum, Term value) {
    Node node = Make(datum, Kind::kConstant);
    node.constant = value;
    return node;
  }

  Node Variable(const Datum& datum, Kind kind) {
    Node node = Make(datum, kind);
    node.slot = slot_of_(datum.text);
    return node;
  }

  Node Symbol(const Datum& datum) {
    if (IsConstantSymbol(datum)) return Constant(datum, terms_->Symbol(datum.text));
    for (auto local = locals_.rbegin(); local != locals_.rend(); ++local) {
      if (local->first != datum.text) continue;
      Node node = Make(datum, Kind::kLocal);
      node.slot = local->second;
      return node;
    }
    std::vector<std::string> known;
    for (const auto& local : locals_) known.push_back(local.first);
    Fail(datum,
         base::UnknownName("unbound name: value", datum.text, known) +
             fmt::format("; write '{} for the symbol itself (words stand for themselves, as in "
                         "JSHOP2, where a file computes by (call ...) alone)",
                         Excerpt(datum)));
  }

  Node List(const Datum& datum) {
    if (!datum.tail.empty()) {
      Fail(datum, "a call cannot be a dotted list; spread a list by (apply #'function list)");
    }
    const std::string head(datum.Head());
    if (head.empty()) {
      Fail(datum, "a call begins with the name of a function; quote what is meant as a list");
    }
    const auto form = Forms().find(head);
    if (form != Forms().end()) return (this->*form->second)(datum);
    if (ListForms().count(head) > 0) return ApplyForm(datum);
    return FunctionCall(datum);
  }

  Node FunctionCall(const Datum& datum) {
    Node node = Make(datum, Kind::kCall);
    node.callable = Resolve(datum, datum.items.front());
    CheckCount(datum, "function", node.callable.min_arguments, node.callable.max_arguments);
    node.takes_unbound =
        datum.Head() == "list" || datum.Head() == "list*" || datum.Head() == "cons";
    CompileParts(datum, 1, &node);
    if (node.takes_unbound) LetVariablesThrough(&node);
    node.arguments.reserve(node.parts.size());
    return node;
  }

  static void LetVariablesThrough(Node* node) {
    for (Node& part : node->parts) {
      if (part.kind == Kind::kVariable) part.kind = Kind::kQuotedVariable;
    }
  }

  void CompileParts(const Datum& datum, std::size_t first, Node* node) {
    for (std::size_t i = first; i < datum.items.size(); ++i) {
      node->parts.push_back(Compile(datum.items[i]));
    }
  }

  Callable Resolve(const Datum& datum, const Datum& name) const {
    const Functions::Entry* entry = functions_.Find(name.text);
    if (entry == nullptr) return Unknown(datum, name.text);
    Callable callable{entry->name, entry->min_arguments, entry->max_arguments, nullptr, {}};
    const auto* test = entry->function.target<StandardPredicate>();
    if (test != nullptr) {
      callable.predicate = test->predicate;
    } else {
      callable.function = entry->function;
    }
    return callable;
  }

  /// Fails where it is called.
  Callable Unknown(const Datum& datum, const std::string& name) const {
    const std::string text = UnknownFunctionText(name, functions_);
    if (unknown_ == nullptr) Fail(datum, text);
    unknown_->push_back(Located(source_, datum.place, Excerpt(datum) + ": " + text));
    const auto fail = [text](TermTable*, const std::vector<Term>&) -> Term {
      throw EvaluationError(text);
    };
    return {name, 0, -1, nullptr, fail};
  }

  // ---------------------------------------------------------------- forms that apply a function

  Node ApplyForm(const Datum& datum) {
    const ListFormShape& shape = ListForms().find(datum.Head())->second;
    CheckCount(datum, "form", shape.min_others + 1,
               shape.max_others < 0 ? -1 : shape.max_others + 1);
    Node node = Make(datum, Kind::kListForm);
    node.list_form = shape.form;
    const std::size_t function_at = shape.function_at + 1;
    node.callable = Resolve(datum, FunctionName(datum, datum.items[function_at]));
    for (std::size_t i = 1; i < datum.items.size(); ++i) {
      if (i != function_at) node.parts.push_back(Compile(datum.items[i]));
    }
    CheckInner(datum, node);
    return node;
  }

  const Datum& FunctionName(const Datum& datum, const Datum& argument) const {
    const bool is_named =
        (argument.Head() == "function" || argument.Head() == "quote") && argument.items.size() == 2;
    if (!is_named || argument.items[1].kind != Datum::Kind::kSymbol) {
      Fail(datum, fmt::format("got {} where the name of a function was wanted, like #'first; "
                              "lambda and computed functions are not supported, C++ code can add "
                              "the function by name",
                              Excerpt(argument)));
    }
    return argument.items[1];
  }

  void CheckInner(const Datum& datum, const Node& node) const {
    const auto count = InnerArguments(node.list_form, node.parts.size());
    if (!count || node.callable.Takes(*count)) return;
    Fail(datum, fmt::format("calls '{}' with {} argument{}, which takes {}", node.callable.name,
                            *count, *count == 1 ? "" : "s",
                            CountText(node.callable.min_arguments, node.callable.max_arguments)));
  }

  // ---------------------------------------------------------------- quoted data

  Node Quote(const Datum& datum) {
    CheckCount(datum, "form", 1, 1);
    return Template(datum.items[1], false);
  }

  Node Backquote(const Datum& datum) {
    CheckCount(datum, "form", 1, 1);
    if (HasHead(datum.items[1], "backquote")) {
      Fail(datum, "a backquote within a backquote is not supported; build the inner list by list");
    }
    return Template(datum.items[1], true);
  }

  Node Template(const Datum& datum, bool backquoted) {
    if (datum.kind == Datum::Kind::kVariable) return Variable(datum, Kind::kQuotedVariable);
    if (datum.Head() == "unquote") return Unquoted(datum, backquoted);
    if (IsGround(datum) && !HasHead(datum, "unquote")) {
      return Constant(datum, terms_->FromDatum(datum));
    }
    Node node = Make(datum, Kind::kTemplate);
    for (const Datum& part : datum.items) node.parts.push_back(Template(part, backquoted));
    node.parts.push_back(datum.tail.empty() ? Constant(datum, Term())
                                            : Template(datum.tail.front(), backquoted));
    return node;
  }

  Node Unquoted(const Datum& datum, bool backquoted) {
    if (!backquoted) Fail(datum, "a comma belongs inside a backquote (`), not a quote (')");
    CheckCount(datum, "form", 1, 1);
    return Compile(datum.items[1]);
  }

  Node StrayUnquote(const Datum& datum) { Fail(datum, "a comma belongs inside a backquote (`)"); }

  Node FunctionForm(const Datum& datum) {
    CheckCount(datum, "form", 1, 1);
    const Datum& name = FunctionName(datum, datum);
    Resolve(datum, name);
    return Constant(datum, terms_->Symbol(name.text));
  }

  Node Lambda(const Datum& datum) {
    Fail(datum, "lambda is not supported; name a function, which C++ code can add");
  }

  // ---------------------------------------------------------------- control

  /// The parts of `datum` from `first` on, one after the other.
  Node Sequence(const Datum& datum, std::size_t first) {
    Node node = Make(datum, Kind::kSequence);
    CompileParts(datum, first, &node);
    return node;
  }

  Node Clause(const Datum& datum, std::vector<Node> parts) {
    Node node = Make(datum, Kind::kSequence);
    node.parts = std::move(parts);
    return node;
  }

  Node If(const Datum& datum) {
    CheckCount(datum, "form", 2, 3);
    Node node = Make(datum, Kind::kCond);
    node.parts.push_back(Clause(datum, {Compile(datum.items[1]), Compile(datum.items[2])}));
    if (datum.items.size() == 4)
      node.parts.push_back(Clause(datum, {True(datum), Compile(datum.items[3])}));
    return node;
  }

  Node True(const Datum& datum) { return Constant(datum, terms_->Symbol("t")); }

  Node When(const Datum& datum) {
    CheckCount(datum, "form", 1, -1);
    Node node = Make(datum, Kind::kCond);
    node.parts.push_back(Clause(datum, {Compile(datum.items[1]), Sequence(datum, 2)}));
    return node;
  }

  Node Unless(const Datum& datum) {
    CheckCount(datum, "form", 1, -1);
    Node node = Make(datum, Kind::kCond);
    node.parts.push_back(Clause(datum, {Compile(datum.items[1]), Constant(datum, Term())}));
    node.parts.push_back(Clause(datum, {True(datum), Sequence(datum, 2)}));
    return node;
  }

  Node Cond(const Datum& datum) {
    Node node = Make(datum, Kind::kCond);
    for (std::size_t i = 1; i < datum.items.size(); ++i) {
      const Datum& clause = datum.items[i];
      if (!clause.IsList() || clause.items.empty() || !clause.tail.empty()) {
        Fail(clause, "a clause of cond is a list (test value)");
      }
      node.parts.push_back(Sequence(clause, 0));
    }
    return node;
  }

  Node And(const Datum& datum) { return Logical(datum, Kind::kAnd); }
  Node Or(const Datum& datum) { return Logical(datum, Kind::kOr); }
  Node Logical(const Datum& datum, Kind kind) {
    Node node = Make(datum, kind);
    CompileParts(datum, 1, &node);
    return node;
  }

  Node Progn(const Datum& datum) { return Sequence(datum, 1); }
  Node Let(const Datum& datum) { return Binding(datum, false); }
  Node LetStar(const Datum& datum) { return Binding(datum, true); }

  // Every binding has a slot of its own, so the values of a plain let may be stored at once.
  Node Binding(const Datum& datum, bool one_after_the_other) {
    CheckCount(datum, "form", 1, -1);
    const Datum& bindings = datum.items[1];
    if (!bindings.IsList() || !bindings.tail.empty()) {
      Fail(datum, "wanted a list of bindings ((name value) ...)");
    }
    Node node = Make(datum, Kind::kLet);
    node.slot = num_locals_;
    num_locals_ += static_cast<int>(bindings.items.size());
    const std::size_t num_outer = locals_.size();
    std::vector<std::pair<std::string, int>> fresh;
    for (const Datum& binding : bindings.items) {
      const int slot = node.slot + static_cast<int>(node.parts.size());
      node.parts.push_back(BoundValue(binding));
      auto& scope = one_after_the_other ? locals_ : fresh;
      scope.emplace_back(BoundName(binding), slot);
    }
    locals_.insert(locals_.end(), fresh.begin(), fresh.end());
    node.parts.push_back(Sequence(datum, 2));
    locals_.resize(num_outer);
    return node;
  }

  /// The value in (name value); nil for (name) and for the name alone.
  Node BoundValue(const Datum& binding) {
    if (!binding.IsList() || binding.items.size() == 1) return Constant(binding, Term());
    if (binding.items.size() != 2 || !binding.tail.empty()) {
      Fail(binding, "a binding is (name value)");
    }
    return Compile(binding.items[1]);
  }

  std::string BoundName(const Datum& binding) const {
    const Datum& name = binding.IsList() ? binding.items.front() : binding;
    if (name.kind != Datum::Kind::kSymbol || IsConstantSymbol(name)) {
      Fail(binding,
           fmt::format("let binds a name that is a symbol without ?, got {}", Excerpt(name)));
    }
    return name.text;
  }

  const std::function<int(const std::string&)>& slot_of_;
  const Functions& functions_;
  TermTable* terms_;
  const std::string& source_;
  std::vector<std::string>* unknown_;
  std::vector<std::pair<std::string, int>> locals_;  // of the lets around, innermost last
  int num_locals_{0};
};

const std::map<std::string, ExpressionCompiler::Form, std::less<>>& ExpressionCompiler::Forms() {
  static const std::map<std::string, Form, std::less<>> forms = {
      {"quote", &ExpressionCompiler::Quote},
      {"function", &ExpressionCompiler::FunctionForm},
      {"backquote", &ExpressionCompiler::Backquote},
      {"unquote", &ExpressionCompiler::StrayUnquote},
      {"if", &ExpressionCompiler::If},
      {"cond", &ExpressionCompiler::Cond},
      {"when", &ExpressionCompiler::When},
      {"unless", &ExpressionCompiler::Unless},
      {"and", &ExpressionCompiler::And},
      {"or", &ExpressionCompiler::Or},
      {"let", &ExpressionCompiler::Let},
      {"let*", &ExpressionCompiler::LetStar},
      {"progn", &ExpressionCompiler::Progn},
      {"lambda", &ExpressionCompiler::Lambda},
  };
  return forms;
}

}  // namespace

bool IsForm(std::string_view name) {
  return ExpressionCompiler::Forms().count(name) > 0 || ListForms().count(name) > 0;
}

std::vector<std::string> FormNames() {
  std::vector<std::string> names;
  for (const auto& form : ExpressionCompiler::Forms()) names.push_back(form.first);
  for (const auto& form : ListForms()) names.push_back(form.first);
  return names;
}

std::string UnknownFunctionText(const std::string& name, const Functions& functions) {
  std::vector<std::string> known = functions.Names();
  const std::vector<std::string> forms = FormNames();
  known.insert(known.end(), forms.begin(), forms.end());
  const std::string excerpt = Excerpt(MakeSymbol(name));
  if (!base::LikelyNames(excerpt, known).empty()) {
    return base::UnknownName("function", excerpt, known) +
           "; C++ code adds more through Functions::Add";
  }
  return fmt::format(
      "function '{}' is unknown, and none has a name like it; functions that a JSHOP2 domain has "
      "in Java are not read: C++ code adds them through Functions::Add",
      excerpt);
}

bool Callable::Takes(std::size_t count) const {
  const int arguments = static_cast<int>(count);
  return arguments >= min_arguments && (max_arguments < 0 || arguments <= max_arguments);
}

std::unique_ptr<CompiledExpression> CompileExpression(
    const Datum& datum, const std::function<int(const std::string&)>& slot_of,
    const Functions& functions, TermTable* terms, const std::string& source,
    std::vector<std::string>* unknown) {
  if (IsDeeperThan(datum, kMaxExpressionDepth)) {
    FailAt(source, datum.place,
           fmt::format("{}: an expression may nest {} lists deep, this one is deeper; split it "
                       "over several goals",
                       Excerpt(datum), kMaxExpressionDepth));
  }
  auto compiled = std::make_unique<CompiledExpression>();
  compiled->datum = datum;
  compiled->source = source;
  compiled->true_term = terms->Symbol("t");
  ExpressionCompiler compiler(slot_of, functions, terms, compiled->source, unknown);
  compiled->root = compiler.Compile(compiled->datum);
  compiled->num_locals = compiler.num_locals();
  return compiled;
}

}  // namespace hires::planning
