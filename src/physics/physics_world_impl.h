// Private to this layer: what physics_world.cpp and physics_world_contacts.cpp share.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hires/physics/physics_world.h"
#include "physics/contact_solver.h"
#include "physics/placed_shape.h"

namespace hires::physics {
namespace detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A shape of a static or driven body in its group's frame G.
struct Fixture {
  PlacedShape shape;
  Vector3d p_GS;
  Matrix3d R_GS;
  geometry::Aabb bounds_G;
  BodyId body{-1};             // whose shape it is; a driven group has one body
  int collision{0};            // of the body's, whose piece it is
  std::uint64_t placed_at{0};  // the group's num_moves for which shape stands in the world
};

/// Shapes that move together: all static ones (G is the world), or those of one driven body.
struct Group {
  bool is_static{true};
  BodyId body{-1};  // of a driven group
  BodyState motion;
  Matrix3d R_WG{Matrix3d::Identity()};
  std::uint64_t num_moves{1};
  std::vector<Fixture> fixtures;         // by body, then by place in the body
  Vector3d p_GMiddle{Vector3d::Zero()};  // of a ball around all shapes of a driven body
  Vector3d p_WMiddle{Vector3d::Zero()};
  double radius{0.0};
  std::uint64_t asked_at{0};  // num_moves for which fixed_touch holds
  BodyId asked_except{-1};
  std::optional<FixedTouch> fixed_touch;

  /// Velocity of the group's material point at p_W [m/s].
  Vector3d VelocityAt(const Vector3d& p_W) const {
    return motion.V_WB.linear + motion.V_WB.angular.cross(p_W - motion.X_WB.translation);
  }

  /// What to add for a body that rides at p_W, so that a step takes it along the chord of its arc:
  /// the tangent would let it creep outwards. The same for all contacts of the body, which cannot
  /// shrink as the chords of its points would have it.
  Vector3d ChordCorrection(const Vector3d& p_W, double time_step) const {
    const Vector3d& w = motion.V_WB.angular;
    return 0.5 * time_step * w.cross(w.cross(p_W - motion.X_WB.translation));
  }
};

/// The shapes of one group that a loose body can reach while its centre of mass C stays within
/// kNearMargin of p_GC: a superset, so that how it came about never shows in the contacts.
struct NearList {
  bool is_valid{false};
  Vector3d p_GC{Vector3d::Zero()};
  std::vector<int> fixtures;
};

struct LooseShape {
  PlacedShape shape;
  Vector3d p_CS;
  Matrix3d R_BS;
};

struct LooseBody {
  dBodyID ode;
  Vector3d p_BC;
  double mass{0.0};  // [kg]
  Matrix3d I_B;      // [kg m^2] about C
  std::vector<LooseShape> shapes;
  double reach{0.0};           // no point is farther from C [m]
  double inside{0.0};          // radius of a ball within the thickest shape [m]
  std::vector<NearList> near;  // by group
  bool is_canonical{false};    // `state` is what ODE's numbers were made of
  BodyState state;
  BodyId id{-1};
  std::optional<HeldBody> held;
  bool may_rest{false};    // see PhysicsWorld::LetRest
  bool is_resting{false};  // ODE leaves it out then, and its shapes stay placed
  bool is_reached{false};  // see PhysicsWorld::IsReached

  // At the start of the step; v as it would be at the end without contacts.
  Vector3d p_WC, v, w;
  Matrix3d R_WB;
};

enum class BodyKind { kStatic, kDriven, kLoose };
struct BodyEntry {
  BodyKind kind;
  int index;  // of the group or of the loose body
};

inline Vector3d ToEigen(const dReal* v) { return {v[0], v[1], v[2]}; }

inline Matrix3d RotationOf(dBodyID body) {
  const dReal* r = dBodyGetRotation(body);
  Matrix3d R;
  R << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return R;
}

/// How ODE's things are given back.
struct Deleters {
  void operator()(dxWorld* world) const { dWorldDestroy(world); }
  void operator()(dxThreadingImplementation* threading) const {
    dThreadingFreeImplementation(threading);
  }
};

}  // namespace detail

struct PhysicsWorld::Impl {
  using Vector3d = Eigen::Vector3d;
  using BodyEntry = detail::BodyEntry;
  using BodyKind = detail::BodyKind;
  using Deleters = detail::Deleters;
  using Fixture = detail::Fixture;
  using Group = detail::Group;
  using LooseBody = detail::LooseBody;
  using NearList = detail::NearList;

  explicit Impl(const PhysicsParams& params_in);

  BodyId AddEntry(BodyKind kind, int index);
  void AddFixtures(const std::vector<geometry::Collision>& collisions, const geometry::Pose3& X_GB,
                   BodyId body, Group* group);
  LooseBody MakeLoose(const geometry::MassProperties& properties,
                      const std::vector<geometry::Collision>& collisions);
  void ForgetNear();
  Group& DrivenAt(BodyId id);
  LooseBody& LooseAt(BodyId id);
  const BodyEntry& At(BodyId id) const;

  void SetLoose(const BodyState& state, LooseBody* body);
  void SetDriven(const BodyState& state, Group* group);
  BodyState LooseState(const LooseBody& body) const;

  BodyState HeldState(const LooseBody& body) const;
  void Grip(const HeldBody& held, LooseBody* body);
  void Release(const BodyState& state, LooseBody* body);
  void PlaceFixture(const Group& group, Fixture* fixture) const;
  std::optional<FixedTouch> LookForFixedTouch(BodyId except, Group* group);
  void PlaceAllLoose();
  void FindAllContacts();  ///< of what is placed
  /// Sums up `found` for touches().
  void NoteTouch(const LooseBody& body, BodyId other, double friction);

  void Rest(LooseBody* body);
  void Wake(LooseBody* body);
  /// Wakes what rests and is touched by something that moves or may; so what it touches, too.
  void WakeTouched();
  bool IsTouchedByGroup(Group* group, LooseBody* body);
  bool IsTouchedBy(LooseBody* other, LooseBody* body);
  void NoteReached();
  /// It hardly moves, is held up from straight below by what never moves, and nothing else touches
  /// it.
  bool CanRest(int index);
  void RestWhatCan();

  void PlaceLoose(LooseBody* body);
  void TouchGroup(int group, LooseBody* body);
  /// True if they touch.
  bool TouchFixture(const Group& group, const Vector3d& lean, Fixture* fixture, LooseBody* body);
  void TouchLoose(LooseBody* a, LooseBody* b);
  void MakeNearList(const Group& group, const Vector3d& p_GC, const LooseBody& body,
                    NearList* near) const;
  /// Lets a body that would pass through a shape within this step come up to it and no farther.
  void CatchFast(const Group& group, const Vector3d& v_rel, Fixture* fixture, LooseBody* body);
  /// The normal velocity [m/s] relative to the other surface that a contact enforces as a lower
  /// bound: it repairs penetration and bounces.
  /// @param approach  normal velocity at the start of the step
  double WantedNormalSpeed(double depth, double restitution, double approach) const;
  /// @param wanted_speed  [m/s] see WantedNormalSpeed
  void AddContact(const ContactPoint& point, const Vector3d& v_other, double wanted_speed,
                  double friction, LooseBody* body, LooseBody* other_body);
  template <typename SurfaceVelocity>
  void AddContacts(const PlacedShape& shape, const PlacedShape& other, LooseBody* body,
                   LooseBody* other_body, const SurfaceVelocity& other_velocity);
  void MoveLoose();
  /// All loose bodies as they would be after a step without contacts.
  void FindFreeBodies();
  void NoteBroken();
  void MoveDriven();

  PhysicsParams params;
  Vector3d acceleration{Vector3d::Zero()};  // extra, of loose bodies
  std::uint64_t num_steps{0};
  int num_contacts{0};                  // of the last step
  std::vector<SolverContact> contacts;  // of what FindAllContacts looked at last
  double fastest_surface2{0.0};         // [m^2/s^2] of all that touched a loose body in this step
  BodyId broken{-1};
  std::unique_ptr<dxThreadingImplementation, Deleters> threading;  // outlives the world
  std::unique_ptr<dxWorld, Deleters> world;
  std::vector<BodyEntry> entries;  // by BodyId
  std::vector<Group> groups;       // 0 is the static one
  std::vector<LooseBody> loose;
  std::vector<LooseBody*> awake;  // those that FindAllContacts looked at last: that do not rest
  std::vector<SolverBody> solver_bodies;  // by index of loose bodies
  std::vector<geometry::Pose3> static_poses;
  ContactList found;
  std::vector<Vector3d> below;  // contact points of one body, for CanRest
  std::vector<Touch> touches;
};

}  // namespace hires::physics
