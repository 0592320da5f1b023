#pragma once

#include <string>

namespace hires::base {

/// What is read is not written over by what is made of it.
/// @param option  under which the output was named: "--csv".  @param output  empty: none is wanted.
/// @param what    the input is: "store".
/// @throws ConfigError where both are one file, by whatever paths. Devices may be both.
void RefuseOwnInput(const std::string& option, const std::string& output, const std::string& what,
                    const std::string& input);

}  // namespace hires::base
