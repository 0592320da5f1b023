#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/tabletop_recogniser.h"
#include "hires/robot/observation.h"
#include "hires/sensing/object_memory.h"
#include "hires/simulation/scene.h"
#include "hires/simulation/variation.h"
#include "simulation/planar_robot.h"

namespace hires::simulation {

/// The camera on the head of a robot, which looks for objects twice a second while the head is
/// still, and what the robot knows of objects by it.
class HeadCamera {
 public:
  struct State {
    base::Rng rng;
    sensing::ObjectMemory memory;
    double last_look{-1e9};  ///< [s]
  };

  /// @param robot  outlives this.  @param rng  of its noise.  @pre the scene has surroundings
  HeadCamera(std::shared_ptr<const Scene> scene, const Variation& variation,
             const PlanarRobot* robot, const base::Rng& rng);

  /// What the robot knows though it has not looked, in the map as it believes it. What its hands
  /// hold it knows by itself.
  void Remember(const std::vector<robot::SeenObject>& objects, const geometry::Pose2& X_MBbelieved);
  /// A hand holds an object at the start.
  void KnowHeld(const std::string& name, const std::string& model, const std::string& link,
                const geometry::Pose3& X_LO);

  /// How the robot's body stands tells where things are that it carries.
  void Feel(double time, const geometry::Pose2& X_MBbelieved);
  bool MayLook(double time) const;  ///< the last look is long ago and the head is still
  /// @param X_MB  the base in truth.
  /// @param error  the believed base in it; none: as drawn, with noise.
  /// @param objects  all loose ones in truth.
  void Look(double time, const geometry::Pose2& X_MB, const std::optional<geometry::Pose2>& error,
            const std::vector<world::ObjectState>& objects);
  /// All that is known to a robot that believes its base to be at X_MBbelieved.
  std::vector<robot::SeenObject> Known(double time, const geometry::Pose2& X_MBbelieved) const;
  int num_newcomers() const { return state_.memory.num_newcomers(); }

  const State& Save() const { return state_; }
  void Restore(const State& state) { state_ = state; }

 private:
  perception::Sighting Detect(const perception::LineOfSight& sight, const geometry::Pose3& X_MC,
                              const std::vector<world::ObjectState>& objects);
  perception::Sighting Recognise(const perception::LineOfSight& sight, const geometry::Pose3& X_MC,
                                 const sensing::BodyReading& body, base::Rng rng);
  bool IsHeld(const std::string& name) const;  // as far as the robot knows
  sensing::BodyReading FeltBody(double time, const geometry::Pose2& X_MBbelieved) const;

  std::shared_ptr<const Scene> scene_;
  Variation variation_;
  const PlanarRobot* robot_;
  std::optional<perception::TabletopRecogniser> eye_;  // where the scene has a recogniser
  State state_;
};

}  // namespace hires::simulation
