#include "robot/urdf/told.h"

#include <fmt/format.h>

#include "hires/base/log.h"
#include "hires/base/text.h"

namespace hires::robot {

void Told::Add(int line, const std::string& name, const std::string& what) {
  if (names_.empty()) first_ = fmt::format("line {}{}", line, what.empty() ? "" : ": " + what);
  names_.push_back(name);
}

void Told::Tell(const std::string& where, const char* key, const char* reason) const {
  if (names_.empty()) return;
  base::Log(base::LogLevel::kWarn,
            fmt::format("urdf={} {}={} count={} first=\"{}\" reason=\"{}\"", where, key,
                        base::Join(names_, ","), names_.size(), first_, reason));
}

}  // namespace hires::robot
