#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "hires/base/error.h"
#include "hires/knowledge/fluent_yaml.h"
#include "knowledge/yaml/fluent_yaml_modification.h"
#include "knowledge/yaml/pose_attachments.h"

namespace hires::knowledge {
namespace {

constexpr std::size_t kMaxMoves = 1'000'000;  // poses moved, each as often as it is moved

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
      FailModification(
          where, fmt::format("more than {} poses are moved; attach less to each other", kMaxMoves));
    }
    for (Fluent* fluent : Find(instance, where)) {
      double& value = Axis(fluent, axis, where);
      value += delta;
      if (!std::isfinite(value))
        FailModification(where, fmt::format("{} of '{}' overflows", axis, instance));
    }
  }

  const std::vector<Fluent*>& Find(const std::string& instance, const std::string& where) const {
    const auto found = by_instance_.find(instance);
    if (found == by_instance_.end()) {
      FailModification(
          where, fmt::format("pose '{}' is to be moved, and no fluent is called so; load it first",
                             instance));
    }
    for (const Fluent* fluent : found->second) {
      if (fluent->concept_name == "Pose") continue;
      FailModification(where, fmt::format("'{}' is to be moved and is a {}; name its Pose",
                                          instance, fluent->concept_name));
    }
    return found->second;
  }

 private:
  static double& Axis(Fluent* fluent, const std::string& axis, const std::string& where) {
    for (Property& property : fluent->properties) {
      auto* const value = std::get_if<double>(&property.filler);
      if (property.role == axis && value != nullptr) return *value;
    }
    FailModification(
        where, fmt::format("pose '{}' is to be moved along {} and has no such xsd:float; add it",
                           fluent->instance, axis));
  }

  ByInstance<std::vector<Fluent*>> by_instance_;
  std::size_t num_moves_{0};
};

std::string WhereOf(const PoseModification& modification) {
  return fmt::format("modification of '{}'", modification.instance);
}

void Apply(const PoseModification& modification, int choice, const PoseAttachments& attachments,
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

void ApplyModifications(const std::vector<PoseModification>& modifications, base::Rng rng,
                        std::vector<Fluent>* fluents) {
  CheckModifications(modifications, [&](std::size_t i) { return WhereOf(modifications[i]); });
  const std::map<std::string, int> choices = DrawChoices(modifications, rng);
  const PoseAttachments attachments(modifications);
  std::vector<Fluent> moved = *fluents;  // all modifications or none
  Poses poses(&moved);
  for (const PoseModification& modification : modifications) {
    Apply(modification, choices.at(modification.group), attachments, &poses);
  }
  *fluents = std::move(moved);
}

}  // namespace hires::knowledge
