#pragma once

#include <string>

#include "hires/knowledge/episode_diff.h"

namespace hires::knowledge {

/// For people: both episodes, a line for every change that differs, comes late or out of order
/// (with `all`, for every change), and the numbers. Times in s since each episode's start.
std::string ToTable(const EpisodeDiff& diff, bool all = false);

/// For programs: `{a, b: {id, name, label, task, outcome, parent, start, finish}, summary: {same,
/// differing, only_in_a, only_in_b, late, out_of_order}, instances: [{instance, verdict, changes:
/// [{a, b: {change, concept, time, moment} or null, other_concept, differences: [{role, a: [...],
/// b: [...]}], delay, late, out_of_order}]}]}`. Times [s] that are not finite are null.
std::string ToJson(const EpisodeDiff& diff);

}  // namespace hires::knowledge
