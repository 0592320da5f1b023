#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/sensing/history.h"
#include "hires/sensing/object_memory.h"
#include "hires/sensing/robot_state_estimator.h"
#include "hires/world/world.h"

namespace hires::sensing {

/// One look of a camera. The detections' poses are in `frame`: the camera's link, or any frame that
/// is connected with the robot.
struct Look {
  double stamp{0.0};  ///< [s] of the picture
  std::string frame;
  std::vector<perception::Detection> detections;  ///< empty: it looked and saw nothing
  std::vector<Eigen::Vector3d> table{};  ///< corners of what was looked at, counter-clockwise from
                                         ///< above; empty: all that is in view
};

/// What others say of an object: where it is in the frame of a link, or in the world.
struct StatedObject {
  std::string name, model, link;
  geometry::Pose3 X_LO;
};

/// What became of the looks up to a moment.
struct LookNews {
  bool has_changed_hands{false};  ///< one took, let go of or lost something
  int num_looks{0};               ///< that were remembered
  double newest_look{-1e9};       ///< [s] stamp of the newest of them
  std::vector<std::string> warnings;
};

/// Feeds the memory of objects with what is felt and seen, in the order of time: for the middle
/// layer and the tracker alike. A look is judged with the posture that the robot had when the
/// picture was taken, and dropped where that is unknown. One that comes late says nothing if a hand
/// took or let go of something since.
class ObjectEstimator {
 public:
  /// @param state  of the robot; outlives this.
  ObjectEstimator(std::shared_ptr<const perception::Surroundings> surroundings,
                  std::shared_ptr<const robot::Robot> robot, const MemoryParams& params,
                  const RobotStateEstimator* state);

  /// Takes a look, to be remembered when the robot's state is known so far.
  /// @return what was left out, and why: the look, or some of its detections.
  std::vector<std::string> OnLook(Look look);

  /// Takes a scan of the laser over the tray, to be used when the robot's state is known so far;
  /// of several within kScanPeriod the first alone is.
  /// @param frame  of the laser.
  /// @return what is wrong: with this scan, or with earlier ones that could not be used since.
  std::vector<std::string> OnTrayScan(double stamp, const std::string& frame,
                                      robot::ScanReading scan);
  static constexpr double kScanPeriod = 0.1;  ///< [s]

  /// All that others say now; what they do not say any more is believed no longer.
  /// @return what could not be believed, and why.
  std::vector<std::string> OnStated(const std::vector<StatedObject>& stated);
  /// Likewise, with poses in the world.
  std::vector<std::string> OnStated(const world::WorldState& stated, const RobotEstimate& at);

  /// Remembers what was felt and seen up to this moment.
  LookNews Update(const RobotEstimate& now);
  /// Drops the looks up to a moment for which the robot's posture will stay unknown, but for
  /// those that wait for their frame.
  /// @return how many.
  int DropUntil(double time);
  /// Stamp of the first look from `time` on that no Update has seen; nothing if there is none.
  std::optional<double> NextLook(double time) const;

  const ObjectMemory& memory() const { return memory_; }
  int num_outdated() const { return num_outdated_; }  ///< looks that came too late
  int num_dropped() const { return num_dropped_; }    ///< whose posture or frame was unknown
  int num_scans() const { return num_scans_; }        ///< of the tray that were used

 private:
  struct Waiting {
    Look look;
    bool is_tried{false};  ///< and waits for the transform of its frame
  };
  void FollowClock();
  void Feel(const BodyReading& body, LookNews* news);
  bool Remember(const Look& look, double now, LookNews* news);
  FrameStatus PutInCamera(const RobotEstimate& then, Look* look) const;
  void Drop(const std::string& why, LookNews* news);
  struct TrayScan {
    std::string frame;
    robot::ScanReading reading;
  };
  void ScanTray(double now);
  std::string Use(double stamp, const TrayScan& scan);

  std::shared_ptr<const perception::Surroundings> surroundings_;
  std::shared_ptr<const robot::Robot> robot_;
  const RobotStateEstimator* state_;
  ObjectMemory memory_;
  std::deque<Waiting> looks_;  // oldest first
  History<TrayScan> scans_;    // not used yet
  double scanned_{-1e9};       // [s] stamp of the last that was used
  int num_scans_{0};
  std::vector<std::string> scan_problems_;  // not told of yet
  double felt_{-1e9};                       // [s] when hands were felt last
  double hands_changed_{-1e9};              // [s] when one took or let go of something
  int num_outdated_{0}, num_dropped_{0};
  int restarts_{0};  // of the clock, so far
};

}  // namespace hires::sensing
