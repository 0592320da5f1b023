#pragma once

#include <string>
#include <vector>

#include "hires/knowledge/experience.h"

namespace hires::lab {

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

/// The last argument of an action: "fast" of "move_base_param(NT1, fast)"; one without arguments as
/// it is.
std::string MotionSetOf(const std::string& action);

/// By run the motion sets that it has, as one text: what kind of run it is, for resampling.
std::vector<std::string> MotionSetsOf(const std::vector<ExperienceRun>& runs);

/// The parts in which a fall begins: the load topples, and did not in the part before.
std::vector<std::size_t> OnsetsOf(const Stretch& stretch);

}  // namespace hires::lab
