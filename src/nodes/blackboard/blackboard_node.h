#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/BlackboardError.h>
#include <hires/BlackboardStatistics.h>
#include <hires/ChangesSince.h>
#include <hires/Demand.h>
#include <hires/ExportFluents.h>
#include <hires/FinishEpisode.h>
#include <hires/ListEpisodes.h>
#include <hires/LoadKnowledge.h>
#include <hires/QueryFluents.h>
#include <hires/RemoveFluents.h>
#include <hires/StartEpisode.h>
#include <hires/WriteFluents.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/blackboard_readers.h"
#include "hires/knowledge/blackboard_writer.h"
#include "nodes/blackboard/blackboard_topics.h"

namespace hires_ros {

/// The file in ~config (config/blackboard.yaml where there is none); ~store, ~durability,
/// ~knowledge, ~topics (paths) and ~threads win over it.  @throws hires::base::ConfigError.
hires::knowledge::BlackboardConfig LoadBlackboardParams();

/// Serves the store: services below `blackboard/`, answered side by side by the threads that spin;
/// they wait for the one thread that writes, or read from stores of their own. What cannot be
/// granted is answered with an error, never with a failed call.
class BlackboardNode {
 public:
  /// Opens the store; loads what is known at first where it is empty; opens the topics.
  /// @throws ConfigError.
  BlackboardNode(const hires::knowledge::BlackboardConfig& config,
                 std::shared_ptr<const hires::knowledge::Ontology> ontology, ros::NodeHandle* nh);

 private:
  void StartWriting(hires::knowledge::Store store, ros::NodeHandle* nh);
  void ServeAll();
  template <typename Service>
  void Serve(const char* name, void (BlackboardNode::*answer)(const typename Service::Request&,
                                                              typename Service::Response*));
  hires::BlackboardError ErrorOf(const std::function<void()>& call);
  template <typename Call>
  auto Read(const Call& call);

  void OnAdd(const hires::WriteFluents::Request& asked, hires::WriteFluents::Response* answer);
  void OnUpdate(const hires::WriteFluents::Request& asked, hires::WriteFluents::Response* answer);
  void OnRemove(const hires::RemoveFluents::Request& asked, hires::RemoveFluents::Response* answer);
  void OnQuery(const hires::QueryFluents::Request& asked, hires::QueryFluents::Response* answer);
  void OnLoad(const hires::LoadKnowledge::Request& asked, hires::LoadKnowledge::Response* answer);
  void OnExport(const hires::ExportFluents::Request& asked, hires::ExportFluents::Response* answer);
  void OnStartEpisode(const hires::StartEpisode::Request& asked,
                      hires::StartEpisode::Response* answer);
  void OnFinishEpisode(const hires::FinishEpisode::Request& asked,
                       hires::FinishEpisode::Response* answer);
  void OnListEpisodes(const hires::ListEpisodes::Request& asked,
                      hires::ListEpisodes::Response* answer);
  void OnChangesSince(const hires::ChangesSince::Request& asked,
                      hires::ChangesSince::Response* answer);
  void OnDemand(const hires::Demand::Request& asked, hires::Demand::Response* answer);
  void OnStatistics(const hires::BlackboardStatistics::Request& asked,
                    hires::BlackboardStatistics::Response* answer);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  double TimeOr(double time) const;

  const hires::knowledge::BlackboardConfig config_;
  const std::shared_ptr<const hires::knowledge::Ontology> ontology_;
  std::unique_ptr<BlackboardTopics> topics_;  ///< of the writer's thread
  std::unique_ptr<hires::knowledge::BlackboardWriter> writer_;
  /// Closed before the writer: who closes the file last puts its log into it, which readers cannot.
  hires::knowledge::BlackboardReaders readers_;
  std::mutex error_mutex_;
  std::string last_error_;  // guarded
  std::atomic<int> num_refused_{0};
  std::uint64_t changes_before_{0};  ///< at the last diagnosis
  double diagnosed_at_{0.0};         ///< [s] steady
  std::vector<ros::ServiceServer> servers_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace hires_ros
