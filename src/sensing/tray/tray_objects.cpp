#include "hires/sensing/tray_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "sensing/tray/beam_outline.h"

namespace hires::sensing {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;
using geometry::Pose3;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Which beams end near the robot's own parts; those beside them may be split there.
std::vector<bool> OwnBeams(const TrayBeams& beams, const Slice& own_T, double padding, int beside) {
  std::vector<bool> is_own(beams.beams.size(), false);
  if (own_T.empty()) return is_own;
  for (const int i : BeamsNear(beams, own_T, padding, true)) {
    const int last = std::min(static_cast<int>(is_own.size()) - 1, i + beside);
    for (int j = std::max(0, i - beside); j <= last; ++j) is_own[j] = true;
  }
  return is_own;
}

TrayBeams BeamsOf(const robot::ScanReading& scan, const Pose3& X_TL, const Polygon& tray_T,
                  const Slice& own_T, const TrayParams& params) {
  const geometry::Pose2 flat = geometry::Flatten(X_TL);
  const Vector2d middle =
      std::accumulate(tray_T.begin(), tray_T.end(), Vector2d(0.0, 0.0)) / tray_T.size();
  Polygon wider_T = tray_T;
  for (Vector2d& corner : wider_T) corner += params.outside * (corner - middle).normalized();
  TrayBeams beams{flat.position(), {}};
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = flat.yaw + scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const double range = scan.ranges[i];
    beams.beams.push_back(
        {{std::cos(angle), std::sin(angle)}, range > scan.range_min ? range : kNothing, false});
    TrayBeam& beam = beams.beams.back();
    beam.is_on_tray = beam.range <= params.max_range &&
                      geometry::Contains(wider_T, beams.EndOf(static_cast<int>(i)));
  }
  const int beside = static_cast<int>(std::ceil(params.edge / std::abs(scan.angle_increment)));
  const std::vector<bool> is_own = OwnBeams(beams, own_T, params.padding, beside);
  for (std::size_t i = 0; i < is_own.size(); ++i) {
    if (is_own[i]) beams.beams[i] = {beams.beams[i].direction_T, kNothing, false};
  }
  return beams;
}

/// The box about the points whose sides they lie on best, turned in steps of half a degree: the
/// smallest sum of distances to the next side. The smallest area would not do, which is the same
/// for many boxes about two sides of a thing [Zhang, Xu, Dong, Dolan 2017, "Efficient L-Shape
/// Fitting for Vehicle Detection Using Laser Scanners", IEEE IV].
void Enclose(TrayThing* thing) {
  constexpr int kSteps = 180;  // of a quarter turn
  double least = kEndless;
  for (int k = 0; k < kSteps; ++k) {
    const double yaw = geometry::kPi / 2 * k / kSteps;
    const Vector2d x(std::cos(yaw), std::sin(yaw)), y(-x.y(), x.x());
    Vector2d lower = Vector2d::Constant(kEndless), upper = -lower;
    for (const Vector2d& p : thing->points_T) {
      lower = lower.cwiseMin(Vector2d(p.dot(x), p.dot(y)));
      upper = upper.cwiseMax(Vector2d(p.dot(x), p.dot(y)));
    }
    double sum = 0.0;
    for (const Vector2d& p : thing->points_T) {
      const Vector2d p_B(p.dot(x), p.dot(y));
      sum += (p_B - lower).cwiseMin(upper - p_B).minCoeff();
    }
    if (sum >= least) continue;
    least = sum;
    const Vector2d size = upper - lower, middle = (lower + upper) / 2;
    const Vector2d p_TB = middle.x() * x + middle.y() * y;
    const bool is_long = size.x() >= size.y();
    thing->X_TB = {p_TB.x(), p_TB.y(), is_long ? yaw : yaw + geometry::kPi / 2};
    thing->size = is_long ? size : Vector2d(size.y(), size.x());
  }
}

/// Groups of beams whose ends are linked by steps of at most `gap`.
std::vector<TrayThing> ThingsOf(const TrayBeams& beams, const std::vector<int>& which,
                                const TrayParams& params) {
  std::vector<TrayThing> things;
  std::vector<int> left = which;
  while (!left.empty()) {
    std::vector<int> group{left.front()};
    left.erase(left.begin());
    for (std::size_t next = 0; next < group.size(); ++next) {
      const Vector2d p = beams.EndOf(group[next]);
      const auto far = std::stable_partition(left.begin(), left.end(), [&](int beam) {
        return (beams.EndOf(beam) - p).norm() > params.gap;
      });
      group.insert(group.end(), far, left.end());
      left.erase(far, left.end());
    }
    if (static_cast<int>(group.size()) < params.min_beams) continue;
    std::sort(group.begin(), group.end());
    TrayThing& thing = things.emplace_back();
    for (const int beam : group) thing.points_T.push_back(beams.EndOf(beam));
    Enclose(&thing);
  }
  return things;
}

bool Fits(const BeamFit& fit, const TrayParams& params) {
  return static_cast<int>(fit.on.size()) >= params.min_beams && fit.ShareOn() >= params.matching;
}

/// Beams that end on the tray and on no object yet.
class FreeBeams {
 public:
  explicit FreeBeams(const TrayBeams& beams) {
    for (std::size_t i = 0; i < beams.beams.size(); ++i) {
      if (beams.beams[i].is_on_tray) free_.insert(static_cast<int>(i));
    }
  }
  void Take(const std::vector<int>& beams) {
    for (const int beam : beams) free_.erase(beam);
  }
  std::vector<int> All() const { return {free_.begin(), free_.end()}; }

 private:
  std::set<int> free_;
};

/// Whether one of the things left is the object, elsewhere: then the one that fits best, and which
/// beams end on it.
bool FindMoved(const TrayBeams& beams, const std::vector<TrayThing>& things, const Slice& slice,
               const TrayParams& params, TrayObject* object, std::vector<int>* near) {
  const Eigen::Vector3d believed = object->X_TO.translation;
  double best = 0.0;
  for (const TrayThing& thing : things) {
    constexpr int kMaxSteps = 100;
    const Vector2d shift =
        FitShift(thing.points_T, slice, ShiftBehind(thing.points_T, beams.p_TL, slice), kMaxSteps);
    const Slice moved = Shifted(slice, shift);
    const BeamFit fit = FitBeams(beams, moved, params.tolerance);
    // A part of another thing may look like it: then too many beams are left.
    const bool is_whole = thing.num_beams() - static_cast<int>(fit.on.size()) < params.min_beams;
    if (!is_whole || !Fits(fit, params) || fit.ShareOn() <= best) continue;
    best = fit.ShareOn();
    *near = BeamsNear(beams, moved, params.tolerance);
    object->X_TO.translation = believed + Eigen::Vector3d(shift.x(), shift.y(), 0.0);
  }
  return best > 0.0;
}

/// What stands where it is believed, but for some millimetres: to where its beams say, if that is
/// farther than they err.
void Refine(const TrayBeams& beams, const std::vector<int>& near, const Slice& slice,
            const TrayParams& params, TrayObject* object) {
  constexpr int kMaxSteps = 10;   // that little is left of a small shift
  constexpr double kErr = 0.003;  // [m]
  std::vector<Vector2d> points_T;
  for (const int beam : near) points_T.push_back(beams.EndOf(beam));
  const Vector2d shift = FitShift(points_T, slice, Vector2d::Zero(), kMaxSteps);
  if (shift.norm() < kErr) return;
  if (!Fits(FitBeams(beams, Shifted(slice, shift), params.tolerance), params)) return;
  object->X_TO.translation += Eigen::Vector3d(shift.x(), shift.y(), 0.0);
}

/// Where it is believed, if it is not somewhere else.
TrayObject Judge(const TrayBeams& beams, const BelievedOnTray& believed, const Slice& slice,
                 const TrayParams& params, FreeBeams* free) {
  TrayObject object{believed.name, TrayState::kUnknown, believed.X_TO, 0};
  const BeamFit fit = FitBeams(beams, slice, params.tolerance, believed.is_box);
  const auto num_on = static_cast<int>(fit.on.size());
  if (num_on + fit.num_through < params.min_beams) return object;  // not to be seen
  object.state = Fits(fit, params) ? TrayState::kInPlace : TrayState::kMissing;
  if (object.state != TrayState::kInPlace) return object;
  object.num_beams = num_on;
  const std::vector<int> near = BeamsNear(beams, slice, params.tolerance, believed.is_box);
  free->Take(near);
  if (!believed.is_box && !near.empty()) Refine(beams, near, slice, params, &object);
  return object;
}

}  // namespace

TrayReading ReadTray(const robot::ScanReading& scan, const Pose3& X_TL, const Polygon& tray_T,
                     const std::vector<BelievedOnTray>& believed, const TrayParams& params,
                     const std::vector<Polygon>& own_T) {
  HIRES_CHECK(geometry::TiltOf(X_TL.rotation) <= kLevelLaser,
              "the tray's laser leans over the tray");
  const TrayBeams beams = BeamsOf(scan, X_TL, tray_T, own_T, params);
  FreeBeams free(beams);
  TrayReading reading;
  reading.things = ThingsOf(beams, free.All(), params);
  std::vector<Slice> slices;
  for (const BelievedOnTray& one : believed) {
    slices.push_back(SliceAt(X_TL.translation.z(), params.thickness, one.shapes_O, one.X_TO));
    reading.objects.push_back(Judge(beams, one, slices.back(), params, &free));
  }
  for (std::size_t i = 0; i < believed.size(); ++i) {
    TrayObject& object = reading.objects[i];
    std::vector<int> near;
    if (object.state == TrayState::kMissing && !believed[i].is_box &&
        FindMoved(beams, ThingsOf(beams, free.All(), params), slices[i], params, &object, &near)) {
      object.state = TrayState::kMoved;
      object.num_beams = static_cast<int>(near.size());
      free.Take(near);
    }
  }
  reading.surplus = ThingsOf(beams, free.All(), params);
  return reading;
}

std::vector<Polygon> SliceAt(double height, double thickness,
                             const std::vector<geometry::Collision>& shapes_O, const Pose3& X_TO) {
  std::vector<Polygon> slice;
  for (const geometry::Collision& shape_O : shapes_O) {
    const auto outline = geometry::OutlineInBand(shape_O.shape, X_TO * shape_O.X_BS,
                                                 height - thickness / 2, height + thickness / 2);
    if (outline) slice.push_back(*outline);
  }
  return slice;
}

}  // namespace hires::sensing
