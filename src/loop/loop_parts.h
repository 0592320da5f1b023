#pragma once

#include <memory>

#include "hires/control/action_runner.h"
#include "hires/execution/monitor_config.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/planner_config.h"
#include "hires/sensing/scan_obstacles.h"
#include "loop/imagination_desk.h"
#include "loop/message_line.h"
#include "loop/task_loop.h"
#include "loop/tracker.h"
#include "sim_robot/sim_robot_sensors.h"

namespace hires::loop {

/// How messages fare, by their kind.
struct LoopMessages {
  MessageParams sensors;     ///< from the robot to the tracker, but for
  MessageParams looks;       ///< what its camera sees
  MessageParams actions;     ///< from the monitor to skills, and back
  MessageParams blackboard;  ///< from the Blackboard to the monitor
};

/// config/loop.yaml and the files of the nodes that it names.
struct LoopConfig {
  imagination::ClientConfig imagination;
  imagination::SetupConfig scene;
  execution::MonitorConfig execution;
  control::RunnerParams runner;
  sensing::ScanParams scan;
  sim_robot::SimSensorParams sensors;
  TrackerParams tracker;
  ImaginationPace pace;
  std::string recogniser;      ///< file: what is known of things on tables
  std::string truths;          ///< folder of what robot and world may really be like
  double planning_time{0.05};  ///< [s] that a search takes
  LoopMessages messages;
};

/// @throws base::ConfigError naming file and key.
LoopConfig ReadLoopConfig(const std::string& path, const LoopFiles& files);

struct LoopSetup::Parts {
  Parts(const std::string& path, const LoopFiles& files);
  sim_robot::Truth ReadTruth(const std::string& name) const;  ///< as LoopSetup's
  /// Sensors of the robot under a truth, with what it recognises things by.
  sim_robot::SimSensorParams SensorsUnder(const sim_robot::Truth& truth) const;

  LoopConfig config;
  imagination::ImaginationSetup world;
  std::shared_ptr<const knowledge::Ontology> ontology;
  translation::TranslatorContext context;  ///< of the world, with the ontology
  planning::PlanningKnowledge planning;
  planning::OperatorData operators;
};

}  // namespace hires::loop
