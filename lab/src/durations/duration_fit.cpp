#include "lab/src/durations/duration_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/check.h"

namespace hires::lab {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double MeanOf(const DurationRows& rows, double DurationRow::*member) {
  double sum = 0.0;
  for (const DurationRow& row : rows) sum += row.*member;
  return rows.empty() ? kNone : sum / static_cast<double>(rows.size());
}

double NoiseOf(const DurationRows& rows) {
  double squares = 0.0;
  for (const DurationRow& row : rows) squares += row.sigma * row.sigma;
  return rows.empty() ? kNone : std::sqrt(squares / static_cast<double>(rows.size()));
}

/// Slope of the regression through the point (played, measured).
double Slope(const DurationRows& rows, double played, double measured) {
  double both = 0.0, squares = 0.0;
  for (const DurationRow& row : rows) {
    both += (row.played - played) * (row.measured - measured);
    squares += (row.played - played) * (row.played - played);
  }
  return both / squares;
}

std::vector<std::string> RoutesOf(const DurationRows& rows) {
  std::vector<std::string> routes;
  for (const DurationRow& row : rows) {
    if (std::find(routes.begin(), routes.end(), row.route) == routes.end()) {
      routes.push_back(row.route);
    }
  }
  return routes;
}

DurationRows OtherRoutes(const DurationRows& rows, const std::string& route) {
  DurationRows others;
  for (const DurationRow& row : rows) {
    if (row.route != route) others.push_back(row);
  }
  return others;
}

/// Mean absolute error of the rows, each route predicted from the others.
double ErrorLeftOut(DurationModel model, const DurationRows& rows) {
  std::vector<double> errors;
  for (const DurationRow& row : rows) {
    const DurationFit fit = FitDurations(model, OtherRoutes(rows, row.route));
    errors.push_back(std::abs(fit.At(row.played) - row.measured));
  }
  return base::Mean(errors);
}

std::size_t BestWithout(const std::vector<DurationPredictor>& predictors,
                        const std::string& route) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; predictors.size() > 1 && p < predictors.size(); ++p) {
    const double error = ErrorLeftOut(predictors[p].model, OtherRoutes(predictors[p].rows, route));
    if (!(error < least)) continue;
    least = error;
    best = p;
  }
  return best;
}

DurationFold FoldWithout(const std::vector<DurationPredictor>& predictors,
                         const std::string& route) {
  DurationFold fold{route, BestWithout(predictors, route), {}};
  const DurationPredictor& chosen = predictors[fold.predictor];
  fold.fit = FitDurations(chosen.model, OtherRoutes(chosen.rows, route));
  return fold;
}

void SumUpErrors(const DurationRows& rows, LeftOutPredictions* out) {
  std::vector<double> all, by_route;
  for (const DurationFold& fold : out->folds) {
    std::vector<double> errors;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (rows[r].route != fold.route) continue;
      errors.push_back(std::abs(out->predicted[r] - rows[r].measured));
    }
    by_route.push_back(base::Mean(errors));
    all.insert(all.end(), errors.begin(), errors.end());
  }
  out->mean_error = base::Mean(all);
  out->largest_error =
      std::isnan(out->mean_error) ? kNone : *std::max_element(all.begin(), all.end());
  out->error = MeanInterval(by_route);
}

}  // namespace

const char* ToString(DurationModel model) {
  switch (model) {
    case DurationModel::kConstant:
      return "mean of the others";
    case DurationModel::kAsPlayed:
      return "as played";
    case DurationModel::kStartTime:
      return "start time";
    case DurationModel::kTimeScale:
      return "time scale";
    case DurationModel::kStartAndScale:
      return "start time, time scale";
  }
  return "";
}

int NumFitted(DurationModel model) {
  if (model == DurationModel::kAsPlayed) return 0;
  return model == DurationModel::kStartAndScale ? 2 : 1;
}

DurationFit FitDurations(DurationModel model, const DurationRows& rows) {
  const double played = MeanOf(rows, &DurationRow::played);
  const double measured = MeanOf(rows, &DurationRow::measured);
  DurationFit fit;
  fit.noise = NoiseOf(rows);
  if (model == DurationModel::kConstant) fit.time_scale = 0.0;
  if (model == DurationModel::kTimeScale) fit.time_scale = Slope(rows, 0.0, 0.0);
  if (model == DurationModel::kStartAndScale) fit.time_scale = Slope(rows, played, measured);
  const bool starts = model != DurationModel::kAsPlayed && model != DurationModel::kTimeScale;
  if (starts) fit.start_time = measured - fit.time_scale * played;
  return fit;
}

const DurationFold& LeftOutPredictions::FoldOf(const std::string& route) const {
  const auto found = std::find_if(folds.begin(), folds.end(),
                                  [&](const DurationFold& fold) { return fold.route == route; });
  HIRES_CHECK(found != folds.end(), "no row has this route");
  return *found;
}

LeftOutPredictions PredictLeftOut(const std::vector<DurationPredictor>& predictors) {
  HIRES_CHECK(!predictors.empty(), "somebody has to predict");
  const DurationRows& rows = predictors.front().rows;
  const std::vector<std::string> routes = RoutesOf(rows);
  HIRES_CHECK(routes.size() > 1, "too few routes to leave one out");
  LeftOutPredictions out;
  for (const std::string& route : routes) out.folds.push_back(FoldWithout(predictors, route));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const DurationFold& fold = out.FoldOf(rows[r].route);
    out.predicted.push_back(fold.fit.At(predictors[fold.predictor].rows[r].played));
  }
  SumUpErrors(rows, &out);
  return out;
}

}  // namespace hires::lab
