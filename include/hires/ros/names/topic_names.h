#pragma once

#include <string>

/// Names of topics and actions; all relative.
namespace hires_ros {

constexpr char kImagineAction[] = "imagine";
constexpr char kImaginedRollout[] = "imagined_rollout";  ///< service
constexpr char kPlanAction[] = "plan";
constexpr char kAchieveAction[] = "achieve";
constexpr char kGenerateImagineState[] = "generate_imagine_state";  ///< service
constexpr char kBlackboard[] = "blackboard";  ///< its services and topics lie below
constexpr char kBlackboardChanges[] = "blackboard/changes";
constexpr char kImaginedChanges[] = "blackboard/imagined_changes";
constexpr char kObservationProgress[] = "observation_progress";  ///< what of it was observed
constexpr char kImaginationMarkers[] = "imagination_markers";    ///< ranking, latched
constexpr char kDrivePlan[] = "navigation/plan";                 ///< path of a drive, latched
constexpr char kLocalCostmap[] = "navigation/local_costmap";     ///< round the robot, latched
constexpr char kWorldMarkers[] = "world_markers";                ///< furniture, areas, latched

/// What a worker owns under its master and what crosses to the main one: "worker_3/rollout".
/// Worker, host and client are in one namespace, so that each client of a master has workers of its
/// own.
inline std::string WorkerName(int index, const std::string& what) {
  return "worker_" + std::to_string(index) + "/" + what;
}
constexpr char kRollout[] = "rollout";
constexpr char kWorkerMarkers[] = "markers";

}  // namespace hires_ros
