#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/evaluation/experiment/report.h"
#include "hires/simulation/self_localisation.h"

namespace hires::evaluation {

/// How far a robot that finds its place by itself is off at one moment.
struct PlaceError {
  double distance{0.0};  ///< [m]
  double yaw{0.0};       ///< [rad] not negative
  /// The truth lies in the ellipsoid of x, y and yaw that holds 95 % by the filter's covariance.
  bool is_inside{false};
};

PlaceError PlaceErrorOf(const simulation::SelfLocaliser& localiser);

/// Of all moments; what is asked of none is no number.
TextTable PlaceTable(const std::vector<PlaceError>& errors);
std::vector<Measure> PlaceMeasures(const std::vector<PlaceError>& errors);

}  // namespace hires::evaluation
