#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"

namespace hires::localisation {

/// Where a robot takes itself to be, and how sure it is.
struct PlaceBelief {
  geometry::Pose2 X_MB;
  /// [m^2, m rad, rad^2] of x, y along the map's axes and yaw.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

struct OutlineMatchParams {
  double reach{3.0};         ///< [m] from the robot: echoes farther away tell little of its place
  double gate{0.1};          ///< [m] from an outline: an echo beyond is of something else
  double noise{0.02};        ///< [m] sd of an echo against the outline that it is of
  double independent{0.04};  ///< [rad] so far apart two beams err each for itself
  double least_view{0.1};    ///< [rad] of view that outlines must fill before they say anything
};

/// What a scan says of a belief.
struct Correction {
  enum class Verdict {
    kCorrected,
    kSilent,      ///< outlines fill too little of the view, the belief is too wide to tell them
                  ///< apart (half-way to the reach its sd exceeds half the gate), or the search
                  ///< does not settle
    kContradicts  ///< belief and scan are more than 4 sd apart
  };
  Verdict verdict{Verdict::kSilent};
  PlaceBelief belief;  ///< as it was, unless corrected
};

/// Corrects a belief by what a planar laser sees of outlines that are known: Gauss-Newton from
/// points to the nearest face that looks at the laser, with the belief as prior [point to line:
/// Censi 2008, "An ICP variant using a point-to-line metric", ICRA]. What counts is the view that
/// outlines fill, not how many beams a laser has. Constant.
class OutlineMatch {
 public:
  /// @param outlines_M  of all that stands in the laser's plane, in map; in either sense of turn.
  OutlineMatch(const std::vector<geometry::Polygon>& outlines_M, const OutlineMatchParams& params);

  /// @param prior      of a covariance that is positive definite, or no number: then it is silent.
  /// @param echoes_B   [m] in the base, with the robot at `prior`.
  /// @param laser_B    [m] where they were seen from.
  /// @param increment  [rad] between two beams, > 0.
  Correction Correct(const PlaceBelief& prior, const std::vector<Eigen::Vector2d>& echoes_B,
                     const Eigen::Vector2d& laser_B, double increment) const;

 private:
  struct Face {
    Eigen::Vector2d from, along;  // [m] in map; of unit length
    double length;                // [m]
    Eigen::Vector2d normal;       // outwards
  };
  struct Meeting {
    Eigen::Vector2d direction;  // from the face to the echo, of unit length
    double distance;            // [m] along it
  };
  static Meeting Meet(const Face& face, const Eigen::Vector2d& echo_M);
  bool IsNarrow(const PlaceBelief& prior) const;
  /// What of all outlines comes into question round a place.
  std::vector<Face> FacesNear(const Eigen::Vector2d& place_M) const;
  /// Of each echo the face that it is of, or null.
  std::vector<const Face*> Match(const std::vector<Face>& faces, const geometry::Pose2& X_MB,
                                 const std::vector<Eigen::Vector2d>& echoes_B,
                                 const Eigen::Vector2d& laser_B) const;

  OutlineMatchParams params_;
  std::vector<Face> faces_;
};

}  // namespace hires::localisation
