#pragma once

#include <optional>

#include "hires/base/failure.h"
#include "hires/robot/observation.h"

namespace hires::skills {

/// When a robot is lost, and what driving skills do then: they stop, and turn where the base's
/// laser shows that there is room, so that it sees more.
struct LostParams {
  double max_position_sd{0.3};  ///< [m] of the place that it is told, in the worst direction
  double patience{60.0};        ///< [s] that it waits for a better one
  double turning{0.4};          ///< [rad/s]
  double room{0.1};             ///< [m] that must be free round what it sweeps by turning
};

/// Tells a driving skill whether the robot knows where it is. A value.
class LostWatch {
 public:
  enum class State {
    kSure,
    kFound,  ///< again: what was planned before is of another place
    kLost,
    kGivenUp
  };

  explicit LostWatch(const LostParams& params) : params_(params) {}

  State Look(const robot::Observation& observation);
  bool is_lost() const { return since_.has_value(); }
  /// @pre it has given up
  base::Failure Why(const robot::Observation& observation) const;

 private:
  LostParams params_;
  std::optional<double> since_;  // [s]
};

}  // namespace hires::skills
