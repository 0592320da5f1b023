#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/ros/robot_messages.h"
#include "hires/sensing/object_memory.h"
#include "hires/world/map_to_world.h"

namespace hires_ros {

/// A moment of which all is known: where the robot is, its joints, and what its camera saw if it
/// looked then.
struct TrackerMoment {
  hires::sensing::BodyReading body;
  hires::geometry::Twist2 V_B;
  std::optional<std::vector<hires::perception::Detection>> look;
  /// A look that came after later moments had been taken: `body` is as it was then.
  bool is_late{false};
};

/// Puts together moments from messages that come in any order, each with its own stamp [s]. Knows
/// no clock and no connection. Localisation corrects odometry: a moment waits for one of its own
/// stamp as long as odometry is less than 0.15 s ahead, so that the same messages give the same
/// moments however they interleave. Looks may take longer, up to 3 s: recognising objects does.
class TrackerSenses {
 public:
  /// How the map that localisation speaks of lies in the world that moments speak of.
  explicit TrackerSenses(const hires::world::MapToWorld& map_to_world = {})
      : map_to_world_(map_to_world) {}

  void OnOdometry(double stamp, const OdometryReading& reading);
  void OnLocalisation(double stamp, const hires::geometry::Pose2& X_MB);
  /// Where odometry begins, which tf tells again and again. It counts for moments that have no
  /// localisation of late: a PR2's tells its pose when it has moved, and not while it stands.
  void OnOdometryOrigin(double stamp, const hires::geometry::Pose2& X_MO);
  void OnJoints(double stamp, hires::robot::JointPositions joints);
  void OnLook(double stamp, std::vector<hires::perception::Detection> detections);

  /// Late looks, and then the next complete moment, in the order of time; nothing if it is not
  /// complete yet.
  std::optional<TrackerMoment> Take();

  int num_dropped() const { return num_dropped_; }  ///< moments that came too late, or stayed alone
  /// What has not come at all, or kept the last moment from being complete; for people.
  std::string Missing() const;

 private:
  struct Pending {
    std::optional<hires::robot::JointPositions> joints;
    std::optional<std::vector<hires::perception::Detection>> look;
  };
  template <typename T>
  struct Stamped {
    double stamp;
    T value;
  };

  bool IsTaken(double stamp) const;
  Pending* PendingAt(double stamp);
  std::optional<TrackerMoment> TakeLate();
  const hires::robot::JointPositions* PostureAt(double stamp) const;
  void NoteTime(double stamp);
  std::string Lack(double stamp, const Pending& pending) const;
  bool IsHopeless(double stamp) const;
  std::optional<hires::geometry::Pose2> BaseAt(double stamp) const;
  const OdometryReading* OdometryAt(double stamp) const;
  void Forget();

  hires::world::MapToWorld map_to_world_;
  std::deque<Stamped<OdometryReading>> odometry_;                        // oldest first
  std::deque<Stamped<hires::geometry::Pose2>> localisation_;             // likewise
  std::deque<Stamped<hires::geometry::Pose2>> origins_;                  // X_MO, likewise
  std::map<double, Pending> pending_;                                    // by stamp
  std::deque<Stamped<std::vector<hires::perception::Detection>>> late_;  // as they came
  std::deque<Stamped<hires::robot::JointPositions>> postures_;  // of moments taken, oldest first
  std::optional<double> newest_joints_;                         // stamp
  double taken_{-1.0};                                          // stamp of the last moment
  std::string why_dropped_;                                     // the last one, none came since
  int num_dropped_{0};
};

}  // namespace hires_ros
