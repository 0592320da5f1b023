#include "sensing/anchoring.h"

#include <algorithm>
#include <limits>

namespace hires::sensing {
namespace {

constexpr double kImpossible = 1e6;  // [m] for a thing to be an instance that it cannot be

/// [m] of each column for each row: of anchors, and as many more in which a thing stays alone.
using Costs = std::vector<std::vector<double>>;

struct Assignment {
  std::vector<int> column;  // of each row
  double cost{0.0};
};

/// The assignment of least cost: shortest augmenting paths with potentials [Kuhn 1955; Jonker,
/// Volgenant 1987].  @pre as many columns as rows at least.
class Assigner {
 public:
  explicit Assigner(const Costs& costs)
      : costs_(costs),
        num_columns_(costs.empty() ? 0 : costs[0].size()),
        row_potential_(costs.size(), 0.0),
        column_potential_(num_columns_, 0.0),
        row_of_(num_columns_, -1) {}

  Assignment Run() {
    for (std::size_t row = 0; row < costs_.size(); ++row) Augment(static_cast<int>(row));
    Assignment result;
    result.column.assign(costs_.size(), -1);
    for (std::size_t column = 0; column < num_columns_; ++column) {
      if (row_of_[column] < 0) continue;
      result.column[row_of_[column]] = static_cast<int>(column);
      result.cost += costs_[row_of_[column]][column];
    }
    return result;
  }

 private:
  void Augment(int first_row) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> slack(num_columns_, kInfinity);
    std::vector<int> before(num_columns_, -1);  // column before this one on the path; -1: it begins
    std::vector<bool> is_done(num_columns_, false);
    int row = first_row, at = -1;
    while (row >= 0) {
      int next = -1;
      for (std::size_t column = 0; column < num_columns_; ++column) {
        if (is_done[column]) continue;
        const double reduced =
            costs_[row][column] - row_potential_[row] - column_potential_[column];
        if (reduced < slack[column]) {
          slack[column] = reduced;
          before[column] = at;
        }
        if (next < 0 || slack[column] < slack[next]) next = static_cast<int>(column);
      }
      const double step = slack[next];
      row_potential_[first_row] += step;
      for (std::size_t column = 0; column < num_columns_; ++column) {
        if (is_done[column]) {
          row_potential_[row_of_[column]] += step;
          column_potential_[column] -= step;
        } else {
          slack[column] -= step;
        }
      }
      is_done[next] = true;
      at = next;
      row = row_of_[at];
    }
    for (; at >= 0; at = before[at]) row_of_[at] = before[at] < 0 ? first_row : row_of_[before[at]];
  }

  const Costs& costs_;
  std::size_t num_columns_;
  std::vector<double> row_potential_, column_potential_;
  std::vector<int> row_of_;  // of each column; -1: free
};

/// The least cost with which a thing is another instance than its own, or stays alone and another
/// thing is that instance. That it stays alone, and so nothing is that instance, is no other way to
/// name them: a thing not far from the only instance it can be is that one.
double CostOfOthers(const Costs& costs, std::size_t thing, int own, int num_anchors,
                    double margin) {
  Costs another = costs;
  std::fill(another[thing].begin() + num_anchors, another[thing].end(), kImpossible);
  another[thing][own] = kImpossible;
  Costs alone = costs;
  std::fill(alone[thing].begin(), alone[thing].begin() + num_anchors, kImpossible);
  // More than the margin's worth, so that where none takes it, it is worse by that.
  for (std::size_t i = 0; i < costs.size(); ++i) alone[i][own] -= 2 * margin;
  return std::min(Assigner(another).Run().cost, Assigner(alone).Run().cost + 2 * margin);
}

}  // namespace

std::optional<double> CostOf(const SeenThing& thing, const Anchor& anchor, double reach) {
  const auto kind = std::find_if(thing.kinds.begin(), thing.kinds.end(),
                                 [&](const SeenKind& one) { return one.kind == anchor.kind; });
  if (kind == thing.kinds.end()) return std::nullopt;
  const double cost = (thing.p_M - anchor.p_M).norm() + kind->doubt;
  return cost <= reach ? std::optional(cost) : std::nullopt;
}

Anchoring AnchorThings(const std::vector<SeenThing>& things, const std::vector<Anchor>& anchors,
                       double reach, double margin) {
  const int num_anchors = static_cast<int>(anchors.size());
  Costs costs(things.size(), std::vector<double>(anchors.size() + things.size(), reach));
  for (std::size_t i = 0; i < things.size(); ++i) {
    for (std::size_t k = 0; k < anchors.size(); ++k)
      costs[i][k] = CostOf(things[i], anchors[k], reach).value_or(kImpossible);
  }
  const Assignment best = Assigner(costs).Run();
  Anchoring out;
  out.anchor.assign(things.size(), -1);
  out.is_ambiguous.assign(things.size(), false);
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (best.column[i] >= num_anchors) continue;
    out.is_ambiguous[i] =
        CostOfOthers(costs, i, best.column[i], num_anchors, margin) - best.cost < margin;
    if (!out.is_ambiguous[i]) out.anchor[i] = best.column[i];
  }
  return out;
}

}  // namespace hires::sensing
