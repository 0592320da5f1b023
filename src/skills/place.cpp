#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/skills/head_aim.h"
#include "skills/hand_stages.h"
#include "skills/joint_motion.h"
#include "skills/look_skills.h"
#include "skills/object_skills.h"

namespace hires::skills {
namespace {

using geometry::Pose3;
using robot::Observation;
using Code = base::FailureCode;

/// Everything loose but one object.
std::vector<world::ObjectState> Others(const Observation& seen, const std::string& object) {
  std::vector<world::ObjectState> others;
  for (world::ObjectState& other : ObjectsOf(seen)) {
    if (base::ToLower(other.name) != object && other.attached_to.empty()) {
      others.push_back(std::move(other));
    }
  }
  return others;
}

}  // namespace

PlaceObject::PlaceObject(SharedContext context, const base::ActionCall& action,
                         const std::string& object, const std::string& arm, const std::string& area,
                         const std::string& spot)
    : StagedSkill(context->params.period),
      context_(std::move(context)),
      object_(base::ToLower(object)),
      arm_(KnownArm(*context_, arm)),
      area_(AreaIn(*context_->world, area, context_->params.place)),
      spot_(ParseSpot(spot)),
      seed_(SeedOf(context_->params, action)),
      lean_(context_->standing) {
  AppendStages();
  AppendChecking();
}

PlaceObject::PlaceObject(SharedContext context, const base::ActionCall& action,
                         const std::string& object, const std::string& arm)
    : StagedSkill(context->params.period),
      context_(std::move(context)),
      object_(base::ToLower(object)),
      arm_(KnownArm(*context_, arm)),
      seed_(SeedOf(context_->params, action)),
      lean_(context_->standing) {
  RequireTray(*context_);
  AppendStages();
  AppendChecking();
}

Pose3 PlaceObject::X_MGoal(const Observation& observation) const {
  return area_ ? area_->X_MA : TrayFrame(*context_, observation);
}

FreeSpots PlaceObject::SpotsFor(const world::ObjectModel& model, const Pose3& X_MGoal,
                                const std::vector<world::ObjectState>& others) const {
  const PlaceParams& params = context_->params.place;
  const world::World& world = *context_->world;
  if (!area_) return FindFreeSlots(params, world, model, X_MGoal, others);
  if (spot_) return FindStatedSpot(params, world, model, *area_, others, *spot_);
  return FindFreeSpots(params, world, model, *area_, others);
}

Beginning PlaceObject::Plan(const Observation& observation) {
  if (base::Failure unknown = WhyNotKnown(*context_, observation); unknown) {
    return CannotBegin(unknown);
  }
  const robot::SeenObject* held = FindSeen(observation, object_);
  if (held == nullptr) return CannotBegin(Code::kObjectSlipped);
  const auto model = context_->world->RequireModel(held->model);
  const Pose3 X_MA = X_MGoal(observation);
  const FreeSpots spots = SpotsFor(*model, X_MA, Others(observation, object_));
  plan_ = PlanPlacing(*context_, arm_, observation, *held, X_MA, spots, seed_);
  return plan_.failure ? CannotBegin(plan_.failure) : NothingToDo();
}

void PlaceObject::AppendStages() {
  const auto is_held = [this](const Observation& seen) {
    return WhyNotHeld(*context_, arm_, object_, seen);
  };
  Append({"check_hand",
          [this](const Observation& seen) {
            const base::Failure why = WhyNotHeld(*context_, arm_, object_, seen);
            return why ? CannotBegin(why) : NothingToDo();
          },
          {}});
  Append({"look",
          [this](const Observation& seen) {
            return LookAtPoint(context_, seen, X_MGoal(seen).translation);
          },
          is_held});
  // What nobody told of is in the way as well, once some looks have agreed on what it is.
  Append({"see_newcomers",
          [this](const Observation& begin) {
            if (begin.num_newcomers == 0) return NothingToDo();
            const double latest = begin.time + context_->params.look.time_limit;
            return Begin(std::make_unique<WaitUntil>(
                [latest](const Observation& seen) {
                  return seen.num_newcomers == 0 || seen.time >= latest;
                },
                context_->params.look.time_limit, base::Failure()));
          },
          is_held});
  Append({"plan", [this](const Observation& seen) { return Plan(seen); }, {}});
  Append({"reach",
          [this](const Observation& seen) {
            return Begin(Along(context_, arm_, plan_.reach, seen, context_->params.speed));
          },
          is_held});
  Append({"lower",
          [this](const Observation& seen) {
            return Begin(Along(context_, arm_, plan_.lower, seen, context_->params.straight_speed));
          },
          is_held});
  Append({"open_gripper",
          [this](const Observation&) { return Begin(GripperMotion::Open(context_, arm_)); },
          {}});
  Append({"retreat",
          [this](const Observation& seen) {
            return Begin(
                Along(context_, arm_, plan_.retreat, seen, context_->params.straight_speed));
          },
          {}});
}

Beginning PlaceObject::ReturnAndLook(const Observation& observation) const {
  Beginning side = ToSide(context_, arm_, false, observation, seed_);
  if (side.activity == nullptr) return side;
  const Pose3 X_MO = geometry::Lift(observation.X_MB) * plan_.X_BO;
  Beginning look = LookAtPoint(context_, observation, X_MO.translation);
  if (look.activity == nullptr) return look;
  return Begin(std::make_unique<Both>(std::move(side.activity), std::move(look.activity)));
}

base::Failure PlaceObject::WhyNotStanding(const Observation& observation) const {
  const robot::SeenObject* seen = FindSeen(observation, object_);
  const PlaceParams& params = context_->params.place;
  const Pose3 X_BO = geometry::Lift(observation.X_MB).Inverse() * seen->X_MO;
  if (lean_.lies()) return Code::kObjectToppled;
  const double away = (X_BO.translation - plan_.X_BO.translation).norm();
  return away <= params.standing_tolerance ? base::Failure() : Code::kObjectSlipped;
}

void PlaceObject::AppendChecking() {
  Append({"to_side", [this](const Observation& seen) { return ReturnAndLook(seen); }, {}});
  Append({"see_it_stand",
          [this](const Observation& begin) {
            looked_since_ = begin.time;
            return Begin(std::make_unique<WaitUntil>(
                [this](const Observation& seen) {
                  const robot::SeenObject* object = FindSeen(seen, object_);
                  const bool is_new = object != nullptr && object->time > looked_since_;
                  if (is_new) lean_.See(*object);
                  return is_new && !lean_.is_open();
                },
                context_->params.look.time_limit + context_->standing.hold_time,
                Code::kObjectNotSeen));
          },
          {}});
  Append({"check_stand",
          [this](const Observation& seen) {
            const base::Failure why = WhyNotStanding(seen);
            return why ? CannotBegin(why) : NothingToDo();
          },
          {}});
}

std::vector<Stage> PlaceObject::AfterFailure(const std::string& stage,
                                             const Observation& /*observation*/) {
  const bool has_moved = stage == "reach" || stage == "lower" || stage == "open_gripper" ||
                         stage == "retreat" || stage == "to_side";
  return has_moved ? StopAndTidy(context_, arm_, seed_) : std::vector<Stage>{};
}

}  // namespace hires::skills
