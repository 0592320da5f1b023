#pragma once

#include <optional>
#include <string>

#include "hires/control/move_base_limits.h"

namespace hires::control {

/// What was changed at a local planner and has to be put back: on disk before the first change, so
/// that the next process can do it after a crash.
struct MoveBaseJournal {
  std::string server;      ///< dynamic_reconfigure server, resolved: /move_base_node/DWAPlannerROS
  std::string set_name;    ///< motion set in force
  PlannerValues original;  ///< as they were
  PlannerValues in_force;  ///< as they were set; the same names
  bool operator==(const MoveBaseJournal& other) const;
};

/// Replaces the file as a whole and returns when it is on the disk; makes missing folders.
/// @throws base::ConfigError naming the path and what the system said.
void WriteJournal(const std::string& path, const MoveBaseJournal& journal);

/// @return nothing, if there is no file.
/// @throws base::ConfigError naming file and line, what could still be read, and what to do,
/// where the file is not what WriteJournal wrote.
std::optional<MoveBaseJournal> ReadJournal(const std::string& path);

/// No error if there is none.  @throws base::ConfigError.
void RemoveJournal(const std::string& path);

/// ROS_HOME/hires/move_base_originals.yaml (ROS_HOME is ~/.ros where it is not set).
std::string DefaultJournalPath();

}  // namespace hires::control
