#include "hires/knowledge/episode_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "hires/base/error.h"
#include "knowledge/state/live_view_match.h"

namespace hires::knowledge {
namespace {

using Verdict = InstanceDiff::Verdict;

constexpr double kTurn = 2.0 * 3.14159265358979323846;  // [rad]

struct NameOrder {
  bool operator()(const std::string& a, const std::string& b) const { return NameLess(a, b); }
};
struct BothHistories {
  std::vector<EpisodeChange> a, b;
};
using Histories = std::map<std::string, BothHistories, NameOrder>;

void CheckTolerance(const std::string& name, double tolerance) {
  if (tolerance >= 0.0) return;  // false for NaN as well
  throw base::ConfigError(fmt::format(
      "diff of episodes: the tolerance of {} is {}; wanted 0 or more", name, tolerance));
}

void CheckOptions(const EpisodeDiffOptions& options) {
  CheckTolerance("time", options.time_tolerance);
  CheckTolerance("numbers", options.tolerance);
  for (const auto& [role, tolerance] : options.tolerances) CheckTolerance(role, tolerance);
}

// Properties ----------------------------------------------------------------------------------

bool SameNumber(const std::string& role, const Filler& a, const Filler& b,
                const EpisodeDiffOptions& options) {
  if (SameFiller(a, b)) return true;
  const auto named = options.tolerances.find(role);
  const double tolerance = named == options.tolerances.end() ? options.tolerance : named->second;
  const double apart = AsDouble(a) - AsDouble(b);
  const bool is_angle = options.angles.count(role) > 0;
  return std::abs(is_angle ? std::remainder(apart, kTurn) : apart) <= tolerance;
}

bool SameProperty(const Property& a, const Property& b, const EpisodeDiffOptions& options) {
  if (IsNumber(a.filler) && IsNumber(b.filler)) {
    return SameNumber(a.role, a.filler, b.filler, options);
  }
  return a.IsLink() && b.IsLink() ? SameFiller(a.filler, b.filler) : a.filler == b.filler;
}

std::vector<const Property*> OfRole(const Fluent& fluent, const std::string& role) {
  std::vector<const Property*> found;
  for (const Property& property : fluent.properties) {
    if (property.role == role) found.push_back(&property);
  }
  return found;
}

std::vector<Filler> Fillers(const std::vector<const Property*>& properties) {
  std::vector<Filler> fillers;
  for (const Property* property : properties) fillers.push_back(property->filler);
  return fillers;
}

std::set<std::string> Roles(const Fluent& a, const Fluent& b) {
  std::set<std::string> roles;
  for (const Property& property : a.properties) roles.insert(property.role);
  for (const Property& property : b.properties) roles.insert(property.role);
  return roles;
}

std::vector<PropertyDifference> Differences(const Fluent& a, const Fluent& b,
                                            const EpisodeDiffOptions& options) {
  std::vector<PropertyDifference> differences;
  for (const std::string& role : Roles(a, b)) {
    const auto of_a = OfRole(a, role), of_b = OfRole(b, role);
    const bool same = std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                 [&](const Property* one, const Property* other) {
                                   return SameProperty(*one, *other, options);
                                 });
    if (!same) differences.push_back({role, Fillers(of_a), Fillers(of_b)});
  }
  return differences;
}

/// Cheaper than to list the differences where properties come in the same order.
bool SameContent(const Fluent& a, const Fluent& b, const EpisodeDiffOptions& options) {
  if (a.concept_name != b.concept_name) return false;
  const bool in_order = std::equal(a.properties.begin(), a.properties.end(), b.properties.begin(),
                                   b.properties.end(), [&](const Property& x, const Property& y) {
                                     return x.role == y.role && SameProperty(x, y, options);
                                   });
  return in_order || Differences(a, b, options).empty();
}

// Lining up -------------------------------------------------------------------------------------

bool Ends(const EpisodeChange& change) { return change.kind == Change::Kind::kRemoved; }

double Delay(double a, double b) { return a == b ? 0.0 : b - a; }  // also where both are -infinity

ComparedChange Pair(EpisodeChange a, EpisodeChange b, const EpisodeDiffOptions& options) {
  ComparedChange pair;
  pair.other_concept = a.fluent.concept_name != b.fluent.concept_name;
  pair.differences = Differences(a.fluent, b.fluent, options);
  pair.delay = Delay(a.time, b.time);
  pair.late = std::abs(pair.delay) > options.time_tolerance;
  pair.a = std::move(a);
  pair.b = std::move(b);
  return pair;
}

/// The cheapest way to line up what happened to one instance: a pair that differs costs 1, a change
/// without its like costs 1 (so a pair that differs is better than two of those), and what begins
/// never pairs with what ends.
class Alignment {
 public:
  Alignment(BothHistories histories, const EpisodeDiffOptions& options)
      : histories_(std::move(histories)),
        options_(options),
        width_(histories_.b.size() + 1),
        by_number_((histories_.a.size() + 1) * width_ > kMostWays) {}

  std::vector<ComparedChange> Changes() {
    if (!by_number_) FillCosts();
    std::size_t i = 0, j = 0;
    std::vector<ComparedChange> changes;
    while (i < histories_.a.size() || j < histories_.b.size()) {
      changes.push_back(Next(&i, &j));
    }
    return changes;
  }

 private:
  static constexpr std::size_t kMostWays = 1'000'000;
  static constexpr std::uint32_t kNever = 1u << 30;

  std::uint32_t& Cost(std::size_t i, std::size_t j) { return costs_[i * width_ + j]; }

  std::uint32_t PairCost(std::size_t i, std::size_t j) const {
    const EpisodeChange &a = histories_.a[i], &b = histories_.b[j];
    if (Ends(a) != Ends(b)) return kNever;
    return SameContent(a.fluent, b.fluent, options_) ? 0 : 1;
  }

  /// Cost of lining up all that comes from i and j on.
  void FillCosts() {
    const std::size_t rows = histories_.a.size(), columns = histories_.b.size();
    costs_.assign((rows + 1) * width_, 0);
    pair_costs_.assign((rows + 1) * width_, kNever);
    for (std::size_t i = rows + 1; i-- > 0;) {
      for (std::size_t j = columns + 1; j-- > 0;) FillCost(i, j);
    }
  }

  void FillCost(std::size_t i, std::size_t j) {
    const bool in_a = i < histories_.a.size(), in_b = j < histories_.b.size();
    if (!in_a && !in_b) return;
    std::uint32_t cost = kNever;
    if (in_a) cost = std::min(cost, Cost(i + 1, j) + 1);
    if (in_b) cost = std::min(cost, Cost(i, j + 1) + 1);
    if (in_a && in_b) {
      std::uint32_t& pair = pair_costs_[i * width_ + j];
      pair = PairCost(i, j);
      cost = std::min(cost, Cost(i + 1, j + 1) + pair);
    }
    Cost(i, j) = cost;
  }

  bool PairsUp(std::size_t i, std::size_t j) {
    if (i == histories_.a.size() || j == histories_.b.size()) return false;
    if (by_number_) return Ends(histories_.a[i]) == Ends(histories_.b[j]);
    return Cost(i, j) == Cost(i + 1, j + 1) + pair_costs_[i * width_ + j];
  }

  bool TakesA(std::size_t i, std::size_t j) {
    if (i == histories_.a.size() || j == histories_.b.size()) return i < histories_.a.size();
    return by_number_ || Cost(i, j) == Cost(i + 1, j) + 1;
  }

  ComparedChange Next(std::size_t* i, std::size_t* j) {
    if (PairsUp(*i, *j)) {
      return Pair(std::move(histories_.a[(*i)++]), std::move(histories_.b[(*j)++]), options_);
    }
    ComparedChange change;
    if (TakesA(*i, *j)) {
      change.a = std::move(histories_.a[(*i)++]);
    } else {
      change.b = std::move(histories_.b[(*j)++]);
    }
    return change;
  }

  BothHistories histories_;
  const EpisodeDiffOptions& options_;
  std::size_t width_;
  bool by_number_;
  std::vector<std::uint32_t> costs_, pair_costs_;
};

Verdict VerdictOf(const std::vector<ComparedChange>& changes) {
  const auto all = [&](auto holds) { return std::all_of(changes.begin(), changes.end(), holds); };
  if (all([](const ComparedChange& change) { return change.SameContent(); })) return Verdict::kSame;
  if (all([](const ComparedChange& change) { return !change.b; })) return Verdict::kOnlyInA;
  if (all([](const ComparedChange& change) { return !change.a; })) return Verdict::kOnlyInB;
  return Verdict::kDiffering;
}

// Order -----------------------------------------------------------------------------------------

/// Everything but a longest run of changes whose moments rise (or stay) in both episodes. One of
/// the fewest that can be called moved; found by patience sorting.
void MarkOutOfOrder(std::vector<ComparedChange*> changes) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const ComparedChange* x, const ComparedChange* y) {
                     return std::make_pair(x->a->moment, x->b->moment) <
                            std::make_pair(y->a->moment, y->b->moment);
                   });
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> ends;  // of the run of each length that ends earliest in b
  std::vector<std::size_t> before(changes.size(), kNone);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto end = std::upper_bound(
        ends.begin(), ends.end(), changes[i]->b->moment,
        [&](std::size_t moment, std::size_t one) { return moment < changes[one]->b->moment; });
    if (end != ends.begin()) before[i] = *(end - 1);
    if (end == ends.end()) {
      ends.push_back(i);
    } else {
      *end = i;
    }
    changes[i]->out_of_order = true;
  }
  for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i]) {
    changes[i]->out_of_order = false;
  }
}

// Reading ---------------------------------------------------------------------------------------

/// Numbers the moments at which something changed.
std::map<double, std::size_t> Moments(const std::vector<Change>& changes) {
  std::map<double, std::size_t> moments;
  for (const Change& change : changes) moments.emplace(change.time, 0);
  std::size_t number = 0;
  for (auto& [time, moment] : moments) moment = ++number;
  return moments;
}

void Collect(const Episode& episode, const std::vector<Change>& changes,
             std::vector<EpisodeChange> BothHistories::*side, Histories* histories) {
  const std::map<double, std::size_t> moments = Moments(changes);
  for (const Change& change : changes) {
    EpisodeChange collected;
    collected.kind = change.kind;
    collected.moment = moments.at(change.time);
    collected.time = change.time - episode.start;
    collected.fluent = change.fluent;
    ((*histories)[change.fluent.instance].*side).push_back(std::move(collected));
  }
}

/// What either episode changed, from one walk through all changes: the end of what held before the
/// episode is not among the fluents written in it.
std::pair<std::vector<Change>, std::vector<Change>> ReadChanges(const Store& store,
                                                                const Episode& a,
                                                                const Episode& b) {
  constexpr std::size_t kAtOnce = 1000;
  std::pair<std::vector<Change>, std::vector<Change>> found;
  std::vector<Change> changes;
  std::uint64_t last = 0;
  do {
    changes = store.ChangesSince(last, kAtOnce);
    for (const Change& change : changes) {
      if (change.episode == a.id) found.first.push_back(change);
      if (change.episode == b.id) found.second.push_back(change);
      last = change.sequence;
    }
  } while (changes.size() == kAtOnce);
  return found;
}

template <typename Holds>
std::size_t CountChanges(const EpisodeDiff& diff, Holds holds) {
  std::size_t count = 0;
  for (const InstanceDiff& instance : diff.instances) {
    count += static_cast<std::size_t>(
        std::count_if(instance.changes.begin(), instance.changes.end(), holds));
  }
  return count;
}

}  // namespace

std::size_t EpisodeDiff::Count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(instances.begin(), instances.end(),
                    [&](const InstanceDiff& instance) { return instance.verdict == verdict; }));
}

std::size_t EpisodeDiff::num_late() const {
  return CountChanges(*this, [](const ComparedChange& change) { return change.late; });
}

std::size_t EpisodeDiff::num_out_of_order() const {
  return CountChanges(*this, [](const ComparedChange& change) { return change.out_of_order; });
}

bool EpisodeDiff::Same() const {
  return Count(Verdict::kSame) == instances.size() && num_late() == 0 && num_out_of_order() == 0;
}

EpisodeDiff Compare(const Episode& a, const std::vector<Change>& changes_a, const Episode& b,
                    const std::vector<Change>& changes_b, const EpisodeDiffOptions& options) {
  CheckOptions(options);
  Histories histories;
  Collect(a, changes_a, &BothHistories::a, &histories);
  Collect(b, changes_b, &BothHistories::b, &histories);
  EpisodeDiff diff;
  diff.a = a;
  diff.b = b;
  for (auto& [instance, both] : histories) {
    std::vector<ComparedChange> changes = Alignment(std::move(both), options).Changes();
    const Verdict verdict = VerdictOf(changes);
    diff.instances.push_back({instance, verdict, std::move(changes)});
  }
  std::vector<ComparedChange*> in_both;
  for (InstanceDiff& instance : diff.instances) {
    for (ComparedChange& change : instance.changes) {
      if (change.InBoth()) in_both.push_back(&change);
    }
  }
  MarkOutOfOrder(std::move(in_both));
  return diff;
}

EpisodeDiff Compare(const Store& store, const Episode& a, const Episode& b,
                    const EpisodeDiffOptions& options) {
  const auto [changes_a, changes_b] = ReadChanges(store, a, b);
  return Compare(a, changes_a, b, changes_b, options);
}

}  // namespace hires::knowledge
