#include "hires/ros/imagination/truth_messages.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

std::uint8_t CodeOf(hires::world::Fall fall) {
  switch (fall) {
    case hires::world::Fall::kNone:
      return msg::ObjectTruth::NOT_FALLEN;
    case hires::world::Fall::kLost:
      return msg::ObjectTruth::LOST;
    case hires::world::Fall::kToppled:
      return msg::ObjectTruth::TOPPLED;
    case hires::world::Fall::kDropped:
      return msg::ObjectTruth::DROPPED;
    case hires::world::Fall::kSlid:
      return msg::ObjectTruth::SLID;
  }
  return msg::ObjectTruth::NOT_FALLEN;
}

hires::world::Fall FallOf(std::uint8_t code) {
  for (const auto fall :
       {hires::world::Fall::kNone, hires::world::Fall::kLost, hires::world::Fall::kToppled,
        hires::world::Fall::kDropped, hires::world::Fall::kSlid}) {
    if (CodeOf(fall) == code) return fall;
  }
  throw hires::base::ConfigError(fmt::format("first_fall of a thing is {}, wanted 0 .. 4", code));
}

}  // namespace

msg::ObjectTruth ToMsg(const std::string& name, const hires::simulation::ObjectFate& fate) {
  msg::ObjectTruth out;
  out.name = name;
  out.pose = ToMsg(fate.X_MO);
  out.attached_to = fate.attached_to;
  out.stands = fate.stands;
  out.tilt = fate.tilt;
  out.max_tilt = fate.max_tilt;
  out.falls = static_cast<std::uint32_t>(fate.falls);
  out.first_fall = CodeOf(fate.first_fall);
  return out;
}

hires::simulation::ObjectFate FromMsg(const msg::ObjectTruth& truth) {
  hires::simulation::ObjectFate fate;
  fate.X_MO = FromMsg(truth.pose);
  fate.attached_to = truth.attached_to;
  fate.stands = truth.stands;
  fate.tilt = truth.tilt;
  fate.max_tilt = truth.max_tilt;
  fate.falls = static_cast<int>(truth.falls);
  fate.first_fall = FallOf(truth.first_fall);
  return fate;
}

}  // namespace hires_ros
