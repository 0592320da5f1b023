#include "reports/episode/episode.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hires::reports {
namespace {

using sensing::Missing;
using sensing::Receipt;
using sensing::RobotEstimate;

std::shared_ptr<const robot::Robot> RobotOf(const imagination::ImaginationSetup& setup) {
  return {setup.scene, &setup.scene->robot};
}

std::vector<std::string> BodyJointsOf(const robot::Robot& robot) {
  std::vector<std::string> joints;
  const auto& body = robot.profile.upper_body;
  if (!body) return joints;
  if (!body->torso_joint.empty()) joints.push_back(body->torso_joint);
  for (const auto& [name, arm] : body->arms) {
    joints.insert(joints.end(), arm.joints.begin(), arm.joints.end());
  }
  return joints;
}

}  // namespace

std::string ToString(ActionFate fate) {
  switch (fate) {
    case ActionFate::kSucceeded:
      return "succeeded";
    case ActionFate::kFailed:
      return "failed";
    case ActionFate::kPreempted:
      return "stopped";
    case ActionFate::kUnknown:
      break;
  }
  return "unknown";
}

const EpisodeSample* Episode::At(double time) const {
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), time,
                       [](double t, const EpisodeSample& sample) { return t < sample.time; });
  return after == samples.begin() ? nullptr : &*std::prev(after);
}

double Episode::LongestGap(double from, double to) const {
  double longest = 0.0, before = from;
  for (const EpisodeSample& sample : samples) {
    if (sample.time <= from) continue;
    if (sample.time >= to) break;
    longest = std::max(longest, sample.time - before);
    before = sample.time;
  }
  return std::max(longest, to - before);
}

EpisodeBuilder::EpisodeBuilder(const imagination::ImaginationSetup& setup,
                               const sensing::FrameNames& frames,
                               const geometry::MapToWorld& map_to_world,
                               std::shared_ptr<sensing::FrameTree> tree, double period)
    : frames_(frames),
      period_(period),
      state_(RobotOf(setup), frames, setup.sensing.robot_state, map_to_world, std::move(tree)),
      episodes_(1),
      body_joints_(BodyJointsOf(setup.scene->robot)) {
  if (!setup.scene->has_camera()) return;
  objects_ = std::make_unique<sensing::ObjectEstimator>(setup.scene->surroundings, RobotOf(setup),
                                                        setup.sensing.memory, &state_);
}

void EpisodeBuilder::OnOdometry(double stamp, const std::string& frame, const std::string& child,
                                const robot::OdometryReading& reading) {
  Note("odometry", state_.OnOdometry(stamp, frame, child, reading));
  FollowClock();
  Sample();
}

void EpisodeBuilder::OnJoints(double stamp, const robot::JointReading& reading) {
  Note("joint states", state_.OnJoints(stamp, reading));
  for (const auto& [name, position] : reading.positions) told_joints_.insert(name);
  Sample();
}

void EpisodeBuilder::OnTransforms(double stamp) {
  Note("transforms", state_.OnTransforms(stamp));
  Sample();
}

void EpisodeBuilder::OnLook(sensing::Look look) {
  if (!objects_) return;
  for (const std::string& why : objects_->OnLook(std::move(look))) Drop("detections", why);
}

void EpisodeBuilder::OnKnownObjects(double stamp, const world::WorldState& known) {
  known_ = Known{stamp, known};
}

void EpisodeBuilder::OnGoal(const std::string& id, const base::ActionCall& action, double stamp) {
  if (!std::isfinite(stamp) || stamp <= 0.0) return Drop("goals", "its time is 0 or no number");
  std::vector<RecordedAction>& actions = episodes_.back().actions;
  const bool is_known = std::any_of(actions.begin(), actions.end(), [&](const auto& earlier) {
    return earlier.id == id && earlier.begin == stamp;
  });
  if (is_known && !id.empty()) return Drop("goals", "recorded before");
  actions.push_back({id, action, stamp, {}, 0.0, ActionFate::kUnknown, {}});
}

void EpisodeBuilder::OnResult(const std::string& id, double stamp, double duration, ActionFate fate,
                              const base::Failure& failure) {
  std::vector<RecordedAction>& actions = episodes_.back().actions;
  const auto action = std::find_if(actions.rbegin(), actions.rend(), [&](const auto& candidate) {
    return candidate.id == id && !candidate.end;
  });
  if (action == actions.rend()) {
    const bool is_known = std::any_of(actions.begin(), actions.end(), [&](const auto& earlier) {
      return earlier.id == id && earlier.end == stamp;
    });
    return Drop("results", is_known ? "recorded before" : "their goal was not recorded");
  }
  if (!std::isfinite(stamp) || stamp < action->begin || !std::isfinite(duration)) {
    return Drop("results", "its time is before its goal's, or no number");
  }
  action->end = stamp;
  action->duration = duration;
  action->fate = fate;
  action->failure = failure;
}

void EpisodeBuilder::Drop(const std::string& topic, const std::string& why) {
  ++dropped_[topic + ": " + why];
}

std::string EpisodeBuilder::MissingText() const {
  switch (state_.MissingNow()) {
    case Missing::kNothing:
      break;
    case Missing::kOdometry:
      return "odometry";
    case Missing::kOdometryFrame:
      return "the transform " + frames_.odometry + " -> " + frames_.base;
    case Missing::kJointStates:
      return "joint states";
    case Missing::kLocalisation:
      return "the transform " + frames_.map + " -> " + frames_.odometry;
  }
  return "";
}

std::vector<std::string> EpisodeBuilder::UntoldJoints() const {
  std::vector<std::string> untold;
  for (const std::string& joint : body_joints_) {
    if (told_joints_.count(joint) == 0) untold.push_back(joint);
  }
  return untold;
}

std::vector<Episode> EpisodeBuilder::Take() {
  std::vector<Episode> all = std::exchange(episodes_, std::vector<Episode>(1));
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const Episode& e) { return e.samples.empty() && e.actions.empty(); }),
            all.end());
  return all;
}

void EpisodeBuilder::Note(const std::string& topic, const Receipt& receipt) {
  if (receipt.is_bad()) Drop(topic, sensing::ToString(receipt));
}

/// A clock that began again begins another episode.
void EpisodeBuilder::FollowClock() {
  if (state_.num_restarts() == restarts_) return;
  restarts_ = state_.num_restarts();
  next_.reset();
  episodes_.emplace_back();
}

void EpisodeBuilder::Sample() {
  const std::optional<double> until = state_.CompleteUntil();
  if (!until) return;
  if (!next_ || *next_ < *until - state_.params().history) next_ = *until;
  for (; *next_ <= *until; *next_ += period_) {
    if (const auto now = state_.At(*next_)) Add(*now);
  }
}

void EpisodeBuilder::Add(const RobotEstimate& now) {
  Episode& episode = episodes_.back();
  if (episode.joint_names.empty()) {
    for (const auto& [name, position] : now.posture) episode.joint_names.push_back(name);
  }
  EpisodeSample sample{now.time, now.X_WB, now.V_B, {}, {}};
  for (const std::string& name : episode.joint_names) {
    const auto joint = now.posture.find(name);
    sample.joints.push_back(joint == now.posture.end() ? 0.0 : joint->second);
  }
  if (objects_) {
    if (known_) {
      const auto then = state_.At(known_->stamp);
      for (const std::string& why : objects_->OnStated(known_->objects, then.value_or(now))) {
        Drop("known objects", why);
      }
      known_.reset();
    }
    for (const std::string& why : objects_->Update(now).warnings) Drop("detections", why);
    sample.objects = objects_->memory().Known(now.Body());
  }
  episode.samples.push_back(std::move(sample));
}

}  // namespace hires::reports
