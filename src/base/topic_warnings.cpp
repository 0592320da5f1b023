#include "hires/base/topic_warnings.h"

#include <fmt/format.h>

#include "hires/base/log.h"
#include "hires/base/process.h"

namespace hires::base {

void TopicWarnings::Tell(const std::string& topic, const std::string& what,
                         const std::string& why) {
  constexpr double kPeriod = 1.0;  // [s]
  const double now = SteadyNow();
  const auto told = told_.find(topic);
  if (told != told_.end() && now - told->second < kPeriod) return;
  told_[topic] = now;
  Log(LogLevel::kWarn, fmt::format("topic={} {} why={}", topic, what, why));
}

}  // namespace hires::base
