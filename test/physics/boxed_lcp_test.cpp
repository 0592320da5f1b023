#include "physics/boxed_lcp.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "hires/base/rng.h"

namespace hires::physics::boxed_lcp_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the conditions lack, at most, as a share of what rounding explains: of an x within its
/// bounds.
double Residual(const BoxedLcp& problem, const VectorXd& x) {
  const MatrixXd A = problem.JT.transpose() * problem.inverse_mass * problem.JT;
  const VectorXd w = A * x + problem.softness * x - problem.b;
  double most = 0.0;
  for (int i = 0; i < x.size(); ++i) {
    if (x[i] < problem.lower[i] || x[i] > problem.upper[i]) return kInfinity;
    if (x[i] > problem.lower[i]) most = std::max(most, w[i]);
    if (x[i] < problem.upper[i]) most = std::max(most, -w[i]);
  }
  const double terms = A.diagonal().maxCoeff() * x.cwiseAbs().maxCoeff();
  return most / (1e-9 * problem.b.cwiseAbs().maxCoeff() + 1e-12 * terms + 1e-300);
}

/// Whole numbers make ties, more unknowns than velocities leave softness alone to choose.
BoxedLcp DrawProblem(base::Rng* rng) {
  const int k = 1 + static_cast<int>(rng->Uniform(0.0, 12.0));
  const int n = 1 + static_cast<int>(rng->Uniform(0.0, 30.0));
  const bool is_whole = rng->Uniform(0.0, 1.0) < 0.5;
  const auto draw = [&] {
    const double value = rng->Uniform(-2.5, 2.5);
    return is_whole ? std::round(value) : value;
  };
  BoxedLcp problem;
  problem.softness = 1e-5;
  problem.JT.resize(k, n);
  problem.mass = MatrixXd::Zero(k, k);
  for (int i = 0; i < k; ++i) {
    problem.mass(i, i) = is_whole ? 1.0 : std::pow(10.0, rng->Uniform(-3.0, 1.0));
    for (int j = 0; j < n; ++j) problem.JT(i, j) = draw();
  }
  problem.inverse_mass = problem.mass.inverse();
  problem.b.resize(n);
  problem.lower.resize(n);
  problem.upper.resize(n);
  for (int i = 0; i < n; ++i) {
    problem.b[i] = draw();
    const double kind = rng->Uniform(0.0, 1.0);
    problem.upper[i] = kind < 0.4 ? kInfinity : kind < 0.5 ? 0.0 : std::abs(draw());
    problem.lower[i] = kind < 0.4 ? 0.0 : -problem.upper[i];
  }
  return problem;
}

TEST(BoxedLcpTest, OneUnknownBetweenAndAtItsBounds) {
  BoxedLcp problem;
  problem.softness = 1e-8;
  problem.JT = problem.mass = problem.inverse_mass = MatrixXd::Identity(1, 1);
  problem.lower = VectorXd::Constant(1, -2.0);
  problem.upper = VectorXd::Constant(1, 1.0);
  for (const auto& [b, expected] : {std::pair(0.5, 0.5), std::pair(3.0, 1.0), std::pair(-3.0, -2.0),
                                    std::pair(1.0, 1.0), std::pair(0.0, 0.0)}) {
    problem.b = VectorXd::Constant(1, b);
    for (const Place guess : {Place::kLower, Place::kBetween, Place::kUpper}) {
      std::vector<Place> places{guess};
      VectorXd x;
      ASSERT_TRUE(Solve(problem, &places, &x));
      EXPECT_NEAR(x[0], expected, 1e-7) << b;
    }
  }
}

TEST(BoxedLcpTest, TiesAndRedundantUnknownsAreSolved) {
  const base::Rng seed(11);
  for (int i = 0; i < 5000; ++i) {
    base::Rng rng = seed.Fork(i);
    const BoxedLcp problem = DrawProblem(&rng);
    std::vector<Place> places(problem.b.size(), Place::kBetween);
    VectorXd x;
    ASSERT_TRUE(Solve(problem, &places, &x)) << "problem " << i;
    EXPECT_LT(Residual(problem, x), 1.0) << "problem " << i;
  }
}

TEST(BoxedLcpTest, TheSolutionDoesNotDependOnTheGuess) {
  const base::Rng seed(12);
  for (int i = 0; i < 500; ++i) {
    base::Rng rng = seed.Fork(i);
    const BoxedLcp problem = DrawProblem(&rng);
    std::vector<Place> places(problem.b.size(), Place::kBetween);
    VectorXd x, other;
    ASSERT_TRUE(Solve(problem, &places, &x));
    places.assign(problem.b.size(), Place::kLower);
    ASSERT_TRUE(Solve(problem, &places, &other));
    EXPECT_LT((problem.JT * (x - other)).norm(), 1e-6) << "problem " << i;
  }
}

}  // namespace
}  // namespace hires::physics::boxed_lcp_test
