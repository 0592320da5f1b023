#pragma once

#include <string>
#include <vector>

#include "hires/perception/cloud_age.h"
#include "hires/perception/recogniser.h"

namespace hires::perception {

struct RecogniserConfig {
  std::string objects{};                ///< file of the catalogue of objects
  std::vector<KnownModel> catalogue{};  ///< by label
  RecogniserParams params{};
  CloudAgeParams age{};  ///< of clouds that come from a running camera; files have no age
};

/// Reads a file like config/recogniser.yaml, and the models that it leads to.
/// @param objects  another catalogue than the file says; empty: the file's.
/// @throws base::ConfigError naming file and key.
RecogniserConfig ReadRecogniserConfig(const std::string& path, const std::string& objects = "");

}  // namespace hires::perception
