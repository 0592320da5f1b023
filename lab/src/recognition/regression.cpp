#include "lab/src/recognition/regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hires/base/error.h"

namespace hires::lab {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 100;
constexpr double kSettled = 1e-10;

void RequireCases(const MatrixXd& x) {
  if (x.rows() > 0) return;
  throw base::ConfigError("nothing to fit: wanted at least one case; play more tables");
}

/// Precision of the prior of each weight; the constant has none, but for a trifle.
VectorXd PriorOf(Eigen::Index size) {
  VectorXd prior = VectorXd::Constant(size, 1.0 / (kPriorSd * kPriorSd));
  prior[0] = 1e-4;
  return prior;
}

VectorXd ErrorsOf(const MatrixXd& curvature) {
  const MatrixXd covariance =
      curvature.ldlt().solve(MatrixXd::Identity(curvature.rows(), curvature.cols()));
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

/// log(1 + exp(z)), for any z.
double Softplus(double z) { return std::max(z, 0.0) + std::log1p(std::exp(-std::abs(z))); }

double Penalised(const MatrixXd& x, const VectorXd& y, const VectorXd& w, const VectorXd& prior) {
  return LogLikelihood(x * w, y) - 0.5 * w.cwiseAbs2().dot(prior);
}

}  // namespace

double LogLikelihood(const VectorXd& log_odds, const VectorXd& y) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < y.size(); ++i) sum += y[i] * log_odds[i] - Softplus(log_odds[i]);
  return sum;
}

FittedRegression FitLogistic(const MatrixXd& x, const VectorXd& y) {
  RequireCases(x);
  const VectorXd prior = PriorOf(x.cols());
  FittedRegression fit;
  fit.weight = VectorXd::Zero(x.cols());
  MatrixXd curvature;
  for (int step = 0; step < kMostSteps; ++step) {
    const ArrayXd share = 1.0 / (1.0 + (-(x * fit.weight)).array().exp());
    const VectorXd slope =
        x.transpose() * (y.array() - share).matrix() - prior.cwiseProduct(fit.weight);
    curvature = x.transpose() * (share * (1.0 - share)).matrix().asDiagonal() * x;
    curvature.diagonal() += prior;
    VectorXd change = curvature.ldlt().solve(slope);
    const double before = Penalised(x, y, fit.weight, prior);
    while (change.norm() > kSettled && Penalised(x, y, fit.weight + change, prior) < before)
      change *= 0.5;
    fit.weight += change;
    if (change.norm() <= kSettled) break;
  }
  fit.error = ErrorsOf(curvature);
  fit.log_likelihood = LogLikelihood(x * fit.weight, y);
  return fit;
}

FittedRegression FitLinear(const MatrixXd& x, const VectorXd& y) {
  RequireCases(x);
  const VectorXd prior = PriorOf(x.cols());
  FittedRegression fit;
  fit.spread = 1.0;
  // The prior counts against a spread that is itself unknown: two rounds settle it.
  for (int round = 0; round < 2; ++round) {
    MatrixXd curvature = x.transpose() * x / (fit.spread * fit.spread);
    curvature.diagonal() += prior;
    fit.weight = curvature.ldlt().solve(x.transpose() * y / (fit.spread * fit.spread));
    fit.error = ErrorsOf(curvature);
    const double rest = (y - x * fit.weight).squaredNorm();
    fit.spread =
        std::sqrt(rest / static_cast<double>(std::max<Eigen::Index>(1, y.size() - x.cols())));
    if (!(fit.spread > 0.0)) break;
  }
  return fit;
}

}  // namespace hires::lab
