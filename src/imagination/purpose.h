#pragma once

#include <string>

#include "hires/actions/catalogue.h"
#include "hires/base/action.h"

namespace hires::imagination {

/// What an action is meant to do with one object; actions that only move the robot have none.
struct Purpose {
  using Kind = actions::Purpose;
  Kind kind{Kind::kNone};
  std::string object;     ///< lower case; empty for kNone
  std::string arm;        ///< that takes it or puts it down, lower case
  std::string area;       ///< kPutOnArea: where, lower case
  double area_edge{0.0};  ///< [m] inside the area's extent where it must not stand
};

/// As the action's description says; kNone for what the catalogue does not know, and where
/// arguments are missing.
Purpose PurposeOf(const actions::Catalogue& catalogue, const base::ActionCall& action);

}  // namespace hires::imagination
