#pragma once

#include <stdexcept>
#include <string>

namespace hires::base {

[[noreturn]] inline void FailCheck(const char* file, int line, const char* condition,
                                   const std::string& text) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + text +
                         " (broken: " + condition + ")");
}

}  // namespace hires::base

/// Guards a precondition: the caller is wrong if this throws std::logic_error.
#define HIRES_CHECK(condition, text) \
  ((condition) ? void(0) : ::hires::base::FailCheck(__FILE__, __LINE__, #condition, (text)))
