#pragma once

#include <string>

#include "hires/base/action.h"

namespace hires::imagination {

/// What an action is meant to do with one object; actions that only move the robot have none.
struct Purpose {
  enum class Kind {
    kNone,       ///< nothing is taken or put down: what is carried stays where it is
    kTake,       ///< the object ends in the hand
    kPutOnArea,  ///< the object ends upright on an area of the world
    kPutOnTray   ///< the object ends upright on the robot's tray
  };
  Kind kind{Kind::kNone};
  std::string object;             ///< lower case; empty for kNone
  std::string arm;                ///< that takes it or puts it down, lower case
  std::string area;               ///< kPutOnArea: where, lower case
  double area_half_width{0.175};  ///< [m] of the square round its place that it must stand on
};

/// In the words of skills::MakeSkill; kNone for everything else, arguments that are missing
/// included.
Purpose PurposeOf(const base::ActionCall& action);

}  // namespace hires::imagination
