#include "hires/skills/lost_watch.h"

#include <fmt/format.h>

namespace hires::skills {

LostWatch::State LostWatch::Look(const robot::Observation& observation) {
  // Written so that what is no number is lost.
  if (observation.position_sd <= params_.max_position_sd) {
    if (!since_) return State::kSure;
    since_.reset();
    return State::kFound;
  }
  if (!since_) since_ = observation.time;
  return observation.time - *since_ > params_.patience ? State::kGivenUp : State::kLost;
}

base::Failure LostWatch::Why(const robot::Observation& observation) const {
  return {base::FailureCode::kLocalisationLost,
          {},
          fmt::format("sd {:.2f} m for {:.0f} s", observation.position_sd,
                      observation.time - since_.value_or(observation.time))};
}

}  // namespace hires::skills
