#pragma once

#include <functional>
#include <vector>

#include "lab/src/recognition/detector_fit.h"

namespace hires::lab {

using LookTest = std::function<bool(const perception::ThingVerdict&)>;

/// Regressors of some looks, a row for each, and what is asked of them.
struct FitCases {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
};

FitCases CasesOf(const std::vector<TwoLooks>& things, const LookTest& is_in,
                 const std::function<double(const perception::ThingVerdict&)>& value);

FitCases FoundCases(const std::vector<TwoLooks>& things);  ///< 1: was found
FitCases NamedCases(const std::vector<TwoLooks>& things);  ///< of what was found; 1: called rightly

/// Whether its pose can be judged.
bool IsPlaced(const perception::ThingVerdict& look);

double ShareOf(double log_odds);  ///< 0 .. 1

}  // namespace hires::lab
