#pragma once

#include <hires/ImagineFeedback.h>
#include <hires/ImagineResult.h>
#include <hires/Prediction.h>
#include <hires/RolloutRecord.h>

#include "hires/imagination/report.h"
#include "hires/imagination/rollout_result.h"

/// What imagination found, as messages and back. Every float64 survives both ways bit for bit.
namespace hires_ros {

namespace msg = ::hires;

msg::RolloutRecord ToMsg(const hires::imagination::RolloutResult& result, int index);
/// @throws hires::base::ConfigError for an unknown outcome, or joints that do not pair up.
hires::imagination::RolloutResult FromMsg(const msg::RolloutRecord& record);

msg::Prediction ToMsg(const hires::imagination::Prediction& prediction);
hires::imagination::Prediction FromMsg(const msg::Prediction& prediction);
msg::ImagineResult ToMsg(const hires::imagination::Report& report);
hires::imagination::Report FromMsg(const msg::ImagineResult& result);
msg::ImagineFeedback ToMsg(const hires::imagination::Interim& interim);
hires::imagination::Interim FromMsg(const msg::ImagineFeedback& feedback);

}  // namespace hires_ros
