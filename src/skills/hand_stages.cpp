#include "skills/hand_stages.h"

#include <limits>

#include "skills/joint_motion.h"
#include "skills/posture_skills.h"

namespace hires::skills {
namespace {

using robot::Observation;

constexpr double kAnyDistance = std::numeric_limits<double>::infinity();  // [m]

/// Advances one of two; false if it has failed.
bool Advance(std::unique_ptr<Activity>* activity, const Observation& observation,
             robot::Command* command, Status* failed) {
  if (*activity == nullptr) return true;
  const Status status = (*activity)->Update(observation, command);
  if (status.progress == Progress::kSucceeded) activity->reset();
  if (status.progress != Progress::kFailed) return true;
  *failed = status;
  return false;
}

Beginning StopArm(const SharedContext& context, const std::string& arm, const Observation& seen) {
  robot::Command halt = Halt(*context->robot, seen);
  const auto braking = halt.trajectories.find(arm);
  if (braking == halt.trajectories.end()) return NothingToDo();
  return Begin(std::make_unique<JointMotion>(context, GroupTrajectories{{arm, braking->second}}));
}

}  // namespace

Status Both::Update(const Observation& observation, robot::Command* command) {
  Status failed;
  if (!Advance(&a_, observation, command, &failed)) return failed;
  if (!Advance(&b_, observation, command, &failed)) return failed;
  return a_ == nullptr && b_ == nullptr ? Succeeded() : Status{};
}

std::unique_ptr<Activity> Along(const SharedContext& context, const std::string& arm,
                                const JointPath& path, const Observation& observation,
                                double speed) {
  robot::JointTrajectory trajectory =
      TrajectoryFrom(*context, observation, context->arm(arm).joints, path, speed);
  return std::make_unique<JointMotion>(context, GroupTrajectories{{arm, std::move(trajectory)}});
}

Beginning ToSide(const SharedContext& context, const std::string& arm, bool holds,
                 const Observation& observation, std::uint64_t seed) {
  const std::vector<double>& side = PosturePositions(context->arm(arm), "armtosideposture", holds);
  Beginning beginning;
  for (int i = 0; i < context->params.pick.max_return_tries; ++i) {
    beginning = MoveArmTo(context, {arm, side, AttemptSeed(seed, 1000 + i)}, observation);
    if (!beginning.failure) break;
  }
  return beginning;
}

std::vector<Stage> StopAndTidy(const SharedContext& context, const std::string& arm,
                               std::uint64_t seed) {
  return {{"stop", [=](const Observation& seen) { return StopArm(context, arm, seen); }, {}},
          {"tidy_up",
           [=](const Observation& seen) {
             const bool holds = HeldBy(context->arm(arm), seen) != nullptr;
             return ToSide(context, arm, holds, seen, seed);
           },
           {}}};
}

LeanWatch::LeanWatch(const world::StandingCriterion& criterion)
    : detector_({criterion.tilt, criterion.hold_time, kAnyDistance, kAnyDistance}) {}

void LeanWatch::See(const robot::SeenObject& object) {
  is_held_ = !object.attached_to.empty();
  detector_.Update(object.X_MO, is_held_, object.time);
}

Sight::Sight(SharedContext context, std::string object, world::ObjectState* sighted)
    : context_(std::move(context)),
      object_(std::move(object)),
      lean_(context_->standing),
      sighted_(sighted) {}

Status Sight::Update(const Observation& observation, robot::Command* /*command*/) {
  if (begin_ < 0.0) begin_ = latest_ = observation.time;
  const robot::SeenObject* seen = FindSeen(observation, object_);
  if (seen != nullptr && seen->time > latest_) Take(*seen);
  const LookParams& look = context_->params.look;
  if (static_cast<int>(X_MO_.size()) >= look.sightings) return Conclude();
  const double time_limit = look.time_limit + context_->standing.hold_time;
  return observation.time - begin_ > time_limit ? Conclude() : Status{};
}

void Sight::Take(const robot::SeenObject& seen) {
  latest_ = seen.time;
  lean_.See(seen);
  if (lean_.is_open()) return;
  X_MO_.push_back(seen.X_MO);
  sighted_->name = seen.name;
  sighted_->model = seen.model;
  sighted_->attached_to = seen.attached_to;
}

Status Sight::Conclude() {
  if (X_MO_.empty()) return Failed(base::FailureCode::kObjectNotSeen);
  sighted_->X_MO = X_MO_.back();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const geometry::Pose3& X_MO : X_MO_) sum += X_MO.translation;
  sighted_->X_MO.translation = sum / static_cast<double>(X_MO_.size());
  return Succeeded();
}

}  // namespace hires::skills
