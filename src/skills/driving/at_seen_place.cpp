#include "skills/driving/at_seen_place.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/geometry/covariance.h"
#include "hires/robot/echoes.h"

namespace hires::skills {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Pose2;
using localisation::PlaceBelief;

constexpr double kMostSds = 4.0;  // between told and seen place

/// The belief of a robot that moved, by an odometry that errs not.
PlaceBelief Moved(const PlaceBelief& belief, const Pose2& X_BNow) {
  const Pose2 X_MNow = belief.X_MB * X_BNow;
  const Vector2d way = X_MNow.position() - belief.X_MB.position();
  Matrix3d F = Matrix3d::Identity();
  F(0, 2) = -way.y();
  F(1, 2) = way.x();
  return {X_MNow, F * belief.covariance * F.transpose()};
}

double PositionSd(const PlaceBelief& belief) {
  const Matrix3d& C = belief.covariance;
  return geometry::LargestSd(C(0, 0), C(0, 1), C(1, 1));
}

PlaceBelief ToldPlace(const robot::Observation& observation, const SeenPlaceParams& params) {
  const double sd = observation.position_sd > 0.0 ? observation.position_sd : params.told_sd;
  return {observation.X_MB,
          Vector3d(sd * sd, sd * sd, params.told_yaw_sd * params.told_yaw_sd).asDiagonal()};
}

/// Whether the told place says that the robot cannot be where it believes to be.
bool Contradicts(const PlaceBelief& told, const PlaceBelief& belief) {
  const Vector3d off(told.X_MB.x - belief.X_MB.x, told.X_MB.y - belief.X_MB.y,
                     geometry::WrapToPi(told.X_MB.yaw - belief.X_MB.yaw));
  const Matrix3d both = told.covariance + belief.covariance;
  return !(off.dot(both.inverse() * off) <= kMostSds * kMostSds);
}

}  // namespace

AtSeenPlace::AtSeenPlace(std::unique_ptr<Skill> skill, std::shared_ptr<const SeenPlace> seen,
                         geometry::Polygon footprint)
    : skill_(std::move(skill)), seen_(std::move(seen)), footprint_(std::move(footprint)) {}

void AtSeenPlace::Correct(const robot::PlacedScan& scan) {
  const Pose2 X_NowScan = X_OB_.Inverse() * scan.X_OB;  // the robot drove on since
  PlaceBelief then = Moved(*belief_, X_NowScan);
  const double walk = seen_->params.walk;
  then.covariance += walk * walk * Matrix3d::Identity();
  const auto corrected =
      seen_->match.Correct(then, robot::EchoesOf(scan, footprint_), scan.X_BL.position(),
                           std::abs(scan.reading.angle_increment));
  if (corrected) belief_ = Moved(*corrected, X_NowScan.Inverse());
}

void AtSeenPlace::Look(const robot::Observation& observation) {
  const ScanWatch::News news = watch_.Look(observation);
  const PlaceBelief told = ToldPlace(observation, seen_->params);
  if (belief_ && !news.is_reset) {
    const Pose2 step = X_OB_.Inverse() * observation.X_OB;
    belief_ = Moved(*belief_, step);
    const double drift = seen_->params.drift * seen_->params.drift;
    belief_->covariance.diagonal() +=
        drift * Vector3d(step.position().norm(), step.position().norm(), std::abs(step.yaw));
    const bool is_worse = PositionSd(*belief_) >= PositionSd(told);
    if (is_worse || Contradicts(told, *belief_)) belief_ = told;
  } else {
    belief_ = told;
  }
  X_OB_ = observation.X_OB;
  if (news.scan) Correct(*news.scan);
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
