#include "hires/robot/scan_memory.h"

#include <algorithm>
#include <utility>

#include "hires/base/check.h"
#include "hires/robot/echoes.h"
#include "hires/robot/odometry_jump.h"

namespace hires::robot {
namespace {

using Eigen::Vector2d;

constexpr double kReach = 1.0;      // [m] beyond the body
constexpr double kNearUntil = 1.0;  // [m] driven, of what is too near to be measured
constexpr double kKeep = 10.0;      // [s] of what is beside the view: people walk on
constexpr double kSame = 0.01;      // [m] two points that lie nearer are one

}  // namespace

ScanMemory::ScanMemory(geometry::Polygon body) : body_(std::move(body)) {
  HIRES_CHECK(body_.size() >= 3, "the memory of scans knows the robot's body");
  reach_ = geometry::CircumscribedRadius(body_) + kReach;
}

void ScanMemory::NoteMotion(double time, const geometry::Pose2& X_OB) {
  if (last_) {
    const geometry::Pose2 step = last_->X_OB.Inverse() * X_OB;
    if (IsOdometryJump(step, time - last_->time, kFastestDrive, kFastestTurn)) points_.clear();
    way_ += step.position().norm();
  }
  last_ = Last{time, X_OB};
}

bool ScanMemory::IsRemembered(double time, const PlacedScan& scan, const Point& point) const {
  const Vector2d p_B = scan.X_OB.Inverse() * point.p_O;
  if (p_B.norm() > reach_ || IsInView(scan, p_B)) return false;
  return IsTooNear(scan, p_B) ? way_ - point.way <= kNearUntil : time - point.time <= kKeep;
}

void ScanMemory::Complete(double time, PlacedScan* scan) {
  NoteMotion(time, scan->X_OB);
  std::vector<Point> kept;
  scan->out_of_view_O.clear();
  for (const Point& point : points_) {
    if (!IsRemembered(time, *scan, point)) continue;
    const auto known = std::find_if(kept.begin(), kept.end(), [&](const Point& other) {
      return (other.p_O - point.p_O).norm() < kSame;
    });
    if (known == kept.end()) {
      kept.push_back(point);
    } else {
      known->time = std::max(known->time, point.time);
      known->way = std::max(known->way, point.way);
    }
  }
  for (const Point& point : kept) scan->out_of_view_O.push_back(point.p_O);
  points_ = std::move(kept);
  for (const Vector2d& echo_B : EchoesOf(*scan, body_)) {
    if (echo_B.norm() <= reach_) points_.push_back({scan->X_OB * echo_B, time, way_});
  }
}

}  // namespace hires::robot
