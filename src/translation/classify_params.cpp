#include "hires/translation/classify_params.h"

namespace hires::translation {

using base::Between;

ClassifyParams ReadClassifyParams(base::ParamReader in) {
  hires::translation::ClassifyParams params;
  params.area_distance = in.Get("area_distance", Between(0.01, 5.0));
  params.area_yaw = in.Get("area_yaw", Between(0.01, 3.2));
  params.tucked_tolerance = in.Get("tucked_tolerance", Between(0.01, 3.2));
  params.posture_tolerance = in.Get("posture_tolerance", Between(0.01, 3.2));
  params.torso_tolerance = in.Get("torso_tolerance", Between(0.001, 0.2));
  params.placing_height = in.Get("placing_height", Between(0.005, 1.0));
  params.tray_height = in.Get("tray_height", Between(0.005, 1.0));
  params.hysteresis = in.Get("hysteresis", Between(1.0, 3.0));
  params.placing_hysteresis = in.Get("placing_hysteresis", Between(0.0, 0.2));
  return params;
}

}  // namespace hires::translation
