#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/base/failure.h"
#include "hires/manipulation/arm_path.h"
#include "hires/manipulation/collision_scene.h"
#include "hires/skills/manipulation_context.h"

namespace hires::skills {

using JointPath = std::vector<std::vector<double>>;

/// Why a search for an arm's way failed, as a skill says it: no_path with the two that touch.
/// @pre result.status is not kFound.
base::Failure FailureOf(const manipulation::ArmPathResult& result);
/// That there is no way where these two touch.
base::Failure NoPath(const manipulation::Touch& touch);

/// What is seen, as a world's objects. An object that the robot holds moves with its link.
std::vector<world::ObjectState> ObjectsOf(const robot::Observation& observation);

/// Searches ways for one arm in the world as it was observed. Searches are pure thought: they may
/// begin from any joints of the arm.
class ArmPlanner {
 public:
  ArmPlanner(const ManipulationContext& context, const std::string& arm,
             const robot::Observation& observation);

  /// The observed objects and robot, to be changed before a search.
  void SetObjects(std::vector<world::ObjectState> objects);
  const std::vector<world::ObjectState>& objects() const { return objects_; }
  void SetGap(double gap);  ///< [m] of this arm's fingers
  void SetArm(const std::vector<double>& joints);
  void Allow(const std::string& part, const std::string& other) { scene_.Allow(part, other); }
  /// The fingers may touch the object, whatever it touches then.
  void AllowFingers(const std::string& object);
  /// The object, held in the present posture, may touch what it touches of furniture and of the
  /// robot's base, its tray among it.
  void AllowSupport(const std::string& object);
  /// Parts of the robot that touch each other with the arm's joints like this may do so.
  void AllowSelfTouches(const std::vector<double>& joints);
  /// ... anywhere on the straight way between two sets of joints.
  void AllowSelfTouchesAlong(const std::vector<double>& from, const std::vector<double>& to);

  const std::vector<double>& start() const { return start_; }  ///< the arm now
  const robot::JointPositions& posture() const { return posture_; }
  geometry::Pose3 X_BT(const std::vector<double>& joints) const;
  geometry::Pose3 X_MT(const std::vector<double>& joints) const;

  /// Joint positions that bring the tool to X_MT, the one nearest to `near` first.
  std::vector<std::vector<double>> Inverse(const geometry::Pose3& X_MT,
                                           const std::vector<double>& near,
                                           std::uint64_t seed) const;
  std::optional<manipulation::Touch> TouchAt(const std::vector<double>& joints) const;

  /// A way from one set of joints to another, the held object upright.
  manipulation::ArmPathResult Way(const std::vector<double>& from, const std::vector<double>& to,
                                  std::uint64_t seed) const;
  /// The tool straight to X_MT.
  manipulation::ArmPathResult Straight(const std::vector<double>& from,
                                       const geometry::Pose3& X_MT) const;
  /// Whether several arms may go straight to their ends at once, along `path` of all their joints.
  std::optional<manipulation::Touch> TouchAlong(const std::vector<std::string>& joints,
                                                const JointPath& path) const;

  const ManipulationContext& context() const { return context_; }
  const robot::ArmProfile& profile() const { return context_.arm(arm_); }

 private:
  manipulation::ArmScene SceneFrom(const std::vector<double>& joints) const;

  const ManipulationContext& context_;
  std::string arm_;
  const manipulation::ArmKinematics& kinematics_;
  manipulation::CollisionScene scene_;
  manipulation::LinkMask links_;       // that the arm moves
  manipulation::LinkMask upper_body_;  // that the torso moves
  geometry::Pose2 X_MB_;
  robot::JointPositions posture_;
  std::vector<double> start_;
  std::vector<world::ObjectState> objects_;
  std::optional<Eigen::Vector3d> upright_T_;
};

}  // namespace hires::skills
