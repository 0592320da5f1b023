#pragma once

#include <hires/GroundTruth.h>
#include <ros/ros.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/process.h"
#include "lab/src/experiment/hypothesis.h"
#include "lab/src/graph/process_watch.h"

// What a process needs that plays one run through a graph of nodes of its own.
namespace hires_ros {

/// Everything below the master on this port, which is on loopback; nodes write into the folder.
void EnterGraph(const std::string& folder, int port);

/// `roslaunch` of hypothesis_run.launch under that master, its output in the folder's system.log.
/// @param arguments  "name:=value"
hires::base::ProcessOptions GraphLaunch(const std::string& package_folder,
                                        const std::string& folder, int port,
                                        const std::vector<std::string>& arguments);

/// How long a run may take.
struct GraphLimits {
  double start{180.0};      ///< [s] of the wall's clock, until the graph is there
  double wall{3600.0};      ///< [s] likewise, for the whole run
  double simulated{900.0};  ///< [s] simulated
};

/// Why a run must end before its task does: what was first.
class RunLimits {
 public:
  RunLimits(const GraphLimits& limits, hires::base::ChildProcess* graph,
            hires::base::StopSignals* stop);

  bool Broken() { return Broken(limits_.wall); }
  /// @param wall_limit  [s] from the run's start.
  bool Broken(double wall_limit);
  double start_limit() const { return limits_.start; }
  void Pass(double seconds) { stop_->Wait(seconds); }
  /// From now on a process of the graph that dies or is stopped breaks the run.
  void WatchProcesses();

  const std::string& outcome() const { return outcome_; }  ///< empty while nothing is broken
  const std::string& reason() const { return reason_; }
  bool is_time_over() const { return is_time_over_; }  ///< simulated time, while the graph was well

 private:
  void Break(const std::string& outcome, const std::string& reason);

  const GraphLimits limits_;
  hires::base::ChildProcess* graph_;
  hires::base::StopSignals* stop_;
  double begin_;
  std::optional<hires::lab::BreakdownWatch> processes_;
  std::string outcome_, reason_;
  bool is_time_over_{false};
};

/// The last truth that came, from whichever thread spins.
class Witness {
 public:
  explicit Witness(ros::NodeHandle* nh)
      : subscriber_(nh->subscribe("ground_truth/summary", 10, &Witness::OnSummary, this)) {}

  bool HasSeen() const;
  hires::simulation::RunTruth Truth() const;

 private:
  void OnSummary(const hires::GroundTruthConstPtr& summary);

  mutable std::mutex mutex_;
  hires::simulation::RunTruth truth_;
  bool has_seen_{false};
  ros::Subscriber subscriber_;
};

/// The master answers and says whose clock counts; a node that starts before does not know.
/// @throws base::ConfigError where it does not in time.
void AwaitMaster(RunLimits* limits);
/// @throws base::ConfigError likewise.
void AwaitTruth(const Witness& witness, RunLimits* limits);
/// What is put down or falls needs a moment to come to rest.
void AwaitRest(RunLimits* limits);

/// roslaunch ends its nodes in order when it is interrupted.
void StopGraph(hires::base::ChildProcess* graph, hires::base::StopSignals* stop);

/// What roslaunch said last about a process that died; "" for nothing.
std::string LastDeath(const std::string& folder);

/// @throws base::ConfigError for none from 1024 to 64999.
int PortOf(const std::string& word);

}  // namespace hires_ros
