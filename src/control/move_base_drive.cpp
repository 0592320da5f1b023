#include "hires/control/move_base_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/navigation/hybrid_a_star.h"

namespace hires::control {
namespace {

using base::Failure;
using geometry::Pose2;
using navigation::Costmap;
using Code = base::FailureCode;
using skills::Failed;
using skills::Status;

Failure NoMoveBase() { return {Code::kNoController, {}, "move_base"}; }

double LengthOf(const Pose2& X) { return std::hypot(X.x, X.y); }

bool Mentions(const std::string& text, const std::string& word) {
  return base::ToLower(text).find(word) != std::string::npos;
}

/// move_base tells in words what it gave up at: a valid plan, a valid control, or oscillation.
Code CodeOfAbortion(const std::string& text) {
  const bool is_stuck = Mentions(text, "control") || Mentions(text, "oscillat");
  return is_stuck ? Code::kStuck : Code::kUnreachable;
}

}  // namespace

Failure FailureOf(const MoveBaseNews& news) {
  using State = MoveBaseNews::State;
  switch (news.state) {
    case State::kAborted:
      return CodeOfAbortion(news.text);
    case State::kRejected:
      return Code::kUnreachable;
    case State::kReplaced:
      return Code::kInterrupted;
    case State::kLost:
      return NoMoveBase();
    case State::kNone:
    case State::kSent:
    case State::kDriving:
    case State::kArrived:
      break;
  }
  return {};
}

MoveBaseDrive::MoveBaseDrive(std::shared_ptr<MoveBaseServer> server,
                             std::function<bool()> may_drive, const MoveBaseDriveParams& params,
                             std::shared_ptr<const skills::DrivingContext> driving,
                             const skills::MoveBaseBlindParams& blind, const Pose2& X_MGoal,
                             const robot::MotionSet& motion_set)
    : server_(std::move(server)),
      may_drive_(std::move(may_drive)),
      params_(params),
      driving_(std::move(driving)),
      X_MGoal_(X_MGoal),
      motion_set_(motion_set),
      rest_(blind, X_MGoal, motion_set, driving_->robot->profile.base_controller,
            skills::BodyThatLooks(*driving_)) {}

MoveBaseDrive::~MoveBaseDrive() {
  if (stage_ == Stage::kDriving) server_->Cancel();
}

std::string MoveBaseDrive::phase() const {
  switch (stage_) {
    case Stage::kWaiting:
      return "wait_for_leave";
    case Stage::kDriving:
      return "move_base";
    case Stage::kRest:
      return "last_stretch";
  }
  return "";
}

Status MoveBaseDrive::Update(const robot::Observation& seen, robot::Command* command) {
  command->motion_set = motion_set_;
  switch (stage_) {
    case Stage::kWaiting:
      return Begin(seen);
    case Stage::kDriving:
      return Follow(seen, command);
    case Stage::kRest:
      break;
  }
  return DriveRest(seen, command);
}

Status MoveBaseDrive::Begin(const robot::Observation& seen) {
  const bool may_drive = may_drive_(), is_there = server_->IsThere();
  if (may_drive && is_there) {
    server_->Go(X_MGoal_);
    sent_ = seen.time;
    stage_ = Stage::kDriving;
  } else if (seen.time > params_.start_patience) {
    return Failed(is_there ? Failure(Code::kNoPermit) : NoMoveBase());
  }
  return {};
}

Status MoveBaseDrive::Follow(const robot::Observation& seen, robot::Command* command) {
  const MoveBaseNews news = server_->News();
  if (news.state == MoveBaseNews::State::kArrived) return BeginRest(seen, command);
  const Failure failure = FailureOf(news);
  if (failure) {
    base::Log(base::LogLevel::kWarn,
              fmt::format("move_base failure=\"{}\" text=\"{}\"", ToString(failure), news.text));
    return Failed(failure);
  }
  const bool is_silent =
      news.state == MoveBaseNews::State::kSent && seen.time - sent_ > params_.answer_patience;
  if (is_silent || !server_->IsThere()) return Failed(NoMoveBase());
  return {};
}

/// move_base says that it has arrived; whether that is so, our own tolerances say.
Status MoveBaseDrive::BeginRest(const robot::Observation& seen, robot::Command* command) {
  const Pose2 X_BGoal = seen.X_MB.Inverse() * X_MGoal_;
  const double distance = LengthOf(X_BGoal), turn = std::abs(X_BGoal.yaw);
  const navigation::DwaParams& tolerances = driving_->params.local;
  stage_ = Stage::kRest;
  if (distance <= tolerances.xy_goal_tolerance && turn <= tolerances.yaw_goal_tolerance) {
    return skills::Succeeded();
  }
  if (distance > params_.max_rest || turn > params_.max_rest_turn) {
    return Failed({Code::kGoalMissed, {}, fmt::format("{:.2f} m, {:.2f} rad", distance, turn)});
  }
  return DriveRest(seen, command);
}

/// Looks along each way before it is driven: the first one, and those that a car takes anew where
/// it came to rest out of tolerance.
Status MoveBaseDrive::DriveRest(const robot::Observation& seen, robot::Command* command) {
  const bool is_first = !std::exchange(has_looked_, true);
  const int ways = rest_.num_ways();
  const Status status = rest_.Update(seen, command);
  if ((is_first || rest_.num_ways() > ways) && !IsWayFree(seen)) {
    command->base_velocity.reset();
    const double distance = LengthOf(seen.X_MB.Inverse() * X_MGoal_);
    const auto words = fmt::format("something stands on the last {:.2f} m", distance);
    return Failed({Code::kUnreachable, {}, words});
  }
  return status;
}

/// The way that MoveBaseBlind drives: straight, or as a car does.
std::vector<Pose2> MoveBaseDrive::WayFrom(const Pose2& X_MB, double resolution) const {
  std::vector<Pose2> way;
  const robot::BaseControllerParams& base = driving_->robot->profile.base_controller;
  if (base.drive == robot::Drive::kCarLike) {
    for (const auto& pose : navigation::ShortestCarPath(X_MB, X_MGoal_, base.min_turning_radius)) {
      way.push_back(pose.X_MB);
    }
    return way;
  }
  const Pose2 X_BGoal = X_MB.Inverse() * X_MGoal_;
  const double reach = geometry::CircumscribedRadius(driving_->footprint);
  const double length = LengthOf(X_BGoal) + reach * std::abs(X_BGoal.yaw);
  const int steps = std::max(1, static_cast<int>(std::ceil(length / resolution)));
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    way.push_back(X_MB * Pose2{share * X_BGoal.x, share * X_BGoal.y, share * X_BGoal.yaw});
  }
  return way;
}

/// Whether the outline passes over free floor on the way to the goal.
bool MoveBaseDrive::IsWayFree(const robot::Observation& seen) const {
  // Where the robot stands it can stand, whatever the map says.
  const Costmap costmap = driving_->costmap->WithObstacles(seen.obstacles_M)
                              .WithRoomFor(Transformed(seen.X_MB, driving_->body));
  const std::vector<Pose2> way = WayFrom(seen.X_MB, costmap.resolution());
  return std::all_of(way.begin(), way.end(), [&](const Pose2& X_MB) {
    return costmap.FootprintCost(driving_->body, X_MB) < navigation::kLethalCost;
  });
}

bool IsForMoveBase(const skills::SkillSet& skills, const base::ActionCall& action) {
  return skills::SpecOf(skills, action).driving == actions::Driving::kRoundObstacles;
}

std::unique_ptr<skills::Skill> MakeMoveBaseDrive(const skills::SkillSet& skills,
                                                 const base::ActionCall& action,
                                                 std::shared_ptr<MoveBaseServer> server,
                                                 std::function<bool()> may_drive,
                                                 const MoveBaseDriveParams& params) {
  HIRES_CHECK(IsForMoveBase(skills, action), "move_base cannot drive this action");
  skills::MakeSkill(skills, action);  // its words for what is wrong with an action
  return std::make_unique<MoveBaseDrive>(
      std::move(server), std::move(may_drive), params, skills.driving, skills.blind,
      skills.areas.at(*actions::ArgumentOf(skills::SpecOf(skills, action), action,
                                           actions::ParameterKind::kArea)),
      skills.motion_sets.at(skills::MotionSetNameOf(skills, action)));
}

}  // namespace hires::control
