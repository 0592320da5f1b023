#pragma once

#include <string>

#include "cli/list_rows.h"

namespace hires::cli {

/// Tasks with a method; whole ones, of which no other consists, first.
/// @throws base::ConfigError for a domain that cannot be read.
ListRows TasksOf(const std::string& domain_file);

}  // namespace hires::cli
