#include "lab/src/place/pose_error_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/imagination/evidence.h"

namespace hires::lab {
namespace {

using geometry::Pose2;

constexpr int kFewestCorrections = 100;
constexpr double kSame = 1e-9;     // [m], [rad] by which a map's odometry may move uncorrected
constexpr double kLeastWay = 0.5;  // [m] of a drive that tells how its ways are stretched

Eigen::Vector3d VectorOf(const Pose2& X) { return {X.x, X.y, geometry::WrapToPi(X.yaw)}; }

bool IsCorrectedBetween(const PlaceMoment& before, const PlaceMoment& now) {
  return VectorOf(before.X_MO().Inverse() * now.X_MO()).cwiseAbs().maxCoeff() > kSame;
}

/// The error that the second moment would have, had the laser not corrected.
Pose2 Uncorrected(const PlaceMoment& before, const PlaceMoment& now) {
  return now.X_MB.Inverse() * before.X_MO() * now.X_OB;
}

/// An error right before a correction, and right after it.
struct Correction {
  Eigen::Vector3d before, after;
};

std::vector<Correction> CorrectionsOf(const std::vector<PlaceTrail>& trails) {
  std::vector<Correction> corrections;
  for (const PlaceTrail& trail : trails) {
    for (std::size_t i = 1; i < trail.size(); ++i) {
      if (!IsCorrectedBetween(trail[i - 1], trail[i])) continue;
      corrections.push_back(
          {VectorOf(Uncorrected(trail[i - 1], trail[i])), VectorOf(trail[i].error())});
    }
  }
  return corrections;
}

/// Of the second half of each drive: how it began is told no more.
Eigen::Matrix3d CovarianceLater(const std::vector<PlaceTrail>& trails) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (const PlaceTrail& trail : trails) {
    for (std::size_t i = trail.size() / 2; i < trail.size(); ++i, ++n) {
      const Eigen::Vector3d error = VectorOf(trail[i].error());
      sum += error * error.transpose();
    }
  }
  return sum / std::max(n, 1.0);
}

/// Odometry against truth, from one moment to the next.
struct Drift {
  double squares{0.0};  // of stretches, each of one drive
  int num_drives{0};
  double walk{0.0}, walk_yaw{0.0};  // squares of what is left
  double way{0.0};                  // [m]
};

void AddDrift(const PlaceTrail& trail, Drift* drift) {
  double along = 0.0, square = 0.0, way = 0.0;
  const auto pieces = [&](const auto& visit) {
    for (std::size_t i = 1; i < trail.size(); ++i) {
      visit(trail[i - 1].X_MB.Inverse() * trail[i].X_MB,
            trail[i - 1].X_OB.Inverse() * trail[i].X_OB);
    }
  };
  pieces([&](const Pose2& moved, const Pose2& told) {
    along += moved.position().dot(told.position());
    square += moved.position().squaredNorm();
    way += moved.position().norm();
  });
  if (way < kLeastWay) return;
  const double stretch = along / square - 1.0;
  drift->squares += stretch * stretch;
  ++drift->num_drives;
  drift->way += way;
  pieces([&](const Pose2& moved, const Pose2& told) {
    drift->walk += (told.position() - (1.0 + stretch) * moved.position()).squaredNorm() / 2.0;
    const double turned = geometry::WrapToPi(told.yaw - moved.yaw);
    drift->walk_yaw += turned * turned;
  });
}

/// Sums for a correlation of errors that are a way apart.
struct Alike {
  double product{0.0}, first{0.0}, second{0.0};
  double value() const {
    const double norm = std::sqrt(first * second);
    return norm > 0.0 ? product / norm : NAN;
  }
};

/// Positions' errors in the map, at places of a trail that are `apart` [m] of way apart.
void AddAlike(const PlaceTrail& trail, double apart, Alike* alike) {
  std::vector<double> ways{0.0};
  for (std::size_t i = 1; i < trail.size(); ++i)
    ways.push_back(ways.back() + (trail[i].X_MB.position() - trail[i - 1].X_MB.position()).norm());
  std::size_t j = 0;
  for (std::size_t i = 0; i < trail.size(); ++i) {
    while (j < trail.size() && ways[j] < ways[i] + apart) ++j;
    if (j == trail.size()) return;
    const Eigen::Vector2d a = trail[i].off(), b = trail[j].off();
    alike->product += a.dot(b);
    alike->first += a.squaredNorm();
    alike->second += b.squaredNorm();
  }
}

}  // namespace

int NumCorrections(const std::vector<PlaceTrail>& trails) {
  return static_cast<int>(CorrectionsOf(trails).size());
}

simulation::PoseErrorParams FitPoseError(const std::vector<PlaceTrail>& trails,
                                         double update_distance, double update_turn) {
  const std::vector<Correction> corrections = CorrectionsOf(trails);
  const auto n = static_cast<Eigen::Index>(corrections.size());
  if (n < kFewestCorrections) {
    throw base::ConfigError("the drives hold " + std::to_string(n) + " corrections, wanted " +
                            std::to_string(kFewestCorrections) + " or more; drive longer");
  }
  Eigen::MatrixX3d before(n, 3), after(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    before.row(i) = corrections[static_cast<std::size_t>(i)].before;
    after.row(i) = corrections[static_cast<std::size_t>(i)].after;
  }
  simulation::PoseErrorParams params;
  params.update_distance = update_distance;
  params.update_turn = update_turn;
  params.kept = before.colPivHouseholderQr().solve(after).transpose();
  if (params.kept.eigenvalues().cwiseAbs().maxCoeff() >= 1.0)
    throw base::ConfigError("the errors of the drives do not fade: the robot gets lost on them");
  const Eigen::MatrixX3d left = after - before * params.kept.transpose();
  params.added = left.transpose() * left / static_cast<double>(n - 3);
  params.start = CovarianceLater(trails);
  Drift drift;
  for (const PlaceTrail& trail : trails) AddDrift(trail, &drift);
  params.stretch = std::sqrt(drift.squares / std::max(drift.num_drives, 1));
  params.walk = std::sqrt(drift.walk / std::max(drift.way, kLeastWay));
  params.walk_yaw = std::sqrt(drift.walk_yaw / std::max(drift.way, kLeastWay));
  return params;
}

std::vector<PlaceTrail> PlayPoseError(const simulation::PoseErrorParams& params,
                                      const std::vector<PlaceTrail>& trails, const base::Rng& rng) {
  std::vector<PlaceTrail> played;
  for (std::size_t k = 0; k < trails.size(); ++k) {
    PlaceTrail& trail = played.emplace_back();
    std::optional<simulation::PoseErrorWalk> walk;
    for (const PlaceMoment& moment : trails[k]) {
      if (!walk) walk.emplace(params, moment.X_MB, moment.error(), rng.Fork(k));
      walk->Drive(moment.X_MB);
      trail.push_back({moment.X_MB, walk->X_MBelieved(), walk->X_OB(), false});
    }
  }
  return played;
}

PoseErrorFigures FiguresOf(const std::vector<PlaceTrail>& trails) {
  std::vector<double> distances;
  double squares = 0.0, squares_yaw = 0.0;
  Alike after_1m, after_4m;
  for (const PlaceTrail& trail : trails) {
    for (const PlaceMoment& moment : trail) {
      const Pose2 error = moment.error();
      distances.push_back(error.position().norm());
      squares += error.position().squaredNorm();
      squares_yaw += std::pow(geometry::WrapToPi(error.yaw), 2.0);
    }
    AddAlike(trail, 1.0, &after_1m);
    AddAlike(trail, 4.0, &after_4m);
  }
  std::sort(distances.begin(), distances.end());
  const auto n = static_cast<double>(distances.size());
  double jumps = 0.0;
  const std::vector<Correction> corrections = CorrectionsOf(trails);
  for (const Correction& one : corrections)
    jumps += (one.after - one.before).head<2>().squaredNorm();
  return {imagination::Quantile(distances, 50),
          imagination::Quantile(distances, 95),
          distances.back(),
          std::sqrt(squares / n),
          std::sqrt(squares_yaw / n),
          std::sqrt(jumps / std::max<double>(1.0, static_cast<double>(corrections.size()))),
          after_1m.value(),
          after_4m.value()};
}

}  // namespace hires::lab
