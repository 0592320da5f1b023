#include "hires/knowledge/experience.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/base/error.h"

namespace hires::knowledge {
namespace {

std::int64_t Nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

std::string CsvOf(const Dynamics& motion, double time) {
  return fmt::format("0,{},/map,{},{},{},{},{},{}", Nanoseconds(time), motion.v, motion.a, motion.j,
                     motion.angular_v, motion.angular_a, motion.angular_j);
}

}  // namespace

const char* ToString(ToppleState state) {
  switch (state) {
    case ToppleState::kNoTopple:
      return "notopple";
    case ToppleState::kShaking:
      return "shaking";
    case ToppleState::kTopple:
      return "topple";
  }
  return "";
}

ToppleState ParseToppleState(const std::string& text) {
  for (const ToppleState state :
       {ToppleState::kNoTopple, ToppleState::kShaking, ToppleState::kTopple}) {
    if (text == ToString(state)) return state;
  }
  throw base::ConfigError(
      fmt::format("state '{}' is unknown; wanted notopple, shaking or topple", text));
}

std::string CsvOf(const ToppleEpisodePart& part) {
  const std::int64_t now = Nanoseconds(part.time);
  const double middle = part.time - kDynamicsDelay;
  return fmt::format(
      "{},0,{},,{},{},0,{},/base_footprint,{},{},0.0,{},0,0,,0.0,0.0,0.0,{},0,{},/map,{},{},{}",
      now, now, part.episode, ToString(part.state), now, part.alpha, part.deviation,
      CsvOf(part.object, middle), CsvOf(part.base, middle), now, part.x, part.y, part.yaw);
}

}  // namespace hires::knowledge
