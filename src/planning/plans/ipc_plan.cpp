#include "hires/planning/ipc_plan.h"

#include <fmt/format.h>

#include <vector>

#include "hires/base/check.h"
#include "planning/plans/ipc_names.h"

namespace hires::planning {
namespace {

template <typename Items>
bool IsIndex(int index, const Items& items) {
  return index >= 0 && static_cast<std::size_t>(index) < items.size();
}

/// "drive dock t1": no parentheses, and no `!` where there is one.
std::string TaskText(const Datum& task) {
  const std::string_view name = task.Head();
  std::string text = ToString(MakeSymbol(name.substr(0, 1) == "!" ? name.substr(1) : name));
  for (std::size_t i = 1; i < task.items.size(); ++i) text += ' ' + ToString(task.items[i]);
  return text;
}

/// The nodes with their subtasks, each before its children.
std::vector<int> Preorder(const Plan& plan) {
  std::vector<int> order;
  std::vector<int> open{0};
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    order.push_back(node);
    HIRES_CHECK(order.size() <= plan.nodes.size(), "a node of the plan is above itself");
    const std::vector<int>& children = plan.nodes[node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      HIRES_CHECK(IsIndex(*child, plan.nodes), "the plan has no such node");
      open.push_back(*child);
    }
  }
  return order;
}

/// Steps are numbered as they come, the other tasks go on from there.
std::vector<int> NumberNodes(const Plan& plan, const std::vector<int>& order) {
  std::vector<int> ids(plan.nodes.size(), -1);
  int next = static_cast<int>(plan.steps.size());
  for (const int node : order) {
    if (node == 0) continue;
    const int step = plan.nodes[node].step;
    ids[node] = step >= 0 ? step : next++;
  }
  return ids;
}

std::string ChildIds(const PlanNode& node, const std::vector<int>& ids) {
  std::string text;
  for (const int child : node.children) text += fmt::format(" {}", ids[child]);
  return text;
}

/// The label of a branch, if no other branch of the task's methods has it.
std::string UniqueLabel(const Domain& domain, const Method& method, int branch) {
  const std::string& label = method.branches[branch].label;
  int count = 0;
  for (const Method& other : domain.methods) {
    if (other.head.Head() != method.head.Head()) continue;
    for (const Branch& candidate : other.branches) count += candidate.label == label ? 1 : 0;
  }
  return count == 1 ? label : "";
}

/// 1 for the first method of its task, 2 for the second.
int NumberWithinTask(const Domain& domain, int method) {
  int number = 1;
  for (int i = 0; i < method; ++i) {
    if (domain.methods[i].head.Head() == domain.methods[method].head.Head()) ++number;
  }
  return number;
}

}  // namespace

std::string IpcMethodName(const Domain& domain, int method, int branch) {
  HIRES_CHECK(IsIndex(method, domain.methods), "the domain has no such method");
  const Method& source = domain.methods[method];
  HIRES_CHECK(IsIndex(branch, source.branches), "the method has no such branch");
  if (source.name.empty()) {
    std::string label = UniqueLabel(domain, source, branch);
    if (!label.empty()) return label;
  }
  const std::string name = source.name.empty() ? fmt::format("{}-{}", source.head.Head(),
                                                             NumberWithinTask(domain, method))
                                               : source.name;
  if (source.branches.size() == 1) return name;
  const std::string& label = source.branches[branch].label;
  return fmt::format("{}/{}", name, label.empty() ? std::to_string(branch + 1) : label);
}

std::string ToIpcPlan(const Domain& domain, const Plan& plan) {
  HIRES_CHECK(!plan.nodes.empty(), "a plan has at least its root");
  const std::vector<int> order = Preorder(plan);
  const std::vector<int> ids = NumberNodes(plan, order);
  std::string text = "==>\n";
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    text += fmt::format("{} {}\n", i, TaskText(plan.steps[i].task));
  }
  text += fmt::format("root{}\n", ChildIds(plan.nodes[0], ids));
  for (const int index : order) {
    const PlanNode& node = plan.nodes[index];
    if (index == 0 || node.step >= 0) continue;
    text += fmt::format("{} {} -> {}{}\n", ids[index], TaskText(node.task),
                        IpcMethodName(domain, node.method, node.branch), ChildIds(node, ids));
  }
  return text + "<==\n";
}

}  // namespace hires::planning
