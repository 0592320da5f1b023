#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/planning/operator_data.h"
#include "hires/simulation/truth_record.h"
#include "hires/world/named_area.h"
#include "loop/achieve.h"
#include "loop/loop_observer.h"
#include "sim_robot/truth.h"

namespace hires::loop {

/// Files instead of those that the configuration names; empty: its own.
struct LoopFiles {
  std::string world, robot, objects;
  std::string map;  ///< map_server YAML whose walls are the world instead
  /// Beside those of the world; what the knowledge does not say of them is told to the Blackboard.
  std::vector<world::NamedArea> areas;
  std::string domain;     ///< SHOP2 or HDDL
  std::string operators;  ///< empty with a domain: the one beside it, d.yaml for d.lisp
};

/// Everything constant that tasks in one process need, loaded once and shared by all of them.
class LoopSetup {
 public:
  /// @param config  a file like config/loop.yaml.  @throws base::ConfigError naming file and key.
  explicit LoopSetup(const std::string& config, const LoopFiles& files = {});
  ~LoopSetup();
  LoopSetup(const LoopSetup&) = delete;
  LoopSetup& operator=(const LoopSetup&) = delete;

  /// The world that is imagined in, as the robot and its planner know it.
  const imagination::ImaginationSetup& world() const;
  const imagination::ClientConfig& imagination() const;  ///< what a request does not say itself
  const planning::OperatorData& operators() const;
  /// @param name  of config/truths, or a file; empty: same.  @throws base::ConfigError
  sim_robot::Truth ReadTruth(const std::string& name) const;

  struct Parts;
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const Parts> parts_;
};

/// One task that is to be played.
struct LoopOrder {
  std::string scenario;     ///< file: who stands where, and what the robot is told
  std::string task;         ///< empty: the scenario's
  std::string truth;        ///< of config/truths, or a file; empty: same
  std::string sensing;      ///< fitted, ideal, pictures: in place of the truth's; empty: as it says
  std::string imagination;  ///< domain, thesis, off; empty: as the execution monitor is configured
  std::string defaults;     ///< as execution::ReadDefaults; empty: the domain's
  std::uint64_t seed{1};    ///< of the hidden truth, of all noise and of imagination
  int rollouts{0};          ///< per combination of alternatives; 0: as the monitor is configured
  int threads{1};           ///< that play rollouts; their number changes nothing
  bool dry_run{false};      ///< planned and imagined alone (execution::MonitorParams)
  double time_limit{900.0};  ///< [s] of virtual time
  /// [s] on the clock of StepStatus at which the middle layer is lost and starts again: its actions
  /// fail.
  std::vector<double> middle_layer_losses;
  std::string store;         ///< file, new, that keeps what the Blackboard was told; empty: none
};

/// What became of it.
struct LoopRun {
  AchieveReport report;
  simulation::RunTruth truth;   ///< how things really stand in the end
  std::string truth_name;       ///< of what robot and world were really like: same, foreign, ...
  double virtual_seconds{0.0};  ///< [s] from the robot's start to the end
  bool is_timed_out{false};     ///< the time limit came first
};

/// For who plays a task often and unattended: what PlayTask() would refuse, and arguments that it
/// would only warn of because nothing names them, before anything is played.
/// @param scenario  file.
/// @throws base::ConfigError naming what came and what is like it.
void RequireTask(const LoopSetup& setup, const std::string& scenario, const std::string& task);

/// Plays a whole task with robot, world, middle layer, tracker, Blackboard, planner, execution
/// monitor and imagination in this process, in virtual time: as fast as it goes, and the same to
/// the last bit for the same order, whatever the number of threads.
/// @param on_status  told of every change; may be empty.
/// @param cancelled  asked every tick; then the task is preempted; may be empty.
/// @param observer   told of what happens; changes nothing.
/// @throws base::ConfigError for a scenario, a truth or a task that makes no sense.
LoopRun PlayTask(const LoopSetup& setup, const LoopOrder& order,
                 const OnAchieveStatus& on_status = {}, const std::function<bool()>& cancelled = {},
                 const LoopObserver& observer = {});

}  // namespace hires::loop
