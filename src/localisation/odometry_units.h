#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/robot/lent_time.h"

namespace hires::localisation {

/// Whether poses of odometry, as a file has them, may be in another unit than metres and radians:
/// where more than half of the moves, or of the turning, are faster than any robot, they are.
class OdometryUnits {
 public:
  void Take(double x, double y, double theta, double time);

  /// A question with the factor for what is suspected; empty: nothing is.
  std::string Doubt() const;

 private:
  struct Reading {
    double x, y, theta, time;
  };
  std::optional<Reading> last_;
  robot::LentTime time_of_moves_, time_of_turns_;
  std::vector<double> speeds_;                 // [unit/s] of moves
  int num_too_fast_{0};                        // of those
  double turned_{0.0}, turned_too_fast_{0.0};  // in all
  int num_too_fast_turns_{0};
};

}  // namespace hires::localisation
