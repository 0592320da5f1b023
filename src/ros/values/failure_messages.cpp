#include "hires/ros/values/failure_messages.h"

#include <fmt/format.h>

namespace hires_ros {

msg::Failure ToMsg(const hires::base::Failure& failure) {
  msg::Failure out;
  out.code = static_cast<std::uint16_t>(failure.code);
  out.subjects = failure.subjects;
  out.detail = failure.detail;
  return out;
}

hires::base::Failure FromMsg(const msg::Failure& failure) {
  const auto code = hires::base::FailureCodeOf(failure.code);
  if (code) return {*code, failure.subjects, failure.detail};
  return {hires::base::FailureCode::kOther, failure.subjects,
          fmt::format("code {}, unknown to this version{}{}", failure.code,
                      failure.detail.empty() ? "" : ": ", failure.detail)};
}

}  // namespace hires_ros
