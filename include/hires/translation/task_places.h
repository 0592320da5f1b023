#pragma once

#include <string>
#include <vector>

#include "hires/translation/translator.h"

namespace hires::translation {

/// What the tasks and plans that are under way are about and a camera can look at: placing areas
/// (named, or those of the furniture, guest, seat, object or standing area that is named) and
/// objects on the tray, lower case, in the order in which fluents name them, each once.
/// @pre the context has an ontology.
std::vector<std::string> PlacesOfTasks(const TranslatorContext& context,
                                       const knowledge::FluentView& fluents);

}  // namespace hires::translation
