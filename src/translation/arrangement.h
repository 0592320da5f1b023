#pragma once

#include "hires/translation/translator.h"
#include "translation/body.h"
#include "translation/wanted_state.h"

namespace hires::translation {

/// Where objects are, as StateOf says.
/// @throws base::ConfigError if the tray is full.
world::WorldState Arrange(const TranslatorContext& context, const knowledge::FluentView* fluents,
                          const WantedState& wanted, const Body& body);

/// [m] of an object between finger tips: the smaller one of its sides.
double WidthOf(const world::ObjectModel& model);

}  // namespace hires::translation
