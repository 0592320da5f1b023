#pragma once

#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/sparql.h"
#include "hires/world/named_area.h"

namespace hires::loop {

/// What an area file or --area says, as knowledge files say it: an Area with its Pose. Areas that
/// `known` has, in whatever case, are left out.
std::vector<knowledge::Fluent> AreaFluents(const std::vector<world::NamedArea>& areas,
                                           const knowledge::FluentView& known);

}  // namespace hires::loop
