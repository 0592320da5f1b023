#pragma once

#include <hires/Failure.h>

#include "hires/base/failure.h"

namespace hires_ros {

namespace msg = ::hires;

msg::Failure ToMsg(const hires::base::Failure& failure);
/// A number that this version does not know, as a later one may send, becomes kOther with words
/// that name it: what is unknown is told, and nothing is guessed.
hires::base::Failure FromMsg(const msg::Failure& failure);

}  // namespace hires_ros
