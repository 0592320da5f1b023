#pragma once

#include <Eigen/Core>
#include <string>

#include "hires/world/world.h"

namespace hires::world {

/// [kg/m^3] of the box around a thing of unknown kind; assumed (docs/sources.md).
inline constexpr double kUnknownDensity = 500.0;

/// The model of a thing of which its box alone is known: a text that says its size along the
/// thing's own x, y and z in metres with three decimals, "unknown_0.120x0.080x0.200".
/// @param size  [m] each from 0.001 to 10, rounded to a millimetre.
/// @throws base::ConfigError for another size.
std::string UnknownBoxModel(const Eigen::Vector3d& size);

/// Whether a model's name says a box, be it a good one or not: whether it begins with "unknown_".
bool SaysUnknownBox(const std::string& model);

/// [m] the size that the name says.
/// @throws base::ConfigError with what came and what was wanted: not three numbers in metres with
/// three decimals each, one that is not from 0.001 to 10.
Eigen::Vector3d SizeOfUnknownBox(const std::string& model);

/// The box that the name says, solid, of kUnknownDensity; origin: middle of its underside.
/// @throws base::ConfigError as SizeOfUnknownBox.
ObjectModel MakeUnknownBox(const std::string& model);

}  // namespace hires::world
