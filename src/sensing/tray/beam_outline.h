#pragma once

#include <limits>
#include <vector>

#include "hires/geometry/polygon.h"

namespace hires::sensing {

constexpr double kEndless = std::numeric_limits<double>::infinity();  ///< [m]

/// One beam of a planar laser, in the tray's plane.
struct TrayBeam {
  Eigen::Vector2d direction_T{1.0, 0.0};  ///< of length 1
  double range{kEndless};                 ///< [m]; NaN: says nothing
  bool is_on_tray{false};                 ///< where it ends
};

struct TrayBeams {
  Eigen::Vector2d p_TL{0.0, 0.0};
  std::vector<TrayBeam> beams;
  Eigen::Vector2d EndOf(int beam) const {
    return p_TL + beams[beam].range * beams[beam].direction_T;
  }
};

/// Several convex outlines: the slice of a thing at the height of the scan.
using Slice = std::vector<geometry::Polygon>;

Slice Shifted(const Slice& slice, const Eigen::Vector2d& by);

/// How the beams fit to a thing there.
struct BeamFit {
  std::vector<int> on;  ///< beams that end on its outline
  int num_through{0};   ///< that go on where it should be
  int num_before{0};    ///< that end before they reach it
  double ShareOn() const {
    const double reached = static_cast<double>(on.size()) + num_through;
    return reached > 0.0 ? static_cast<double>(on.size()) / reached : 0.0;
  }
};

/// @param tolerance  [m] along the beam.
/// @param is_filled  what ends within the outline is on it, too.
BeamFit FitBeams(const TrayBeams& beams, const Slice& slice, double tolerance,
                 bool is_filled = false);

/// Beams that end as near as `tolerance` [m] to the thing's outline, also where they graze it.
/// @param is_filled  as above.
std::vector<int> BeamsNear(const TrayBeams& beams, const Slice& slice, double tolerance,
                           bool is_filled = false);

/// The shift that puts the slice behind the points, as seen from the laser: where to begin FitShift
/// with what may be anywhere.  @pre as FitShift.
Eigen::Vector2d ShiftBehind(const std::vector<Eigen::Vector2d>& points_T,
                            const Eigen::Vector2d& p_TL, const Slice& slice);

/// The shift of the slice that lays its outline through the points best, by repeated nearest
/// points.
/// @pre there are points, and the slice has an outline.
Eigen::Vector2d FitShift(const std::vector<Eigen::Vector2d>& points_T, const Slice& slice,
                         Eigen::Vector2d begin, int max_steps);

}  // namespace hires::sensing
