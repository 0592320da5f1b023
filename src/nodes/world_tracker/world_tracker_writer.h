#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "hires/ros/knowledge/remote_view.h"
#include "hires/ros/node/service_links.h"
#include "nodes/world_tracker/world_tracker_params.h"

namespace hires_ros {

/// Makes the Blackboard say what was observed last, on a thread of its own: what changed against
/// what it says, in batches; and tells until when it is said. While the Blackboard is away, the
/// latest observation waits for it.
class ObservationWriter {
 public:
  /// @param on_view  told of every change of the view, as RemoteView::Listener.
  /// @pre context outlives it.
  ObservationWriter(const hires::translation::TranslatorContext* context,
                    const WorldTrackerParams& params, const ros::NodeHandle& nh,
                    RemoteView::Listener on_view);
  ~ObservationWriter();
  ObservationWriter(const ObservationWriter&) = delete;
  ObservationWriter& operator=(const ObservationWriter&) = delete;

  /// Replaces what was posted before and is not written yet.
  /// @param time  [s] main ROS time, of the observation.
  void Post(double time, hires::translation::ObservedWorld observed);

  const RemoteView& view() const { return view_; }
  /// The context with what the Blackboard knows of areas.
  hires::translation::TranslatorContext ContextNow(const hires::knowledge::FluentView& view) const;

  std::uint64_t num_written() const { return num_written_; }  ///< fluents
  std::uint64_t num_failures() const { return num_failures_; }
  std::string last_failure() const;

 private:
  struct Posted {
    double time;  ///< [s]
    hires::translation::ObservedWorld observed;
  };
  enum class Written { kAll, kNotNow, kNever };

  void OnView(const RemoteView::Update& update);
  void Run();
  Written Write(const hires::translation::ObservedWorld& observed);
  void TellProgress(double time);
  bool Send(const hires::translation::FluentUpdate& update);
  template <typename Service>
  bool Call(const char* service, Service* call);
  void Fail(const std::string& why);

  const hires::translation::TranslatorContext* const context_;
  const WorldTrackerParams params_;
  const RemoteView::Listener on_view_;
  std::atomic<std::int64_t> episode_{0};  // of the monitor's last word
  std::atomic<std::uint64_t> num_written_{0}, num_failures_{0};
  ServiceLinks blackboard_;
  ros::Publisher progress_;
  double last_warning_{-1e9};  // [s] steady; of the writing thread

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Posted> posted_;  // guarded
  std::string last_failure_;      // guarded
  bool is_ending_{false};         // guarded
  RemoteView view_;
  std::thread thread_;
};

}  // namespace hires_ros
