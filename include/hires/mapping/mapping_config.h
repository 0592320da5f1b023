#pragma once

#include "hires/base/param_reader.h"
#include "hires/localisation/live_scan_params.h"
#include "hires/mapping/mapper.h"

namespace hires::mapping {

/// config/mapping.yaml
struct MappingConfig {
  MapperParams mapper;  ///< gmapping's `delta` is its resolution, `maxRange` its max_range
  double map_update_interval{5.0};  ///< [s] between maps that are drawn
  localisation::LiveScanParams node;
};

/// @throws base::ConfigError naming the key
MappingConfig ReadMappingConfig(base::ParamReader in);

}  // namespace hires::mapping
