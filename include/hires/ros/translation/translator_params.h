#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/control/robot_names.h"
#include "hires/translation/translator.h"

namespace hires_ros {

/// Which files symbols and geometry are about; config/translator.yaml.
struct TranslatorParams {
  std::string scene;                  ///< scene.yaml: names world, robot and objects
  std::vector<std::string> ontology;  ///< Turtle or RDF/XML files
  std::string world, robot, objects;  ///< instead of the scene's where not empty
  hires::control::RobotNames names;
};

/// @throws hires::base::ConfigError naming file and key.
TranslatorParams ReadTranslatorParams(const std::string& path);
/// From the private parameters config, world, robot, objects, names.
TranslatorParams LoadTranslatorParams();

/// Loads the files.  @throws hires::base::ConfigError naming file, element and remedy.
hires::translation::TranslatorContext LoadTranslatorContext(const TranslatorParams& params);

/// Keys that the nodes translator and world_tracker share.
void ReadTranslatorFiles(const std::string& path, hires::base::ParamReader* in,
                         TranslatorParams* params);

}  // namespace hires_ros
