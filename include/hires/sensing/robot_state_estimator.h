#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hires/geometry/map_to_world.h"
#include "hires/sensing/body_reading.h"
#include "hires/sensing/frame_tree.h"
#include "hires/sensing/joint_history.h"

namespace hires::sensing {

/// What the tree calls the frames (REP 105).
struct FrameNames {
  std::string map{"map"}, odometry{"odom"}, base{"base_link"};
};

struct StateParams {
  double stale_after{0.3};       ///< [s] without odometry, joint states or a correction of map ->
                                 ///< odometry the robot's state is unknown
  double history{3.0};           ///< [s] that is kept: messages may come so late, or so early
  double correction_wait{0.15};  ///< [s] of odometry within which a correction may still come
  double posture_reach{0.05};  ///< [s] from joint states after which head and arms may be elsewhere
  bool operator==(const StateParams& other) const;
};

/// What became of a message.
enum class Reception {
  kTaken,
  kRepeated,      ///< nothing new
  kLate,          ///< older than what is kept
  kAhead,         ///< of a clock that is far ahead of the odometry's
  kNoStamp,       ///< its time is 0 or no number
  kNotFinite,     ///< `subject` is no number
  kUnknownFrame,  ///< the frame `subject` was never received
  kNotConnected,  ///< nothing leads from the frame `subject` to the robot's
  kNotThen,       ///< where the frame `subject` was at that time is unknown
  kInLoop,        ///< the links above the frame `subject` lead in a circle
  kTilted         ///< the laser `subject` does not scan in the plane of the base
};

struct Receipt {
  Reception what{Reception::kTaken};
  std::string subject;
  double limit{0.0};  ///< [s] by which it may be late or ahead, or [rad] tilted
  bool is_taken() const { return what == Reception::kTaken; }
  /// A person must mend something; messages that come late or twice are normal.
  bool is_bad() const;
};
/// For people: what is wrong and what was wanted.
std::string ToString(const Receipt& receipt);
/// Of what is in a frame that the tree was asked for.
Receipt ReceiptOf(FrameStatus status, const std::string& frame);

/// What keeps the robot's state from being known.
enum class Missing {
  kNothing,
  kOdometry,
  kOdometryFrame,  ///< where the odometry's own frame is in the one that localisation corrects
  kJointStates,
  kLocalisation  ///< map -> odometry
};

/// The robot at a moment.
struct RobotEstimate {
  double time{0.0};      ///< [s] on the robot's clock
  geometry::Pose2 X_WB;  ///< in the world, which is the map of skills and symbols
  geometry::Pose2 X_MB;  ///< in the map that the robot localises itself in
  geometry::Pose2 X_OB;
  geometry::Twist2 V_B;
  robot::JointPositions joints, joint_velocities;  ///< as measured, within their limits
  robot::JointPositions posture;                   ///< of all joints, see JointHistory::PostureOf

  BodyReading Body() const { return {time, X_WB, posture}; }
};

/// The one estimate of where the robot is and how it stands, for all who ask. Puts together what
/// sensors say, each at its own time: between two readings it is interpolated. Knows no clock but
/// the messages' stamps [s]; the odometry's newest is "now". The same messages give the same state
/// however they interleave; of what is too far ahead of the odometry the newest of each kind waits
/// for it.
///
/// Localisation is what the tree says of map -> odometry: the correction of that time where there
/// are corrections around it, else the newest one. One that is dated ahead, as amcl does, is no
/// fresher for that than the odometry that had come when it came.
///
/// Odometry may count in any frame. One that the tree connects is converted; one that nothing
/// connects (a PR2's wheels count in `odom`, and a filter joins them with the IMU in
/// `odom_combined`) is put where the tree has the base in the odometry's frame, and leads on from
/// there. Where the tree does not know the odometry's frame at all and map -> base instead (a
/// camera on the ceiling), that is the correction: of the odometry of its time.
///
/// Odometry that goes back by more than 4 s, or by more than 1 s and stays there, is a clock that
/// began again: all that was before is forgotten.
class RobotStateEstimator {
 public:
  /// @param tree  may know nothing yet.
  RobotStateEstimator(std::shared_ptr<const robot::Robot> robot, FrameNames frames,
                      const StateParams& params, const geometry::MapToWorld& map_to_world,
                      std::shared_ptr<FrameTree> tree);

  /// @param frame  in which the pose is; `child`, whose it is, and in which the velocity is. No
  ///               child is the base.
  Receipt OnOdometry(double stamp, const std::string& frame, const std::string& child,
                     const robot::OdometryReading& reading);
  Receipt OnJoints(double stamp, const robot::JointReading& reading);
  /// The tree has learnt something about this moment; infinity: about frames that never move.
  Receipt OnTransforms(double stamp);

  /// Time up to which everything is known; nothing while something is missing.
  std::optional<double> CompleteUntil() const;
  /// No message that is at most `correction_wait` late can change the state of that time; where the
  /// robot is not localised then, none that is at most `history` late.
  bool IsSettled(double time) const;
  /// Stamp of the newest correction of the odometry; infinity: it never needs one.
  std::optional<double> LocalisedUntil() const;
  Missing MissingAt(double time) const;
  Missing MissingNow() const;

  /// Nothing where something is missing.
  std::optional<RobotEstimate> At(double time) const;
  /// Whether joint states came near enough to say where the camera looked.
  bool IsPostureKnown(double time) const;
  /// Stamp of the first joint states after `time`.
  std::optional<double> NextJoints(double time) const { return joints_.NextAfter(time); }
  /// Whether that is too far ahead of the odometry to be of the same clock.
  bool IsAhead(double stamp) const;
  Receipt Ahead(const std::string& subject) const;  ///< what to say of it
  /// Stamp of the newest odometry.
  std::optional<double> now() const;

  /// A frame in the base at that moment: the robot's links by its joints, map and odometry by where
  /// it is, others by the tree. X_PC is X_BF.
  FramePose InBase(const std::string& frame, const RobotEstimate& at) const;
  /// A link of the robot in the world; no name is the world itself.
  /// @throws base::ConfigError if there is no such link.
  geometry::Pose3 LinkInWorld(const std::string& link, const RobotEstimate& at) const;

  int num_restarts() const { return num_restarts_; }  ///< of the clock
  const FrameNames& frames() const { return frames_; }
  const StateParams& params() const { return params_; }

 private:
  struct Correction {
    geometry::Pose2 X_MF;  ///< of the odometry's frame, or of the base by itself
    double heard;          ///< [s] about when it came
    double lead;           ///< [s] its stamp was newer than the odometry when it was read
  };
  bool HasClockRestarted(double stamp);
  void Restart();
  void ForgetOld();
  void ForgetAhead();
  void TakeEarly();
  bool IsLate(double stamp) const;
  Receipt Late() const;
  FramePose ChildToBase(const std::string& child, double stamp) const;
  Receipt CheckFrame(const std::string& frame) const;
  std::optional<robot::OdometryReading> RawAt(double time, double reach) const;
  std::optional<geometry::Pose2> OdometryOrigin(double time) const;
  double LeastLead() const;
  Receipt TakeCorrection(const std::string& frame, double newest, double stamp);
  std::optional<geometry::Pose2> OffsetOf(const Correction& correction, double stamp) const;
  std::optional<geometry::Pose2> CorrectionAt(double time) const;
  std::optional<geometry::Pose3> LinkInBase(const std::string& link,
                                            const robot::JointPositions& posture) const;

  std::shared_ptr<const robot::Robot> robot_;
  FrameNames frames_;
  StateParams params_;
  geometry::MapToWorld map_to_world_;
  std::shared_ptr<FrameTree> tree_;
  std::string raw_frame_;                      // of the odometry
  History<robot::OdometryReading> raw_;        // base in that frame
  History<geometry::Pose2> base_in_odometry_;  // by the tree
  History<Correction> corrections_;
  bool is_base_corrected_{false};             // corrections are of the base, not of the odometry
  std::optional<geometry::Pose2> X_MOfixed_;  // where map and odometry never move
  JointHistory joints_;
  // The newest that was too far ahead of the odometry.
  std::optional<std::pair<double, robot::JointReading>> early_joints_;
  std::optional<double> early_transforms_;  // [s]
  int num_behind_{0};  // readings of the odometry in a row that seem to come from another clock
  int num_restarts_{0};
};

}  // namespace hires::sensing
