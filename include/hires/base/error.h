#pragma once

#include <stdexcept>

namespace hires::base {

/// What somebody wrote in a file, a parameter or a request is wrong. The text says where, what
/// came, what was wanted and what to do; programs print it and exit, services send it back.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hires::base
