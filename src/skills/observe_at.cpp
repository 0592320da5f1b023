#include "skills/observe_at.h"

#include <algorithm>
#include <cmath>

#include "hires/skills/base_place.h"
#include "hires/skills/head_aim.h"
#include "skills/free_spot.h"
#include "skills/joint_motion.h"
#include "skills/look_skills.h"
#include "skills/posture_skills.h"

namespace hires::skills {
namespace {

using geometry::Pose2;
using robot::Observation;

const char kReturnTorso[] = "return_torso";
const char kReturnBase[] = "return_base";

/// A drive as a part of another skill.
class Drive : public Activity {
 public:
  explicit Drive(std::unique_ptr<Skill> skill) : skill_(std::move(skill)) {}
  Status Update(const Observation& observation, robot::Command* command) override {
    return skill_->Update(observation, command);
  }

 private:
  std::unique_ptr<Skill> skill_;
};

Stage DriveStage(const std::string& name, const DriveTo& drive, const Pose2& X_MGoal) {
  return {name,
          [drive, X_MGoal](const Observation&) {
            return Begin(std::make_unique<Drive>(drive(X_MGoal)));
          },
          {}};
}

}  // namespace

ObserveObjectsAt::ObserveObjectsAt(std::shared_ptr<const ManipulationContext> context,
                                   DriveTo drive, const std::string& area, const Pose& pose)
    : StagedSkill(context->params.period),
      context_(std::move(context)),
      drive_(std::move(drive)),
      area_(AreaIn(*context_->world, area, context_->params.place)),
      X_MStand_(pose.X_MStand) {
  const double height = TorsoHeight(*context_, pose.torso);
  Append({"note_expected", [this](const Observation& seen) { return NoteExpected(seen); }, {}});
  Append(DriveStage("drive", drive_, AtBasePlace(X_MStand_, pose.place)));
  Append(TorsoStage(context_, "torso", height));
  Append({"sweep", [this](const Observation& seen) { return Sweep(seen); }, {}});
  Append({"look_again", [this](const Observation& seen) { return LookForMissing(seen); }, {}});
  Append({"return",
          [this](const Observation&) {
            Insert(ReturnStages());
            return NothingToDo();
          },
          {}});
}

Beginning ObserveObjectsAt::NoteExpected(const Observation& observation) {
  const auto height = observation.joints.find(context_->upper_body().torso_joint);
  if (height != observation.joints.end()) height_before_ = height->second;
  for (const robot::SeenObject& object : observation.objects) {
    const Eigen::Vector3d p_A = area_.X_MA.Inverse() * object.X_MO.translation;
    const bool is_over = area_.extent_A.contains(p_A.head<2>().eval());
    const bool stands = object.attached_to.empty() && std::abs(p_A.z()) <= kSameLevel;
    if (is_over && stands) expected_.push_back(object.name);
  }
  return NothingToDo();
}

Beginning ObserveObjectsAt::Sweep(const Observation& observation) {
  looks_since_ = observation.time;
  return Begin(std::make_unique<SweepPoints>(
      context_, PointsOn(area_.X_MA, area_.extent_A, context_->params.look.part_spacing)));
}

bool ObserveObjectsAt::HasSeen(const Observation& observation, const std::string& object) const {
  const robot::SeenObject* known = FindSeen(observation, object);
  return known != nullptr && known->time > looks_since_;
}

Beginning ObserveObjectsAt::LookForMissing(const Observation& observation) {
  std::vector<Stage> looks;
  for (const std::string& object : expected_) {
    if (HasSeen(observation, object)) continue;
    const auto place = [object](const Observation& seen) -> std::optional<Eigen::Vector3d> {
      const robot::SeenObject* known = FindSeen(seen, object);
      if (known == nullptr) return std::nullopt;
      return known->X_MO.translation;
    };
    looks.push_back(LookStage(context_, "look_again", place));
    looks.push_back(
        {"see",
         [this, object](const Observation&) {
           return Begin(std::make_unique<WaitUntil>(
               [this, object](const Observation& seen) { return HasSeen(seen, object); },
               context_->params.look.time_limit,
               base::Failure{base::FailureCode::kObjectNotSeen, {object}, ""}));
         },
         {}});
  }
  Insert(std::move(looks));
  return NothingToDo();
}

std::vector<Stage> ObserveObjectsAt::ReturnStages() const {
  return {TorsoStage(context_, kReturnTorso, height_before_),
          DriveStage(kReturnBase, drive_, X_MStand_)};
}

std::vector<Stage> ObserveObjectsAt::AfterFailure(const std::string& stage,
                                                  const Observation& /*observation*/) {
  if (stage == kReturnBase) return {};
  if (stage == kReturnTorso) return {DriveStage(kReturnBase, drive_, X_MStand_)};
  return ReturnStages();
}

}  // namespace hires::skills
