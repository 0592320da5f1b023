#include "simulation/loose_objects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "hires/base/check.h"
#include "simulation/varied.h"

namespace hires::simulation {

using Eigen::Vector3d;
using geometry::Pose3;

LooseObjects::LooseObjects(const world::World& world, const Variation& variation,
                           physics::PhysicsWorld* physics)
    : world_(world), variation_(variation), physics_(physics) {}

void LooseObjects::AddRigid(const world::ObjectState& object, const Pose3& X_BO) {
  objects_.push_back(object);
  models_.push_back(world_.RequireModel(object.model));
  names_.push_back(object.name);
  rolling_.push_back(geometry::Rolling::kNot);
  bodies_.push_back(-1);
  X_BO_start_.push_back(X_BO);
}

void LooseObjects::AddLoose(const world::ObjectState& object, const Pose3& X_BO, bool is_carried) {
  if (is_carried) carried_.push_back(size());
  AddRigid(object, X_BO);
  const world::ObjectModel& model = ModelOf(size() - 1);
  if (object.attached_to.empty()) {
    rolling_.back() =
        geometry::RollingOf(model.collisions, model.mass_properties.p_BBcm, object.X_MO.rotation);
  }
  const Variation variation = VariationOf(size() - 1);
  bodies_.back() =
      physics_->AddLoose(Varied(model.mass_properties, variation),
                         Varied(model.collisions, variation), {object.X_MO, object.V_MO});
  if (rolling_.back() != geometry::Rolling::kNot) physics_->LetRest(bodies_.back());
}

Variation LooseObjects::VariationOf(int object) const {
  Variation variation = variation_;
  if (RollingOf(object) == geometry::Rolling::kNot) return variation;
  const Variation none;
  variation.com_offset = none.com_offset;
  variation.com_height_factor = none.com_height_factor;
  variation.radius_factor = none.radius_factor;
  return variation;
}

void LooseObjects::TakeOut(const Pose3& X_MB) {
  constexpr double kGentle = 0.2;   // [m/s] at which physics may push apart what stands in another
  constexpr int kMostRounds = 100;  // each frees one more of a stack
  const physics::PhysicsParams& params = physics_->params();
  const double deepest = params.surface_layer + kGentle * params.time_step / params.erp;
  for (int round = 0; round < kMostRounds; ++round) {
    std::map<int, Vector3d> ways_M;
    for (const physics::Touch& touch : physics_->FindTouches()) {
      if (touch.depth <= deepest) continue;
      const auto object = Free(touch.loose), other = Free(touch.other);
      const bool is_other = other && (!object || touch.normal.z() < 0.0);  // the upper one
      if (!object && !is_other) continue;
      Vector3d& way_M =
          ways_M.try_emplace(is_other ? *other : *object, Vector3d::Zero()).first->second;
      if (touch.depth > way_M.norm())
        way_M = (is_other ? -touch.depth : touch.depth) * touch.normal;
    }
    if (ways_M.empty()) return;
    for (const auto& [object, way_M] : ways_M) {
      objects_[object].X_MO.translation += way_M;
      X_BO_start_[object].translation += X_MB.rotation.inverse() * way_M;
      physics_->SetState(bodies_[object], {objects_[object].X_MO, objects_[object].V_MO});
    }
  }
}

const world::ObjectModel& LooseObjects::ModelOf(int object) const { return *models_.at(object); }

std::optional<int> LooseObjects::WithBody(physics::BodyId body) const {
  for (int i = 0; i < size(); ++i) {
    if (IsLoose(i) && bodies_[i] == body) return i;
  }
  return std::nullopt;
}

std::optional<int> LooseObjects::Free(physics::BodyId body) const {
  const std::optional<int> object = WithBody(body);
  return object && !physics_->IsHeld(body) ? object : std::nullopt;
}

Pose3 LooseObjects::PoseOf(int object, const Pose3& X_MB) const {
  if (bodies_[object] < 0) return X_MB * X_BO_start_[object];
  return physics_->GetState(bodies_[object]).X_WB;
}

geometry::Twist3 LooseObjects::VelocityOf(int object) const {
  if (bodies_[object] < 0) return {};
  return physics_->GetState(bodies_[object]).V_WB;
}

void LooseObjects::Put(int object, const physics::BodyState& state) {
  HIRES_CHECK(IsLoose(object), "an attached object cannot be put elsewhere");
  physics_->SetState(bodies_[object], state);
}

std::vector<GraspableObject> LooseObjects::Graspable() const {
  std::vector<GraspableObject> graspable;
  for (int i = 0; i < size(); ++i) {
    const geometry::MassProperties mass = Varied(ModelOf(i).mass_properties, VariationOf(i));
    graspable.push_back({bodies_[i], mass.mass, mass.p_BBcm});
  }
  return graspable;
}

double LooseObjects::FrictionOf(int object) const {
  double friction = HUGE_VAL;
  for (const auto& shape : Varied(ModelOf(object).collisions, VariationOf(object))) {
    friction = std::min(friction, shape.friction);
  }
  return friction;
}

std::vector<geometry::Collision> LooseObjects::RigidShapes_B() const {
  std::vector<geometry::Collision> shapes;
  for (int i = 0; i < size(); ++i) {
    if (IsLoose(i)) continue;
    for (geometry::Collision shape : ModelOf(i).collisions) {
      shape.name = names_[i];
      shape.X_BS = X_BO_start_[i] * shape.X_BS;
      shapes.push_back(std::move(shape));
    }
  }
  return shapes;
}

}  // namespace hires::simulation
