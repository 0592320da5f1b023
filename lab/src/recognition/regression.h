#pragma once

#include <Eigen/Core>

namespace hires::lab {

struct FittedRegression {
  Eigen::VectorXd weight{};
  Eigen::VectorXd error{};     ///< standard errors, from the curvature at the best weights
  double spread{0.0};          ///< sd of what is left; linear ones alone
  double log_likelihood{0.0};  ///< logistic ones alone, without the prior
};

/// By how much weights other than the first are held back: a normal prior of this sd, so that what
/// the data leave open stays finite.
inline constexpr double kPriorSd = 3.0;

/// The weights w that make y likeliest where log odds are x w, by Newton's method.
/// @param x  a row for each case, the first column 1.  @param y  0 or 1.
/// @throws base::ConfigError without cases.
FittedRegression FitLogistic(const Eigen::MatrixXd& x, const Eigen::VectorXd& y);

/// The same where y is normal about x w, by least squares.
FittedRegression FitLinear(const Eigen::MatrixXd& x, const Eigen::VectorXd& y);

/// Of y, each with its log odds.
double LogLikelihood(const Eigen::VectorXd& log_odds, const Eigen::VectorXd& y);

}  // namespace hires::lab
