#include "hires/localisation/outline_match.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/segment.h"

namespace hires::localisation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Pose2;

constexpr int kMostSteps = 30;
constexpr double kSettled = 1e-4;  // [m], [rad] a step that is smaller changes nothing
constexpr double kMostSds = 4.0;   // of the prior, by which a result may differ from it

double TwiceArea(const geometry::Polygon& outline) {
  double area = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

Vector3d Difference(const Pose2& a, const Pose2& b) {
  return {a.x - b.x, a.y - b.y, geometry::WrapToPi(a.yaw - b.yaw)};
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
      const Vector2d along = to - from;
      if (along.norm() < 1e-6) continue;
      faces_.push_back({from, to, sense * Vector2d(along.y(), -along.x()).normalized()});
    }
  }
}

std::vector<OutlineMatch::Face> OutlineMatch::FacesNear(const Vector2d& place_M) const {
  std::vector<Face> near;
  const double far = params_.reach + 2.0 * params_.gate;
  for (const Face& face : faces_) {
    if ((geometry::NearestOnSegment(place_M, face.from, face.to) - place_M).norm() <= far)
      near.push_back(face);
  }
  return near;
}

/// A face that looks away from the laser was not met, however near it is: legs of tables are thin.
std::optional<OutlineMatch::Meeting> OutlineMatch::Meet(const std::vector<Face>& faces,
                                                        const Vector2d& echo_M,
                                                        const Vector2d& laser_M) const {
  double nearest = params_.gate;
  std::optional<Meeting> met;
  for (const Face& face : faces) {
    if (face.normal.dot(laser_M - face.from) <= 0.0) continue;
    const Vector2d off = echo_M - geometry::NearestOnSegment(echo_M, face.from, face.to);
    const double distance = off.norm();
    if (distance > nearest) continue;
    nearest = distance;
    // On a face: along its normal, whichever side, so that a belief that is right stays.
    const double ahead = face.normal.dot(echo_M - face.from);
    const bool is_beside = distance > std::abs(ahead) + 1e-9;
    met = is_beside ? Meeting{off / distance, distance} : Meeting{face.normal, ahead};
  }
  return met;
}

std::optional<PlaceBelief> OutlineMatch::Correct(const PlaceBelief& prior,
                                                 const std::vector<Vector2d>& echoes_B,
                                                 const Vector2d& laser_B, double increment) const {
  const std::vector<Face> faces = FacesNear(prior.X_MB.position());
  const double weight =
      std::min(1.0, increment / params_.independent) / (params_.noise * params_.noise);
  const Matrix3d prior_information = prior.covariance.inverse();
  Pose2 X_MB = prior.X_MB;
  Vector3d step_before = Vector3d::Zero();
  double damping = 1.0;
  for (int i = 0; i < kMostSteps; ++i) {
    Matrix3d information = prior_information;
    Vector3d gradient = prior_information * Difference(prior.X_MB, X_MB);
    double view = 0.0;
    const Vector2d laser_M = X_MB * laser_B;
    for (const Vector2d& echo_B : echoes_B) {
      if (echo_B.norm() > params_.reach) continue;
      const Vector2d echo_M = X_MB * echo_B;
      const auto met = Meet(faces, echo_M, laser_M);
      if (!met) continue;
      view += increment;
      const Vector2d arm = echo_M - X_MB.position();
      const Vector3d J(met->direction.x(), met->direction.y(),
                       met->direction.y() * arm.x() - met->direction.x() * arm.y());
      information += weight * J * J.transpose();
      gradient -= weight * met->distance * J;
    }
    if (view < params_.least_view) return std::nullopt;
    Vector3d step = information.ldlt().solve(gradient);
    // Between two outlines echoes may change sides for good: half of the way each time ends that.
    if (step.dot(step_before) < 0.0) damping *= 0.5;
    step_before = step;
    step *= damping;
    X_MB = {X_MB.x + step.x(), X_MB.y + step.y(), geometry::WrapToPi(X_MB.yaw + step.z())};
    if (step.cwiseAbs().maxCoeff() > kSettled * damping) continue;
    const Vector3d off = Difference(X_MB, prior.X_MB);
    if (off.dot(prior_information * off) > kMostSds * kMostSds) return std::nullopt;
    return PlaceBelief{X_MB, information.inverse()};
  }
  return std::nullopt;
}

}  // namespace hires::localisation
