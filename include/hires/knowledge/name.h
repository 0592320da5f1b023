#pragma once

#include <string>

namespace hires::knowledge {

/// Of a sentence what the store keeps as a name: control characters are spaces, and its end is left
/// out where it is too long.
std::string AsName(std::string sentence);

}  // namespace hires::knowledge
