#pragma once

#include <hires/ImaginedRollout.h>
#include <hires/Prediction.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hires/imagination/report.h"
#include "hires/ros/imagination/imagine_request.h"

namespace hires_ros {

/// One request that was answered.
struct AnsweredRequest {
  std::string id;  ///< that the asker gave it; may be empty
  int number{0};   ///< of this node's requests
  std::shared_ptr<const ImagineRequest> request;
  std::vector<hires::imagination::Prediction> ranking;
  std::vector<hires::Prediction> predictions;  ///< the same as messages, with complete references
};

/// The service `imagined_rollout`: plays a rollout of one of the last requests again, as bits go
/// the same, and writes it to a bag. Works in a thread of its own, as playing takes a while.
class RolloutReplayer {
 public:
  /// @param folder  for bags; made when it is needed.
  RolloutReplayer(std::string folder, ros::NodeHandle* nh);
  ~RolloutReplayer();
  RolloutReplayer(const RolloutReplayer&) = delete;
  RolloutReplayer& operator=(const RolloutReplayer&) = delete;

  /// Only the last few are kept. From any thread.
  void Keep(AnsweredRequest answered);

 private:
  using Request = hires::ImaginedRollout::Request;
  using Response = hires::ImaginedRollout::Response;
  bool OnRequest(Request& request, Response& response);
  void Answer(const Request& request, Response* response);
  std::shared_ptr<const AnsweredRequest> Find(const std::string& id) const;
  std::string PathFor(const AnsweredRequest& answered, int rank, int index) const;

  const std::string folder_;
  const std::int64_t started_;  ///< [s] since 1970
  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<const AnsweredRequest>> last_;  // the latest first
  std::atomic<bool> is_stopping_{false};
  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace hires_ros
