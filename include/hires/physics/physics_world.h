#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::physics {

/// How the solver is set; the defaults are measured on the pepper mill on its tray at 1 kHz.
struct PhysicsParams {
  double time_step{0.001};              ///< [s]
  double gravity{9.81};                 ///< [m/s^2], along -z
  double erp{0.2};                      ///< share of a penetration that a step repairs
  double cfm{1e-8};                     ///< softness of constraints
  double surface_layer{0.001};          ///< [m] penetration that is left alone
  double max_correcting_velocity{100};  ///< [m/s]
  double restitution_threshold{0.01};   ///< [m/s] slower impacts do not bounce
};

using BodyId = int;

struct BodyState {
  geometry::Pose3 X_WB;
  geometry::Twist3 V_WB;  ///< of the body origin B, in world axes
};

/// A loose body that moves with a driven one.
struct HeldBody {
  BodyId loose{-1};
  BodyId driven{-1};
  geometry::Pose3 X_DL;      ///< the loose body in the driven one
  std::vector<BodyId> grip;  ///< driven bodies that hold it: they do not collide with it
};

/// All that changes about a PhysicsWorld, in the order in which bodies were added.
struct PhysicsState {
  std::vector<BodyState> bodies;
  std::vector<HeldBody> held;            ///< by loose body
  BodyId broken{-1};                     ///< see PhysicsWorld::broken
  std::vector<BodyId> resting, reached;  ///< see PhysicsWorld::LetRest, IsReached
};

/// Two bodies that touch; where they do in several points, those are summed up.
struct Touch {
  BodyId loose{-1};
  BodyId other{-1};          ///< static, driven, or a loose body added later
  Eigen::Vector3d position;  ///< [m] mean of the contact points
  Eigen::Vector3d normal;    ///< unit, out of `other` into `loose`, at the deepest point
  double depth{0.0};         ///< [m] of the deepest point
  double friction{0.0};      ///< coefficient there
};

/// Which shape of a driven body touches what never moves.
struct FixedTouch {
  int shape{-1};  ///< index in the collisions with which the driven body was added
  BodyId fixed{-1};
  double depth{0.0};  ///< [m]
};

/// Rigid bodies in contact, simulated by ODE at a fixed step. One instance belongs to one thread at
/// a time; several instances may run in several threads. The same calls give the same bits.
/// Shapes, masses and parameters that no body can have are refused with base::ConfigError; a wrong
/// BodyId or a state that is not finite breaks a precondition (std::logic_error).
class PhysicsWorld {
 public:
  explicit PhysicsWorld(const PhysicsParams& params);
  ~PhysicsWorld();
  PhysicsWorld(const PhysicsWorld&) = delete;
  PhysicsWorld& operator=(const PhysicsWorld&) = delete;

  /// Never moves.
  BodyId AddStatic(const std::vector<geometry::Collision>& collisions, const geometry::Pose3& X_WB);
  /// The half space z <= 0.
  BodyId AddFloor(double friction);
  /// Moves as SetMotion says, whatever it hits. Static and driven bodies do not collide with each
  /// other here.
  BodyId AddDriven(const std::vector<geometry::Collision>& collisions, const geometry::Pose3& X_WB);
  BodyId AddLoose(const geometry::MassProperties& mass_properties,
                  const std::vector<geometry::Collision>& collisions, const BodyState& state);

  /// Pose of a driven body now and its velocity during the next step(s). @pre body is driven.
  void SetMotion(BodyId driven, const BodyState& state);
  /// Puts a loose body somewhere else. @pre body is loose and not held.
  void SetState(BodyId loose, const BodyState& state);

  /// From now on the loose body keeps its pose in the driven one, whatever that takes: it pushes
  /// other loose bodies, and nothing pushes it. It does not collide with `grip`; with static and
  /// other driven bodies its touches are noted and nothing more.
  /// @pre `loose` is loose and not held, `driven` and all of `grip` are driven.
  void Hold(BodyId loose, BodyId driven, const std::vector<BodyId>& grip);
  /// It goes on with the velocity that it has. @pre it is held.
  void LetGo(BodyId loose);
  /// Moves a held body in the one that holds it, by `way_W` [m] in world axes. @pre it is held.
  void ShiftHeld(BodyId loose, const Eigen::Vector3d& way_W);
  bool IsHeld(BodyId loose) const;

  /// For what rolls at the least touch: from the step on in which it hardly moves and what never
  /// moves holds it up from straight below, it rests. It keeps its pose bit for bit and costs next
  /// to nothing, until a driven body, a held one or a loose one that does not rest touches it, it
  /// is put elsewhere, or the ground is shaken. What was reached rests no more.
  /// @pre body is loose
  void LetRest(BodyId loose);
  bool IsResting(BodyId loose) const;  ///< @pre body is loose
  /// A driven or held body has touched it in some step so far, or a loose one that was reached
  /// itself. What was not moves by its own weight alone, and what it moves, too. @pre body is loose
  bool IsReached(BodyId loose) const;
  BodyState GetState(BodyId body) const;

  /// Acceleration added to every loose body's own weight during the next step(s), in world axes
  /// [m/s^2]; the non-inertial force of tests and of shaken ground. Zero at first. A setting, like
  /// params(): no part of what Save() returns.
  void SetExtraAcceleration(const Eigen::Vector3d& acceleration);

  void Step();  ///< advances by params().time_step
  std::uint64_t num_steps() const;
  int num_contacts() const;  ///< contact points of the last step
  /// What touched at the beginning of the last step; held bodies and their grip left out, and what
  /// rests on something.
  const std::vector<Touch>& touches() const;
  /// The first loose body that gained energy which nothing gave it: within one step more than
  /// kUnexplained beyond what gravity, shaking and the fastest surface that touched anything can
  /// have done. Then contacts were computed wrongly or bodies stood in each other, and what this
  /// world says from there on means nothing.
  std::optional<BodyId> broken() const;
  /// [J/kg] Enough for 0.7 m/s from rest, or 2.5 cm of height. What repairing ordinary penetrations
  /// gives lies below a third of it.
  static constexpr double kUnexplained = 0.25;
  /// What touches now, without a step; of what rests, nothing. Costs about as much as one.
  std::vector<Touch> FindTouches();
  /// The deepest touch of a driven body with static ones but `except`, or nothing. Looks at shapes
  /// only when the body has moved since it was asked last. @pre body is driven.
  std::optional<FixedTouch> FindFixedTouch(BodyId driven, BodyId except = -1);

  /// Saving canonicalises the state (unit quaternions): after Save() the world goes on with exactly
  /// what was saved, so that a restored world and the saved one stay equal bit by bit.
  PhysicsState Save();
  void Restore(const PhysicsState& state);  ///< @pre same bodies in the same order

  /// Messages that ODE itself raised in this thread since the last call (caught, never printed).
  static std::vector<std::string> TakeSolverMessages();

  const PhysicsParams& params() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::physics
