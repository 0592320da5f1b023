#include "hires/sensing/ground_watch.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "hires/base/param_reader.h"
#include "hires/perception/camera_view.h"
#include "sensing/ground/ground_obstacles.h"
#include "sensing/unmapped.h"

namespace hires::sensing {

using base::Between;

namespace {

constexpr std::uint64_t kSeed = 1;  // of the search for the floor; any will do
constexpr double kSweep = 2.0;      // [s] that a cloud may have been put together from
constexpr double kStep = 0.1;       // [s] in which arms move less than the padding
constexpr double kInHand = 0.15;    // [m] from where a hand grasps, to which what it holds reaches

/// A ball about what each hand may hold: nothing there stands on the floor.
void AddLoads(const robot::Robot& robot, const geometry::Pose2& X_FB,
              const robot::JointPositions& posture, std::vector<geometry::Collision>* shapes_F) {
  if (!robot.profile.upper_body) return;
  const auto X_RL = robot::ForwardKinematics(robot.model, posture);
  const geometry::Pose3 X_FR =
      geometry::Lift(X_FB) * X_RL[*robot.model.FindLink(robot.profile.base_link)].Inverse();
  for (const auto& [name, arm] : robot.profile.upper_body->arms) {
    const auto tool = robot.model.FindLink(arm.tool_link);
    if (!tool) continue;
    geometry::Collision& load = shapes_F->emplace_back();
    load.name = "load of " + name;
    load.shape = geometry::Sphere{kInHand};
    load.X_BS = X_FR * X_RL[*tool];
  }
}

}  // namespace

GroundWatchParams ReadGroundWatchParams(base::ParamReader in) {
  GroundWatchParams params;
  params.is_enabled = in.GetBool("enabled");
  params.scan = ReadScanKeys(&in);
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

bool GroundWatchParams::operator==(const GroundWatchParams& other) const {
  const auto all = [](const GroundWatchParams& p) {
    const FloorParams& floor = p.ground.floor;
    return std::tie(p.is_enabled, floor.max_tilt, floor.max_offset, floor.inlier, floor.min_share,
                    floor.min_points, p.ground.min_height, p.ground.min_depth, p.ground.min_points,
                    p.self.padding, p.self.jump, p.eye, p.keep, p.scan.tolerance, p.scan.range,
                    p.scan.cell);
  };
  return all(*this) == all(other);
}

GroundWatch::GroundWatch(const RobotStateEstimator* state,
                         std::shared_ptr<const robot::Robot> robot,
                         std::shared_ptr<const navigation::Costmap> map,
                         const GroundWatchParams& params)
    : state_(state),
      robot_(std::move(robot)),
      find_(new GroundObstacles(
          std::move(map),
          geometry::Padded(robot_->profile.footprint, robot_->profile.footprint_padding),
          params.scan, params.ground)),
      self_(params.self),
      params_(params),
      rng_(kSeed) {}
GroundWatch::~GroundWatch() = default;
GroundWatch::GroundWatch(GroundWatch&&) noexcept = default;

Receipt GroundWatch::OnCloud(double stamp, const std::string& frame, perception::PointCloud cloud) {
  if (!(stamp > 0.0)) return {Reception::kNoStamp, {}};
  if (state_->IsAhead(stamp)) return state_->Ahead("header.stamp");
  waiting_ = {stamp, frame, std::move(cloud)};
  return {};
}

bool GroundWatch::Update(const RobotEstimate& now) {
  if (!waiting_ || waiting_->stamp > now.time) return false;
  const Cloud cloud = *std::exchange(waiting_, std::nullopt);
  return Look(cloud.stamp, cloud.frame, cloud.points);
}

const std::vector<geometry::Polygon>& GroundWatch::Obstacles(const RobotEstimate& now) {
  if (Update(now)) {
    obstacles_M_.clear();
    for (const GroundSpot& spot : reading_.spots)
      obstacles_M_.push_back(SquareOf(spot.cell.first, spot.cell.second, params_.scan.cell));
  }
  // A stamp of later is of a clock that has begun again.
  if (now.time - seen_ > params_.keep || seen_ > now.time) obstacles_M_.clear();
  return obstacles_M_;
}

/// Moves the cloud to where it was seen from, cuts the robot out of it, and looks at the floor.
bool GroundWatch::Look(double stamp, const std::string& frame, perception::PointCloud cloud) {
  const auto then = state_->At(stamp);
  if (!then) {
    receipt_ = {Reception::kNotThen, frame};
    return false;
  }
  const FramePose X_BC = state_->InBase(frame, *then);
  const FramePose X_BE = params_.eye.empty() ? X_BC : state_->InBase(params_.eye, *then);
  receipt_ = ReceiptOf(X_BC.status, frame);
  if (X_BC.is_found()) receipt_ = ReceiptOf(X_BE.status, params_.eye);
  if (!X_BC.is_found() || !X_BE.is_found()) return false;
  const geometry::Pose3 X_BS{X_BE.X_PC.translation, X_BC.X_PC.rotation};
  const Eigen::Vector3f p_SC = ((X_BS.Inverse() * X_BC.X_PC).translation).cast<float>();
  for (Eigen::Vector3f& point : cloud.points) point += p_SC;
  std::vector<geometry::Collision> shapes = perception::ShapesOf(*robot_, {}, then->posture);
  double height = 0.0;
  for (const geometry::Collision& shape : shapes)
    height = std::max(height, geometry::BoundsOf(shape.shape, shape.X_BS).upper.z());
  AddLoads(*robot_, {}, then->posture, &shapes);
  for (geometry::Collision& shape : shapes) shape.X_BS = X_BS.Inverse() * shape.X_BS;
  self_.Cut(shapes, &cloud);
  reading_ = find_->Find(cloud, X_BS, then->X_WB, height, &rng_);
  DropOwn(stamp);
  seen_ = stamp;
  return true;
}

/// Drops what hangs where the robot itself was while the cloud was put together: at the end of a
/// sweep its arms may be elsewhere.
void GroundWatch::DropOwn(double stamp) {
  const double margin = params_.self.padding + params_.scan.cell;
  std::vector<GroundSpot>& spots = reading_.spots;
  for (double time = stamp - kSweep; time <= stamp && !spots.empty(); time += kStep) {
    const auto then = state_->At(time);
    if (!then) continue;
    std::vector<geometry::Collision> shapes_M =
        perception::ShapesOf(*robot_, then->X_WB, then->posture);
    AddLoads(*robot_, then->X_WB, then->posture, &shapes_M);
    for (const geometry::Collision& shape_M : shapes_M) {
      const geometry::Aabb box = geometry::BoundsOf(shape_M.shape, shape_M.X_BS);
      const auto is_own = [&](const GroundSpot& spot) {
        const Eigen::Vector3d low(spot.p_M.x(), spot.p_M.y(), spot.lowest);
        const Eigen::Vector3d high(spot.p_M.x(), spot.p_M.y(), spot.highest);
        return (low.array() >= box.lower.array() - margin).all() &&
               (high.array() <= box.upper.array() + margin).all();
      };
      spots.erase(std::remove_if(spots.begin(), spots.end(), is_own), spots.end());
    }
  }
}

}  // namespace hires::sensing
