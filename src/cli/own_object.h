#pragma once

#include <string>

#include "hires/imagination/imagination_setup.h"

namespace hires::cli {

/// What an object is called that was typed by its name or as a file, which is then loaded beside
/// the catalogue's and called by its model.  @throws base::ConfigError as world::LoadObjectModel.
std::string NameOf(const std::string& object, imagination::SetupConfig* setup);

}  // namespace hires::cli
