#include "hires/planning/plan_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>

#include "hires/planning/substitution.h"

namespace hires::planning {
namespace {

/// An atom that a step adds or deletes.
struct Change {
  Datum atom;
  int step{0};
  bool adds{false};
};

/// Collects for every step the earlier ones that it has to wait for.
class OrderBuilder {
 public:
  explicit OrderBuilder(const Plan& plan) : plan_(plan), before_(plan.steps.size()) {
    for (int i = 0; i < num_steps(); ++i) {
      for (const Datum& atom : plan.steps[i].adds) Note({atom, i, true});
      for (const Datum& atom : plan.steps[i].deletes) Note({atom, i, false});
    }
  }

  std::vector<std::set<int>> Build() {
    for (int i = 0; i < num_steps(); ++i) {
      for (const CausalLink& link : plan_.steps[i].links) KeepLink(link, i);
      for (const Datum& pattern : plan_.steps[i].reads) KeepPattern(pattern, i);
    }
    for (const auto& [text, changes] : by_atom_) KeepChanges(changes);
    KeepProtections();
    for (const auto& [before, after] : plan_.subtask_order) Keep(before, after);
    return std::move(before_);
  }

 private:
  int num_steps() const { return static_cast<int>(plan_.steps.size()); }

  void Note(const Change& change) {
    by_atom_[ToString(change.atom)].push_back(change);
    by_predicate_[std::string(change.atom.Head())].push_back(change);
  }

  void Keep(int a, int b) {
    if (a != b) before_[std::max(a, b)].insert(std::min(a, b));
  }

  void KeepLink(const CausalLink& link, int consumer) {
    if (link.producer != CausalLink::kInitial) Keep(link.producer, consumer);
    if (!link.literal.holds) return KeepPattern(link.literal.atom, consumer);
    const auto changes = by_atom_.find(ToString(link.literal.atom));
    if (changes == by_atom_.end()) return;
    // Others that add the atom again do no harm: the producer's order to whatever deletes it holds.
    for (const Change& change : changes->second) {
      if (!change.adds) Keep(change.step, consumer);
    }
  }

  void KeepPattern(const Datum& pattern, int reader) {
    const auto changes = by_predicate_.find(std::string(pattern.Head()));
    if (changes == by_predicate_.end()) return;
    for (const Change& change : changes->second) {
      if (Substitution().Unify(pattern, change.atom)) Keep(change.step, reader);
    }
  }

  void KeepChanges(const std::vector<Change>& changes) {
    for (const Change& add : changes) {
      if (!add.adds) continue;
      for (const Change& change : changes) {
        if (!change.adds) Keep(add.step, change.step);
      }
    }
  }

  void KeepProtections() {
    std::unordered_map<std::string, std::vector<int>> begins;
    for (int i = 0; i < num_steps(); ++i) {
      for (const Datum& mark : plan_.steps[i].reads) {
        if (mark.Head() == ":protection") begins[ToString(mark.items.at(1))].push_back(i);
      }
    }
    for (int i = 0; i < num_steps(); ++i) {
      for (const Datum& mark : plan_.steps[i].reads) {
        if (mark.Head() != ":unprotection") continue;
        for (const int begin : begins[ToString(mark.items.at(1))]) Keep(begin, i);
      }
    }
  }

  const Plan& plan_;
  std::vector<std::set<int>> before_;
  std::unordered_map<std::string, std::vector<Change>> by_atom_;
  std::unordered_map<std::string, std::vector<Change>> by_predicate_;
};

using Bits = std::vector<std::uint64_t>;

bool Has(const Bits& bits, int i) { return (bits[i / 64] >> (i % 64) & 1u) != 0; }
void Insert(Bits* bits, int i) { (*bits)[i / 64] |= std::uint64_t{1} << (i % 64); }
void InsertAll(Bits* bits, const Bits& others) {
  for (std::size_t i = 0; i < bits->size(); ++i) (*bits)[i] |= others[i];
}

/// Without the pairs that follow from others. Every pair goes from a lower to a higher index, so a
/// nearer predecessor is never implied by a farther one.
std::vector<std::pair<int, int>> Reduced(const std::vector<std::set<int>>& before) {
  std::vector<std::pair<int, int>> order;
  std::vector<Bits> all_before(before.size(), Bits(before.size() / 64 + 1, 0));
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (auto step = before[i].rbegin(); step != before[i].rend(); ++step) {
      if (Has(all_before[i], *step)) continue;
      order.emplace_back(*step, static_cast<int>(i));
      Insert(&all_before[i], *step);
      InsertAll(&all_before[i], all_before[*step]);
    }
  }
  std::sort(order.begin(), order.end());
  return order;
}

/// Puts steps into all orders that are allowed, one step a level.
class Extender {
 public:
  Extender(int num_steps, const std::vector<std::pair<int, int>>& order,
           const std::function<bool(const std::vector<int>&)>& visit)
      : visit_(visit), waits_for_(num_steps, 0), after_(num_steps) {
    for (const auto& [before, after] : order) {
      after_[before].push_back(after);
      ++waits_for_[after];
    }
  }

  /// False once `visit` wants no more.
  bool Extend() {
    if (taken_.size() == after_.size()) return visit_(taken_);
    for (int step = 0; step < static_cast<int>(after_.size()); ++step) {
      if (waits_for_[step] != 0) continue;
      Take(step);
      const bool go_on = Extend();
      TakeBack(step);
      if (!go_on) return false;
    }
    return true;
  }

 private:
  void Take(int step) {
    taken_.push_back(step);
    waits_for_[step] = -1;
    for (const int later : after_[step]) --waits_for_[later];
  }

  void TakeBack(int step) {
    for (const int later : after_[step]) ++waits_for_[later];
    waits_for_[step] = 0;
    taken_.pop_back();
  }

  const std::function<bool(const std::vector<int>&)>& visit_;
  std::vector<int> waits_for_;  ///< -1: taken
  std::vector<std::vector<int>> after_;
  std::vector<int> taken_;
};

}  // namespace

std::vector<std::pair<int, int>> PartialOrder(const Plan& plan) {
  return Reduced(OrderBuilder(plan).Build());
}

void ForEachLinearExtension(int num_steps, const std::vector<std::pair<int, int>>& order,
                            const std::function<bool(const std::vector<int>&)>& visit) {
  Extender(num_steps, order, visit).Extend();
}

}  // namespace hires::planning
