#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"

namespace hires::knowledge {

/// How something rigid is moved: turned about a vertical axis, then shifted along the map's axes.
struct PoseMove {
  double pivot_x{0.0}, pivot_y{0.0};  ///< [m] where the axis stands, before it is shifted
  double yaw{0.0};                    ///< [rad]
  double x{0.0}, y{0.0}, z{0.0};      ///< [m]
  bool is_own_axis{false};            ///< the axis goes through what is moved, wherever that stands
};

/// Moves the origin of something [m].
void MovePoint(const PoseMove& move, double* x, double* y);

/// What moves each pose, in this order; by instance in lower case.
using PoseMoves = std::map<std::string, std::vector<PoseMove>>;

/// Applies modifications, in their order, to the poses among `fluents`, all or none. What is
/// attached moves along rigidly, about the pose that is modified, and so does what is attached to
/// that; each once for a modification, even where two ways lead to it. A pose that has several
/// validities is moved in all of them. Instance names compare without regard to the case of ASCII
/// letters, as in the store.
/// @param choices  by group, from 0.
/// @return what it did, for things that no fluent speaks of.
/// @pre each group has a choice that its modifications have.
/// @throws ConfigError where an instance is missing or no pose, or lacks the axis; where something
/// is
///   attached to a pose that is turned and has several validities; or where modifications do not
///   fit together, as ReadKnowledge says.
PoseMoves MovePoses(const std::vector<PoseModification>& modifications,
                    const std::map<std::string, int>& choices, std::vector<Fluent>* fluents);

}  // namespace hires::knowledge
