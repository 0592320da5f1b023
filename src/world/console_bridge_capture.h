#pragma once

#include <console_bridge/console.h>

#include <mutex>
#include <string>
#include <vector>

namespace hires::world {

/// urdfdom says what is wrong only on a console that all threads share. This takes that console for
/// itself, one thread at a time, and keeps the errors instead of printing them.
class ConsoleBridgeCapture : public console_bridge::OutputHandler {
 public:
  ConsoleBridgeCapture();
  ~ConsoleBridgeCapture() override;
  ConsoleBridgeCapture(const ConsoleBridgeCapture&) = delete;
  ConsoleBridgeCapture& operator=(const ConsoleBridgeCapture&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* file,
           int line) override;

  const std::vector<std::string>& errors() const { return errors_; }

 private:
  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* before_;
  std::vector<std::string> errors_;
};

}  // namespace hires::world
