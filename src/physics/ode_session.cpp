#include "physics/ode_session.h"

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace hires::physics {
namespace {

constexpr std::size_t kMessagesKept = 100;

struct ThreadMessages {
  std::vector<std::string> kept;
  std::size_t num_dropped{0};
};
thread_local ThreadMessages messages;

std::string Format(const char* kind, int number, const char* format, va_list arguments) {
  std::array<char, 512> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  return std::string("ODE ") + kind + " " + std::to_string(number) + ": " + text.data();
}

void KeepMessage(int number, const char* format, va_list arguments) {
  if (messages.kept.size() >= kMessagesKept) {
    ++messages.num_dropped;
    return;
  }
  messages.kept.push_back(Format("message", number, format, arguments));
}

// ODE ends the process when these two return.
[[noreturn]] void ThrowError(int number, const char* format, va_list arguments) {
  throw std::logic_error(Format("error", number, format, arguments));
}

[[noreturn]] void ThrowDebug(int number, const char* format, va_list arguments) {
  throw std::logic_error(Format("internal error", number, format, arguments));
}

void InitProcess() {
  dSetMessageHandler(&KeepMessage);
  dSetErrorHandler(&ThrowError);
  dSetDebugHandler(&ThrowDebug);
  if (dInitODE2(dInitFlagManualThreadCleanup) == 0) {
    throw std::runtime_error("ODE does not start: dInitODE2 failed");
  }
}

struct ThreadData {
  ThreadData() {
    if (dAllocateODEDataForThread(dAllocateMaskAll) == 0) {
      throw std::runtime_error("ODE does not start in this thread: no memory for its data");
    }
  }
  ~ThreadData() { dCleanupODEAllDataForThread(); }
};

}  // namespace

void EnsureOdeIsReady() {
  static std::once_flag once;
  thread_local bool is_ready = false;
  if (is_ready) return;
  std::call_once(once, InitProcess);
  thread_local const ThreadData data;
  is_ready = true;
}

std::vector<std::string> TakeOdeMessages() {
  std::vector<std::string> taken = std::move(messages.kept);
  if (messages.num_dropped > 0) {
    taken.push_back("ODE: " + std::to_string(messages.num_dropped) + " more messages");
  }
  messages = {};
  return taken;
}

}  // namespace hires::physics
