#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hires/imagination/report.h"
#include "hires/imagination/rollout_recording.h"

namespace hires::python {

/// A report, and the criteria that it was made by.
struct Answer {
  imagination::Report report;
  imagination::Criteria criteria;
};

/// As `hires imagine --json` writes it.
std::string JsonOf(const Answer& answer);

/// How often each failure came, by its words.
std::map<std::string, int> FailuresOf(const imagination::Prediction& prediction);

/// "move_base_param(atbench, slow): 100.0 % of 64 (92 .. 100 %), 15.0 s"
std::string TextOf(const imagination::Prediction& prediction);

std::vector<std::pair<double, std::string>> EventsOf(
    const imagination::RolloutRecording& recording);
std::string FailureTextOf(const imagination::RolloutRecording& recording);

}  // namespace hires::python
