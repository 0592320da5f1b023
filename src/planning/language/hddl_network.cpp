#include "planning/language/hddl_network.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"

namespace hires::planning::hddl {
namespace {

const std::vector<std::string> kUnorderedNames{":subtasks", ":tasks"};
const std::vector<std::string> kOrderedNames{":ordered-subtasks", ":ordered-tasks"};
const std::vector<std::string> kOrderingNames{":ordering", ":order"};

using Ids = std::map<std::string, int>;  // name of a subtask to its index

/// `(task ...)`, or the task in `(id (task ...))`.
const Datum& TaskWithin(const HddlScope& scope, const Datum& datum, int index, Ids* ids) {
  RequireList(scope.spot, datum, "a subtask such as (go ?place) or (id (go ?place))");
  if (datum.items.size() != 2 || !datum.items[1].IsList()) return datum;
  const std::string& id = RequireName(scope.spot, datum.items[0], "the id of a subtask");
  if (!ids->emplace(id, index).second) {
    scope.spot.Fail(datum, fmt::format("two subtasks have the id '{}'; rename one", id));
  }
  return datum.items[1];
}

/// @param atoms  of the needs: those for the action's parameters.
/// @param task  of the action.
void AddNeeds(const HddlVocabulary& vocabulary, const Datum& task,
              std::vector<Datum> HddlVocabulary::Needs::*atoms, std::vector<Formula>* conditions) {
  const auto found = vocabulary.needs.find(task.items[0].text);
  if (found == vocabulary.needs.end()) return;
  const HddlVocabulary::Needs& needs = found->second;
  std::map<std::string, Datum> values;
  for (std::size_t i = 0; i < needs.parameters.size(); ++i) {
    values[needs.parameters[i]] = task.items[i + 1];
  }
  for (const Datum& atom : needs.*atoms) conditions->push_back(MakeAtom(Substitute(atom, values)));
}

void ReadTasks(const Datum& datum, HddlScope* scope, HddlNetwork* result, Ids* ids) {
  for (const Datum* part : Conjuncts(scope->spot, datum)) {
    const int index = static_cast<int>(result->network.items.size());
    TaskItem item;
    item.task = TaskWithin(*scope, *part, index, ids);
    item.place = item.task.place;
    const HddlVocabulary::Signature& signature =
        CheckTerm(scope->spot, item.task, "task", scope->vocabulary->tasks, scope->variables,
                  scope->vocabulary);
    if (signature.kind == "action") {
      item.task.items[0].text = "!" + signature.name;
      AddNeeds(*scope->vocabulary, item.task, &HddlVocabulary::Needs::fixed, &result->conditions);
    }
    result->network.items.push_back(std::move(item));
  }
}

int IndexOf(const HddlScope& scope, const Datum& id, const Ids& ids) {
  const auto found = ids.find(RequireName(scope.spot, id, "the id of a subtask"));
  if (found != ids.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& entry : ids) known.push_back(entry.first);
  known.resize(std::min<std::size_t>(known.size(), 1000));  // enough to find what was meant
  scope.spot.Fail(id, base::UnknownName("subtask id", id.text, known));
}

/// `(< a b)`, also written `(a < b)`.
std::pair<int, int> ReadPair(const HddlScope& scope, const Datum& datum, const Ids& ids) {
  RequireList(scope.spot, datum, "(< before after)");
  const bool is_pair = datum.items.size() == 3;
  if (is_pair && datum.items[0].IsSymbol("<")) {
    return {IndexOf(scope, datum.items[1], ids), IndexOf(scope, datum.items[2], ids)};
  }
  if (is_pair && datum.items[1].IsSymbol("<")) {
    return {IndexOf(scope, datum.items[0], ids), IndexOf(scope, datum.items[2], ids)};
  }
  scope.spot.Fail(
      datum, fmt::format("{} came, wanted (< before after) with ids of subtasks", Excerpt(datum)));
}

/// Takes away tasks that nothing comes before until none is left.
/// @return a task on a circle, or -1
int FindCircle(const TaskNetwork& network) {
  const std::size_t count = network.items.size();
  std::vector<int> num_before(count);
  std::vector<std::vector<int>> after(count);
  for (const auto& [first, second] : network.order) {
    ++num_before[second];
    after[first].push_back(second);
  }
  std::vector<int> ready;
  for (std::size_t i = 0; i < count; ++i) {
    if (num_before[i] == 0) ready.push_back(static_cast<int>(i));
  }
  for (std::size_t done = 0; done < ready.size(); ++done) {
    for (const int next : after[ready[done]]) {
      if (--num_before[next] == 0) ready.push_back(next);
    }
  }
  const auto left = std::find_if(num_before.begin(), num_before.end(), [](int n) { return n > 0; });
  return left == num_before.end() ? -1 : static_cast<int>(left - num_before.begin());
}

/// The task that comes before all others, or -1: there are several that nothing comes before. What
/// something comes before comes after the only one that nothing does, as the order has no circle.
int FirstOfAll(const TaskNetwork& network) {
  std::vector<bool> has_before(network.items.size());
  for (const auto& [before, after] : network.order) has_before[after] = true;
  const auto first = std::find(has_before.begin(), has_before.end(), false);
  if (first == has_before.end() ||
      std::find(first + 1, has_before.end(), false) != has_before.end())
    return -1;
  return static_cast<int>(first - has_before.begin());
}

void ReadOrdering(const Datum& datum, const HddlScope& scope, const Ids& ids,
                  TaskNetwork* network) {
  for (const Datum* part : Conjuncts(scope.spot, datum)) {
    network->order.push_back(ReadPair(scope, *part, ids));
  }
  std::sort(network->order.begin(), network->order.end());
  network->order.erase(std::unique(network->order.begin(), network->order.end()),
                       network->order.end());
  const int circle = FindCircle(*network);
  if (circle < 0) return;
  scope.spot.Fail(datum, fmt::format("the order of the subtasks has a circle: {} would come before "
                                     "itself; take one (< ...) away",
                                     Excerpt(network->items[circle].task)));
}

/// Constraints are equalities and types, also denied.
void ReadConstraints(const Datum& datum, HddlScope* scope, std::vector<Formula>* conditions) {
  for (const Datum* part : Conjuncts(scope->spot, datum)) {
    const bool denied = part->Head() == "not" && part->items.size() == 2;
    const std::string_view head = denied ? part->items[1].Head() : part->Head();
    if (head != "=" && !IsSortWord(head)) {
      scope->spot.Fail(*part, fmt::format("{} came, wanted (= a b), (sortof ?x - type) or "
                                          "(not ...) of them; put other conditions into "
                                          ":precondition",
                                          Excerpt(*part)));
    }
    conditions->push_back(ReadCondition(*part, scope));
  }
}

}  // namespace

const std::vector<std::string>& NetworkFields() {
  static const std::vector<std::string> names{":subtasks",      ":tasks",    ":ordered-subtasks",
                                              ":ordered-tasks", ":ordering", ":order",
                                              ":constraints"};
  return names;
}

HddlNetwork ReadNetwork(const HddlFields& fields, HddlScope* scope) {
  const Datum* unordered = fields.FindOneOf(kUnorderedNames);
  const Datum* ordered = fields.FindOneOf(kOrderedNames);
  if (unordered != nullptr && ordered != nullptr) {
    scope->spot.Fail(*ordered, "there are :subtasks and :ordered-subtasks; keep one");
  }
  HddlNetwork result;
  Ids ids;
  if (const Datum* constraints = fields.Find(":constraints")) {
    ReadConstraints(*constraints, scope, &result.conditions);
  }
  if (unordered != nullptr) ReadTasks(*unordered, scope, &result, &ids);
  if (ordered != nullptr) {
    ReadTasks(*ordered, scope, &result, &ids);
    const int count = static_cast<int>(result.network.items.size());
    for (int i = 1; i < count; ++i) result.network.order.emplace_back(i - 1, i);
  }
  if (const Datum* ordering = fields.FindOneOf(kOrderingNames)) {
    ReadOrdering(*ordering, *scope, ids, &result.network);
  }
  const int first = FirstOfAll(result.network);
  if (first >= 0) {
    AddNeeds(*scope->vocabulary, result.network.items[first].task, &HddlVocabulary::Needs::changing,
             &result.needs_of_first);
  }
  return result;
}

}  // namespace hires::planning::hddl
