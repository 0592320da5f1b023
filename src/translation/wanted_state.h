#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/translation/translator.h"

namespace hires::translation {

/// What a list of atoms asks for; names in lower case.
struct WantedState {
  std::string robot_area;
  std::map<std::string, std::string> arm_postures;  ///< by arm
  std::string torso_posture;                        ///< or empty
  std::map<std::string, std::string> holders;       ///< object -> arm
  std::map<std::string, std::string> places;        ///< object -> placing area or tray
};

/// @throws base::ConfigError naming the atom, as StateOf.
WantedState ReadWanted(const TranslatorContext& context, const std::vector<base::Atom>& atoms);

}  // namespace hires::translation
