#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/rolling.h"
#include "hires/physics/physics_world.h"
#include "hires/simulation/variation.h"
#include "hires/world/world.h"
#include "simulation/hands.h"

namespace hires::simulation {

/// The objects of a world that are no furniture, by their index: each is a loose body in a
/// PhysicsWorld, or part of a robot with frozen joints that holds it.
class LooseObjects {
 public:
  /// `world` and `physics` outlive this.
  LooseObjects(const world::World& world, const Variation& variation,
               physics::PhysicsWorld* physics);

  /// What rolls from where it lies (geometry::RollingOf) has its middle and its radius as its model
  /// says, whatever the variation: else it would not lie still there. It may rest until it is
  /// touched.
  /// @param object  as it starts.  @param X_BO  where that is, seen from the base.
  /// @param is_carried  it stands on the robot.
  void AddLoose(const world::ObjectState& object, const geometry::Pose3& X_BO, bool is_carried);
  /// One that moves with the base whatever happens. @param object  with the link that holds it.
  void AddRigid(const world::ObjectState& object, const geometry::Pose3& X_BO);
  /// What starts so deep in something that it would be thrown out is put onto its surface, and in a
  /// stack all that stands on it.  @param X_MB  the base now.
  void TakeOut(const geometry::Pose3& X_MB);

  int size() const { return static_cast<int>(objects_.size()); }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<int>& carried() const { return carried_; }  ///< stood on the robot at the start
  const world::ObjectState& AtStart(int object) const { return objects_.at(object); }
  const world::ObjectModel& ModelOf(int object) const;
  bool IsLoose(int object) const { return bodies_.at(object) >= 0; }
  physics::BodyId BodyOf(int object) const { return bodies_[object]; }  ///< @pre IsLoose(object)
  /// How it rolls from where it lay at the start; kNot of one that was held then.
  geometry::Rolling RollingOf(int object) const { return rolling_.at(object); }
  std::optional<int> WithBody(physics::BodyId body) const;

  /// @param X_MB  the base now.
  geometry::Pose3 PoseOf(int object, const geometry::Pose3& X_MB) const;
  geometry::Twist3 VelocityOf(int object) const;  ///< in map axes; 0 for one that is not loose
  geometry::Pose3 X_BOstart(int object) const { return X_BO_start_[object]; }
  /// Puts it somewhere, moving. @pre IsLoose(object), nothing holds it
  void Put(int object, const physics::BodyState& state);

  std::vector<GraspableObject> Graspable() const;          ///< each, by index
  double FrictionOf(int object) const;                     ///< of its most slippery shape
  std::vector<geometry::Collision> RigidShapes_B() const;  ///< named by their objects

 private:
  std::optional<int> Free(physics::BodyId body) const;  // an object that nothing holds
  Variation VariationOf(int object) const;

  const world::World& world_;
  Variation variation_;
  physics::PhysicsWorld* physics_;
  std::vector<world::ObjectState> objects_;  // poses as at the start
  std::vector<std::shared_ptr<const world::ObjectModel>> models_;
  std::vector<std::string> names_;
  std::vector<geometry::Rolling> rolling_;
  std::vector<physics::BodyId> bodies_;      // -1: not loose
  std::vector<geometry::Pose3> X_BO_start_;  // in the base frame
  std::vector<int> carried_;
};

}  // namespace hires::simulation
