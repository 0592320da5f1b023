#include "hires/sensing/ground_watch.h"

#include <algorithm>
#include <utility>

#include "hires/base/param_reader.h"
#include "hires/perception/camera_view.h"
#include "sensing/ground/ground_obstacles.h"

namespace hires::sensing {

using base::Between;

GroundWatchParams ReadGroundWatchParams(base::ParamReader in) {
  GroundWatchParams params;
  params.is_enabled = in.GetBool("enabled");
  params.ground.floor.max_tilt = in.Get("max_tilt", Between(0.0, 0.3));
  params.ground.floor.max_offset = in.Get("max_offset", Between(0.0, 0.3));
  params.ground.min_height = in.Get("min_height", Between(0.005, 0.5));
  params.ground.min_depth = in.Get("min_depth", Between(0.005, 0.5));
  params.ground.min_points = in.Get("min_points", Between(1, 1000));
  params.self.padding = in.Get("padding", Between(0.0, 0.3));
  params.self.jump = in.Get("jump", Between(0.01, 1.0));
  params.eye = in.GetString("eye");
  params.keep = in.Get("keep", Between(0.1, 60.0));
  in.RejectUnknownKeys();
  return params;
}

GroundWatch::GroundWatch(const RobotStateEstimator* state,
                         std::shared_ptr<const robot::Robot> robot,
                         std::shared_ptr<const navigation::Costmap> map,
                         geometry::Polygon footprint, const ScanParams& scan,
                         const GroundWatchParams& params, base::Rng rng)
    : state_(state),
      robot_(std::move(robot)),
      find_(new GroundObstacles(std::move(map), std::move(footprint), scan, params.ground)),
      self_(params.self),
      params_(params),
      rng_(rng) {}
GroundWatch::~GroundWatch() = default;
GroundWatch::GroundWatch(GroundWatch&&) noexcept = default;

Receipt GroundWatch::OnCloud(double stamp, const std::string& frame, perception::PointCloud cloud) {
  if (!(stamp > 0.0)) return {Reception::kNoStamp, {}};
  if (state_->IsAhead(stamp)) return state_->Ahead("header.stamp");
  waiting_ = {stamp, frame, std::move(cloud)};
  return {};
}

const std::vector<geometry::Polygon>& GroundWatch::Obstacles(const RobotEstimate& now) {
  if (waiting_ && waiting_->stamp <= now.time) {
    const Cloud cloud = std::move(*waiting_);
    waiting_.reset();
    Look(cloud.stamp, cloud.frame, cloud.points);
  }
  // A stamp of later is of a clock that has begun again.
  if (now.time - seen_ > params_.keep || seen_ > now.time) obstacles_M_.clear();
  return obstacles_M_;
}

/// Moves the cloud to where it was seen from, cuts the robot out of it, and looks at the floor.
void GroundWatch::Look(double stamp, const std::string& frame, perception::PointCloud cloud) {
  const auto then = state_->At(stamp);
  if (!then) {
    receipt_ = {Reception::kNotThen, frame};
    return;
  }
  const FramePose X_BC = state_->InBase(frame, *then);
  const FramePose X_BE = params_.eye.empty() ? X_BC : state_->InBase(params_.eye, *then);
  receipt_ = ReceiptOf(X_BC.status, frame);
  if (X_BC.is_found()) receipt_ = ReceiptOf(X_BE.status, params_.eye);
  if (!X_BC.is_found() || !X_BE.is_found()) return;
  const geometry::Pose3 X_BS{X_BE.X_PC.translation, X_BC.X_PC.rotation};
  const Eigen::Vector3f p_SC = ((X_BS.Inverse() * X_BC.X_PC).translation).cast<float>();
  for (Eigen::Vector3f& point : cloud.points) point += p_SC;
  std::vector<geometry::Collision> shapes = perception::ShapesOf(*robot_, {}, then->posture);
  double height = 0.0;
  for (geometry::Collision& shape : shapes) {
    height = std::max(height, geometry::BoundsOf(shape.shape, shape.X_BS).upper.z());
    shape.X_BS = X_BS.Inverse() * shape.X_BS;
  }
  self_.Cut(shapes, &cloud);
  obstacles_M_ = find_->Find(cloud, X_BS, then->X_WB, height, &rng_).obstacles_M;
  seen_ = stamp;
}

}  // namespace hires::sensing
