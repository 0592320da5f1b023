#pragma once

#include <string>
#include <vector>

#include "hires/knowledge/experience.h"

namespace hires::evaluation {

constexpr double kExperiencePeriod = 0.05;  // [s] between two parts of one stretch

/// What one run went through while one action lasted: parts without a gap.
using Stretch = std::vector<knowledge::ToppleEpisodePart>;

struct ExperienceRun {
  std::string name;
  std::vector<std::string> actions;  ///< of each stretch
  std::vector<Stretch> stretches;
};

/// Runs in the order they were written.
std::vector<ExperienceRun> RunsOf(const knowledge::ExperienceStore& store,
                                  const knowledge::ExperienceQuery& query = {});

/// The first part of the stretch from `from` on in which the load topples: the onset of a fall. The
/// stretch's size if there is none.
std::size_t NextOnset(const Stretch& stretch, std::size_t from);

}  // namespace hires::evaluation
