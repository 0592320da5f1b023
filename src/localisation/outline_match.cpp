#include "hires/localisation/outline_match.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/covariance.h"
#include "hires/geometry/pose_difference.h"

namespace hires::localisation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Pose2;

constexpr int kMostSteps = 30;
constexpr int kMostSearches = 10;  // then echoes stay with the faces that they were matched with,
                                   // and steps that turn back are halved: between two outlines, and
                                   // at the end of one, a search may go to and fro for good
constexpr double kSettled = 1e-4;  // [m], [rad] a step that is smaller changes nothing
constexpr double kMostSds = 4.0;   // between belief and scan
constexpr double kLeastShare = 0.05;  // of the variance along an axis that a scan must take away
                                      // before it can contradict along that

double TwiceArea(const geometry::Polygon& outline) {
  double area = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

/// By how much belief and scan differ [sd^2]: the innovation of the filter, told from the shift
/// that it brought about, whose covariance is what the scan took away. Axis by axis of that, in
/// units of the prior, since along some the scan says nothing.
double InnovationSquared(const Matrix3d& prior, const Matrix3d& posterior, const Vector3d& shift) {
  const Eigen::LLT<Matrix3d> root(prior);
  const Matrix3d left = root.matrixL().solve(posterior);
  const Matrix3d kept = root.matrixL().solve(left.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(Matrix3d::Identity() - kept);
  const Vector3d along = axes.eigenvectors().transpose() * root.matrixL().solve(shift);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double share = axes.eigenvalues()[i];
    if (share > kLeastShare) sum += along[i] * along[i] / share;
  }
  return sum;
}

}  // namespace

OutlineMatch::OutlineMatch(const std::vector<geometry::Polygon>& outlines_M,
                           const OutlineMatchParams& params)
    : params_(params) {
  HIRES_CHECK(params.reach > 0.0 && params.gate > 0.0 && params.noise > 0.0 &&
                  params.independent > 0.0 && params.least_view >= 0.0,
              "a match of outlines has a reach, a gate and a noise");
  for (const geometry::Polygon& outline : outlines_M) {
    const double sense = TwiceArea(outline) < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2d &from = outline[i], &to = outline[(i + 1) % outline.size()];
      const double length = (to - from).norm();
      if (length < 1e-6) continue;
      const Vector2d along = (to - from) / length;
      faces_.push_back({from, along, length, sense * Vector2d(along.y(), -along.x())});
    }
  }
}

OutlineMatch::Meeting OutlineMatch::Meet(const Face& face, const Vector2d& echo_M) {
  const Vector2d off = echo_M - face.from;
  const double at = face.along.dot(off), ahead = face.normal.dot(off);
  // On a face: along its normal, whichever side, so that a belief that is right stays.
  const Vector2d from_end = off - (at < 0.0 ? 0.0 : face.length) * face.along;
  const double distance = from_end.norm();
  if ((at >= 0.0 && at <= face.length) || distance == 0.0) return {face.normal, ahead};
  return {from_end / distance, distance};
}

/// Written so that what is no number is none.
bool OutlineMatch::IsNarrow(const PlaceBelief& prior) const {
  const Matrix3d& C = prior.covariance;
  const double place = geometry::LargestSd(C(0, 0), C(0, 1), C(1, 1));
  const double turn = std::sqrt(C(2, 2)) * 0.5 * params_.reach;
  return std::hypot(place, turn) <= 0.5 * params_.gate;
}

std::vector<OutlineMatch::Face> OutlineMatch::FacesNear(const Vector2d& place_M) const {
  std::vector<Face> near;
  const double far = params_.reach + 2.0 * params_.gate;
  for (const Face& face : faces_) {
    if (std::abs(Meet(face, place_M).distance) <= far) near.push_back(face);
  }
  return near;
}

/// A face that looks away from the laser was not met, however near it is: legs of tables are thin.
std::vector<const OutlineMatch::Face*> OutlineMatch::Match(const std::vector<Face>& faces,
                                                           const Pose2& X_MB,
                                                           const std::vector<Vector2d>& echoes_B,
                                                           const Vector2d& laser_B) const {
  const Vector2d laser_M = X_MB * laser_B;
  std::vector<const Face*> visible;
  for (const Face& face : faces) {
    if (face.normal.dot(laser_M - face.from) > 0.0) visible.push_back(&face);
  }
  std::vector<const Face*> met;
  for (const Vector2d& echo_B : echoes_B) {
    const Vector2d echo_M = X_MB * echo_B;
    const Face* nearest = nullptr;
    double least = params_.gate;
    for (const Face* face : visible) {
      if (std::abs(face->normal.dot(echo_M - face->from)) > least) continue;
      const double distance = std::abs(Meet(*face, echo_M).distance);
      if (distance > least) continue;
      least = distance;
      nearest = face;
    }
    met.push_back(nearest);
  }
  return met;
}

Correction OutlineMatch::Correct(const PlaceBelief& prior, const std::vector<Vector2d>& echoes_B,
                                 const Vector2d& laser_B, double increment) const {
  using Verdict = Correction::Verdict;
  if (!IsNarrow(prior)) return {Verdict::kSilent, prior};
  std::vector<Vector2d> near_B;
  for (const Vector2d& echo_B : echoes_B) {
    if (echo_B.norm() <= params_.reach) near_B.push_back(echo_B);
  }
  const std::vector<Face> faces = FacesNear(prior.X_MB.position());
  const double weight =
      std::min(1.0, increment / params_.independent) / (params_.noise * params_.noise);
  const Matrix3d prior_information = prior.covariance.inverse();
  Pose2 X_MB = prior.X_MB;
  std::vector<const Face*> met;
  Vector3d step_before = Vector3d::Zero();
  double damping = 1.0;
  for (int i = 0; i < kMostSteps; ++i) {
    if (i < kMostSearches) met = Match(faces, X_MB, near_B, laser_B);
    Matrix3d information = prior_information;
    Vector3d gradient = prior_information * Difference(prior.X_MB, X_MB);
    double view = 0.0;
    for (std::size_t k = 0; k < near_B.size(); ++k) {
      if (met[k] == nullptr) continue;
      view += increment;
      const Vector2d echo_M = X_MB * near_B[k], arm = echo_M - X_MB.position();
      const auto [direction, distance] = Meet(*met[k], echo_M);
      const Vector3d J(direction.x(), direction.y(),
                       direction.y() * arm.x() - direction.x() * arm.y());
      information += weight * J * J.transpose();
      gradient -= weight * distance * J;
    }
    if (view < params_.least_view) return {Verdict::kSilent, prior};
    Vector3d step = information.ldlt().solve(gradient);
    if (i >= kMostSearches && step.dot(step_before) < 0.0) damping *= 0.5;
    step_before = step;
    step *= damping;
    X_MB = {X_MB.x + step.x(), X_MB.y + step.y(), geometry::WrapToPi(X_MB.yaw + step.z())};
    if (!(step.cwiseAbs().maxCoeff() <= kSettled)) continue;
    const PlaceBelief corrected{X_MB, information.inverse()};
    const double innovation =
        InnovationSquared(prior.covariance, corrected.covariance, Difference(X_MB, prior.X_MB));
    if (!(innovation <= kMostSds * kMostSds)) return {Verdict::kContradicts, prior};
    return {Verdict::kCorrected, corrected};
  }
  return {Verdict::kSilent, prior};
}

}  // namespace hires::localisation
