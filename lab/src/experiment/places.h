#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/src/experiment/report.h"
#include "lab/src/place/place_moment.h"
#include "hires/simulation/self_localisation.h"
#include "hires/skills/lost_watch.h"

namespace hires::lab {

/// @param lost  what makes it too unsure to drive
PlaceMoment MomentOf(const simulation::SelfLocaliser& localiser, const skills::LostParams& lost);

/// Of all moments; what is asked of none is no number.
TextTable PlaceTable(const PlaceTrail& moments);
std::vector<Measure> PlaceMeasures(const PlaceTrail& moments);

constexpr double kElsewhere = 0.5;  ///< [m] a robot that errs more takes itself to be elsewhere

/// What becomes of drives on which the robot takes itself to be elsewhere.
class LostTally {
 public:
  void Add(const PlaceTrail& drive);
  TextTable Table() const;
  std::vector<Measure> Measures() const;

 private:
  int num_drives_{0};
  int num_astray_{0};    // that took themselves to be elsewhere at some moment; of these ...
  int num_noticed_{0};   // ... were lost at some moment
  int num_found_{0};     // ... were sure of the right place in the end
  int num_deceived_{0};  // ... were sure of a wrong one
  long num_moments_{0}, num_lost_{0}, num_wrong_and_sure_{0};
  std::vector<double> until_found_;  // [s] from being wrong first to being right for good
};

}  // namespace hires::lab
