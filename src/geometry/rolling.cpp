#include "geometry/rolling.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "hires/geometry/angles.h"

namespace hires::geometry {
namespace {

using Eigen::Vector3d;
using MeshPtr = std::shared_ptr<const TriangleMesh>;

constexpr double kTurns[] = {0.1, 0.2, 0.3};  // [rad]
/// Share of the height. What stands on a flat foot cannot be as high within 0.4 % at all three
/// turns, be the foot as narrow as it may; a mesh with 42 sides or more rises by less than this.
constexpr double kAsHigh = 0.003;
constexpr int kAxes = 4;           // level ones that are tried in any case
constexpr double kLowest = 0.001;  // share of the height: a mesh's vertices that it lies on

/// How far the shape reaches along a direction of unit length from its own middle [m].
double ReachAlong(const Shape& shape, const Vector3d& direction) {
  if (const auto* box = std::get_if<Box>(&shape)) return 0.5 * box->size.dot(direction.cwiseAbs());
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return cylinder->radius * direction.head<2>().norm() +
           0.5 * cylinder->length * std::abs(direction.z());
  }
  double reach = -HUGE_VAL;
  for (const Vector3d& vertex : std::get<MeshPtr>(shape)->vertices)
    reach = std::max(reach, vertex.dot(direction));
  return reach;
}

/// A body as it is turned on level ground. All in its own frame B.
class TurnedBody {
 public:
  TurnedBody(const std::vector<Collision>& shapes_B, const Vector3d& p_BBcm,
             const Eigen::Quaterniond& R_WB)
      : shapes_(shapes_B),
        p_BBcm_(p_BBcm),
        down_(R_WB.normalized().conjugate() * -Vector3d::UnitZ()),
        height_(HeightAlong(down_)) {}

  /// Axes about which it might roll: of cylinders, along what meshes lie on, from one part that it
  /// lies on to another, and some more.
  std::vector<Vector3d> Axes() const {
    std::vector<Vector3d> axes = LevelAxes();
    const Collision* first = nullptr;
    for (const Collision& part : shapes_) {
      if (DepthOf(part, down_) < (1.0 - kLowest) * height_) continue;
      const bool is_cylinder = std::holds_alternative<Cylinder>(part.shape);
      AddLevel(is_cylinder ? part.X_BS.rotation * Vector3d::UnitZ() : LineUnder(part), &axes);
      if (first == nullptr) first = &part;
      AddLevel(part.X_BS.translation - first->X_BS.translation, &axes);
    }
    return axes;
  }

  std::vector<Vector3d> LevelAxes() const {
    const Vector3d first = down_.unitOrthogonal(), second = down_.cross(first);
    std::vector<Vector3d> axes;
    for (int i = 0; i < kAxes; ++i) {
      const double angle = i * kPi / kAxes;
      axes.push_back(std::cos(angle) * first + std::sin(angle) * second);
    }
    return axes;
  }

  bool RollsAbout(const Vector3d& axis) const {
    return std::all_of(std::begin(kTurns), std::end(kTurns), [&](double turn) {
      return std::abs(RiseAt(turn, axis)) <= kAsHigh && std::abs(RiseAt(-turn, axis)) <= kAsHigh;
    });
  }

  /// Leaning about any axis by a little, it is not lower.
  bool IsSteady() const {
    const std::vector<Vector3d> axes = LevelAxes();
    return height_ > 0.0 && std::all_of(axes.begin(), axes.end(), [&](const Vector3d& axis) {
             return RiseAt(kTurns[0], axis) >= -kAsHigh && RiseAt(-kTurns[0], axis) >= -kAsHigh;
           });
  }

 private:
  /// [m] from the centre of mass to the part's lowest point, if this direction points down.
  double DepthOf(const Collision& part, const Vector3d& down) const {
    const Vector3d down_S = part.X_BS.rotation.normalized().conjugate() * down;
    return down.dot(part.X_BS.translation - p_BBcm_) + ReachAlong(part.shape, down_S);
  }

  /// [m] of the centre of mass over the lowest point.
  double HeightAlong(const Vector3d& down) const {
    double height = -HUGE_VAL;
    for (const Collision& part : shapes_) height = std::max(height, DepthOf(part, down));
    return height;
  }

  /// Share of its height by which a turn lifts the centre of mass.
  double RiseAt(double turn, const Vector3d& axis) const {
    return HeightAlong(Eigen::AngleAxisd(turn, axis) * down_) / height_ - 1.0;
  }

  /// From one end to the other of the vertices that are lowest; zero of other shapes.
  Vector3d LineUnder(const Collision& part) const {
    const auto* mesh = std::get_if<MeshPtr>(&part.shape);
    if (mesh == nullptr) return Vector3d::Zero();
    const Vector3d down_S = part.X_BS.rotation.normalized().conjugate() * down_;
    const double lowest = ReachAlong(part.shape, down_S) - kLowest * std::abs(height_);
    std::optional<Vector3d> from;
    Vector3d line = Vector3d::Zero();
    for (const Vector3d& vertex : (*mesh)->vertices) {
      if (vertex.dot(down_S) < lowest) continue;
      if (!from) from = vertex;
      if ((vertex - *from).squaredNorm() > line.squaredNorm()) line = vertex - *from;
    }
    return part.X_BS.rotation * line;
  }

  void AddLevel(const Vector3d& axis, std::vector<Vector3d>* axes) const {
    const Vector3d level = axis - down_ * down_.dot(axis);
    if (level.norm() > 0.5 * axis.norm()) axes->push_back(level.normalized());
  }

  const std::vector<Collision>& shapes_;
  const Vector3d p_BBcm_, down_;
  const double height_;
};

}  // namespace

Rolling RollingOf(const std::vector<Collision>& shapes_B, const Vector3d& p_BBcm,
                  const Eigen::Quaterniond& R_WB) {
  if (shapes_B.empty()) return Rolling::kNot;
  const TurnedBody body(shapes_B, p_BBcm, R_WB);
  if (!body.IsSteady()) return Rolling::kNot;
  const std::vector<Vector3d> axes = body.Axes();
  const auto num = std::count_if(axes.begin(), axes.end(),
                                 [&](const Vector3d& axis) { return body.RollsAbout(axis); });
  if (num == 0) return Rolling::kNot;
  return num == static_cast<long>(axes.size()) ? Rolling::kAllWays : Rolling::kAlongALine;
}

}  // namespace hires::geometry
