#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace hires_ros {

/// The node that made a goal, by the goal's id: "/asker" of "/asker-1-1700000000.25", as
/// actionlib's clients write it; "" where the id has another form.
std::string ClientOf(const std::string& goal_id);

/// Watches whether the client that asked for a task lives. A client that was killed cancels
/// nothing, and a robot should not go on at nobody's wish. Where nothing listens any more it is
/// gone within seconds; where it is but silent, stopped or cut off, within half a minute.
class ClientWatch {
 public:
  /// @param on_gone  Called on the watch's thread, once for each goal whose client answered at
  /// first
  ///   and does not any more.
  explicit ClientWatch(std::function<void(const std::string& goal_id)> on_gone);
  ~ClientWatch();
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;

  /// From now on the client of this goal, in place of another one; "": nobody. A client that cannot
  /// be found or asked is not watched: its goal lives until it is cancelled.
  void Watch(const std::string& goal_id);

 private:
  void Run();
  bool Rest(const std::string& goal_id);
  void Follow(const std::string& goal_id);

  const std::function<void(const std::string&)> on_gone_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string goal_id_;    // guarded
  bool is_ending_{false};  // guarded
  std::thread thread_;
};

}  // namespace hires_ros
