#include "hires/ros/planning/plan_nodes.h"

#include <fmt/format.h>

#include <string>

#include "hires/base/error.h"
#include "hires/planning/datum_reader.h"

namespace hires_ros {
namespace {

namespace planning = hires::planning;
using planning::Datum;

hires::PlanNode NodeToMsg(const planning::PlanNode& node) {
  hires::PlanNode message;
  message.task = planning::ToString(node.task);
  message.parent = node.parent;
  message.children.assign(node.children.begin(), node.children.end());
  message.step = node.step;
  message.method = node.method;
  message.branch = node.branch;
  message.label = node.label;
  message.at_step = node.at_step;
  for (const auto& [variable, value] : node.bindings) {
    message.variables.push_back(variable);
    message.values.push_back(planning::ToString(value));
  }
  return message;
}

/// Reads one node; `where` is its name in messages of errors.
class NodeReader {
 public:
  NodeReader(const hires::PlanNode& message, std::string where)
      : message_(message), where_(std::move(where)) {}

  planning::PlanNode Read(std::size_t num_nodes, std::size_t num_steps,
                          const planning::Domain& domain) {
    planning::PlanNode node;
    node.task = Term("task", message_.task);
    node.parent = Index("parent", message_.parent, num_nodes);
    for (const int child : message_.children) {
      node.children.push_back(Index("children", child, num_nodes));
    }
    node.step = Index("step", message_.step, num_steps);
    node.method = Index("method", message_.method, domain.methods.size());
    const std::size_t num_branches =
        node.method < 0 ? 1 : domain.methods[static_cast<std::size_t>(node.method)].branches.size();
    node.branch = Index("branch", message_.branch, num_branches);
    node.label = message_.label;
    node.at_step = Index("at_step", message_.at_step, num_steps + 1);
    if (message_.variables.size() != message_.values.size()) {
      Fail("variables", fmt::format("has {} names for {} values", message_.variables.size(),
                                    message_.values.size()));
    }
    for (std::size_t i = 0; i < message_.values.size(); ++i) {
      node.bindings.emplace_back(message_.variables[i], Term("values", message_.values[i]));
    }
    return node;
  }

 private:
  [[noreturn]] void Fail(const std::string& field, const std::string& text) const {
    throw hires::base::ConfigError(fmt::format("{}.{}: {}", where_, field, text));
  }

  Datum Term(const std::string& field, const std::string& text) const {
    std::vector<Datum> data = planning::ReadData(text, where_ + "." + field);
    if (data.size() != 1) Fail(field, fmt::format("has {} terms, wanted one", data.size()));
    return std::move(data[0]);
  }

  int Index(const std::string& field, int index, std::size_t count) const {
    if (index >= -1 && index < static_cast<int>(count)) return index;
    Fail(field, fmt::format("is {}, wanted -1 (none) or less than {}; do both sides use the same "
                            "domain?",
                            index, count));
  }

  const hires::PlanNode& message_;
  std::string where_;
};

}  // namespace

std::vector<hires::PlanNode> NodesToMsg(const planning::Plan& plan) {
  std::vector<hires::PlanNode> nodes;
  for (const planning::PlanNode& node : plan.nodes) nodes.push_back(NodeToMsg(node));
  return nodes;
}

void AddNodes(const hires::Plan& message, const planning::Domain& domain, planning::Plan* plan) {
  if (message.nodes.empty()) return;
  std::vector<planning::PlanNode> nodes;
  for (std::size_t i = 0; i < message.nodes.size(); ++i) {
    NodeReader reader(message.nodes[i], fmt::format("plan.nodes[{}]", i));
    nodes.push_back(reader.Read(message.nodes.size(), plan->steps.size(), domain));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].step >= 0) {
      plan->steps[static_cast<std::size_t>(nodes[i].step)].node = static_cast<int>(i);
    }
  }
  plan->nodes = std::move(nodes);
}

}  // namespace hires_ros
