#include "lab/src/recognition/detector_fit.h"

#include <algorithm>
#include <cmath>

#include "lab/src/recognition/fit_cases.h"
#include "lab/src/recognition/regression.h"
#include "hires/base/error.h"

namespace hires::lab {
namespace {

using Eigen::VectorXd;
using perception::DetectorErrors;
using perception::LengthRegression;
using perception::RecognitionScore;
using perception::Regression;
using perception::ThingVerdict;

constexpr double kShortest = 1e-6;  // [m] or [rad] of errors

using Look = const ThingVerdict&;

/// Two looks go wrong together more often than by chance: in a share r of looks the thing decides,
/// so that both go wrong with r^2 p + (1 - r^2) p^2.
/// @param is_in  of both looks.  @param is_wrong  likewise.
double RepeatsOf(const std::vector<TwoLooks>& things, const FittedRegression& fit,
                 const LookTest& is_in, const LookTest& is_wrong) {
  double both = 0.0, always = 0.0, by_chance = 0.0;
  for (const TwoLooks& thing : things) {
    if (!is_in(thing.first) || !is_in(thing.second)) continue;
    const double p = ShareOf(-fit.weight.dot(perception::RegressorsOf(thing.first.view)));
    both += is_wrong(thing.first) && is_wrong(thing.second) ? 1.0 : 0.0;
    always += p;
    by_chance += p * p;
  }
  if (always <= by_chance) return 0.0;
  return std::sqrt(std::clamp((both - by_chance) / (always - by_chance), 0.0, 1.0));
}

/// Two looks of which a share r^2 goes alike say as much as 2 / (1 + r^2) that have nothing to do
/// with each other.
Regression Weights(const FittedRegression& fit, double repeats) {
  Regression out;
  out.weight = fit.weight;
  out.error = fit.error * std::sqrt(1.0 + repeats * repeats);
  out.repeats = repeats;
  return out;
}

bool IsFound(Look look) { return look.is_found(); }
bool IsTurned(Look look) { return look.turned_by.has_value(); }

LengthRegression FitLength(const std::vector<TwoLooks>& things, const LookTest& is_in,
                           const std::function<double(Look)>& length) {
  const auto log_of = [&](Look look) { return std::log(std::max(length(look), kShortest)); };
  const FitCases cases = CasesOf(things, is_in, log_of);
  const FittedRegression fit = FitLinear(cases.x, cases.y);
  const auto rest_of = [&](Look look) {
    return log_of(look) - fit.weight.dot(perception::RegressorsOf(look.view));
  };
  double together = 0.0, num = 0.0;
  for (const TwoLooks& thing : things) {
    if (!is_in(thing.first) || !is_in(thing.second)) continue;
    together += rest_of(thing.first) * rest_of(thing.second);
    num += fit.spread * fit.spread;
  }
  const double repeats = num > 0.0 ? std::sqrt(std::clamp(together / num, 0.0, 1.0)) : 0.0;
  return {Weights(fit, repeats), fit.spread};
}

/// Errors that point the same way at both looks are repeated, whatever their lengths.
double RepeatsOfWays(const std::vector<TwoLooks>& things) {
  double cosines = 0.0, num = 0.0;
  for (const TwoLooks& thing : things) {
    if (!IsPlaced(thing.first) || !IsPlaced(thing.second)) continue;
    cosines += thing.first.offset.normalized().dot(thing.second.offset.normalized());
    num += 1.0;
  }
  return num > 0.0 ? std::sqrt(std::clamp(cosines / num, 0.0, 1.0)) : 0.0;
}

/// Angular central Gaussian, its axes known: likeliest by the fixed point of [Tyler 1987,
/// Biometrika 74:579-589].
Eigen::Vector3d DirectionOf(const std::vector<TwoLooks>& things) {
  constexpr int kRounds = 100;
  Eigen::Vector3d variance = Eigen::Vector3d::Constant(1.0 / 3.0);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const TwoLooks& thing : things) {
      for (const ThingVerdict* look : {&thing.first, &thing.second}) {
        if (!IsPlaced(*look)) continue;
        const Eigen::Vector3d squares = look->offset.normalized().cwiseAbs2();
        sum += squares / squares.cwiseQuotient(variance).sum();
      }
    }
    variance = (sum / sum.sum()).cwiseMax(1e-4);
  }
  return variance / variance.sum();
}

void NoteMistakes(const std::vector<TwoLooks>& things, const RecognitionScore& kinds,
                  DetectorErrors* errors) {
  double confidence = 0.0, doubt = 0.0;
  int num = 0;
  for (const TwoLooks& thing : things) {
    for (const ThingVerdict* look : {&thing.first, &thing.second}) {
      if (!look->is_found() || look->is_right()) continue;
      for (const std::string& label : kinds.LabelsLike(look->kind))
        ++errors->called[label][look->called];
      if (look->called == perception::kUnknownLabel) continue;
      confidence += look->confidence;
      doubt += look->doubt;
      ++num;
    }
  }
  if (num == 0) return;
  errors->confidence = confidence / num;
  errors->doubt = doubt / num;
}

}  // namespace

FitCases CasesOf(const std::vector<TwoLooks>& things, const LookTest& is_in,
                 const std::function<double(Look)>& value) {
  std::vector<const ThingVerdict*> looks;
  for (const TwoLooks& thing : things)
    for (const ThingVerdict* look : {&thing.first, &thing.second})
      if (is_in(*look)) looks.push_back(look);
  const auto num = static_cast<Eigen::Index>(looks.size());
  FitCases cases{Eigen::MatrixXd(num, perception::Regressors::RowsAtCompileTime), VectorXd(num)};
  for (Eigen::Index i = 0; i < num; ++i) {
    cases.x.row(i) = perception::RegressorsOf(looks[i]->view).transpose();
    cases.y[i] = value(*looks[i]);
  }
  return cases;
}

FitCases FoundCases(const std::vector<TwoLooks>& things) {
  return CasesOf(
      things, [](Look) { return true; }, [](Look look) { return look.is_found() ? 1.0 : 0.0; });
}

FitCases NamedCases(const std::vector<TwoLooks>& things) {
  return CasesOf(things, IsFound, [](Look look) { return look.is_right() ? 1.0 : 0.0; });
}

bool IsPlaced(Look look) { return look.is_right() && look.is_known() && look.error > 0.0; }

double ShareOf(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

DetectorErrors FitDetector(const std::vector<TwoLooks>& things, const RecognitionScore& kinds) {
  const auto is_placed = [](const TwoLooks& thing) { return IsPlaced(thing.first); };
  if (std::none_of(things.begin(), things.end(), is_placed)) {
    throw base::ConfigError("nothing was recognised rightly, of " + std::to_string(things.size()) +
                            " things; wanted some to fit errors to: play more tables, or look at "
                            "the recogniser's configuration");
  }
  DetectorErrors errors;
  const FitCases found = FoundCases(things), named = NamedCases(things);
  const FittedRegression finds = FitLogistic(found.x, found.y);
  const FittedRegression names = FitLogistic(named.x, named.y);
  errors.found = Weights(finds, RepeatsOf(
                                    things, finds, [](Look) { return true; },
                                    [](Look look) { return !look.is_found(); }));
  errors.named =
      Weights(names, RepeatsOf(things, names, IsFound, [](Look look) { return !look.is_right(); }));
  NoteMistakes(things, kinds, &errors);
  errors.position = FitLength(things, IsPlaced, [](Look look) { return look.error; });
  errors.position.log.repeats = RepeatsOfWays(things);
  errors.direction = DirectionOf(things);
  const auto turn_of = [](Look look) { return *look.turned_by; };
  const auto is_turned = [](const TwoLooks& thing) {
    return IsTurned(thing.first) || IsTurned(thing.second);
  };
  if (std::any_of(things.begin(), things.end(), is_turned))
    errors.turn = FitLength(things, IsTurned, turn_of);
  return errors;
}

}  // namespace hires::lab
