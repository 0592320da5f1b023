#include "perception/recognition/model_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "hires/geometry/angles.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;
using geometry::Pose2;

constexpr double kSameSize = 5e-4;  // [m]
// Distances [m] at which points begin to count less, step by step; first with few of the points.
constexpr double kCoarse[] = {0.03, 0.03, 0.02, 0.012};
constexpr double kFine[] = {0.008, 0.005, 0.005, 0.004, 0.004};
constexpr std::size_t kFew = 4;          // every 4th point
constexpr std::size_t kMostRefined = 2;  // beginnings that are followed to the end
constexpr double kAbove = 0.03;          // [m] above a model no point of it is measured ...
constexpr double kMostAbove = 0.1;       // ... but this share
constexpr double kDamping = 1e-3;
constexpr double kLever = 0.05;  // [m] by which a turn counts as a way

// By the distances at the nodes of a coarse grid around both.
bool AreAlike(const ModelShape& a, const ModelShape& b) {
  const geometry::Aabb &p = a.field->bounds(), &q = b.field->bounds();
  if ((p.lower - q.lower).norm() > kSameSize || (p.upper - q.upper).norm() > kSameSize)
    return false;
  constexpr int kNodes = 12;
  for (int i = 0; i < kNodes * kNodes * kNodes; ++i) {
    const Vector3d at(i % kNodes, i / kNodes % kNodes, i / (kNodes * kNodes));
    const Vector3d point = p.lower + (p.upper - p.lower).cwiseProduct(at) / (kNodes - 1);
    const auto da = a.field->At(point), db = b.field->At(point);
    if (!da || !db || std::abs(da->distance - db->distance) > kSameSize) return false;
  }
  return true;
}

struct Placed {
  Placed(const ModelShape& shape, const Pose2& X_TO)
      : X_TO(X_TO), c(std::cos(X_TO.yaw)), s(std::sin(X_TO.yaw)), foot(shape.foot) {}
  Vector3d ToModel(const Vector3d& p_T) const {
    const double dx = p_T.x() - X_TO.x, dy = p_T.y() - X_TO.y;
    return {c * dx + s * dy, c * dy - s * dx, p_T.z() - foot};
  }
  Pose2 X_TO;
  double c, s, foot;
};

Pose2 Improved(const ModelShape& shape, const ThingPoints& thing, const Pose2& X_TO, double scale) {
  const Placed placed(shape, X_TO);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double sum = 0.0;
  for (const Vector3d& p_T : thing.p_T) {
    const Vector3d p_O = placed.ToModel(p_T);
    const auto value = shape.field->At(p_O);
    if (!value) continue;
    const double ratio = value->distance / scale;
    const double weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
    const Vector3d& g = value->gradient;
    // How the distance changes as the model moves along x and y of T, and turns.
    const Vector3d row(-(placed.c * g.x() - placed.s * g.y()),
                       -(placed.s * g.x() + placed.c * g.y()),
                       shape.is_round ? 0.0 : (g.x() * p_O.y() - g.y() * p_O.x()) / kLever);
    normal += weight * row * row.transpose();
    right += weight * row * value->distance;
    sum += weight;
  }
  if (sum == 0.0) return X_TO;
  normal.diagonal().array() += kDamping * sum;
  const Vector3d step = -normal.ldlt().solve(right);
  return {X_TO.x + step.x(), X_TO.y + step.y(), X_TO.yaw + step.z() / kLever};
}

double MisfitOf(const ModelShape& shape, const ThingPoints& thing, const Pose2& X_TO) {
  const Placed placed(shape, X_TO);
  double sum = 0.0;
  for (std::size_t i = 0; i < thing.p_T.size(); ++i) {
    const auto value = shape.field->At(placed.ToModel(thing.p_T[i]));
    const double ratio = value ? value->distance / thing.sd[i] : kFarthest;
    sum += std::min(kFarthest, ratio * ratio);
  }
  return sum / kFarthest / static_cast<double>(thing.p_T.size());
}

// The corner of a rectangle around the origin that is nearest to a point.
Eigen::Vector2d NearestCorner(double length, double width, const Eigen::Vector2d& to) {
  return {std::copysign(length / 2.0, to.x()), std::copysign(width / 2.0, to.y())};
}

// Where the middle of the model is, seen from above, if it is turned so.
Eigen::Vector2d FirstMiddle(const Vector3d& extent, double yaw, const Footprint& footprint) {
  const Eigen::Vector2d to_camera_F = footprint.X_TF.Inverse() * Eigen::Vector2d(0.0, 0.0);
  const Eigen::Vector2d corner =
      footprint.X_TF * NearestCorner(footprint.length, footprint.width, to_camera_F);
  const Eigen::Rotation2Dd turn(yaw);
  const Eigen::Vector2d to_camera_O = turn.inverse() * Eigen::Vector2d(-corner);
  return corner - turn * NearestCorner(extent.x(), extent.y(), to_camera_O);
}

Eigen::Vector2d BehindMean(const ThingPoints& thing, double radius) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Vector3d& p_T : thing.p_T) mean += p_T.head<2>();
  mean /= static_cast<double>(thing.p_T.size());
  return mean + mean.normalized() * radius / 2.0;
}

ThingPoints EveryNth(const ThingPoints& thing, std::size_t n) {
  ThingPoints few;
  for (std::size_t i = 0; i < thing.p_T.size(); i += n) {
    few.p_T.push_back(thing.p_T[i]);
    few.sd.push_back(thing.sd[i]);
  }
  return few;
}

// Higher than the model can be.
bool StandsOut(const ModelShape& shape, const ThingPoints& thing) {
  const double top = shape.foot + shape.field->bounds().upper.z() + kAbove;
  const auto above = std::count_if(thing.p_T.begin(), thing.p_T.end(),
                                   [&](const Vector3d& p_T) { return p_T.z() > top; });
  return above > kMostAbove * thing.p_T.size();
}

std::vector<Pose2> Starts(const ModelShape& shape, const ThingPoints& thing,
                          const Footprint& footprint) {
  const geometry::Aabb& bounds = shape.field->bounds();
  const Vector3d extent = bounds.upper - bounds.lower;
  const Eigen::Vector2d middle_O = (bounds.upper + bounds.lower).head<2>() / 2.0;
  const Eigen::Vector2d behind = BehindMean(thing, std::min(extent.x(), extent.y()) / 2.0);
  std::vector<Pose2> starts;
  const auto add = [&](const Eigen::Vector2d& middle, double yaw) {
    const Eigen::Vector2d origin = middle - Eigen::Rotation2Dd(yaw) * middle_O;
    starts.push_back({origin.x(), origin.y(), yaw});
  };
  if (shape.is_round) add(behind, 0.0);
  for (int quarter = 0; quarter < 4 && !shape.is_round; ++quarter) {
    const double yaw = footprint.X_TF.yaw + quarter * geometry::kPi / 2.0;
    add(behind, yaw);
    add(FirstMiddle(extent, yaw, footprint), yaw);
  }
  return starts;
}

}  // namespace

Footprint FootprintOf(const std::vector<Vector3d>& p_T) {
  std::vector<cv::Point2f> points;
  for (const Vector3d& p : p_T)
    points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  const cv::RotatedRect box = cv::minAreaRect(points);
  Footprint print{{box.center.x, box.center.y, box.angle * geometry::kPi / 180.0},
                  box.size.width,
                  box.size.height};
  if (print.length < print.width) {
    std::swap(print.length, print.width);
    print.X_TF.yaw += geometry::kPi / 2.0;
  }
  return print;
}

std::vector<ModelShape> ShapesOfCatalogue(const std::vector<KnownModel>& catalogue) {
  std::vector<KnownModel> sorted = catalogue;
  std::sort(sorted.begin(), sorted.end(),
            [](const KnownModel& a, const KnownModel& b) { return a.label < b.label; });
  std::vector<ModelShape> shapes;
  for (const KnownModel& known : sorted) {
    ModelShape shape;
    shape.models = {known};
    shape.field = std::make_shared<DistanceField>(known.model->collisions);
    shape.is_round = geometry::TurnSymmetry(known.model->collisions) == geometry::kRound;
    shape.foot = -shape.field->bounds().lower.z();
    const auto alike = std::find_if(shapes.begin(), shapes.end(),
                                    [&](const ModelShape& one) { return AreAlike(one, shape); });
    if (alike == shapes.end()) {
      shapes.push_back(std::move(shape));
    } else {
      alike->models.push_back(known);
    }
  }
  return shapes;
}

ModelPose FitModel(const ModelShape& shape, const ThingPoints& thing, const Footprint& footprint) {
  if (StandsOut(shape, thing)) return {};
  const ThingPoints few = EveryNth(thing, kFew);
  std::vector<ModelPose> poses;
  for (const Pose2& X_TO : Starts(shape, thing, footprint)) {
    ModelPose pose{X_TO, 1.0};
    for (const double scale : kCoarse) pose.X_TO = Improved(shape, few, pose.X_TO, scale);
    pose.misfit = MisfitOf(shape, few, pose.X_TO);
    poses.push_back(pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ModelPose& a, const ModelPose& b) { return a.misfit < b.misfit; });
  poses.resize(std::min(poses.size(), kMostRefined));
  ModelPose best;
  for (ModelPose& pose : poses) {
    for (const double scale : kFine) pose.X_TO = Improved(shape, thing, pose.X_TO, scale);
    pose.misfit = MisfitOf(shape, thing, pose.X_TO);
    if (pose.misfit < best.misfit) best = pose;
  }
  return best;
}

}  // namespace hires::perception
