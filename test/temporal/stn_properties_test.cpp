#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/temporal/stn.h"
#include "support/property.h"

// The network against the slow and obvious way: all shortest paths by Floyd and Warshall, over
// whole seconds, so that both are exact.

namespace hires::temporal::stn_properties_test {
namespace {

struct Requirement {
  int from, to;
  Bounds bounds;
};

using Matrix = std::vector<std::vector<double>>;

/// Longest allowed time from each point to each other one.
Matrix AllPairs(int num_points, const std::vector<Requirement>& requirements) {
  Matrix at_most(num_points, std::vector<double>(num_points, kForever));
  for (int i = 0; i < num_points; ++i) at_most[i][i] = 0.0;
  for (const auto& [from, to, bounds] : requirements) {
    at_most[from][to] = std::min(at_most[from][to], bounds.latest);
    at_most[to][from] = std::min(at_most[to][from], -bounds.earliest);
  }
  for (int k = 0; k < num_points; ++k) {
    for (int i = 0; i < num_points; ++i) {
      for (int j = 0; j < num_points; ++j) {
        at_most[i][j] = std::min(at_most[i][j], at_most[i][k] + at_most[k][j]);
      }
    }
  }
  return at_most;
}

bool IsConsistent(const Matrix& at_most) {
  for (std::size_t i = 0; i < at_most.size(); ++i) {
    if (at_most[i][i] < 0.0) return false;
  }
  return true;
}

Requirement AnyRequirement(int num_points) {
  const auto side = [](double sign) {
    return *rc::gen::oneOf(rc::gen::just(sign * kForever),
                           rc::gen::map(rc::gen::inRange(-20, 21), [](int x) { return 1.0 * x; }));
  };
  Requirement any{
      *rc::gen::inRange(0, num_points), *rc::gen::inRange(0, num_points), {side(-1.0), side(1.0)}};
  // Mostly the right way round; what is not must be refused.
  if (any.bounds.earliest > any.bounds.latest && *rc::gen::inRange(0, 8) > 0) {
    std::swap(any.bounds.earliest, any.bounds.latest);
  }
  return any;
}

/// A network beside what was asked of it.
class Pair {
 public:
  explicit Pair(int num_points) : num_points_(num_points) {
    while (static_cast<int>(network_.num_points()) < num_points) network_.AddPoint("p");
  }

  void Add(const Requirement& added) {
    std::vector<Requirement> wanted = Active();
    wanted.push_back(added);
    const bool fits = IsConsistent(AllPairs(num_points_, wanted));
    Stn::ConstraintId id = -1;
    const auto conflict = network_.Constrain(added.from, added.to, added.bounds, "c", &id);
    RC_ASSERT(fits == !conflict);
    if (conflict) return CheckConflict(*conflict, added);
    RC_ASSERT(id == static_cast<int>(all_.size()));
    all_.push_back(added);
    is_active_.push_back(true);
  }

  void RetractAny() {
    std::vector<int> active;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (is_active_[i]) active.push_back(static_cast<int>(i));
    }
    if (active.empty()) return;
    const int id = *rc::gen::elementOf(active);
    network_.Retract(id);
    is_active_[id] = false;
  }

  void CheckBounds() const {
    const Matrix at_most = AllPairs(num_points_, Active());
    for (int i = 0; i < num_points_; ++i) {
      RC_ASSERT(network_.Of(i) == (Bounds{-at_most[i][0], at_most[0][i]}));
      for (int j = 0; j < num_points_; ++j) {
        RC_ASSERT(network_.Between(i, j) == (Bounds{-at_most[j][i], at_most[i][j]}));
      }
    }
  }

 private:
  std::vector<Requirement> Active() const {
    std::vector<Requirement> active;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (is_active_[i]) active.push_back(all_[i]);
    }
    return active;
  }

  /// The constraints of the cycle cannot hold together, and without the refused one they can.
  void CheckConflict(const Stn::Conflict& conflict, const Requirement& refused) const {
    RC_ASSERT(conflict.cycle.at(0) == Stn::Conflict::kRefused);
    std::vector<Requirement> others;
    for (const Stn::ConstraintId id : conflict.cycle) {
      if (id == Stn::Conflict::kRefused) continue;
      RC_ASSERT(is_active_.at(id));
      others.push_back(all_[id]);
    }
    RC_ASSERT(IsConsistent(AllPairs(num_points_, others)));
    others.push_back(refused);
    RC_ASSERT(!IsConsistent(AllPairs(num_points_, others)));
    RC_ASSERT(!conflict.text.empty());
  }

  int num_points_;
  Stn network_;
  std::vector<Requirement> all_;
  std::vector<bool> is_active_;
};

constexpr test_support::PropertyCases kPropertyCases{};

HIRES_PROPERTY(StnPropertyTest, BoundsAreThoseOfAllShortestPathsAlsoAfterRetraction, ()) {
  const int num_points = *rc::gen::inRange(1, 13);
  Pair pair(num_points);
  const int num_changes = *rc::gen::inRange(0, 120);
  for (int i = 0; i < num_changes; ++i) {
    if (*rc::gen::inRange(0, 4) == 0) {
      pair.RetractAny();
    } else {
      pair.Add(AnyRequirement(num_points));
    }
    pair.CheckBounds();
  }
}

}  // namespace
}  // namespace hires::temporal::stn_properties_test
