#pragma once

#include <string>

#include "hires/imagination/scheduler.h"
#include "hires/imagination/validated.h"

namespace hires::imagination {

/// config/imagination_client.yaml: what the imagination client and `hires imagine` share.
struct ClientConfig {
  std::string scene;            ///< path of the scene file (see SetupConfig)
  SchedulerParams scheduler;    ///< what a request does not say itself, prices included
  Validated validated;          ///< beyond it answers carry caveats
  int kept_rollouts{4096};      ///< of earlier requests, see KeptRollouts
  double feedback_period{0.2};  ///< [s] between two feedback messages
  double worker_timeout{1.5};   ///< [s] without a sign of life after which a worker counts as lost
};

/// Where the file names no `prices`, prices.yaml beside the scene file, else the one beside `path`.
/// @throws base::ConfigError naming file and key.
ClientConfig ReadClientConfig(const std::string& path);

}  // namespace hires::imagination
