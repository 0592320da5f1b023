#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/skills/head_aim.h"
#include "skills/hand_stages.h"
#include "skills/joint_motion.h"
#include "skills/look_skills.h"
#include "skills/object_skills.h"

namespace hires::skills {
namespace {

using Code = base::FailureCode;
using robot::Observation;

/// Stages after which the hand is at the object and has to be drawn back before anything else.
bool IsAtObject(const std::string& stage) {
  return stage == "approach" || stage == "close_gripper" || stage == "check_grasp";
}

}  // namespace

PickUpObject::PickUpObject(SharedContext context, const base::ActionCall& action,
                           const std::string& object, const std::string& arm, From from)
    : StagedSkill(context->params.period),
      context_(std::move(context)),
      object_(base::ToLower(object)),
      arm_(KnownArm(*context_, arm)),
      seed_(SeedOf(context_->params, action)) {
  if (from == From::kTray) RequireTray(*context_);
  AppendLooking(from);
  AppendReaching();
  AppendTaking();
}

void PickUpObject::AppendLooking(From from) {
  Append({"look",
          [this, from](const Observation& seen) {
            const robot::SeenObject* held = HeldBy(context_->arm(arm_), seen);
            if (held != nullptr) return CannotBegin({Code::kHandFull, {held->name}});
            const robot::SeenObject* known = FindSeen(seen, object_);
            if (known != nullptr) return LookAtPoint(context_, seen, known->X_MO.translation);
            if (from == From::kTray) {
              return LookAtPoint(context_, seen, TrayFrame(*context_, seen).translation);
            }
            return Begin(
                std::make_unique<SweepPoints>(context_, NearbyPlaces(*context_, seen.X_MB)));
          },
          {}});
  Append({"see",
          [this](const Observation&) {
            return Begin(std::make_unique<Sight>(context_, object_, &sighted_));
          },
          {}});
}

Beginning PickUpObject::Plan(const Observation& observation) {
  if (base::Failure unknown = WhyNotKnown(*context_, observation); unknown) {
    return CannotBegin(unknown);
  }
  if (!sighted_.attached_to.empty()) {
    return CannotBegin({Code::kObjectHeld, {sighted_.attached_to}});
  }
  if (!world::IsUpright(context_->standing, sighted_.X_MO)) {
    return CannotBegin(Code::kObjectToppled);
  }
  plan_ = PlanGrasp(*context_, arm_, observation, sighted_, seed_);
  return plan_.failure ? CannotBegin(plan_.failure) : NothingToDo();
}

void PickUpObject::AppendReaching() {
  Append({"plan", [this](const Observation& seen) { return Plan(seen); }, {}});
  Append({"reach",
          [this](const Observation& seen) {
            return Begin(std::make_unique<Both>(
                Along(context_, arm_, plan_.reach, seen, context_->params.speed),
                GripperMotion::Open(context_, arm_)));
          },
          {}});
  Append({"approach",
          [this](const Observation& seen) {
            return Begin(
                Along(context_, arm_, plan_.approach, seen, context_->params.straight_speed));
          },
          {}});
}

void PickUpObject::AppendTaking() {
  const auto is_held = [this](const Observation& seen) {
    return WhyNotHeld(*context_, arm_, object_, seen);
  };
  Append({"close_gripper",
          [this](const Observation&) { return Begin(GripperMotion::Close(context_, arm_)); },
          {}});
  Append({"check_grasp",
          [this](const Observation& seen) {
            const double gap = GapNow(context_->arm(arm_), seen);
            const bool is_empty = gap < context_->params.gripper.min_held_gap;
            return is_empty ? CannotBegin(Code::kGraspFailed) : NothingToDo();
          },
          {}});
  Append({"lift",
          [this](const Observation& seen) {
            return Begin(Along(context_, arm_, plan_.lift, seen, context_->params.straight_speed));
          },
          is_held});
  Append({"to_side",
          [this](const Observation& seen) { return ToSide(context_, arm_, true, seen, seed_); },
          is_held});
}

std::vector<Stage> PickUpObject::AfterFailure(const std::string& stage,
                                              const Observation& /*observation*/) {
  if (stage == "look" || stage == "see" || stage == "plan") return {};
  std::vector<Stage> stages = StopAndTidy(context_, arm_, seed_);
  if (!IsAtObject(stage)) return stages;
  const Stage open{
      "open_gripper",
      [this](const Observation&) { return Begin(GripperMotion::Open(context_, arm_)); },
      {}};
  const Stage back{
      "draw_back",
      [this](const Observation& seen) {
        JointPath back(plan_.approach.rbegin(), plan_.approach.rend());
        return Begin(Along(context_, arm_, back, seen, context_->params.straight_speed));
      },
      {}};
  stages.insert(stages.begin() + 1, {open, back});
  return stages;
}

base::Failure WhyNotHeld(const ManipulationContext& context, const std::string& arm,
                         const std::string& object, const Observation& observation) {
  const robot::ArmProfile& profile = context.arm(arm);
  if (GapNow(profile, observation) < context.params.gripper.min_held_gap) {
    return Code::kObjectSlipped;
  }
  const robot::SeenObject* seen = FindSeen(observation, object);
  const bool is_elsewhere = seen == nullptr || seen->attached_to != profile.palm_link;
  return is_elsewhere ? Code::kObjectSlipped : base::Failure();
}

}  // namespace hires::skills
