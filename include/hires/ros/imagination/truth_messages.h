#pragma once

#include <hires/ObjectTruth.h>

#include <string>

#include "hires/simulation/truth_record.h"

namespace hires_ros {

namespace msg = ::hires;

msg::ObjectTruth ToMsg(const std::string& name, const hires::simulation::ObjectFate& fate);
hires::simulation::ObjectFate FromMsg(const msg::ObjectTruth& truth);

}  // namespace hires_ros
