#pragma once

#include <string>

#include "hires/mapping/mapper.h"

// Whether a map is worth what it looks like, where the world is not known that was mapped. The
// numbers in the texts of these functions were chosen on drives through made-up buildings, some of
// which no map can be right of: docs/notes_navigation.md.
namespace hires::mapping {

/// How far a map explains the scans that it was drawn from: of at most 200 scans, evenly over the
/// drive, and 90 beams of each. Cells of other than some 0.05 m are drawn again so for this; of a
/// map that is too large for it nothing is told of beams.
/// @param grid  as Draw makes it of the sketch.
MapEvidence EvidenceOf(const MapSketch& sketch, const world::OccupancyGrid& grid);

/// What speaks against a map: that at more than two fifths (and at least five) of the places to
/// which the drive came back the scan does not fit what was seen there before, that more than 0.8 %
/// of the beams went through walls, that less than 60 % ended at one, that the map is broken
/// (MapCounts::num_breaks), that the laser sees less than 0.8 or more than 1.25 of the ways that
/// odometry tells, less than half or more than twice of the turns (as bases that skid turn less
/// than their wheels tell; 0.87 and 1.15 where the field of view is assumed), or turns reversed,
/// that the two disagreed on more than three quarters (and at least twenty) of the stretches, or
/// that more than a third of the scans fitted nothing. Empty: nothing does.
std::string WhyDoubtful(const MapCounts& counts, const MapEvidence& evidence);

/// What may help against what WhyDoubtful says; empty where that is.
std::string WhatToDo(const MapCounts& counts, const MapEvidence& evidence);

}  // namespace hires::mapping
