#include "physics/boxed_lcp.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hires::physics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rounds of block pivoting; one or two are the rule.
constexpr int kPivotRounds = 12;
/// Rounds of descent for each unknown; one or two are what the worst of problems take.
constexpr int kRoundsEach = 10;
/// Shares of the largest b_i and of the largest term of A x that count as rounding.
constexpr double kRoundingOfB = 1e-10, kRoundingOfX = 1e-13;

class Search {
 public:
  Search(const BoxedLcp& problem, std::vector<Place>* places, VectorXd* x)
      : is_(problem), places_(*places), x_(*x) {
    for (int i = 0; i < size(); ++i) {
      largest_ = std::max(largest_, is_.JT.col(i).dot(is_.inverse_mass * is_.JT.col(i)));
    }
    largest_ += is_.softness;
    largest_b_ = is_.b.cwiseAbs().maxCoeff();
    x_.resize(size());
  }

  bool Run() {
    if (!Pivot() && !Descend()) return false;
    x_ = x_.cwiseMax(is_.lower).cwiseMin(is_.upper);
    return true;
  }

 private:
  int size() const { return static_cast<int>(is_.b.size()); }

  /// All in a wrong place change it at once. True if that ends.
  bool Pivot() {
    for (int round = 0; round < kPivotRounds; ++round) {
      if (!SolveBetween()) return false;
      FindWrong();
      if (wrong_.empty()) return true;
      for (const int i : wrong_) places_[i] = RightPlace(i);
    }
    return false;
  }

  /// From an x within its bounds to lower and lower 0.5 x^T A x - b^T x, whose least is the
  /// solution: that ends always. Who comes to a bound first stays there; who is at a bound and
  /// should not be is let go, the worst first.
  bool Descend() {
    x_ = x_.cwiseMax(is_.lower).cwiseMin(is_.upper);
    for (int i = 0; i < size(); ++i) {
      places_[i] = x_[i] <= is_.lower[i]   ? Place::kLower
                   : x_[i] >= is_.upper[i] ? Place::kUpper
                                           : Place::kBetween;
    }
    for (int round = 0; round < kRoundsEach * size(); ++round) {
      const VectorXd from = x_;
      if (!SolveBetween()) return false;
      if (StopAtFirstBound(from)) continue;
      const int worst = WorstAtBound();
      if (worst < 0) return true;
      places_[worst] = Place::kBetween;
    }
    return true;  // what is left is rounding
  }

  /// True if x, on its way here, left its bounds; then it is where it did.
  bool StopAtFirstBound(const VectorXd& from) {
    double share = 1.0;
    int first = -1;
    for (const int i : between_) {
      if (x_[i] >= is_.lower[i] && x_[i] <= is_.upper[i]) continue;
      const double bound = x_[i] < is_.lower[i] ? is_.lower[i] : is_.upper[i];
      const double until = (bound - from[i]) / (x_[i] - from[i]);
      if (first >= 0 && until >= share) continue;
      share = until;
      first = i;
    }
    if (first < 0) return false;
    places_[first] = x_[first] < is_.lower[first] ? Place::kLower : Place::kUpper;
    x_ = from + share * (x_ - from);
    return true;
  }

  int WorstAtBound() const {
    int worst = -1;
    for (int i = 0; i < size(); ++i) {
      if (places_[i] == Place::kBetween || RightPlace(i) == places_[i]) continue;
      if (worst < 0 || std::abs(w_[i]) > std::abs(w_[worst])) worst = i;
    }
    return worst;
  }

  void UpdateW() {
    w_ = is_.JT.transpose() * (is_.inverse_mass * (is_.JT * x_)) + is_.softness * x_ - is_.b;
    slack_w_ = kRoundingOfB * largest_b_ + kRoundingOfX * largest_ * x_.cwiseAbs().maxCoeff();
    slack_x_ = slack_w_ / largest_;
  }

  /// x where all stay in their places, and w. Solves for the velocities u = M^-1 J^T x, which are
  /// fewer than the impulses x = (rest - J u) / softness.
  bool SolveBetween() {
    between_.clear();
    for (int i = 0; i < size(); ++i) {
      if (places_[i] == Place::kBetween) between_.push_back(i);
      x_[i] = places_[i] == Place::kUpper ? is_.upper[i] : is_.lower[i];
      if (places_[i] == Place::kBetween) x_[i] = 0.0;
    }
    UpdateW();
    const int num_between = static_cast<int>(between_.size());
    if (num_between == 0) return true;
    JT_.resize(is_.JT.rows(), num_between);
    for (int k = 0; k < num_between; ++k) JT_.col(k) = is_.JT.col(between_[k]);
    MatrixXd H = is_.softness * is_.mass;
    H.selfadjointView<Eigen::Lower>().rankUpdate(JT_);
    const Eigen::LLT<Eigen::Ref<MatrixXd>> factors(H);
    if (factors.info() != Eigen::Success) return false;
    VectorXd missing(num_between);
    for (int repeat = 0; repeat < 2; ++repeat) {  // the second time for what rounding left
      for (int k = 0; k < num_between; ++k) missing[k] = -w_[between_[k]];
      missing -= JT_.transpose() * factors.solve(JT_ * missing);
      for (int k = 0; k < num_between; ++k) x_[between_[k]] += missing[k] / is_.softness;
      UpdateW();
    }
    return true;
  }

  void FindWrong() {
    wrong_.clear();
    for (int i = 0; i < size(); ++i) {
      if (RightPlace(i) != places_[i]) wrong_.push_back(i);
    }
  }

  Place RightPlace(int i) const {
    const bool is_fixed = is_.lower[i] == is_.upper[i];
    switch (places_[i]) {
      case Place::kBetween:
        if (is_fixed || x_[i] < is_.lower[i] - slack_x_) return Place::kLower;
        return x_[i] > is_.upper[i] + slack_x_ ? Place::kUpper : Place::kBetween;
      case Place::kLower:
        return is_fixed || w_[i] >= -slack_w_ ? Place::kLower : Place::kBetween;
      default:
        return is_fixed || w_[i] <= slack_w_ ? Place::kUpper : Place::kBetween;
    }
  }

  const BoxedLcp& is_;
  std::vector<Place>& places_;
  VectorXd& x_;
  VectorXd w_;
  double largest_{0.0}, largest_b_;  // of A, and of b
  double slack_w_, slack_x_;
  MatrixXd JT_;  // of what lies between its bounds
  std::vector<int> between_, wrong_;
};

}  // namespace

bool Solve(const BoxedLcp& problem, std::vector<Place>* places, VectorXd* x) {
  return Search(problem, places, x).Run();
}

}  // namespace hires::physics
