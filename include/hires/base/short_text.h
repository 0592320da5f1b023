#pragma once

#include <cstddef>
#include <string>

namespace hires::base {

/// Messages repeat what came, however long that was: at most so many bytes of it and " ...", never
/// cut within a UTF-8 character.
std::string Shortened(const std::string& text, std::size_t at_most = 2000);

}  // namespace hires::base
