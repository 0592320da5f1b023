#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "hires/base/text.h"
#include "hires/planning/task_text.h"

namespace hires::planning {
namespace {

using Relation = std::vector<std::vector<bool>>;
using Group = std::vector<int>;

/// before[i][j]: item i comes before item j, directly or through others.
Relation ClosureOf(const TaskNetwork& network) {
  const std::size_t n = network.items.size();
  Relation before(n, std::vector<bool>(n, false));
  for (const auto& [first, second] : network.order) before[first][second] = true;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; before[i][k] && j < n; ++j) {
        if (before[k][j]) before[i][j] = true;
      }
    }
  }
  return before;
}

/// Splits `items` so that two of them are in one group if `are_tied`, directly or through others;
/// groups and their members in the order of the items.
template <typename AreTied>
std::vector<Group> Split(const Group& items, AreTied are_tied) {
  std::vector<Group> groups;
  std::vector<bool> taken(items.size(), false);
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (taken[i]) continue;
    taken[i] = true;
    Group group{items[i]};
    for (std::size_t at = 0; at < group.size(); ++at) {
      for (std::size_t j = 0; j < items.size(); ++j) {
        if (taken[j] || !are_tied(group[at], items[j])) continue;
        taken[j] = true;
        group.push_back(items[j]);
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

/// Writes a network as nested sequences and sets.
class NetworkWriter {
 public:
  explicit NetworkWriter(const TaskNetwork& network)
      : network_(network), before_(ClosureOf(network)) {}

  std::optional<std::string> Write() {
    Group all(network_.items.size());
    std::iota(all.begin(), all.end(), 0);
    return all.empty() ? "()" : Text(all);
  }

 private:
  bool AreOrdered(int a, int b) const { return before_[a][b] || before_[b][a]; }

  std::optional<std::string> Text(const Group& items) const {
    if (items.size() == 1) return Text(network_.items[items[0]]);
    const auto sets = Split(items, [&](int a, int b) { return AreOrdered(a, b); });
    if (sets.size() > 1) return Text(":unordered", sets);
    auto sequence = Split(items, [&](int a, int b) { return !AreOrdered(a, b); });
    if (sequence.size() == 1) return std::nullopt;
    std::sort(sequence.begin(), sequence.end(),
              [&](const Group& a, const Group& b) { return before_[a[0]][b[0]]; });
    return Text(":ordered", sequence);
  }

  std::optional<std::string> Text(const char* word, const std::vector<Group>& groups) const {
    std::string text = "(" + std::string(word);
    for (const Group& group : groups) {
      const auto part = Text(group);
      if (!part) return std::nullopt;
      text += " " + *part;
    }
    return text + ")";
  }

  static std::optional<std::string> Text(const TaskItem& item) {
    if (!item.network.empty()) {
      return item.immediate ? std::nullopt : ToShop2Tasks(item.network.front());
    }
    return item.immediate ? "(:immediate " + ToString(item.task) + ")" : ToString(item.task);
  }

  const TaskNetwork& network_;
  Relation before_;
};

}  // namespace

std::optional<std::string> ToShop2Tasks(const TaskNetwork& network) {
  return NetworkWriter(network).Write();
}

}  // namespace hires::planning
