#include "hires/base/topic_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "hires/base/log.h"
#include "hires/base/process.h"

namespace hires::base {
namespace {

constexpr double kPeriod = 1.0;           // [s] between warnings of one topic
constexpr double kCalm = 10.0;            // [s] without a reason, after which it is a new one
constexpr std::size_t kReasonsKept = 16;  // of one topic, whatever names messages bring
constexpr char kNumbers[] = "0123456789+-.";

std::string WithoutNumbers(std::string text) {
  const auto is_of_number = [](char c) {
    return std::string_view(kNumbers).find(c) != std::string_view::npos;
  };
  text.erase(std::remove_if(text.begin(), text.end(), is_of_number), text.end());
  return text;
}

}  // namespace

void TopicWarnings::Tell(const std::string& topic, const std::string& what,
                         const std::string& why) {
  Tell(topic, what, why, SteadyNow());
}

void TopicWarnings::Tell(const std::string& topic, const std::string& what, const std::string& why,
                         double now) {
  Topic& told = topics_[topic];
  const std::string words = WithoutNumbers(what + ' ' + why);
  if (told.reasons.size() >= kReasonsKept && told.reasons.count(words) == 0) told.reasons.clear();
  Reason& reason = told.reasons[words];
  if (now - reason.heard > kCalm) reason = {};
  reason.heard = now;
  if (now < reason.due || now < told.free) return;
  reason.due = now + reason.pause;
  reason.pause *= 2.0;
  told.free = now + kPeriod;
  Log(LogLevel::kWarn, fmt::format("topic={} {} why={}", topic, what, why));
}

}  // namespace hires::base
