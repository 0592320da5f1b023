#pragma once

#include <functional>
#include <string>

namespace hires_ros {

constexpr double kPollPeriod = 0.02;  ///< [s] of the wall, between two looks whether an answer came

/// Looks every kPollPeriod whether something is so.
/// @param wait  [s] at most, by the wall's clock: ROS time may stand still.
/// @return false if it was not by then, or when it was cancelled.
bool PollUntil(const std::function<bool()>& is_so, double wait,
               const std::function<bool()>& cancelled);

/// @param launch_file  of hires, that starts a master with what is to be asked.
/// @param otherwise  what else helps, after "or"; may be empty.
/// @throws hires::base::ConfigError if no ROS master answers.
void RequireMaster(const std::string& launch_file, const std::string& otherwise = "");

/// Waits for a master, and for somebody who publishes the topic: a node that begins earlier than a
/// robot's time is told to run would take the wall's for it.  @pre ros::init, and no node yet.
/// @param wait  [s] at most, by the wall's clock.
/// @return [s] that are left.
/// @throws hires::base::ConfigError as RequireMaster, if there is still no master.
double AwaitPublisher(const std::string& topic, double wait, const std::function<bool()>& cancelled,
                      const std::string& launch_file);

/// Waits until ROS has a time, as clients of actions do for ever: where /use_sim_time is true, for
/// a first message of /clock. Keeps ROS up from then on.  @pre ros::init
/// @param wait  [s] at most, by the wall's clock.
/// @throws hires::base::ConfigError if there is none by then, or when it is cancelled.
void RequireTime(double wait, const std::function<bool()>& cancelled);

}  // namespace hires_ros
