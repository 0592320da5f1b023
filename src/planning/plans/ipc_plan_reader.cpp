#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/ipc_plan.h"
#include "hires/planning/substitution.h"
#include "planning/plans/ipc_names.h"

namespace hires::planning {
namespace {

/// Ways to match subtasks that are tried before the reader gives up on a line.
constexpr int kMaxTries = 1'000'000;

/// One line of a plan: `id task`, or `id task -> method ids`.
struct Line {
  Place place;
  Datum task;
  std::string method;                  ///< empty for a primitive task
  std::vector<std::int64_t> children;  ///< ids
  int step{-1};                        ///< of a primitive task: its place in the plan
  int first{-1};                       ///< first step at or below it, -1: none
  int last{-1};                        ///< and the last
};

struct PlanText {
  std::map<std::int64_t, Line> lines;  ///< by id
  std::vector<std::int64_t> steps;     ///< ids in the order of execution
  std::vector<std::int64_t> roots;
  Place root_place;
};

// ----------------------------------------------------------------------------------- text to lines

/// Position after the line that `mark` begins (but for blanks), or npos.
std::size_t FindMark(std::string_view text, std::string_view mark, std::size_t from,
                     std::size_t* begin) {
  for (std::size_t at = from; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::size_t first = text.find_first_not_of(" \t\r", at);
    if (first < end && text.substr(first, mark.size()) == mark) {
      *begin = at;
      return std::min(end + 1, text.size());
    }
    at = end + 1;
  }
  return std::string_view::npos;
}

/// What stands between `==>` and `<==`, behind as many empty lines as the text has before it, so
/// that places are those of the text.
std::string PlanPart(std::string_view text, const std::string& source) {
  std::size_t mark = 0;
  const std::size_t begin = FindMark(text, "==>", 0, &mark);
  if (begin == std::string_view::npos) {
    FailAt(source, {1, 1},
           "there is no line ==>, which begins a plan; is this the output of a "
           "planner that found one?");
  }
  const auto num_lines = std::count(text.begin(), text.begin() + static_cast<long>(begin), '\n');
  std::size_t end = text.size();
  FindMark(text, "<==", begin, &end);
  return std::string(static_cast<std::size_t>(num_lines), '\n') +
         std::string(text.substr(begin, end - begin));
}

class LineReader {
 public:
  LineReader(std::string_view text, const std::string& source) : source_(source) {
    const std::vector<Datum> data = ReadData(PlanPart(text, source), source);
    for (std::size_t begin = 0; begin < data.size();) {
      std::size_t end = begin;
      while (end < data.size() && data[end].place.line == data[begin].place.line) ++end;
      Take({data.begin() + static_cast<long>(begin), data.begin() + static_cast<long>(end)});
      begin = end;
    }
    if (!has_root_) {
      FailAt(source, {1, 1},
             "the plan has no line 'root ...', which names the tasks of the "
             "problem; is it cut off?");
    }
  }

  PlanText Result() { return std::move(result_); }

 private:
  void Take(const std::vector<Datum>& words) {
    if (words[0].IsSymbol("root")) {
      if (has_root_) Fail(words[0], "a second line 'root ...' stands here; keep one");
      has_root_ = true;
      result_.root_place = words[0].place;
      result_.roots = ReadIds(words, 1);
      return;
    }
    const std::int64_t id = ReadId(words[0]);
    Line line = ReadLine(words);
    if (line.method.empty()) {
      if (has_root_) {
        Fail(words[0],
             "a step stands behind 'root ...'; the steps come first, and decompositions "
             "have '-> method'");
      }
      line.step = line.first = line.last = static_cast<int>(result_.steps.size());
      result_.steps.push_back(id);
    }
    if (!result_.lines.emplace(id, std::move(line)).second) {
      Fail(words[0], fmt::format("id {} is used twice; give each task an id of its own", id));
    }
  }

  Line ReadLine(const std::vector<Datum>& words) const {
    Line line;
    line.place = words[0].place;
    std::size_t arrow = words.size();
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (words[i].IsSymbol("->")) arrow = i;
    }
    if (arrow == 1 || words.size() == 1 || words[1].kind != Datum::Kind::kSymbol) {
      Fail(words[0], "wanted 'id task arguments' or 'id task arguments -> method ids'");
    }
    line.task.items.assign(words.begin() + 1, words.begin() + static_cast<long>(arrow));
    line.task.place = words[1].place;
    if (arrow == words.size()) return line;
    if (arrow + 1 == words.size()) Fail(words[arrow], "no method stands behind '->'");
    line.method =
        words[arrow + 1].text.empty() ? ToString(words[arrow + 1]) : words[arrow + 1].text;
    line.children = ReadIds(words, arrow + 2);
    return line;
  }

  std::int64_t ReadId(const Datum& word) const {
    if (word.kind == Datum::Kind::kInteger && word.integer >= 0) return word.integer;
    Fail(word, fmt::format("{} stands where the id of a task is wanted, a whole number of at "
                           "least 0",
                           Excerpt(word)));
  }

  std::vector<std::int64_t> ReadIds(const std::vector<Datum>& words, std::size_t begin) const {
    std::vector<std::int64_t> ids;
    for (std::size_t i = begin; i < words.size(); ++i) ids.push_back(ReadId(words[i]));
    return ids;
  }

  [[noreturn]] void Fail(const Datum& at, const std::string& text) const {
    FailAt(source_, at.place, text);
  }

  const std::string& source_;
  PlanText result_;
  bool has_root_{false};
};

// ------------------------------------------------------------------------------ networks of
// methods

/// A network without nesting. Some of its items are no tasks (null): they stand between groups.
struct FlatNetwork {
  std::vector<Datum> patterns;  ///< of the tasks; () for a stand-in
  std::vector<bool> is_task;
  std::vector<std::vector<int>> befores;  ///< items that come directly before
  std::vector<int> order;                 ///< all items, each after those before it
};

/// What an instantiated task can be told to look like before its variables are known: values that
/// are computed can be anything.
Datum PatternOf(const Datum& task, int* num_calls) {
  if (!task.IsList()) return task;
  if (task.Head() == "call") return MakeVariable(fmt::format("?%call{}", ++*num_calls));
  Datum pattern = task;
  for (Datum& item : pattern.items) item = PatternOf(item, num_calls);
  for (Datum& tail : pattern.tail) tail = PatternOf(tail, num_calls);
  return pattern;
}

class Flattening {
 public:
  FlatNetwork Run(const TaskNetwork& network) {
    AddNetwork(network);
    Sort();
    return std::move(flat_);
  }

 private:
  struct Ends {
    int first;
    int last;
  };

  int AddItem(Datum pattern, bool is_task) {
    flat_.patterns.push_back(std::move(pattern));
    flat_.is_task.push_back(is_task);
    flat_.befores.emplace_back();
    return static_cast<int>(flat_.patterns.size()) - 1;
  }

  /// A network in a network stands between two items that are no tasks.
  Ends Add(const TaskItem& item) {
    if (item.network.empty()) {
      const int index = AddItem(PatternOf(item.task, &num_calls_), true);
      return {index, index};
    }
    const int first = AddItem({}, false);
    const std::vector<Ends> inner = AddNetwork(item.network.front());
    const int last = AddItem({}, false);
    flat_.befores[last].push_back(first);
    for (const Ends& ends : inner) {
      flat_.befores[ends.first].push_back(first);
      flat_.befores[last].push_back(ends.last);
    }
    return {first, last};
  }

  std::vector<Ends> AddNetwork(const TaskNetwork& network) {
    std::vector<Ends> items;
    for (const TaskItem& item : network.items) items.push_back(Add(item));
    for (const auto& [before, after] : network.order) {
      flat_.befores[items[after].first].push_back(items[before].last);
    }
    return items;
  }

  void Sort() {
    const std::size_t count = flat_.patterns.size();
    std::vector<int> num_before(count);
    std::vector<std::vector<int>> after(count);
    for (std::size_t i = 0; i < count; ++i) {
      num_before[i] = static_cast<int>(flat_.befores[i].size());
      for (const int before : flat_.befores[i]) after[before].push_back(static_cast<int>(i));
      if (num_before[i] == 0) flat_.order.push_back(static_cast<int>(i));
    }
    for (std::size_t done = 0; done < flat_.order.size(); ++done) {
      for (const int next : after[flat_.order[done]]) {
        if (--num_before[next] == 0) flat_.order.push_back(next);
      }
    }
  }

  FlatNetwork flat_;
  int num_calls_{0};
};

// ------------------------------------------------------------------------------------ lines to
// plan

/// A decomposition that fits a line.
struct Fit {
  int method{-1};
  int branch{-1};
  std::vector<const Line*> subtasks;  ///< in the order of the method
  std::vector<int> earliest;          ///< per subtask: steps that come before it at least
  std::vector<std::pair<std::string, Datum>> bindings;
};

std::vector<std::pair<std::string, Datum>> BindingsOf(const std::set<std::string>& variables,
                                                      const Substitution& values) {
  std::vector<std::pair<std::string, Datum>> bindings;
  for (const std::string& name : variables) {
    if (!values.IsBound(name) || name.rfind("?%call", 0) == 0) continue;
    Datum value = values.Apply(MakeVariable(name));
    if (IsGround(value)) bindings.emplace_back(name, std::move(value));
  }
  return bindings;
}

/// Finds which line is which item of a network.
class Matching {
 public:
  /// @param start  Steps taken before the network comes up.
  Matching(const FlatNetwork& network, std::vector<const Line*> lines, int start,
           Substitution* values, int* tries)
      : network_(network),
        lines_(std::move(lines)),
        start_(start),
        values_(*values),
        tries_(*tries) {
    used_.assign(lines_.size(), false);
    chosen_.assign(network_.patterns.size(), nullptr);
    for (std::size_t i = 0; i < network_.patterns.size(); ++i) {
      if (network_.is_task[i]) tasks_.push_back(static_cast<int>(i));
    }
  }

  bool Run() { return tasks_.size() == lines_.size() && Choose(); }

  std::vector<const Line*> Subtasks() const {
    std::vector<const Line*> subtasks;
    for (const int task : tasks_) subtasks.push_back(chosen_[task]);
    return subtasks;
  }
  std::vector<int> Earliest() const {
    std::vector<int> earliest;
    for (const int task : tasks_) earliest.push_back(earliest_[task]);
    return earliest;
  }
  std::size_t num_tasks() const { return tasks_.size(); }

 private:
  /// Goes through the tasks without recursion: a problem may have thousands.
  bool Choose() {
    struct Choice {
      std::size_t line;
      std::size_t mark;
    };
    std::vector<Choice> choices;
    std::size_t next_line = 0;
    while (true) {
      const std::size_t at = choices.size();
      if (at == tasks_.size() && IsInOrder()) return true;
      const std::size_t mark = values_.Mark();
      const std::size_t line =
          at == tasks_.size() ? lines_.size() : FindLine(tasks_[at], next_line);
      if (line < lines_.size()) {
        used_[line] = true;
        chosen_[tasks_[at]] = lines_[line];
        choices.push_back({line, mark});
        next_line = 0;
        continue;
      }
      if (choices.empty() || tries_ > kMaxTries) return false;
      used_[choices.back().line] = false;
      values_.Undo(choices.back().mark);
      next_line = choices.back().line + 1;
      choices.pop_back();
    }
  }

  /// The next line that can be this task, its variables bound.
  std::size_t FindLine(int task, std::size_t from) {
    for (std::size_t line = from; line < lines_.size(); ++line) {
      if (used_[line]) continue;
      if (++tries_ > kMaxTries) break;
      if (values_.Unify(network_.patterns[task], lines_[line]->task)) return line;
    }
    return lines_.size();
  }

  /// The steps of the chosen lines come in the order of the network.
  bool IsInOrder() {
    earliest_.assign(network_.patterns.size(), start_);
    for (const int item : network_.order) {
      for (const int before : network_.befores[item]) {
        const Line* line = chosen_[before];
        const int end = line != nullptr && line->last >= 0 ? line->last + 1 : earliest_[before];
        earliest_[item] = std::max(earliest_[item], end);
      }
      const Line* line = chosen_[item];
      if (line != nullptr && line->first >= 0 && line->first < earliest_[item]) return false;
    }
    return true;
  }

  const FlatNetwork& network_;
  std::vector<const Line*> lines_;
  int start_;
  Substitution& values_;
  int& tries_;
  std::vector<int> tasks_;  // items that are tasks
  std::vector<bool> used_;
  std::vector<const Line*> chosen_;
  std::vector<int> earliest_;
};

class PlanBuilder {
 public:
  PlanBuilder(PlanText text, const std::string& source, const Domain& domain,
              const Problem& problem)
      : text_(std::move(text)), source_(source), domain_(domain), problem_(problem) {
    for (std::size_t i = 0; i < domain.methods.size(); ++i) {
      methods_[std::string(domain.methods[i].head.Head())].push_back(static_cast<int>(i));
    }
    for (std::size_t i = 0; i < domain.operators.size(); ++i) {
      operators_[std::string(domain.operators[i].head.Head())].push_back(static_cast<int>(i));
    }
  }

  Plan Build() {
    SkipArtificialRoot();
    CheckNames();
    const std::vector<std::int64_t> order = OrderLines();
    for (auto id = order.rbegin(); id != order.rend(); ++id) FindExtent(&text_.lines.at(*id));
    plan_.steps.resize(text_.steps.size());
    plan_.nodes.resize(1);
    AddRoots();
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      Place(next);
    }
    return std::move(plan_);
  }

 private:
  struct Open {
    int node;
    const Line* line;
    int earliest;
  };

  [[noreturn]] void Fail(const hires::planning::Place& place, const std::string& text) const {
    FailAt(source_, place, text);
  }

  void SkipArtificialRoot() {
    if (text_.roots.size() != 1) return;
    const auto found = text_.lines.find(text_.roots[0]);
    if (found == text_.lines.end() || found->second.task.Head() != "__top") return;
    text_.roots = found->second.children;
    text_.lines.erase(found);
  }

  /// Gives the steps their `!` and looks all tasks up, so that a wrong name is told as such.
  void CheckNames() {
    for (auto& entry : text_.lines) {
      Line& line = entry.second;
      std::string& name = line.task.items[0].text;
      if (line.step < 0) {
        if (methods_.count(name) > 0) continue;
        Fail(line.place, base::UnknownName("compound task", name, NamesOf(methods_, 0)));
      }
      if (operators_.count("!" + name) == 0) {
        Fail(line.place, base::UnknownName("primitive task", name, NamesOf(operators_, 1)));
      }
      name.insert(0, "!");
      if (OperatorOf(line.task) == nullptr) {
        Fail(line.place, fmt::format("{} does not fit {}; check its arguments", Excerpt(line.task),
                                     HeadsOf(line.task)));
      }
    }
  }

  static std::vector<std::string> NamesOf(const std::map<std::string, std::vector<int>>& index,
                                          std::size_t skip) {
    std::vector<std::string> names;
    for (const auto& entry : index) names.push_back(entry.first.substr(skip));
    return names;
  }

  /// The first operator that the task can be, or null.
  const Operator* OperatorOf(const Datum& task) const {
    for (const int index : operators_.at(std::string(task.Head()))) {
      if (Substitution().Unify(domain_.operators[index].head, task)) {
        return &domain_.operators[index];
      }
    }
    return nullptr;
  }

  std::string HeadsOf(const Datum& task) const {
    std::vector<std::string> heads;
    for (const int index : operators_.at(std::string(task.Head()))) {
      heads.push_back(Excerpt(domain_.operators[index].head));
    }
    return base::Join(heads, " or ");
  }

  const Line& LineOf(std::int64_t id, const hires::planning::Place& place) const {
    const auto found = text_.lines.find(id);
    if (found == text_.lines.end()) {
      Fail(place, fmt::format("id {} stands for no task; add its line", id));
    }
    return found->second;
  }

  /// Every id once, parents before children.
  std::vector<std::int64_t> OrderLines() const {
    std::vector<std::int64_t> order;
    std::set<std::int64_t> seen;
    const auto visit = [&](std::int64_t id, const hires::planning::Place& place) {
      LineOf(id, place);
      if (!seen.insert(id).second) {
        Fail(place, fmt::format("task {} is a subtask twice; each belongs to one task", id));
      }
      order.push_back(id);
    };
    for (const std::int64_t id : text_.roots) visit(id, text_.root_place);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Line& line = text_.lines.at(order[i]);
      for (const std::int64_t child : line.children) visit(child, line.place);
    }
    if (order.size() < text_.lines.size()) FailForMissing(seen);
    return order;
  }

  /// Names a task that is no other's subtask; if all are, they form a cycle.
  [[noreturn]] void FailForMissing(std::set<std::int64_t> seen) const {
    std::set<std::int64_t> children = seen;
    for (const auto& entry : text_.lines) {
      children.insert(entry.second.children.begin(), entry.second.children.end());
    }
    for (const std::set<std::int64_t>& known : {children, seen}) {
      for (const auto& [id, line] : text_.lines) {
        if (known.count(id) > 0) continue;
        Fail(line.place, fmt::format("task {} is not below 'root'; add it to 'root' or to the "
                                     "decomposition it belongs to",
                                     id));
      }
    }
    throw std::logic_error("no task is missing");
  }

  /// @pre called for the children before
  void FindExtent(Line* line) const {
    for (const std::int64_t child : line->children) {
      const Line& below = text_.lines.at(child);
      if (below.first < 0) continue;
      line->first = line->first < 0 ? below.first : std::min(line->first, below.first);
      line->last = std::max(line->last, below.last);
    }
  }

  std::vector<const Line*> LinesOf(const std::vector<std::int64_t>& ids) const {
    std::vector<const Line*> lines;
    for (const std::int64_t id : ids) lines.push_back(&text_.lines.at(id));
    return lines;
  }

  void AddRoots() {
    const FlatNetwork network = Flattening().Run(problem_.tasks);
    Substitution values;
    int tries = 0;
    Matching matching(network, LinesOf(text_.roots), 0, &values, &tries);
    if (!matching.Run()) {
      Fail(text_.root_place,
           fmt::format("the tasks of 'root' are not those of problem '{}', which has {}, or not in "
                       "their order{}",
                       problem_.name, matching.num_tasks(), GivenUp(tries)));
    }
    std::set<std::string> variables;
    for (const Datum& pattern : network.patterns) CollectVariables(pattern, &variables);
    plan_.nodes[0].bindings = BindingsOf(variables, values);
    AddChildren(0, matching.Subtasks(), matching.Earliest());
  }

  static std::string GivenUp(int tries) {
    return tries > kMaxTries ? fmt::format(" (given up after {} tries)", kMaxTries) : "";
  }

  /// Nodes for subtasks, to be filled in later.
  void AddChildren(int parent, const std::vector<const Line*>& lines,
                   const std::vector<int>& earliest) {
    const int first = static_cast<int>(plan_.nodes.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const int node = first + static_cast<int>(i);
      plan_.nodes.emplace_back();
      plan_.nodes[node].parent = parent;
      plan_.nodes[node].task = lines[i]->task;
      plan_.nodes[parent].children.push_back(node);
      open_.push_back({node, lines[i], earliest[i]});
    }
  }

  void Place(const Open& open) {
    if (open.line->step >= 0) {
      PlaceStep(open);
    } else {
      PlaceDecomposition(open);
    }
  }

  void PlaceStep(const Open& open) {
    PlanStep& step = plan_.steps[open.line->step];
    PlanNode& node = plan_.nodes[open.node];
    node.step = open.line->step;
    node.at_step = open.line->step;
    step.task = open.line->task;
    step.node = open.node;
    const Datum& head = OperatorOf(step.task)->head;
    Substitution values;
    values.Unify(head, step.task);
    std::set<std::string> variables;
    CollectVariables(head, &variables);
    step.bindings = BindingsOf(variables, values);
  }

  void PlaceDecomposition(const Open& open) {
    const Line& line = *open.line;
    const int at_step = line.first >= 0 ? line.first : open.earliest;
    const Fit fit = FindFit(line, at_step);
    PlanNode& node = plan_.nodes[open.node];
    node.method = fit.method;
    node.branch = fit.branch;
    node.at_step = at_step;
    node.bindings = fit.bindings;
    const Method& method = domain_.methods[fit.method];
    const std::string& label = method.branches[fit.branch].label;
    node.label = label.empty() ? method.name : label;
    AddChildren(open.node, fit.subtasks, fit.earliest);
  }

  Fit FindFit(const Line& line, int at_step) const {
    std::vector<std::string> known;
    bool is_named = false;
    int tries = 0;
    for (const int method : methods_.at(std::string(line.task.Head()))) {
      const int count = static_cast<int>(domain_.methods[method].branches.size());
      for (int branch = 0; branch < count; ++branch) {
        known.push_back(IpcMethodName(domain_, method, branch));
        if (known.back() != line.method) continue;
        is_named = true;
        Fit fit;
        if (Fits(line, at_step, method, branch, &tries, &fit)) return fit;
      }
    }
    if (!is_named) {
      Fail(line.place, base::UnknownName(fmt::format("method of task '{}'", line.task.Head()),
                                         line.method, known));
    }
    Fail(line.place,
         fmt::format("{} and its {} subtasks do not fit method '{}': other tasks or "
                     "arguments, or steps that come in another order{}",
                     Excerpt(line.task), line.children.size(), line.method, GivenUp(tries)));
  }

  bool Fits(const Line& line, int at_step, int method, int branch, int* tries, Fit* fit) const {
    const Method& source = domain_.methods[method];
    Substitution values;
    if (!values.Unify(source.head, line.task)) return false;
    const FlatNetwork network = Flattening().Run(source.branches[branch].subtasks);
    Matching matching(network, LinesOf(line.children), at_step, &values, tries);
    if (!matching.Run()) return false;
    std::set<std::string> variables;
    CollectVariables(source.head, &variables);
    for (const Datum& pattern : network.patterns) CollectVariables(pattern, &variables);
    *fit = {method, branch, matching.Subtasks(), matching.Earliest(),
            BindingsOf(variables, values)};
    return true;
  }

  PlanText text_;
  const std::string& source_;
  const Domain& domain_;
  const Problem& problem_;
  std::map<std::string, std::vector<int>> methods_;    // by task
  std::map<std::string, std::vector<int>> operators_;  // by task
  std::vector<Open> open_;
  Plan plan_;
};

}  // namespace

Plan ReadIpcPlan(std::string_view text, const std::string& source, const Domain& domain,
                 const Problem& problem) {
  return PlanBuilder(LineReader(text, source).Result(), source, domain, problem).Build();
}

}  // namespace hires::planning
