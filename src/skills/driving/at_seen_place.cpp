#include "skills/driving/at_seen_place.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/geometry/pose_difference.h"
#include "hires/robot/echoes.h"

namespace hires::skills {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Pose2;
using localisation::PlaceBelief;

constexpr double kMostSds = 4.0;   // between told and seen place
constexpr double kPatience = 1.0;  // [s] with what contradicts: a filter may jump, and jump back

/// The belief of a robot that moved, by an odometry that errs not.
PlaceBelief Moved(const PlaceBelief& belief, const Pose2& X_BNow) {
  const Pose2 X_MNow = belief.X_MB * X_BNow;
  const Vector2d way = X_MNow.position() - belief.X_MB.position();
  Matrix3d F = Matrix3d::Identity();
  F(0, 2) = -way.y();
  F(1, 2) = way.x();
  return {X_MNow, F * belief.covariance * F.transpose()};
}

/// Filters tend to be surer than they are right: below told_sd nobody is believed.
PlaceBelief ToldPlace(const robot::Observation& observation, const SeenPlaceParams& params) {
  const double told = observation.position_sd;
  const double sd = told <= params.told_sd ? params.told_sd : told;  // no number stays none
  const double yaw_sd = params.told_yaw_sd * sd / params.told_sd;    // nobody tells it
  return {observation.X_MB, Vector3d(sd * sd, sd * sd, yaw_sd * yaw_sd).asDiagonal()};
}

/// The belief, but as it is told along every axis [of both covariances] along which it is no surer:
/// beside a long wall the place along it is not seen. Told and told again is no better than told.
PlaceBelief NoWorseThan(const PlaceBelief& told, const PlaceBelief& belief) {
  const Eigen::LLT<Matrix3d> root(told.covariance);
  const Matrix3d left = root.matrixL().solve(belief.covariance);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(root.matrixL().solve(left.transpose()));
  if (axes.eigenvalues().maxCoeff() < 1.0) return belief;
  const Matrix3d& V = axes.eigenvectors();
  Vector3d along = V.transpose() * root.matrixL().solve(Difference(belief.X_MB, told.X_MB));
  Vector3d variances = axes.eigenvalues();
  for (int i = 0; i < 3; ++i) {
    if (variances[i] < 1.0) continue;
    along[i] = 0.0;
    variances[i] = 1.0;
  }
  const Matrix3d back = root.matrixL() * V;
  const Vector3d off = back * along;
  return {
      {told.X_MB.x + off.x(), told.X_MB.y + off.y(), geometry::WrapToPi(told.X_MB.yaw + off.z())},
      back * variances.asDiagonal() * back.transpose()};
}

/// Whether the told place says that the robot cannot be where it believes to be.
bool Contradicts(const PlaceBelief& told, const PlaceBelief& belief) {
  const Vector3d off = Difference(told.X_MB, belief.X_MB);
  const Matrix3d both = told.covariance + belief.covariance;
  return !(off.dot(both.inverse() * off) <= kMostSds * kMostSds);
}

}  // namespace

bool AtSeenPlace::Doubt::Note(bool is_so, double time) {
  if (!is_so) since.reset();
  if (is_so && !since) since = time;
  return since && time - *since >= kPatience;
}

AtSeenPlace::AtSeenPlace(std::unique_ptr<Skill> skill, std::shared_ptr<const SeenPlace> seen,
                         geometry::Polygon body)
    : skill_(std::move(skill)), seen_(std::move(seen)), body_(std::move(body)) {}

void AtSeenPlace::Believe(const PlaceBelief& told) {
  belief_ = told;
  told_contradicts_ = {};
  scans_contradict_ = {};
}

void AtSeenPlace::Predict(const robot::Observation& observation) {
  const SeenPlaceParams& params = seen_->params;
  const Pose2 step = X_OB_.Inverse() * observation.X_OB;
  const double way = step.position().norm();
  belief_ = Moved(*belief_, step);
  belief_->covariance.diagonal() +=
      params.drift * params.drift * Vector3d(way, way, way + std::abs(step.yaw)) +
      params.walk * params.walk * std::max(0.0, observation.time - time_) * Vector3d::Ones();
}

void AtSeenPlace::Correct(const robot::PlacedScan& scan, const PlaceBelief& told) {
  using Verdict = localisation::Correction::Verdict;
  const Pose2 X_NowScan = X_OB_.Inverse() * scan.X_OB;  // the robot drove on since
  const localisation::Correction correction =
      seen_->match.Correct(Moved(*belief_, X_NowScan), robot::EchoesOf(scan, body_),
                           scan.X_BL.position(), std::abs(scan.reading.angle_increment));
  switch (correction.verdict) {
    case Verdict::kSilent:
      scans_contradict_ = {};
      break;
    case Verdict::kContradicts:
      if (scans_contradict_.Note(true, time_)) Believe(told);
      break;
    case Verdict::kCorrected:
      scans_contradict_ = {};
      belief_ = Moved(correction.belief, X_NowScan.Inverse());
      break;
  }
}

void AtSeenPlace::Look(const robot::Observation& observation) {
  const ScanWatch::News news = watch_.Look(observation);
  const PlaceBelief told = ToldPlace(observation, seen_->params);
  const bool is_told = told.covariance.allFinite();  // else nobody knows better for now
  if (!belief_ || news.is_reset || !belief_->covariance.allFinite()) {
    Believe(told);
  } else {
    Predict(observation);
    const bool contradicts = is_told && Contradicts(told, *belief_);
    if (told_contradicts_.Note(contradicts, observation.time)) Believe(told);
    if (is_told) belief_ = NoWorseThan(told, *belief_);
  }
  X_OB_ = observation.X_OB;
  time_ = observation.time;
  if (news.scan) Correct(*news.scan, told);
}

Status AtSeenPlace::Update(const robot::Observation& observation, robot::Command* command) {
  Look(observation);
  robot::Observation seen = observation;
  seen.X_MB = belief_->X_MB;
  const Pose2 X_SeenTold = seen.X_MB * observation.X_MB.Inverse();
  for (robot::SeenObject& object : seen.objects) {
    object.X_MO = geometry::Lift(X_SeenTold) * object.X_MO;
  }
  for (geometry::Polygon& obstacle : seen.obstacles_M) {
    obstacle = geometry::Transformed(X_SeenTold, obstacle);
  }
  return skill_->Update(seen, command);
}

}  // namespace hires::skills
