#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lab/src/recognition/recognition_experiment.h"

namespace hires::lab {

/// "1.2 / 3.4" of two lengths [m]; what is not a number is "-".
std::string MillimetresText(double median, double share_95);

/// How far off the boxes of things are that are called unknown: of those unlike all models, and of
/// kinds left out of the catalogue, each by how much of them is seen.
std::string BoxesText(const RecognitionReport& report);
nlohmann::ordered_json BoxesToJson(const RecognitionReport& report);  ///< [m]

}  // namespace hires::lab
