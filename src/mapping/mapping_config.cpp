#include "hires/mapping/mapping_config.h"

namespace hires::mapping {
namespace {

using base::Between;

MapperParams ReadMapperParams(base::ParamReader* in) {
  MapperParams params;
  params.resolution = in->Get("delta", Between(0.01, 1.0));
  params.max_range = in->Get("maxRange", Between(1.0, 100.0));
  params.keyframe_step = in->Get("keyframe_step", Between(0.05, 5.0));
  params.local_keyframes = in->Get("local_keyframes", Between(1, 1000));
  params.odometry_sd = in->Get("odometry_sd", Between(0.001, 1.0));
  params.surface_sd = in->Get("surface_sd", Between(0.001, 1.0));
  params.loop_radius = in->Get("loop_radius", Between(0.1, 100.0));
  params.loop_length = in->Get("loop_length", Between(1.0, 1000.0));
  params.min_fit = in->Get("min_fit", Between(0.1, 1.0));
  params.max_linear_speed = in->Get("max_linear_speed", Between(0.01, 100.0));
  params.max_angular_speed = in->Get("max_angular_speed", Between(0.01, 100.0));
  return params;
}

}  // namespace

MappingConfig ReadMappingConfig(base::ParamReader in) {
  MappingConfig config;
  config.mapper = ReadMapperParams(&in);
  base::ParamReader node = in.Sub("node");
  config.map_update_interval = node.Get("map_update_interval", Between(0.1, 3600.0));
  config.node = localisation::ReadLiveScanParams(&node);
  in.RejectUnknownKeys();
  return config;
}

}  // namespace hires::mapping
