#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/evaluation/experiment/report.h"
#include "hires/evaluation/place/place_moment.h"
#include "hires/simulation/self_localisation.h"

namespace hires::evaluation {

PlaceMoment MomentOf(const simulation::SelfLocaliser& localiser);

/// Of all moments; what is asked of none is no number.
TextTable PlaceTable(const PlaceTrail& moments);
std::vector<Measure> PlaceMeasures(const PlaceTrail& moments);

}  // namespace hires::evaluation
