#pragma once

#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/sparql.h"
#include "hires/world/named_area.h"

namespace hires::loop {

/// What an area file or --area says, as knowledge files say it: an area, of the concept that its
/// name begins with (FloorArea, PlacingArea, SittingArea; else Area), with its Pose. Areas that
/// `known` has, in whatever case, are not said again, but their pose is: it is where the area is in
/// this map.
/// @throws base::ConfigError  all names that a task could not name, or that `known` has for what is
///                            no area
std::vector<knowledge::Fluent> AreaFluents(const std::vector<world::NamedArea>& areas,
                                           const knowledge::FluentView& known,
                                           const knowledge::Ontology& ontology);

}  // namespace hires::loop
