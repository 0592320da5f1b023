#include "fluent_yaml_modification.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

constexpr std::array<std::string_view, 4> kAxes = {"hasX", "hasY", "hasZ", "hasYaw"};
constexpr std::size_t kMaxMoves = 1'000'000;  // poses moved, each as often as it is moved

using Where = std::function<std::string(std::size_t)>;

[[noreturn]] void Fail(const std::string& where, const std::string& what) {
  throw base::ConfigError(where + ": " + what);
}

void CheckDelta(const PoseModification& modification, const PoseModification::Delta& delta,
                const std::string& where) {
  if (std::count(kAxes.begin(), kAxes.end(), delta.property) == 0) {
    Fail(where, fmt::format("'{}' is moved along {}; wanted one of {}", modification.instance,
                            delta.property, fmt::join(kAxes, ", ")));
  }
  if (delta.choices.size() != static_cast<std::size_t>(std::max(modification.choices, 0))) {
    Fail(where, fmt::format("'{}', {}: has {} deltas, Choices says {}; give one delta for each "
                            "choice",
                            modification.instance, delta.property, delta.choices.size(),
                            modification.choices));
  }
  if (!std::all_of(delta.choices.begin(), delta.choices.end(),
                   [](double value) { return std::isfinite(value); })) {
    Fail(where, fmt::format("'{}', {}: a delta is not finite; wanted numbers",
                            modification.instance, delta.property));
  }
}

void CheckDeltas(const PoseModification& modification, const std::string& where) {
  if (modification.choices < 1) {
    Fail(where, fmt::format("'{}': Choices is {}, wanted 1 or more", modification.instance,
                            modification.choices));
  }
  std::set<std::string> seen;
  for (const PoseModification::Delta& delta : modification.modifications) {
    if (!seen.insert(delta.property).second) {
      Fail(where, fmt::format("'{}', {}: is given twice; keep one", modification.instance,
                              delta.property));
    }
    CheckDelta(modification, delta, where);
  }
}

void CheckInstances(const std::vector<PoseModification>& modifications, const Where& where) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < modifications.size(); ++i) {
    const auto [first, is_new] = seen.emplace(modifications[i].instance, i);
    if (is_new) continue;
    Fail(where(i), fmt::format("'{}' is modified twice (already: {}); make it one modification",
                               modifications[i].instance, where(first->second)));
  }
}

void CheckGroups(const std::vector<PoseModification>& modifications, const Where& where) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < modifications.size(); ++i) {
    const PoseModification& modification = modifications[i];
    const PoseModification& first =
        modifications[seen.emplace(modification.group, i).first->second];
    if (first.choices == modification.choices) continue;
    Fail(where(i),
         fmt::format("'{}' has {} choices, '{}' of the same group '{}' has {}; a group draws one "
                     "choice for all, so give all as many",
                     modification.instance, modification.choices, first.instance,
                     modification.group, first.choices));
  }
}

/// Who is attached to what, with the circles found by taking away, again and again, the poses to
/// which nothing is attached: what is left stands in circles, or leads to one.
class Attachments {
 public:
  explicit Attachments(const std::vector<PoseModification>& modifications) {
    for (std::size_t i = 0; i < modifications.size(); ++i) Add(modifications[i], i);
  }

  /// Instances of a circle, the first again at the end; empty if there is none.
  std::vector<std::string> Circle() const {
    const std::map<std::string, std::size_t> left = Left();
    if (left.empty()) return {};
    std::vector<std::string> walk = {left.begin()->first};
    std::map<std::string, std::size_t> visited;
    while (visited.emplace(walk.back(), walk.size() - 1).second) {
      const std::vector<std::string>& next = attached_.at(walk.back());
      walk.push_back(*std::find_if(next.begin(), next.end(), [&](const std::string& instance) {
        return left.count(instance) > 0;
      }));
    }
    walk.erase(walk.begin(), walk.begin() + static_cast<std::ptrdiff_t>(visited[walk.back()]));
    return walk;
  }

  /// `instance` and all that moves with it, each once.
  std::vector<std::string> MovedWith(const std::string& instance) const {
    std::vector<std::string> moved = {instance};
    std::set<std::string> seen = {instance};
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const auto attached = attached_.find(moved[i]);
      if (attached == attached_.end()) continue;
      for (const std::string& next : attached->second) {
        if (seen.insert(next).second) moved.push_back(next);
      }
    }
    return moved;
  }

  std::size_t modification(const std::string& instance) const { return index_.at(instance); }

 private:
  void Add(const PoseModification& modification, std::size_t index) {
    const std::set<std::string> once(modification.attachments.begin(),
                                     modification.attachments.end());
    attached_[modification.instance].assign(once.begin(), once.end());
    index_[modification.instance] = index;
    for (const std::string& instance : once) carriers_[instance].push_back(modification.instance);
  }

  /// How many attachments are left of what stands in a circle or leads to one.
  std::map<std::string, std::size_t> Left() const {
    std::map<std::string, std::size_t> left;
    std::vector<std::string> free;
    for (const auto& [instance, carriers] : carriers_) {
      if (attached_.count(instance) == 0) free.push_back(instance);
    }
    for (const auto& [instance, attached] : attached_) {
      left[instance] = attached.size();
      if (attached.empty()) free.push_back(instance);
    }
    while (!free.empty()) {
      const std::string instance = free.back();
      free.pop_back();
      left.erase(instance);
      const auto carriers = carriers_.find(instance);
      if (carriers == carriers_.end()) continue;
      for (const std::string& carrier : carriers->second) {
        if (--left[carrier] == 0) free.push_back(carrier);
      }
    }
    return left;
  }

  std::map<std::string, std::vector<std::string>> attached_, carriers_;
  std::map<std::string, std::size_t> index_;
};

void CheckCircles(const std::vector<PoseModification>& modifications, const Where& where) {
  const Attachments attachments(modifications);
  const std::vector<std::string> circle = attachments.Circle();
  if (circle.empty()) return;
  Fail(where(attachments.modification(circle.front())),
       fmt::format("attachments go in a circle: {}; take one out", base::Join(circle, " -> ")));
}

/// Choice by group. Groups draw in the order in which they first appear.
std::map<std::string, int> DrawChoices(const std::vector<PoseModification>& modifications,
                                       const base::Rng& rng) {
  std::map<std::string, int> drawn;
  for (const PoseModification& modification : modifications) {
    if (drawn.count(modification.group) > 0) continue;
    drawn[modification.group] = rng.Fork(drawn.size()).Index(modification.choices);
  }
  return drawn;
}

/// The poses among fluents, by instance; one that has several validities moves in all of them.
class Poses {
 public:
  explicit Poses(std::vector<Fluent>* fluents) {
    for (Fluent& fluent : *fluents) by_instance_[fluent.instance].push_back(&fluent);
  }

  void Move(const std::string& instance, const std::string& axis, double delta,
            const std::string& where) {
    if (++num_moves_ > kMaxMoves) {
      Fail(where,
           fmt::format("more than {} poses are moved; attach less to each other", kMaxMoves));
    }
    for (Fluent* fluent : Find(instance, where)) {
      double& value = Axis(fluent, axis, where);
      value += delta;
      if (!std::isfinite(value)) Fail(where, fmt::format("{} of '{}' overflows", axis, instance));
    }
  }

  const std::vector<Fluent*>& Find(const std::string& instance, const std::string& where) const {
    const auto found = by_instance_.find(instance);
    if (found == by_instance_.end()) {
      Fail(where, fmt::format("pose '{}' is to be moved, and no fluent is called so; load it first",
                              instance));
    }
    for (const Fluent* fluent : found->second) {
      if (fluent->concept_name == "Pose") continue;
      Fail(where, fmt::format("'{}' is to be moved and is a {}; name its Pose", instance,
                              fluent->concept_name));
    }
    return found->second;
  }

 private:
  static double& Axis(Fluent* fluent, const std::string& axis, const std::string& where) {
    for (Property& property : fluent->properties) {
      auto* const value = std::get_if<double>(&property.filler);
      if (property.role == axis && value != nullptr) return *value;
    }
    Fail(where, fmt::format("pose '{}' is to be moved along {} and has no such xsd:float; add it",
                            fluent->instance, axis));
  }

  std::map<std::string, std::vector<Fluent*>> by_instance_;
  std::size_t num_moves_{0};
};

std::string WhereOf(const PoseModification& modification) {
  return fmt::format("modification of '{}'", modification.instance);
}

void Apply(const PoseModification& modification, int choice, const Attachments& attachments,
           Poses* poses) {
  const std::string where = WhereOf(modification);
  for (const std::string& instance : attachments.MovedWith(modification.instance)) {
    poses->Find(instance, where);  // also where nothing is to be added
    for (const PoseModification::Delta& delta : modification.modifications) {
      poses->Move(instance, delta.property, delta.choices[static_cast<std::size_t>(choice)], where);
    }
  }
}

}  // namespace

void CheckModifications(const std::vector<PoseModification>& modifications, const Where& where) {
  for (std::size_t i = 0; i < modifications.size(); ++i) {
    CheckDeltas(modifications[i], where(i));
  }
  CheckInstances(modifications, where);
  CheckGroups(modifications, where);
  CheckCircles(modifications, where);
}

void ApplyModifications(const std::vector<PoseModification>& modifications, base::Rng rng,
                        std::vector<Fluent>* fluents) {
  CheckModifications(modifications, [&](std::size_t i) { return WhereOf(modifications[i]); });
  const std::map<std::string, int> choices = DrawChoices(modifications, rng);
  const Attachments attachments(modifications);
  std::vector<Fluent> moved = *fluents;  // all modifications or none
  Poses poses(&moved);
  for (const PoseModification& modification : modifications) {
    Apply(modification, choices.at(modification.group), attachments, &poses);
  }
  *fluents = std::move(moved);
}

}  // namespace hires::knowledge
