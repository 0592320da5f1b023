#include "sensing/tray/beam_outline.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/segment.h"

namespace hires::sensing {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// [m] along a ray; it enters nowhere if it misses.
struct Chord {
  double enter{kEndless}, leave{-kEndless};
};

/// Of a convex outline, by clipping the ray at each edge.
Chord ChordOf(const Vector2d& from, const Vector2d& direction, const Polygon& outline) {
  double enter = 0.0, leave = kEndless;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
    const double inside = Cross(edge, from - outline[i]), rate = Cross(edge, direction);
    if (rate == 0.0 && inside < 0.0) return {};
    if (rate > 0.0) enter = std::max(enter, -inside / rate);
    if (rate < 0.0) leave = std::min(leave, -inside / rate);
  }
  return enter <= leave ? Chord{enter, leave} : Chord{};
}

Vector2d NearestOn(const Slice& slice, const Vector2d& p) {
  Vector2d nearest = slice.front().front();
  for (const Polygon& outline : slice) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2d q =
          geometry::NearestOnSegment(p, outline[i], outline[(i + 1) % outline.size()]);
      if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
    }
  }
  return nearest;
}

/// The corner that lies farthest in a direction, measured along it.
double Reach(const Slice& slice, const Vector2d& direction) {
  double reach = -kEndless;
  for (const Polygon& outline : slice) {
    for (const Vector2d& corner : outline) reach = std::max(reach, corner.dot(direction));
  }
  return reach;
}

}  // namespace

Slice Shifted(const Slice& slice, const Vector2d& by) {
  Slice shifted = slice;
  for (Polygon& outline : shifted) {
    for (Vector2d& corner : outline) corner += by;
  }
  return shifted;
}

BeamFit FitBeams(const TrayBeams& beams, const Slice& slice, double tolerance, bool is_filled) {
  BeamFit fit;
  for (std::size_t i = 0; i < beams.beams.size(); ++i) {
    const TrayBeam& beam = beams.beams[i];
    if (std::isnan(beam.range)) continue;
    Chord expected;
    for (const Polygon& outline : slice) {
      const Chord chord = ChordOf(beams.p_TL, beam.direction_T, outline);
      expected.enter = std::min(expected.enter, chord.enter);
      expected.leave = std::max(expected.leave, chord.leave);
    }
    if (expected.enter == kEndless) continue;
    if (beam.range > (is_filled ? expected.leave : expected.enter) + tolerance) {
      ++fit.num_through;
    } else if (beam.range < expected.enter - tolerance) {
      ++fit.num_before;
    } else {
      fit.on.push_back(static_cast<int>(i));
    }
  }
  return fit;
}

std::vector<int> BeamsNear(const TrayBeams& beams, const Slice& slice, double tolerance,
                           bool is_filled) {
  std::vector<int> near;
  for (std::size_t i = 0; i < beams.beams.size(); ++i) {
    if (!beams.beams[i].is_on_tray) continue;
    const Vector2d end = beams.EndOf(static_cast<int>(i));
    const bool is_within =
        is_filled && std::any_of(slice.begin(), slice.end(), [&](const Polygon& outline) {
          return geometry::Contains(outline, end);
        });
    if (is_within || (NearestOn(slice, end) - end).norm() <= tolerance) {
      near.push_back(static_cast<int>(i));
    }
  }
  return near;
}

Vector2d ShiftBehind(const std::vector<Vector2d>& points_T, const Vector2d& p_TL,
                     const Slice& slice) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : points_T) middle += p / static_cast<double>(points_T.size());
  // The side of the slice that faces the laser goes to the middle of the points.
  const Vector2d away = (middle - p_TL).normalized(), left(-away.y(), away.x());
  return (middle.dot(away) + Reach(slice, -away)) * away +
         (middle.dot(left) - (Reach(slice, left) - Reach(slice, -left)) / 2) * left;
}

Vector2d FitShift(const std::vector<Vector2d>& points_T, const Slice& slice, Vector2d begin,
                  int max_steps) {
  constexpr double kConverged = 1e-6;  // [m]
  Vector2d shift = begin;
  for (int step = 0; step < max_steps; ++step) {
    Vector2d change = Vector2d::Zero();
    for (const Vector2d& p : points_T) {
      change += (p - shift - NearestOn(slice, p - shift)) / static_cast<double>(points_T.size());
    }
    shift += change;
    if (change.norm() < kConverged) break;
  }
  return shift;
}

}  // namespace hires::sensing
