#include "robot/quiet_urdf_parser.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <vector>

#include "hires/base/log.h"
#include "hires/base/text.h"

namespace hires::robot {
namespace {

/// While it lives, what the URDF parser prints to the console comes here instead. One at a time in
/// the process, because the console's handler is.
class ConsoleCatcher : public console_bridge::OutputHandler {
 public:
  ConsoleCatcher() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~ConsoleCatcher() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR ? errors_ : warnings_).push_back(text);
  }

  const std::vector<std::string>& errors() const { return errors_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static std::mutex& mutex() {
    static std::mutex the_mutex;
    return the_mutex;
  }

  std::lock_guard<std::mutex> lock_;
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

}  // namespace

urdf::ModelInterfaceSharedPtr ParseUrdfQuietly(const std::string& xml, const std::string& where,
                                               UrdfProblems* problems) {
  ConsoleCatcher console;
  urdf::ModelInterfaceSharedPtr model;
  std::string thrown;
  try {
    model = urdf::parseURDF(xml);
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  if (!model || !console.errors().empty()) {
    std::vector<std::string> reasons = console.errors();
    if (!thrown.empty()) reasons.push_back(thrown);
    problems->Fail(
        0, fmt::format("no valid URDF: {}; correct that element", base::Join(reasons, "; ")));
  }
  for (const std::string& warning : console.warnings()) {
    base::Log(base::LogLevel::kWarn, fmt::format("urdf={} warning=\"{}\"", where, warning));
  }
  return model;
}

}  // namespace hires::robot
