#pragma once

#include <string>

namespace hires::base {

/// Messages repeat what came, however long that was: at most 2000 bytes of it, never cut within a
/// UTF-8 character.
std::string Shortened(const std::string& text);

}  // namespace hires::base
