#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/pose_moves.h"
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

  /// As MovePoint, where the pose is not the axis itself.
  void Turn(const std::string& instance, const PoseMove& move, const std::string& where) {
    PoseMove turn;
    turn.pivot_x = move.pivot_x;
    turn.pivot_y = move.pivot_y;
    turn.yaw = move.yaw;
    for (Fluent* fluent : Find(instance, where)) {
      MovePoint(turn, &Axis(fluent, "hasX", where), &Axis(fluent, "hasY", where));
    }
  }

  /// Value of the one validity that a pivot has.
  double Only(const std::string& instance, const std::string& axis, const std::string& where) {
    const std::vector<Fluent*>& validities = Find(instance, where);
    if (validities.size() == 1) return Axis(validities[0], axis, where);
    FailModification(where,
                     fmt::format("'{}' has {} validities, so nothing that is attached can be "
                                 "turned about it; keep one",
                                 instance, validities.size()));
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
  const std::string what = fmt::format("modification of '{}'", modification.instance);
  return modification.where.empty() ? what : modification.where + ": " + what;
}

double DeltaOf(const PoseModification& modification, const std::string& axis, std::size_t choice) {
  for (const PoseModification::Delta& delta : modification.modifications) {
    if (delta.property == axis) return delta.choices[choice];
  }
  return 0.0;
}

PoseMove MoveOf(const PoseModification& modification, std::size_t choice, Poses* poses) {
  PoseMove move;
  move.x = DeltaOf(modification, "hasX", choice);
  move.y = DeltaOf(modification, "hasY", choice);
  move.z = DeltaOf(modification, "hasZ", choice);
  move.yaw = DeltaOf(modification, "hasYaw", choice);
  if (move.yaw == 0.0 || modification.attachments.empty()) return move;
  move.pivot_x = poses->Only(modification.instance, "hasX", WhereOf(modification));
  move.pivot_y = poses->Only(modification.instance, "hasY", WhereOf(modification));
  return move;
}

void Apply(const PoseModification& modification, std::size_t choice,
           const PoseAttachments& attachments, Poses* poses, PoseMoves* moves) {
  const std::string where = WhereOf(modification);
  poses->Find(modification.instance, where);
  PoseMove move = MoveOf(modification, choice, poses);
  const std::vector<std::string> moved = attachments.MovedWith(modification.instance);
  for (const std::string& instance : moved) {
    poses->Find(instance, where);  // also where nothing is to be added
    const bool is_pivot = &instance == &moved.front();
    if (move.yaw != 0.0 && !is_pivot) poses->Turn(instance, move, where);
    move.is_own_axis = is_pivot;
    for (const PoseModification::Delta& delta : modification.modifications) {
      poses->Move(instance, delta.property, delta.choices[choice], where);
    }
    (*moves)[base::ToLower(instance)].push_back(move);
  }
}

}  // namespace

void MovePoint(const PoseMove& move, double* x, double* y) {
  const double dx = *x - move.pivot_x, dy = *y - move.pivot_y;
  const double c = std::cos(move.yaw), s = std::sin(move.yaw);
  const bool is_turned = move.yaw != 0.0 && !move.is_own_axis;  // else not a bit changes
  *x = (is_turned ? move.pivot_x + c * dx - s * dy : *x) + move.x;
  *y = (is_turned ? move.pivot_y + s * dx + c * dy : *y) + move.y;
}

PoseMoves MovePoses(const std::vector<PoseModification>& modifications,
                    const std::map<std::string, int>& choices, std::vector<Fluent>* fluents) {
  CheckModifications(modifications, [&](std::size_t i) { return WhereOf(modifications[i]); });
  const PoseAttachments attachments(modifications);
  std::vector<Fluent> moved = *fluents;  // all modifications or none
  Poses poses(&moved);
  PoseMoves moves;
  for (const PoseModification& modification : modifications) {
    const auto choice = static_cast<std::size_t>(choices.at(modification.group));
    Apply(modification, choice, attachments, &poses, &moves);
  }
  *fluents = std::move(moved);
  return moves;
}

void ApplyModifications(const std::vector<PoseModification>& modifications, base::Rng rng,
                        std::vector<Fluent>* fluents) {
  CheckModifications(modifications, [&](std::size_t i) { return WhereOf(modifications[i]); });
  MovePoses(modifications, DrawChoices(modifications, rng), fluents);
}

}  // namespace hires::knowledge
