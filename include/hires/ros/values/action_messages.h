#pragma once

#include <hires/ActionCall.h>
#include <hires/ActionTemplate.h>

#include "hires/base/action.h"

namespace hires_ros {

namespace msg = ::hires;

msg::ActionCall ToMsg(const hires::base::ActionCall& call);
hires::base::ActionCall FromMsg(const msg::ActionCall& call);
msg::ActionTemplate ToMsg(const hires::base::ActionTemplate& action);
hires::base::ActionTemplate FromMsg(const msg::ActionTemplate& action);

}  // namespace hires_ros
