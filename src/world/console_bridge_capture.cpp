#include "world/console_bridge_capture.h"

namespace hires::world {
namespace {

std::mutex& ConsoleMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

ConsoleBridgeCapture::ConsoleBridgeCapture()
    : lock_(ConsoleMutex()), before_(console_bridge::getOutputHandler()) {
  console_bridge::useOutputHandler(this);
}

ConsoleBridgeCapture::~ConsoleBridgeCapture() { console_bridge::useOutputHandler(before_); }

void ConsoleBridgeCapture::log(const std::string& text, console_bridge::LogLevel level, const char*,
                               int) {
  if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
}

}  // namespace hires::world
