#include "hires/perception/detector_errors.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/perception/detector.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.0012;        // [sr]
constexpr double kLeastSize = 1e-3;     // of kSize
constexpr double kDistance = 1.5;       // [m]
constexpr double kElevation = 0.6;      // [rad]
constexpr double kHeight = 0.1;         // [m]
constexpr double kLeastHeight = 0.005;  // [m]
constexpr double kCrowded = 0.05;       // [m]
constexpr double kNear = 0.5;           // [m] between two things that may crowd each other

geometry::Aabb BoxOf(const world::ObjectModel& model) {
  geometry::Aabb bounds;
  for (const geometry::Collision& one : model.collisions)
    bounds.Include(geometry::BoundsOf(one.shape, one.X_BS));
  return bounds;
}

/// From above, as if it stood upright.
geometry::Polygon FootprintIn(const geometry::Aabb& b, const geometry::Pose3& X_MO) {
  return geometry::Transformed(geometry::Flatten(X_MO), {{b.lower.x(), b.lower.y()},
                                                         {b.upper.x(), b.lower.y()},
                                                         {b.upper.x(), b.upper.y()},
                                                         {b.lower.x(), b.upper.y()}});
}

double Share(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

/// Draws one thing of each kind; which of the two streams counts is the look's chance.
struct Draws {
  double found, named, called, along;  // 0 .. 1
  double length, turn;                 // normal
  Vector3d way;                        // likewise

  explicit Draws(base::Rng* rng)
      : found(rng->Uniform(0.0, 1.0)),
        named(rng->Uniform(0.0, 1.0)),
        called(rng->Uniform(0.0, 1.0)),
        along(rng->Uniform(-1.0, 1.0)),
        length(rng->Normal(0.0, 1.0)),
        turn(rng->Normal(0.0, 1.0)),
        way(rng->Normal(0.0, 1.0), rng->Normal(0.0, 1.0), rng->Normal(0.0, 1.0)) {}
};

std::string WrongName(const DetectorErrors& errors, const std::string& model, double chance) {
  const auto names = errors.called.find(model);
  if (names == errors.called.end()) return kUnknownLabel;
  int all = 0;
  for (const auto& [name, number] : names->second) all += number;
  double left = chance * all;
  for (const auto& [name, number] : names->second)
    if ((left -= number) < 0.0) return name;
  return kUnknownLabel;
}

}  // namespace

ThingInView LookAtThing(const LineOfSight& sight, const CameraView& view,
                        const std::vector<world::ObjectState>& objects, std::size_t index,
                        const VisiblePart& part) {
  const world::ObjectState& object = objects[index];
  const geometry::Aabb bounds = BoxOf(sight.surroundings().Model(object.model));
  const Vector3d way = view.X_MC.translation - object.X_MO.translation;
  ThingInView thing;
  thing.part = part;
  thing.distance = way.norm();
  thing.elevation = std::asin(std::clamp(way.z() / std::max(thing.distance, 1e-9), -1.0, 1.0));
  thing.box = bounds.upper - bounds.lower;
  const geometry::Polygon outline = FootprintIn(bounds, object.X_MO);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (i == index) continue;
    const double away = (objects[i].X_MO.translation - object.X_MO.translation).norm();
    if (away > kNear) continue;
    const geometry::Aabb other = BoxOf(sight.surroundings().Model(objects[i].model));
    const geometry::Polygon beside = FootprintIn(other, objects[i].X_MO);
    thing.gap = std::min(thing.gap, std::max(0.0, geometry::Distance(outline, beside)));
  }
  return thing;
}

Eigen::Matrix3d SightFrame(const Vector3d& p_C, const Vector3d& up_C) {
  Vector3d along = p_C - up_C * up_C.dot(p_C);
  along = along.norm() > 1e-9 ? Vector3d(along.normalized()) : Vector3d(up_C.unitOrthogonal());
  Eigen::Matrix3d frame;
  frame << along, up_C.cross(along), up_C;
  return frame;
}

Regressors RegressorsOf(const ThingInView& view) {
  Regressors x;
  x << 1.0, std::log10(std::max(view.part.size / kSize, kLeastSize)), 1.0 - view.part.share,
      std::log2(std::max(view.distance, 0.1) / kDistance), view.elevation - kElevation,
      std::log10(std::max(view.box.z(), kLeastHeight) / kHeight),
      std::clamp(1.0 - view.gap / kCrowded, 0.0, 1.0);
  return x;
}

Misjudgement Misjudge(const DetectorErrors& errors, const std::string& model,
                      const ThingInView& view, double factor, base::Rng look, base::Rng thing) {
  const Draws now(&look), always(&thing);
  const auto of = [&](const Regression& one) -> const Draws& {
    return look.Bernoulli(one.repeats) ? always : now;
  };
  const Draws &found = of(errors.found), &named = of(errors.named);
  const Draws &position = of(errors.position.log), &turn = of(errors.turn.log);
  Misjudgement out;
  out.is_missed = found.found < factor * Share(-errors.found.At(view));
  if (named.named < factor * Share(-errors.named.At(view)))
    out.called = WrongName(errors, model, named.called);
  const auto length = [&](const LengthRegression& one, double score) {
    return factor * std::exp(one.log.At(view) + one.spread * score);
  };
  const Vector3d way = position.way.cwiseProduct(errors.direction.cwiseSqrt());
  if (way.norm() > 0.0) out.offset = length(errors.position, position.length) * way.normalized();
  out.turn = std::copysign(length(errors.turn, turn.turn), turn.along);
  return out;
}

}  // namespace hires::perception
