#include "hires/navigation/base_guard.h"

namespace hires::navigation {

BaseGuardParams ReadBaseGuardParams(const std::string& path) {
  using base::Between;
  base::ParamReader in = base::ParamReader::FromFile(path);
  BaseGuardParams params;
  params.pose_patience = in.Get("pose_patience", Between(0.02, 10.0));
  params.scan_patience = in.Get("scan_patience", Between(0.02, 10.0));
  params.request_patience = in.Get("request_patience", Between(0.02, 10.0));
  params.command_patience = in.Get("command_patience", Between(0.02, 10.0));
  params.update_patience = in.Get("update_patience", Between(0.02, 10.0));
  params.max_position_sd = in.Get("max_position_sd", Between(0.001, 100.0));
  params.max_yaw_sd = in.Get("max_yaw_sd", Between(0.001, 10.0));
  params.zero_time = in.Get("zero_time", Between(0.0, 60.0));
  params.trailing = in.Get("trailing", Between(0.0, 2.0));
  params.still_speed = in.Get("still_speed", Between(0.0001, 0.1));
  params.braking = ReadBrakingParams(in.Sub("braking"));
  in.RejectUnknownKeys();
  return params;
}

}  // namespace hires::navigation
