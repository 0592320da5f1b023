#pragma once

#include <hires/LockstepAck.h>
#include <hires/LockstepTick.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace hires_ros {

constexpr double kSameStamp = 1e-9;  ///< [s] stamps that differ by less are the same

/// The side of lockstep that answers a simulated robot: each tick is looked at once, when the
/// sensors of its stamp have come, and answered once; the answer is repeated where the tick is.
class LockstepClient {
 public:
  /// @param due  called when a tick that came can be looked at: ask TakeDue then.
  LockstepClient(ros::NodeHandle* nh, std::function<void()> due);

  /// The newest message of a sensor that ticks name.
  void NoteArrival(const std::string& topic, double stamp);
  void ForgetArrivals() { arrived_.clear(); }  ///< the robot's clock began again

  /// The stamp [s] of a tick whose sensors are all there; nothing if there is none, or it was taken
  /// already.
  std::optional<double> TakeDue();

  /// Whether a tick was taken and not answered.
  bool awaits_answer() const { return tick_ && is_taken_; }
  /// @param num_commands  messages to controllers since the last answer.  @pre awaits_answer()
  void Answer(std::uint64_t num_commands);

  bool is_awaited() const;  ///< the robot waits for the answers of this node
  std::string topic() const { return ack_.getTopic(); }

 private:
  void OnTick(const hires::LockstepTick& msg);
  bool IsComplete(const hires::LockstepTick& tick) const;

  std::function<void()> due_;
  std::map<std::string, double> arrived_;  // topic -> newest stamp [s]
  std::optional<hires::LockstepTick> tick_;
  std::optional<hires::LockstepAck> acked_;  // the last one
  bool is_taken_{false};
  std::string awaited_;  // node for whose answers the robot waits
  ros::Publisher ack_;
  ros::Subscriber ticks_;
};

}  // namespace hires_ros
