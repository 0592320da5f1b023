#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/actions/catalogue.h"
#include "hires/base/param_reader.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/skills/manipulation_context.h"
#include "hires/skills/skill_factory.h"
#include "hires/world/object_catalogue.h"
#include "hires/world/world.h"

namespace hires::skills::test_support {

inline std::string InSource(const std::string& path) {
  return std::string(HIRES_SOURCE_DIR) + "/" + path;
}

/// The restaurant with the PR2, loaded once for all tests of a program.
struct Restaurant {
  std::shared_ptr<const simulation::Scene> scene;
  SkillSet skills;
  std::map<std::string, std::string> models;  ///< instance -> model
};

inline const Restaurant& TheRestaurant() {
  static const Restaurant restaurant = [] {
    Restaurant made;
    world::World world = world::LoadWorld(InSource("worlds/restaurant.world"));
    for (const auto& [name, model] : world::LoadCatalogueModels(InSource("worlds/objects.yaml"))) {
      made.models[name] = model->name;
      world.models[model->name] = model;
    }
    base::ParamReader scene = base::ParamReader::FromFile(InSource("config/scene.yaml"));
    const robot::Robot robot = robot::LoadRobot(InSource("config/robots/pr2.yaml"));
    made.skills =
        MakeSkillSet(world, robot, {}, {}, ReadManipulationParams(scene.Sub("manipulation")));
    made.scene = simulation::MakeScene(std::move(world), robot);
    return made;
  }();
  return restaurant;
}

inline const robot::UpperBodyProfile& UpperBody() {
  return TheRestaurant().skills.manipulation->upper_body();
}

inline geometry::Pose3 Frame(const std::string& area) {
  return *TheRestaurant().scene->world.FindFrame(area);
}

inline world::ObjectState Standing(const std::string& name, const geometry::Pose3& X_MO) {
  world::ObjectState object;
  object.name = name;
  object.model = TheRestaurant().models.at(name);
  object.X_MO = X_MO;
  return object;
}

/// An object standing `x`, `y` [m] from the middle of an area.
inline world::ObjectState On(const std::string& name, const std::string& area, double x = 0.0,
                             double y = 0.0, double yaw = 0.0) {
  geometry::Pose3 X_MO = Frame(area);
  X_MO.translation += Eigen::Vector3d(x, y, 0.0);
  X_MO.rotation = geometry::RotationFromRpy(0.0, 0.0, yaw);
  return Standing(name, X_MO);
}

/// Torso and arms by posture, the base on an area.
inline robot::RobotState RobotAt(const std::string& area, const std::string& torso,
                                 const std::string& left, const std::string& right) {
  robot::RobotState state;
  state.X_MB = geometry::Flatten(Frame(area));
  state.joints = TheRestaurant().scene->robot.profile.joints;
  const robot::UpperBodyProfile& profile = UpperBody();
  state.joints[profile.torso_joint] = profile.torso_postures.at(torso);
  const robot::ArmProfile& left_arm = profile.arms.at("leftarm1");
  const robot::ArmProfile& right_arm = profile.arms.at("rightarm1");
  SetJoints(left_arm.joints, left_arm.postures.at(left).front(), &state.joints);
  SetJoints(right_arm.joints, right_arm.postures.at(right).front(), &state.joints);
  return state;
}

inline bool SameBits(const robot::JointTrajectory& a, const robot::JointTrajectory& b) {
  if (a.joints != b.joints || a.points.size() != b.points.size()) return false;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const robot::TrajectoryPoint &p = a.points[i], &q = b.points[i];
    if (p.time != q.time || p.positions != q.positions || p.velocities != q.velocities)
      return false;
  }
  return true;
}

/// The same trajectories and gripper commands to the last bit.
inline bool SameBits(const robot::Command& a, const robot::Command& b) {
  if (a.trajectories.size() != b.trajectories.size() || a.grippers.size() != b.grippers.size()) {
    return false;
  }
  for (const auto& [group, trajectory] : a.trajectories) {
    const auto other = b.trajectories.find(group);
    if (other == b.trajectories.end() || !SameBits(trajectory, other->second)) return false;
  }
  for (const auto& [arm, gripper] : a.grippers) {
    const auto other = b.grippers.find(arm);
    if (other == b.grippers.end() || other->second.gap != gripper.gap) return false;
  }
  return true;
}

/// What became of an action that was played to its end.
struct Played {
  Status status;
  double duration{0.0};                  ///< [s] simulated
  std::vector<std::string> phases;       ///< in order
  std::vector<robot::Command> commands;  ///< of every cycle
};

/// Whether the action's description names that failure; everything that moves may take too long.
inline bool IsDescribed(const base::ActionCall& action, base::FailureCode code) {
  const std::vector<base::FailureCode>& own = actions::OwnActions().Get(action.name).failures;
  return code == base::FailureCode::kNone || code == base::FailureCode::kTimedOut ||
         std::find(own.begin(), own.end(), code) != own.end();
}

/// A simulator at level planar and skills in lockstep with it.
class Rehearsal {
 public:
  /// Called in every control cycle, after the robot has looked: may change the world, and what the
  /// skill is told about it.
  using Meddle = std::function<void(Rehearsal*, const Skill&, robot::Observation*)>;

  Rehearsal(const robot::RobotState& robot, const std::vector<world::ObjectState>& objects,
            const simulation::Variation& variation = {}, std::uint64_t seed = 1)
      : simulator_(TheRestaurant().scene, variation, {objects}, robot, base::Rng(seed), {},
                   simulation::LevelOfDetail::kPlanar) {}

  /// Expects of a failure that the action's description names it.
  Played Play(const base::ActionCall& action, const Meddle& meddle = {},
              const SkillSet& skills = TheRestaurant().skills) {
    Played played;
    const double start = simulator_.time();
    const auto skill = MakeSkill(skills, action);
    for (long cycle = 1; played.status.progress == Progress::kRunning; ++cycle) {
      robot::Observation seen = simulator_.Observe(start);
      if (meddle) meddle(this, *skill, &seen);
      robot::Command command;
      played.status = skill->Update(seen, &command);
      simulator_.Send(command);
      if (played.phases.empty() || played.phases.back() != skill->phase()) {
        played.phases.push_back(skill->phase());
      }
      played.duration = simulator_.time() - start;
      played.commands.push_back(std::move(command));
      if (played.duration > 300.0)
        played.status = Failed({base::FailureCode::kOther, {}, "it never ends"});
      while (simulator_.time() < start + cycle * skill->period() - 1e-6) simulator_.Step();
    }
    EXPECT_TRUE(IsDescribed(action, played.status.failure.code))
        << action.name << ": " << ToString(played.status.failure)
        << " is not among the failures in src/actions/own_actions.cpp";
    return played;
  }

  void Wait(double duration) {
    const double end = simulator_.time() + duration;
    while (simulator_.time() < end) simulator_.Step();
  }

  simulation::RobotSimulator& simulator() { return simulator_; }
  world::ObjectState ObjectNow(const std::string& name) const {
    return *simulator_.GetWorldState().Find(name);
  }

 private:
  simulation::RobotSimulator simulator_;
};

}  // namespace hires::skills::test_support
