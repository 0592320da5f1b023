#pragma once

#include <optional>
#include <string>

#include "hires/geometry/pose.h"
#include "hires/knowledge/sparql.h"

namespace hires::translation {

/// Of things that no recogniser knows; fluents say their boxes.
inline constexpr const char* kUnknownConcept = "UnknownObject";

/// A pose as a Pose fluent states it.
struct StatedPose {
  std::string instance;  ///< of the Pose, as it is spelled
  std::string frame;     ///< F: a link of the robot in the case it was written in, or empty: map
  geometry::Pose3 X_FO;
};

/// The filler of the first link in that role, or empty.
std::string LinkOf(const knowledge::Fluent& fluent, const std::string& role);
std::optional<double> NumberOf(const knowledge::Fluent& fluent, const std::string& role);

/// The Pose that a fluent's hasPose names; nothing if there is none, or it lacks hasX, hasY, hasZ.
std::optional<StatedPose> PoseStatedBy(const knowledge::FluentView& view,
                                       const knowledge::Fluent& fluent);
std::optional<StatedPose> PoseStatedOf(const knowledge::FluentView& view,
                                       const std::string& instance);

/// The fluent that states a pose: roll, pitch and frame only where they are not 0 and not map.
knowledge::Fluent PoseFluent(const StatedPose& pose);

/// "onMug1": a word and then the thing, with a capital letter.
std::string NameFor(const std::string& word, const std::string& thing);

}  // namespace hires::translation
