#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/src/experiment/hypothesis.h"

namespace hires::lab {

/// One run of a series, in a process of its own through a graph of nodes: parses its arguments
/// itself.  @return exit code.
using PlayInGraph = std::function<int(const std::vector<std::string>& arguments)>;

/// What the program can do where there is ROS; all may be empty.
struct LabBackends {
  std::string package_folder;  ///< where config/, worlds/, urdf/ and lab/ lie
  PlayHypothesis play_hypothesis;
  PlayInGraph hypothesis_run, scenario_run;
};

/// The program `hires_lab`: what judges the product. Parses, runs one verb, prints. Never throws.
/// @param arguments  the program's name first, as in argv.
int RunLabCommandLine(const std::vector<std::string>& arguments, const LabBackends& backends);

}  // namespace hires::lab
