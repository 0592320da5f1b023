#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/reference_prover.h"
#include "hires/planning/shop2_reader.h"
#include "planning/language/shop2_parts.h"

namespace hires::planning {
namespace shop2 {
namespace {

/// How many arguments a head or a task has; with a dot, that many or more.
struct Arity {
  std::size_t count;
  bool is_open;
};

Arity ArityOf(const Datum& term) { return {term.items.size() - 1, !term.tail.empty()}; }

bool Fit(Arity task, Arity head) {
  const bool task_is_enough = task.count >= head.count || task.is_open;
  const bool head_is_enough = head.count >= task.count || head.is_open;
  return task_is_enough && head_is_enough;
}

std::string CountText(Arity arity, std::string_view noun) {
  return fmt::format("{}{} {}{}", arity.is_open ? "at least " : "", arity.count, noun,
                     arity.count == 1 ? "" : "s");
}

/// Everything that handles tasks, by name.
class Handlers {
 public:
  explicit Handlers(const Domain& domain) {
    for (const Operator& op : domain.operators) Add(op.head, "operator");
    for (const Method& method : domain.methods) Add(method.head, "method");
  }

  /// @param unknown  takes tasks that nothing handles; null: they are errors.
  void Check(const Construct& in, const TaskNetwork& network,
             std::map<std::string, std::string>* unknown) const {
    for (const TaskItem& item : network.items) {
      if (item.network.empty()) {
        CheckTask(in, item, unknown);
      } else {
        Check(in, item.network.front(), unknown);
      }
    }
  }

 private:
  struct Handler {
    std::string_view kind;
    const Datum* head;
  };

  void Add(const Datum& head, std::string_view kind) {
    handlers_[std::string(head.Head())].push_back({kind, &head});
  }

  void CheckTask(const Construct& in, const TaskItem& item,
                 std::map<std::string, std::string>* unknown) const {
    const std::string name(item.task.Head());
    const auto found = handlers_.find(name);
    if (found == handlers_.end()) {
      if (unknown == nullptr) Fail(in, item.place, UnknownText(name));
      unknown->emplace(name, Located(in.source, item.place, in.name + ": " + UnknownText(name)));
      return;
    }
    const Arity arity = ArityOf(item.task);
    const bool fits =
        std::any_of(found->second.begin(), found->second.end(),
                    [&](const Handler& handler) { return Fit(arity, ArityOf(*handler.head)); });
    if (!fits) FailArity(in, item, found->second.front());
  }

  [[noreturn]] static void FailArity(const Construct& in, const TaskItem& item,
                                     const Handler& handler) {
    Fail(in, item.place,
         fmt::format("task '{}' has {}, {} {} in line {} takes {}; correct one of them",
                     item.task.Head(), CountText(ArityOf(item.task), "argument"), handler.kind,
                     ToString(*handler.head), handler.head->place.line,
                     CountText(ArityOf(*handler.head), "argument")));
  }

  std::string UnknownText(const std::string& name) const {
    const std::vector<std::string> names = NamesLike(name);
    const std::string text = names.empty() ? fmt::format("task '{}' is unknown", name)
                                           : base::UnknownName("task", name, names);
    return text + (names.empty() ? "; write" : " Write") +
           " an operator or a method for it, or correct its name";
  }

  /// Comparing names takes time with their lengths and number, and files come from anywhere.
  std::vector<std::string> NamesLike(const std::string& name) const {
    constexpr std::size_t kMaxNames = 1000;
    constexpr std::size_t kMaxLength = 100;
    std::vector<std::string> names;
    for (const auto& [known, handlers] : handlers_) {
      if (names.size() == kMaxNames || name.size() > kMaxLength) break;
      if (known.size() <= kMaxLength) names.push_back(known);
    }
    return names;
  }

  std::map<std::string, std::vector<Handler>> handlers_;
};

std::string NameOf(const Datum& head) { return std::string(head.Head()); }

void CheckOperatorNames(const Domain& domain) {
  std::map<std::string, Place> places;
  for (const Operator& op : domain.operators) {
    const auto [first, is_new] = places.emplace(NameOf(op.head), op.place);
    if (is_new) continue;
    Fail({domain.source, fmt::format("operator '{}'", first->first)}, op.place,
         fmt::format("stands in line {} already, and a name may have one operator; rename one, or "
                     "make the difference in a method",
                     first->second.line));
  }
}

// --------------------------------------------------------------------------------- unbound effects

void CollectFrom(const Formula& formula, std::set<std::string>* bound) {
  std::vector<std::string> found = formula.variables;
  CollectVariables(formula.term, &found);
  CollectVariables(formula.expression, &found);
  bound->insert(found.begin(), found.end());
  for (const Formula& part : formula.parts) CollectFrom(part, bound);
}

/// What a condition binds is added to the variables that were bound before.
using Collect = void (*)(const Formula& condition, std::set<std::string>* bound);

/// Variables of effects that nothing binds are reported, each with its effect.
template <typename Report>
void FindUnbound(const std::vector<Effect>& effects, Collect collect,
                 const std::set<std::string>& bound, const Report& report) {
  for (const Effect& effect : effects) {
    std::vector<std::string> used;
    CollectVariables(effect.term, &used);
    for (const std::string& name : used) {
      if (bound.count(name) == 0) report(effect, name);
    }
    if (effect.kind != Effect::Kind::kForall) continue;
    std::set<std::string> bound_inside = bound;
    collect(effect.condition, &bound_inside);
    FindUnbound(effect.effects, collect, bound_inside, report);
  }
}

template <typename Report>
void FindUnbound(const Operator& op, const std::vector<Effect>& effects, Collect collect,
                 const Report& report) {
  std::vector<std::string> in_head;
  CollectVariables(op.head, &in_head);
  std::set<std::string> bound(in_head.begin(), in_head.end());
  collect(op.precondition.condition, &bound);
  FindUnbound(effects, collect, bound, report);
}

/// Variables that a proof binds: not those that stand under a `not` and its like alone.
void CollectBinders(const Formula& formula, std::set<std::string>* bound) {
  const std::set<std::string> binders = VariablesBoundBy(formula);
  bound->insert(binders.begin(), binders.end());
}

/// As it is written: a reader's own names have a `#`.
std::string WrittenName(const std::string& name) {
  return name.compare(0, 3, "?_#") == 0 ? "?" : name.substr(0, name.find('#'));
}

void CheckEffects(Domain* domain) {
  for (const Operator& op : domain->operators) {
    const Construct in{domain->source, fmt::format("operator '{}'", op.head.Head())};
    FindUnbound(op, op.adds, CollectFrom, [&](const Effect& add, const std::string& name) {
      Fail(in, add.place,
           fmt::format("{} in an add is neither in the head nor in the precondition, so that "
                       "nothing can bind it; bind it there or correct its name",
                       WrittenName(name)));
    });
    FindUnbound(op, op.deletes, CollectBinders, [&](const Effect& gone, const std::string& name) {
      domain->warnings.push_back(
          Located(in.source, gone.place,
                  fmt::format("{}: {} in the delete {} is never bound, so that it deletes nothing; "
                              "bind it in the head or in the precondition or correct its name",
                              in.name, WrittenName(name), Excerpt(gone.term))));
    });
  }
}

void CheckSubtasks(Domain* domain) {
  const Handlers handlers(*domain);
  for (const Method& method : domain->methods) {
    for (std::size_t i = 0; i < method.branches.size(); ++i) {
      const std::string branch =
          method.branches.size() > 1 ? fmt::format(", branch {}", i + 1) : "";
      handlers.Check({domain->source, fmt::format("method '{}'{}", method.head.Head(), branch)},
                     method.branches[i].subtasks, &domain->unknown_tasks);
    }
  }
}

}  // namespace

void CheckDomain(Domain* domain) {
  CheckOperatorNames(*domain);
  CheckEffects(domain);
  CheckSubtasks(domain);
}

}  // namespace shop2

void CheckTasks(const Problem& problem, const Domain& domain) {
  // A task that was typed belongs to no problem.
  const std::string where =
      problem.name.empty() ? "the task" : fmt::format("problem '{}'", problem.name);
  shop2::Handlers(domain).Check({problem.source, where}, problem.tasks, nullptr);
}

}  // namespace hires::planning
