#pragma once

#include <string>
#include <vector>

#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"

namespace hires::imagination {

/// What imagination in this process needs: as the client's configuration says.
struct LocalSetup {
  ClientConfig config;
  ImaginationSetup setup;
};
/// @param client_config     a file like config/imagination_client.yaml.
/// @param action_libraries  files with more actions.
/// @throws base::ConfigError naming file and key.
inline LocalSetup LoadLocalSetup(const std::string& client_config,
                                 const std::vector<std::string>& action_libraries) {
  LocalSetup local;
  local.config = ReadClientConfig(client_config);
  SetupConfig files = ReadSetupConfig(local.config.scene);
  files.action_libraries = action_libraries;
  local.setup = LoadImaginationSetup(files);
  return local;
}

}  // namespace hires::imagination
