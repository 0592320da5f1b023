#pragma once

#include <hires/FluentChanges.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "hires/knowledge/live_view.h"
#include "hires/ros/node/service_links.h"

namespace hires_ros {

/// The real fluents that hold now on the node `blackboard`, kept in memory by its services and its
/// topic of changes. Survives the Blackboard's absence, restart and replacement, and messages that
/// are lost: what was missed is asked for. While the Blackboard is away, the view shows what was
/// known last.
///
/// It has a thread of its own, so it does not need a spinner; all members may be called from any
/// thread.
class RemoteView {
 public:
  struct Update {
    bool is_fresh{false};  ///< everything was read again: compare for yourself; `changes` is empty
    std::vector<hires::knowledge::Change> changes;  ///< real ones, in order
    std::uint64_t sequence{0};                      ///< of the Blackboard, after them
  };
  /// Called after the view has changed, on the view's thread or on one that is in CatchUp; one call
  /// at a time. It must not call CatchUp; reading is fine.
  using Listener = std::function<void(const Update&)>;

  /// Looks for the Blackboard at once and waits for nothing.
  /// @param check_period  [s] of the steady clock, after which it is asked whether all is known.
  explicit RemoteView(const ros::NodeHandle& nh, Listener listener = {}, double check_period = 1.0);
  ~RemoteView();
  RemoteView(const RemoteView&) = delete;
  RemoteView& operator=(const RemoteView&) = delete;

  bool is_known() const { return is_known_; }          ///< the Blackboard was read at least once
  bool is_connected() const { return is_connected_; }  ///< it answered when asked last
  std::uint64_t sequence() const { return sequence_; }

  /// Asks for all that was acknowledged before this call, and waits for it.
  /// @return false if the Blackboard does not answer.
  bool CatchUp();

  /// Hands the view to `call`, which must be quick: the view does not change meanwhile.
  template <typename Call>
  auto Read(const Call& call) const {
    const std::shared_lock<std::shared_mutex> lock(view_mutex_);
    return call(static_cast<const hires::knowledge::FluentView&>(view_));
  }

 private:
  void OnMessage(const hires::FluentChangesConstPtr& message);
  bool Synchronise();
  bool LoadAll();
  bool LoadMissed();
  void Take(const hires::FluentChanges& message);
  void Tell(Update update);

  const Listener listener_;
  std::mutex synchronising_;  // one at a time changes the view
  mutable std::shared_mutex view_mutex_;
  hires::knowledge::LiveView view_;  // guarded by view_mutex_
  std::atomic<bool> is_known_{false};
  std::atomic<bool> is_connected_{false};
  std::atomic<std::uint64_t> sequence_{0};

  ServiceLinks blackboard_;  // guarded by synchronising_
  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  ros::Subscriber subscriber_;
  ros::SteadyTimer timer_, first_timer_;
  ros::AsyncSpinner spinner_;  // last: stops before what it calls is gone
};

}  // namespace hires_ros
