#include <algorithm>
#include <iterator>
#include <utility>

#include "planning/language/shop2_parts.h"

namespace hires::planning::shop2 {
namespace {

constexpr std::string_view kNetworkWanted =
    "nil, a task (name arguments...), (:task [:immediate] name arguments...), a list of tasks, "
    "(:ordered tasks...) or (:unordered tasks...)";

constexpr std::string_view kTaskWanted = "a task (name arguments...) whose name is a symbol";

/// In a task, ,(f ?x) asks for a value as (call f ?x) does, and ,?x is ?x.
void ReplaceUnquotes(Datum* term) {
  for (Datum& item : term->items) ReplaceUnquotes(&item);
  if (term->Head() != "unquote" || term->items.size() != 2) return;
  Datum inner = std::move(term->items[1]);
  if (inner.IsList() && inner.Head() != "call" && !inner.items.empty()) {
    inner.items.insert(inner.items.begin(), MakeSymbol("call"));
  }
  inner.place = term->place;
  *term = std::move(inner);
}

/// (name arguments...) whose name stands at `first` in `datum`.
Datum TaskTerm(const Construct& in, const Datum& datum, std::size_t first) {
  if (datum.items.size() <= first) FailAbout(in, datum, kTaskWanted);
  Datum task = datum;
  task.items.erase(task.items.begin(), task.items.begin() + static_cast<std::ptrdiff_t>(first));
  CheckTerm(in, task, kTaskWanted);
  ReplaceUnquotes(&task);
  return Unquoted(std::move(task));
}

bool IsInop(const Datum& task) { return task.Head() == "!!inop" && task.items.size() == 1; }

/// (:task name a), (:task :immediate name a), (:immediate name a), (:immediate (name a)), (name a)
TaskItem ReadTask(const Construct& in, const Datum& datum) {
  TaskItem item;
  item.place = datum.place;
  std::size_t first = datum.Head() == ":task" ? 1 : 0;
  if (datum.items.size() > first && datum.items[first].IsSymbol(":immediate")) {
    item.immediate = true;
    ++first;
  }
  const bool is_wrapped = first > 0 && datum.items.size() == first + 1 &&
                          datum.items[first].IsList() && datum.tail.empty();
  item.task = is_wrapped ? TaskTerm(in, datum.items[first], 0) : TaskTerm(in, datum, first);
  if (IsInop(item.task)) item.network.emplace_back();  // SHOP's step that does nothing
  return item;
}

void PutInOrder(TaskNetwork* network) {
  for (int i = 1; i < static_cast<int>(network->items.size()); ++i) {
    network->order.emplace_back(i - 1, i);
  }
}

TaskNetwork ReadBareNetwork(const Construct& in, const Datum& datum);

bool IsSingleTask(const Datum& datum) {
  const std::string_view head = datum.Head();
  return !head.empty() && head != ":ordered" && head != ":unordered" && !datum.IsNil();
}

TaskItem ReadItem(const Construct& in, const Datum& datum) {
  if (IsSingleTask(datum)) return ReadTask(in, datum);
  TaskItem item;
  item.place = datum.place;
  item.network.push_back(ReadBareNetwork(in, datum));
  return item;
}

TaskNetwork ReadBareNetwork(const Construct& in, const Datum& datum) {
  TaskNetwork network;
  if (datum.IsNil()) return network;
  if (IsSingleTask(datum)) {
    network.items.push_back(ReadTask(in, datum));
    return network;
  }
  const bool has_word = !datum.Head().empty();
  const bool is_list = datum.IsList() && datum.tail.empty();
  if (!is_list || (!has_word && !datum.items[0].IsList() && !datum.items[0].IsNil())) {
    FailAbout(in, datum, kNetworkWanted);
  }
  std::transform(datum.items.begin() + (has_word ? 1 : 0), datum.items.end(),
                 std::back_inserter(network.items),
                 [&](const Datum& item) { return ReadItem(in, item); });
  if (datum.Head() != ":unordered") PutInOrder(&network);
  return network;
}

}  // namespace

TaskNetwork ReadNetwork(const Construct& in, const Datum& datum) {
  const bool is_quoted =
      (datum.Head() == "quote" || datum.Head() == "backquote") && datum.items.size() == 2;
  return ReadBareNetwork(in, is_quoted ? datum.items[1] : datum);
}

}  // namespace hires::planning::shop2
