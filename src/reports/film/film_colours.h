#pragma once

#include "hires/perception/picture.h"

/// What things look like in pictures of rollouts and worlds.
namespace hires::reports {

constexpr perception::Colour kPaper{250, 250, 248}, kInk{24, 28, 36}, kAlarm{196, 24, 24};
constexpr perception::Colour kWell{16, 120, 40};
constexpr perception::Colour kFurniture{206, 178, 136}, kWall{150, 158, 170};
constexpr perception::Colour kRobot{112, 136, 172}, kTray{70, 84, 108};
constexpr perception::Colour kLoad{226, 84, 28}, kOther{150, 96, 160};
constexpr perception::Colour kTrace{40, 92, 190}, kGoal{96, 176, 104};

}  // namespace hires::reports
