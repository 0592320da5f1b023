#pragma once

#include <hires/ActionCall.h>
#include <hires/ActionTemplate.h>
#include <hires/Atom.h>
#include <hires/Failure.h>
#include <hires/ImagineFeedback.h>
#include <hires/ImagineResult.h>
#include <hires/ObjectTruth.h>
#include <hires/OutcomeCounts.h>
#include <hires/Prediction.h>
#include <hires/RobotState.h>
#include <hires/RolloutRecord.h>
#include <hires/WorldState.h>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/geometry/pose.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout_result.h"
#include "hires/robot/observation.h"
#include "hires/simulation/truth_record.h"
#include "hires/world/world.h"

/// Messages to core values and back. Every float64 survives both ways bit for bit.
namespace hires_ros {

namespace msg = ::hires;

geometry_msgs::Pose ToMsg(const hires::geometry::Pose3& pose);
hires::geometry::Pose3 FromMsg(const geometry_msgs::Pose& pose);  ///< a quaternion of 0 is identity

msg::ActionCall ToMsg(const hires::base::ActionCall& call);
hires::base::ActionCall FromMsg(const msg::ActionCall& call);
msg::ActionTemplate ToMsg(const hires::base::ActionTemplate& action);
hires::base::ActionTemplate FromMsg(const msg::ActionTemplate& action);

msg::Failure ToMsg(const hires::base::Failure& failure);
/// A number that this version does not know, as a later one may send, becomes kOther with words
/// that name it: what is unknown is told, and nothing is guessed.
hires::base::Failure FromMsg(const msg::Failure& failure);

msg::WorldState ToMsg(const hires::world::WorldState& state);
hires::world::WorldState FromMsg(const msg::WorldState& state);
/// The heading travels beside the quaternion, which would round it.
msg::RobotState ToMsg(const hires::robot::RobotState& state);
hires::robot::RobotState FromMsg(const msg::RobotState& state);
msg::ObjectTruth ToMsg(const std::string& name, const hires::simulation::ObjectFate& fate);
hires::simulation::ObjectFate FromMsg(const msg::ObjectTruth& truth);

/// What FromMsg would drop or read as something else: poses in another frame than map, a velocity,
/// heading or joint that is no number. @throws hires::base::ConfigError naming the field.
void RequireSoundState(const msg::WorldState& world, const msg::RobotState& robot);

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
