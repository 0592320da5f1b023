#include "hires/base/failure.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "hires/base/check.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

using Code = FailureCode;

constexpr FailureScope kAction = FailureScope::kAction, kRobot = FailureScope::kRobot,
                       kPlan = FailureScope::kPlan;

constexpr FailureInfo kTable[] = {
    {Code::kObjectFell, "object_fell", kAction, false},
    {Code::kObjectToppled, "object_toppled", kAction, true},
    {Code::kObjectSlid, "object_slid", kAction, true},
    {Code::kObjectSlipped, "object_slipped", kAction, true},
    {Code::kObjectNotReleased, "object_not_released", kAction, true},
    {Code::kObjectLost, "object_lost", kAction, false},
    {Code::kObjectNotSeen, "object_not_seen", kAction, true},
    {Code::kObjectHeld, "object_held", kAction, true},
    {Code::kKnockedOver, "knocked_over", kAction, true},
    {Code::kHandFull, "hand_full", kAction, true},
    {Code::kGraspFailed, "grasp_failed", kAction, true},
    {Code::kAreaOccupied, "area_occupied", kAction, false},
    {Code::kUnknownModel, "unknown_model", kRobot, true},

    {Code::kRobotCollision, "robot_collision", kAction, true},
    {Code::kNoPath, "no_path", kAction, true},
    {Code::kUnreachable, "unreachable", kAction, false},
    {Code::kStartBlocked, "start_blocked", kAction, true},
    {Code::kGoalBlocked, "goal_blocked", kAction, true},
    {Code::kGoalMissed, "goal_missed", kAction, true},
    {Code::kNoValidTrajectory, "no_valid_trajectory", kAction, true},
    {Code::kOscillating, "oscillating", kAction, true},
    {Code::kStuck, "stuck", kAction, true},
    {Code::kOutOfView, "out_of_view", kAction, true},
    // Every motion has a time in which it ends; one that does not is not obeyed by the robot.
    {Code::kTimedOut, "timed_out", kRobot, true},
    {Code::kRobotTips, "robot_tips", kAction, false},

    {Code::kMotorsHalted, "motors_halted", kRobot, true},
    {Code::kNoMotorsState, "no_motors_state", kRobot, true},
    {Code::kNoPose, "no_pose", kRobot, true},
    {Code::kStalePose, "stale_pose", kRobot, true},
    {Code::kNoScan, "no_scan", kRobot, true},
    {Code::kStaleScan, "stale_scan", kRobot, true},
    {Code::kNoLocalisation, "no_localisation", kRobot, true},
    {Code::kLocalisationLost, "localisation_lost", kRobot, true},
    {Code::kStaleObservation, "stale_observation", kRobot, true},
    {Code::kNoController, "no_controller", kRobot, true},
    {Code::kNoPermit, "no_permit", kRobot, true},
    {Code::kSilentMiddleLayer, "silent_middle_layer", kRobot, true},
    {Code::kSilentCommands, "silent_commands", kRobot, true},
    {Code::kBadRequest, "bad_request", kRobot, false},
    {Code::kBadCommand, "bad_command", kRobot, false},
    {Code::kRequestOver, "request_over", kRobot, true},
    {Code::kMotionSetRefused, "motion_set_refused", kRobot, true},
    {Code::kInterrupted, "interrupted", kRobot, true},
    {Code::kInternalError, "internal_error", kRobot, true},
    {Code::kBusy, "busy", kRobot, true},
    {Code::kGuardEnds, "guard_ends", kRobot, true},
    {Code::kLateGuard, "late_guard", kRobot, true},
    {Code::kNoRequest, "no_request", kRobot, true},
    {Code::kGuardRestarted, "guard_restarted", kRobot, true},
    {Code::kDryRun, "dry_run", kRobot, false},

    {Code::kPreempted, "preempted", kPlan, true},
    {Code::kUnavailable, "unavailable", kRobot, true},
    {Code::kEffectMissing, "effect_missing", kPlan, true},
    {Code::kEffectUnknown, "effect_unknown", kPlan, true},
    {Code::kConditionLost, "condition_lost", kPlan, true},
    {Code::kDidNotStop, "did_not_stop", kRobot, false},
    {Code::kInvalidAction, "invalid_action", kPlan, false},
    {Code::kImaginedFailure, "imagined_failure", kAction, false},

    {Code::kBadStart, "bad_start", kAction, false},
    {Code::kNoSamples, "no_samples", kRobot, false},
    {Code::kUnfinished, "unfinished", kAction, true},
    {Code::kUnplayable, "unplayable", kRobot, false},
    {Code::kPhysicsBroke, "physics_broke", kRobot, false},

    {Code::kOther, "other", kAction, true},
};

}  // namespace

const std::vector<FailureInfo>& AllFailures() {
  static const std::vector<FailureInfo> all(std::begin(kTable), std::end(kTable));
  return all;
}

const FailureInfo& InfoOf(FailureCode code) {
  const auto* found = std::find_if(std::begin(kTable), std::end(kTable),
                                   [&](const FailureInfo& info) { return info.code == code; });
  HIRES_CHECK(found != std::end(kTable), "the failure code stands in no table");
  return *found;
}

std::string ToString(FailureCode code) {
  return code == FailureCode::kNone ? std::string() : InfoOf(code).word;
}

std::optional<FailureCode> ParseFailureCode(const std::string& word) {
  for (const FailureInfo& info : kTable) {
    if (ToLower(word) == info.word) return info.code;
  }
  return std::nullopt;
}

std::optional<FailureCode> FailureCodeOf(std::uint16_t number) {
  if (number == 0) return FailureCode::kNone;
  for (const FailureInfo& info : kTable) {
    if (static_cast<std::uint16_t>(info.code) == number) return info.code;
  }
  return std::nullopt;
}

Failure::Failure(FailureCode what, std::vector<std::string> whom, std::string words)
    : code(what), subjects(std::move(whom)), detail(std::move(words)) {
  for (std::string& subject : subjects) subject = ToLower(subject);
}

bool Failure::operator==(const Failure& other) const {
  return code == other.code && subjects == other.subjects;
}

bool Failure::operator<(const Failure& other) const {
  return std::tie(code, subjects) < std::tie(other.code, other.subjects);
}

std::string ToString(const Failure& failure) {
  const std::string words = failure.detail.empty() ? Join(failure.subjects, ", ") : failure.detail;
  return words.empty() ? ToString(failure.code) : ToString(failure.code) + ": " + words;
}

}  // namespace hires::base
