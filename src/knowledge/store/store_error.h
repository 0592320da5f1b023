#pragma once

#include <SQLiteCpp/Exception.h>

#include <string>
#include <utility>

#include "hires/base/error.h"

namespace hires::knowledge {

inline constexpr int kBusyTimeout = 5000;  ///< [ms] how long SQLite tries before it says "busy"

/// What SQLite reported about the store at `path`, in words that say what to do.
base::ConfigError StoreError(const std::string& path, const SQLite::Exception& error);

/// Calls `call`; what SQLite throws in it becomes a ConfigError that names `path`.
template <typename Call>
auto Guarded(const std::string& path, Call&& call) -> decltype(call()) {
  try {
    return std::forward<Call>(call)();
  } catch (const SQLite::Exception& error) {
    throw StoreError(path, error);
  }
}

/// The file holds something that no store wrote there.
[[noreturn]] void FailDamaged(const std::string& what);

}  // namespace hires::knowledge
