#pragma once

#include <string>
#include <vector>

#include "hires/knowledge/experience.h"

namespace hires::evaluation {

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

/// The parts in which a fall begins: the load topples, and did not in the part before.
std::vector<std::size_t> OnsetsOf(const Stretch& stretch);

}  // namespace hires::evaluation
