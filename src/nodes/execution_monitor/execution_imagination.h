#pragma once

#include <hires/GenerateImagineState.h>
#include <hires/ImaginationStatus.h>
#include <hires/ImagineAction.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/thread_pool.h"
#include "hires/execution/monitor_config.h"
#include "hires/ros/node/service_links.h"
#include "nodes/execution_monitor/action_link.h"

namespace hires_ros {

/// The requests by which the execution monitor has steps imagined: the translator turns the
/// projected state into poses, the imagination client plays. Deadlines are kept here, because they
/// move: when one has passed, the request is ended and what was found until then counts. Belongs to
/// the monitor's thread.
class ImagineRequests {
 public:
  using Post = std::function<void(std::function<void()>)>;  ///< to the monitor's thread
  using OnAnswer = std::function<void(const hires::execution::ImagineAnswered&)>;

  ImagineRequests(const hires::execution::ImaginingParams& imagining,
                  const ActionLinkParams& params, ros::NodeHandle* nh, Post post,
                  OnAnswer on_answer);
  ~ImagineRequests();

  // Times are main ROS time [s].
  void Start(const hires::execution::StartImagination& command, double now);
  void Move(const hires::execution::MoveDeadline& command);
  void Cancel(const hires::execution::CancelImagination& command, double now);
  void CancelAll(double now);  ///< No answer comes any more.
  void Tick(double now);

  /// Of all requests since the last Clear(), in their order; `dispatch` is not filled in. What was
  /// played for one that was cancelled is known once its server has ended it.
  std::vector<hires::ImaginationStatus> Statuses() const;
  void Clear() { finished_.clear(); }
  bool is_available() { return link_.is_available(); }
  bool is_translator_available() const { return translator_state_->is_available; }

 private:
  static constexpr int kNone = 0;
  using State = hires::GenerateImagineState::Response;

  struct Request {
    hires::execution::StartImagination command;
    hires::ImaginationStatus status;
    State state;
    double asked{0.0};  ///< [s] steady
    bool is_translated{false};
    bool is_late{false};
  };
  /// Shared with the thread that asks the translator.
  struct TranslatorState {
    std::atomic<bool> is_ending{false};
    std::atomic<bool> is_available{true};
    ServiceLinks services{ros::NodeHandle(), ""};  // of the translator's thread
  };

  void Translate(int key, const hires::execution::StartImagination& command);
  void OnTranslated(int key, bool is_answered, const State& state);
  void OnEnd(int key, const hires::ImagineResultConstPtr& result, const std::string& why);
  void OnCancelled(int key, const hires::ImagineResultConstPtr& result);
  void Refuse(int key, hires::execution::ImagineAnswered::Outcome outcome, const std::string& why);
  void Answer(int key, const hires::execution::ImagineAnswered& answer);
  void Finish(int key, const std::string& outcome, double now);
  std::vector<int> Overdue(double now) const;
  std::vector<int> Stuck() const;
  int KeyOf(int request) const;  ///< kNone if it is not under way

  const hires::execution::ImaginingParams imagining_;
  const ActionLinkParams params_;
  const Post post_;
  const OnAnswer on_answer_;
  std::map<int, Request> requests_;
  std::map<int, hires::ImaginationStatus> finished_;  // by key
  int next_key_{1};
  ActionLink<hires::ImagineAction> link_;
  std::shared_ptr<TranslatorState> translator_state_;
  hires::base::ThreadPool translator_;
};

}  // namespace hires_ros
