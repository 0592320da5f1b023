#include "hires/base/files/own_input.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "hires/base/error.h"

namespace hires::base {

void RefuseOwnInput(const std::string& option, const std::string& output, const std::string& what,
                    const std::string& input) {
  std::error_code none_there;
  // A terminal is read and written, and loses nothing.
  if (!std::filesystem::is_regular_file(output, none_there)) return;
  if (!std::filesystem::equivalent(output, input, none_there)) return;
  throw ConfigError(
      fmt::format("{} {}: would write over the {}; name another file", option, output, what));
}

}  // namespace hires::base
