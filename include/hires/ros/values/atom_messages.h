#pragma once

#include <hires/Atom.h>

#include <vector>

#include "hires/base/action.h"

namespace hires_ros {

hires::Atom ToMsg(const hires::base::Atom& atom);
std::vector<hires::Atom> ToMsg(const std::vector<hires::base::Atom>& atoms);
std::vector<hires::base::Atom> FromMsg(const std::vector<hires::Atom>& atoms);

}  // namespace hires_ros
