#include "hires/skills/local_costmap.h"

#include <cmath>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/navigation/dwa.h"

namespace hires::skills {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;

/// The map against the odometry, where the robot is: by so much that cells of 0.05 m show it.
bool HasMoved(const Pose2& X_OMbefore, const Pose2& X_OM, const Pose2& X_MB) {
  const Vector2d way = X_OM * X_MB.position() - X_OMbefore * X_MB.position();
  return way.norm() > 0.01 || std::abs(geometry::WrapToPi(X_OM.yaw - X_OMbefore.yaw)) > 0.005;
}

}  // namespace

LocalCostmap::LocalCostmap(const MapByPlane* map, const navigation::ObstacleLayerParams& params,
                           geometry::Polygon footprint, double inflation_radius)
    : map_(map),
      footprint_(std::move(footprint)),
      reach_(navigation::kLocalHalfWidth + inflation_radius),
      layer_(params, map->beyond->resolution()),
      beyond_(map->beyond) {}

void LocalCostmap::SetInscribedRadius(double radius) {
  beyond_ = std::make_shared<const navigation::Costmap>(map_->beyond->WithInscribedRadius(radius));
  now_.reset();
}

const std::shared_ptr<const navigation::Costmap>& LocalCostmap::Look(
    const robot::Observation& observation) {
  const ScanWatch::News news = watch_.Look(observation);
  if (news.is_reset) layer_.Forget();
  if (news.scan) {
    layer_.Insert(observation.time, news.scan->reading, news.scan->X_OB, news.scan->X_BL,
                  footprint_);
  }
  const bool is_new = news.is_reset || news.scan;
  const Pose2 X_OM = observation.X_OB * observation.X_MB.Inverse();
  if (now_ && !is_new && !HasMoved(X_OM_, X_OM, observation.X_MB)) return now_;
  X_OM_ = X_OM;
  now_.reset();  // so that a rollout holds one copy of the map, not two
  now_ =
      std::make_shared<const navigation::Costmap>(beyond_->WithObstaclesAt(Obstacles(observation)));
  return now_;
}

std::vector<Vector2d> LocalCostmap::Marks(const robot::Observation& observation) const {
  const Pose2 X_MO = observation.X_MB * observation.X_OB.Inverse();
  std::vector<Vector2d> marks = layer_.Marks(observation.X_OB, observation.time);
  for (Vector2d& mark : marks) mark = X_MO * mark;
  return marks;
}

/// What is marked, and what the map has in the laser's plane and no beam has shown to be free.
std::vector<Vector2d> LocalCostmap::Obstacles(const robot::Observation& observation) const {
  std::vector<Vector2d> obstacles_M = Marks(observation);
  for (const Vector2d& p : map_->in_plane_M) {
    if ((p - observation.X_MB.position()).cwiseAbs().maxCoeff() > reach_) continue;
    if (layer_.At(X_OM_ * p, observation.time) != navigation::ObstacleLayer::State::kFree)
      obstacles_M.push_back(p);
  }
  return obstacles_M;
}

}  // namespace hires::skills
