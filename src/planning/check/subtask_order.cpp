#include <cstddef>
#include <set>

#include "hires/planning/reasons.h"
#include "planning/check/decomposition_check.h"

namespace hires::planning {
namespace {

using Steps = std::set<int>;

/// Steps of a part of the plan that nothing in that part comes before, and those that nothing in it
/// comes after. Both are empty where the part has no steps.
struct Ends {
  Steps first;
  Steps last;
};

bool IsImagine(const PlanStep& step) { return step.task.Head() == "!imagine"; }

class SubtaskOrders {
 public:
  SubtaskOrders(const Domain& domain, const Problem& problem, const Plan& plan)
      : domain_(domain), problem_(problem), plan_(plan) {}

  /// False where nodes and networks do not fit each other.
  bool Run() {
    if (plan_.nodes.empty() || !CheckTree(plan_).empty()) return false;
    const std::vector<int> nodes = NodesFromRoot(plan_);
    ends_.resize(plan_.nodes.size());
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {  // children before parents
      if (!Join(*node)) return false;
    }
    return true;
  }

  std::vector<std::pair<int, int>> pairs() const { return {pairs_.begin(), pairs_.end()}; }

 private:
  bool Join(int index) {
    const PlanNode& node = plan_.nodes[index];
    if (index != 0 && node.method < 0) {
      if (!IsImagine(plan_.steps[node.step])) ends_[index] = {{node.step}, {node.step}};
      return true;
    }
    const TaskNetwork* network = index == 0 ? &problem_.tasks : NetworkOf(node);
    if (network == nullptr || LeavesOf(*network).size() != node.children.size()) return false;
    std::size_t leaf = 0;
    ends_[index] = Join(*network, node, &leaf);
    return true;
  }

  /// Null where the domain has no such method or branch.
  const TaskNetwork* NetworkOf(const PlanNode& node) const {
    if (node.method >= static_cast<int>(domain_.methods.size())) return nullptr;
    const std::vector<Branch>& branches = domain_.methods[node.method].branches;
    if (node.branch < 0 || node.branch >= static_cast<int>(branches.size())) return nullptr;
    return &branches[node.branch].subtasks;
  }

  Ends Join(const TaskNetwork& network, const PlanNode& node, std::size_t* leaf) {
    std::vector<Ends> parts;
    for (const TaskItem& item : network.items) {
      parts.push_back(item.network.empty() ? ends_[node.children[(*leaf)++]]
                                           : Join(item.network.front(), node, leaf));
    }
    return Order(network, parts);
  }

  /// Puts the parts of a network into its order.
  Ends Order(const TaskNetwork& network, const std::vector<Ends>& parts) {
    Steps begun_later, ended_earlier;  // first steps that wait, last steps that are waited for
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (const int before : LastBefore(network, parts, i)) {
        for (const int after : parts[i].first) {
          pairs_.emplace(before, after);
          begun_later.insert(after);
          ended_earlier.insert(before);
        }
      }
    }
    Ends ends;
    for (const Ends& part : parts) {
      for (const int step : part.first) {
        if (begun_later.count(step) == 0) ends.first.insert(step);
      }
      for (const int step : part.last) {
        if (ended_earlier.count(step) == 0) ends.last.insert(step);
      }
    }
    return ends;
  }

  /// The last steps of what comes next before an item; an item without steps passes on what comes
  /// before itself.
  static Steps LastBefore(const TaskNetwork& network, const std::vector<Ends>& parts,
                          std::size_t item) {
    Steps last;
    std::vector<int> open{static_cast<int>(item)};
    std::set<int> seen;
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      for (const auto& [before, after] : network.order) {
        if (after != at || !seen.insert(before).second) continue;
        const Steps& steps = parts[before].last;
        if (steps.empty()) open.push_back(before);
        last.insert(steps.begin(), steps.end());
      }
    }
    return last;
  }

  const Domain& domain_;
  const Problem& problem_;
  const Plan& plan_;
  std::vector<Ends> ends_;  ///< by node
  std::set<std::pair<int, int>> pairs_;
};

/// One step after the other, as they are listed.
std::vector<std::pair<int, int>> OrderOfList(const Plan& plan) {
  std::vector<std::pair<int, int>> pairs;
  int last = -1;
  for (int i = 0; i < static_cast<int>(plan.steps.size()); ++i) {
    if (IsImagine(plan.steps[i])) continue;
    if (last >= 0) pairs.emplace_back(last, i);
    last = i;
  }
  return pairs;
}

}  // namespace

std::vector<std::pair<int, int>> OrderOfSubtasks(const Domain& domain, const Problem& problem,
                                                 const Plan& plan) {
  SubtaskOrders orders(domain, problem, plan);
  return orders.Run() ? orders.pairs() : OrderOfList(plan);
}

}  // namespace hires::planning
