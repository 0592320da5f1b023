#include "manipulation/smooth_path.h"

#include <algorithm>

namespace hires::manipulation {
namespace {

using Eigen::VectorXd;

constexpr double kSamePoint = 1e-9;         // [rad] or [m]
constexpr double kSameDirection = 1e-9;     // difference of unit vectors
constexpr double kReversalCosine = -0.999;  // a turn by more than 177 degrees

std::vector<VectorXd> DistinctPoints(const std::vector<std::vector<double>>& points) {
  std::vector<VectorXd> distinct;
  for (const auto& point : points) {
    const VectorXd p = Eigen::Map<const VectorXd>(point.data(), point.size());
    if (distinct.empty() || (p - distinct.back()).norm() > kSamePoint) distinct.push_back(p);
  }
  return distinct;
}

PathPiece Line(const VectorXd& from, const VectorXd& to) {
  return {from, to - from, VectorXd::Zero(from.size())};
}

/// Lines grown point by point; the last one ends where the path is so far.
class Builder {
 public:
  Builder(const VectorXd& start, double max_deviation)
      : at_(start), max_deviation_(max_deviation) {}

  void PassCorner(const VectorXd& corner, const VectorXd& before, const VectorXd& after) {
    const VectorXd in = (corner - before).normalized(), out = (after - corner).normalized();
    const VectorXd turn = out - in;
    if (turn.norm() < kSameDirection) return;
    if (in.dot(out) < kReversalCosine) {
      LineTo(corner);
      pieces_.back().stops_at_end = true;
      return;
    }
    // The parabola stays within distance * turn / 4 of the corner; half of each side is its room.
    const double room = 0.5 * std::min((corner - before).norm(), (after - corner).norm());
    const double distance = std::min(room, 4.0 * max_deviation_ / turn.lpNorm<Eigen::Infinity>());
    LineTo(corner - distance * in);
    pieces_.push_back({at_, 2.0 * distance * in, distance * turn});
    at_ = corner + distance * out;
  }
  std::vector<PathPiece> FinishAt(const VectorXd& end) {
    LineTo(end);
    pieces_.back().stops_at_end = true;
    return std::move(pieces_);
  }

 private:
  void LineTo(const VectorXd& point) {
    if ((point - at_).norm() > kSamePoint) pieces_.push_back(Line(at_, point));
    at_ = point;
  }

  VectorXd at_;
  double max_deviation_;
  std::vector<PathPiece> pieces_;
};

}  // namespace

std::vector<PathPiece> SmoothPath(const std::vector<std::vector<double>>& points,
                                  double max_deviation) {
  const std::vector<VectorXd> distinct = DistinctPoints(points);
  if (distinct.size() < 2) return {};
  Builder builder(distinct.front(), max_deviation);
  for (std::size_t i = 1; i + 1 < distinct.size(); ++i) {
    builder.PassCorner(distinct[i], distinct[i - 1], distinct[i + 1]);
  }
  return builder.FinishAt(distinct.back());
}

}  // namespace hires::manipulation
