#pragma once

#include <string>
#include <vector>

#include "hires/translation/translator.h"
#include "hires/world/standing.h"

namespace hires::translation {

/// Which files symbols and geometry are about.
struct ContextFiles {
  std::string world;
  std::string robot;                  ///< as robot::LoadAnyRobot
  std::string objects;                ///< the catalogue of loose objects
  std::vector<std::string> ontology;  ///< Turtle or RDF/XML files
  world::StandingCriterion standing;
  ClassifyParams classify;
};

/// @throws base::ConfigError naming file, element and remedy.
TranslatorContext LoadContext(const ContextFiles& files);

}  // namespace hires::translation
