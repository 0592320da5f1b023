#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/src/statistics.h"

// Predicting how long an action takes on a robot from how long it takes when it is played, with
// numbers that are fitted on other routes only.
namespace hires::lab {

/// What is fitted, the rest being 0 s and 1.
enum class DurationModel {
  kConstant,   ///< nothing of what was played: always the mean of the rows that were fitted on
  kAsPlayed,   ///< nothing is fitted
  kStartTime,  ///< what comes before and after each motion
  kTimeScale,  ///< how much longer every second takes
  kStartAndScale,
};
const char* ToString(DurationModel model);
int NumFitted(DurationModel model);  ///< numbers that it fits

/// One row of a table: a mean that was played and one that was measured.
struct DurationRow {
  std::string route;     ///< rows of one route are left out together
  double played{0.0};    ///< [s]
  double measured{0.0};  ///< [s]
  double sigma{0.0};     ///< [s] of single measured runs
};
using DurationRows = std::vector<DurationRow>;

/// The measured duration of what was played: start_time + time_scale * played.
struct DurationFit {
  double start_time{0.0};  ///< [s] planning, preparing, noticing the arrival: the same everywhere
  double time_scale{1.0};  ///< measured seconds per played second of motion
  double noise{0.0};       ///< [s] of a single run: root mean square of the rows' sigmas

  double At(double played) const { return start_time + time_scale * played; }
};

/// Least squares. Rows that do not determine the numbers give numbers that are not finite.
DurationFit FitDurations(DurationModel model, const DurationRows& rows);

/// One way of predicting: who drove in the play, and what is fitted.
struct DurationPredictor {
  std::string planner;
  DurationModel model{DurationModel::kAsPlayed};
  DurationRows rows;
};

/// Predictions of rows of one route, by numbers fitted on all other routes.
struct DurationFold {
  std::string route;
  std::size_t predictor{0};  ///< index of the one that was chosen
  DurationFit fit;
};

/// All rows predicted, each from the other routes.
struct LeftOutPredictions {
  std::vector<double> predicted;  ///< [s] of each row
  std::vector<DurationFold> folds;
  double mean_error{0.0};     ///< [s] of absolute errors
  double largest_error{0.0};  ///< [s]
  Interval error;             ///< of the mean; routes count as independent, rows of one do not

  const DurationFold& FoldOf(const std::string& route) const;
};

/// Leaves out one route after the other. Of several predictors that one predicts a route which is
/// best at predicting each of the others from the rest of them; the first of equals. So the choice
/// knows nothing of the route either.
/// Where there are two routes, only kAsPlayed can be chosen: nothing is left to fit on.
/// @pre the predictors have the same routes, at least two.
/// @throws std::logic_error if broken.
LeftOutPredictions PredictLeftOut(const std::vector<DurationPredictor>& predictors);

}  // namespace hires::lab
