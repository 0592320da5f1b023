#include "hires/simulation/laser_params.h"

namespace hires::simulation {

using base::Between;

LaserParams ReadBeams(base::ParamReader* in) {
  LaserParams params;
  params.num_beams = in->Get("beams", Between(2, 10000));
  params.angle_min = in->Get("angle_min", Between(-3.1415, 3.1415));
  params.angle_max = in->Get("angle_max", Between(-3.1415, 3.1415));
  if (params.angle_max <= params.angle_min) in->Fail("angle_max", "wanted more than angle_min");
  params.range_min = in->Get("range_min", Between(0.0, 10.0));
  params.range_max = in->Get("range_max", Between(0.1, 100.0));
  return params;
}

LaserParams ReadLaser(base::ParamReader* in) {
  LaserParams params = ReadBeams(in);
  params.noise = in->Get("noise", Between(0.0, 1.0));
  return params;
}

}  // namespace hires::simulation
