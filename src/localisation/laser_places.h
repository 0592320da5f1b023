#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::localisation {

/// Where lasers sit on a robot, as the two poses of each scan's line tell. Two lasers that are
/// logged under one name have two places, each the same to the digits in all its lines; where a
/// mapper has corrected one of the poses, hardly any two lines agree.
class LaserPlaces {
 public:
  void Take(const geometry::Pose2& X_BL);

  /// Whether some differ from the first by more than 0.05 m or 0.05 rad, or are more than 3 m from
  /// the base.
  bool do_vary() const { return do_vary_; }

  /// Of at most four lasers that stay where they are, with a twentieth of the scans each and ten at
  /// least: where they are and how many scans each has, for people. Empty: it is not so.
  std::string TextOfLasers() const;

 private:
  struct Place {
    geometry::Pose2 X_BL;
    int num_scans{0};
  };
  std::vector<Place> places_;  // one more than can be lasers: they are none
  int num_scans_{0};
  bool do_vary_{false}, is_any_far_{false};
};

}  // namespace hires::localisation
