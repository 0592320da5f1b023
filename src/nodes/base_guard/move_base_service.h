#pragma once

#include <dynamic_reconfigure/Config.h>

#include <chrono>
#include <memory>
#include <string>

#include "hires/control/move_base_tuner.h"

/// How a tuner of move_base reaches its local planner: the service of dynamic_reconfigure.
namespace hires_ros {

hires::control::PlannerValues FromMsg(const dynamic_reconfigure::Config& config);  ///< its numbers

/// Asks the service <server>/set_parameters.
/// @param patience  that the server may take to appear, and to answer.
hires::control::Reconfigure ReconfigureByService(std::chrono::milliseconds patience);

/// The tuner of a robot's move_base. Its owner also subscribes to <planner>/parameter_updates and
/// hands that to OnUpdate.
/// @param names    the planner's name is resolved as this node's names are.
/// @param journal  empty: control::DefaultJournalPath().
std::unique_ptr<hires::control::MoveBaseTuner> MakeMoveBaseTuner(
    const hires::control::RobotNames::MoveBase& names, const std::string& journal);

}  // namespace hires_ros
