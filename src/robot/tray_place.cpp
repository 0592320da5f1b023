#include "robot/tray_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/mesh_pieces.h"
#include "hires/robot/tray.h"

namespace hires::robot {
namespace {

using Eigen::Vector2d;
using geometry::Pose3;

constexpr double kRoomAbove =
    0.15;                          // [m] what hangs higher over the plate leaves room, as decks do
constexpr double kOnPlate = 1e-3;  // [m] what reaches less above the plate takes no room
constexpr double kEnough = 0.05;   // [m] round the middle: a cup's radius and a little
constexpr double kLeastRadius = 0.01;  // [m] less is no place
constexpr int kSteps = 48;             // of the search along each side
constexpr double kMillimetre = 1e-3;

/// A shape that takes room on the plate, from above.
struct Taken {
  std::string link;
  geometry::Polygon outline;
  bool is_wall{false};  ///< of the plate's own mesh
};

/// The plate from above in the root's frame, joints as they are.
struct Plate {
  geometry::Polygon outline;
  geometry::Aabb bounds;
  std::vector<Taken> taken;

  Vector2d middle() const { return 0.5 * (bounds.lower + bounds.upper).head<2>(); }

  /// [m] from a point on the plate to its edge; less than 0 beside it.
  double ToEdge(const Vector2d& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
      const Vector2d along = (b - a).normalized();
      least = std::min(least, along.x() * (p - a).y() - along.y() * (p - a).x());
    }
    return least;
  }
  /// [m] to the next thing that stands on it, and which.
  std::pair<double, const Taken*> ToNext(const Vector2d& p) const {
    std::pair<double, const Taken*> next{std::numeric_limits<double>::infinity(), nullptr};
    for (const Taken& one : taken) {
      const double distance = geometry::Distance(one.outline, geometry::Polygon{p});
      if (distance < next.first) next = {distance, &one};
    }
    return next;
  }
  double Radius(const Vector2d& p) const { return std::min(ToEdge(p), ToNext(p).first); }
};

Plate PlateOf(const RobotModel& model, const std::vector<Pose3>& X_R, int link) {
  const auto [top, bounds, area] = LargestFromAbove(model.links[link].collisions, X_R[link]);
  Plate plate;
  plate.bounds = bounds;
  const auto outline = geometry::OutlineInBand(top->shape, X_R[link] * top->X_BS,
                                               plate.bounds.lower.z(), plate.bounds.upper.z());
  if (outline) plate.outline = *outline;
  if (const auto* mesh = std::get_if<std::shared_ptr<const geometry::TriangleMesh>>(&top->shape)) {
    for (geometry::Polygon& wall : geometry::MeshOutlinesInBand(
             **mesh, X_R[link] * top->X_BS, plate.bounds.upper.z() + kOnPlate,
             plate.bounds.upper.z() + kRoomAbove)) {
      plate.taken.push_back({model.links[link].name, std::move(wall), true});
    }
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (const geometry::Collision& shape : model.links[i].collisions) {
      if (&shape == top) continue;
      const auto taken = geometry::OutlineInBand(shape.shape, X_R[i] * shape.X_BS,
                                                 plate.bounds.upper.z() + kOnPlate,
                                                 plate.bounds.upper.z() + kRoomAbove);
      if (taken) plate.taken.push_back({model.links[i].name, *taken, false});
    }
  }
  return plate;
}

/// The middle of the largest free circle, to a millimetre: a grid, then ever smaller steps. Of
/// equal ones that which lies farther ahead.
Vector2d Freest(const Plate& plate) {
  const Vector2d lower = plate.bounds.lower.head<2>();
  const Vector2d size = plate.bounds.upper.head<2>() - lower;
  Vector2d best = plate.middle();
  double radius = -std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector2d& p) {
    const double here = plate.Radius(p);
    if (here <= radius + 1e-6) return;
    radius = here;
    best = p;
  };
  for (int i = kSteps; i >= 0; --i) {
    for (int k = 0; k <= kSteps; ++k)
      look(lower + Vector2d(size.x() * i, size.y() * k) / static_cast<double>(kSteps));
  }
  for (Vector2d step = size / kSteps; step.maxCoeff() > 0.2 * kMillimetre; step *= 0.5) {
    const Vector2d from = best;
    for (const double x : {1.0, 0.0, -1.0}) {
      for (const double y : {1.0, 0.0, -1.0}) look(from + Vector2d(x * step.x(), y * step.y()));
    }
  }
  const Vector2d off =
      (((best - plate.middle()) / kMillimetre).array().round() * kMillimetre).matrix();
  return plate.middle() + off;
}

}  // namespace

TrayPlace PlaceOnTray(const RobotModel& model, const JointPositions& joints,
                      const std::string& link) {
  const std::vector<Pose3> X_R = ForwardKinematics(model, joints);
  const int index = *model.FindLink(link);
  const Plate plate = PlateOf(model, X_R, index);
  TrayPlace place;
  Vector2d p = plate.middle();
  const auto [distance, next] = plate.ToNext(p);
  // Walls of its own are rims, unless they go through its middle.
  const double least = next != nullptr && next->is_wall ? kLeastRadius : kEnough;
  if (next != nullptr && distance < std::min(least, plate.ToEdge(p))) {
    place.taken_by = next->link;
    const Vector2d freest = Freest(plate);
    place.radius = plate.Radius(freest);
    place.is_free = place.radius >= kLeastRadius;
    if (place.is_free) p = freest;
  }
  const Pose3 X_RO{{p.x(), p.y(), plate.bounds.upper.z()}, Eigen::Quaterniond::Identity()};
  place.X_TO = X_R[index].Inverse() * X_RO;
  return place;
}

}  // namespace hires::robot
