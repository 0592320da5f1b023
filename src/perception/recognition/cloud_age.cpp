#include "hires/perception/cloud_age.h"

namespace hires::perception {

CloudAge AgeOf(double stamp, double now, const CloudAgeParams& params) {
  if (now - stamp > params.max_age) return CloudAge::kTooOld;
  if (stamp - now > params.max_ahead) return CloudAge::kAhead;
  return CloudAge::kTimely;
}

}  // namespace hires::perception
