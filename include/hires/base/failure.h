#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hires::base {

/// Why something did not go as it should. The numbers travel in messages and lie in stores: a code
/// keeps its number for good, and a number that is out of use is not given to another meaning.
enum class FailureCode : std::uint16_t {
  kNone = 0,

  // What became of things. 1 .. 99
  kObjectFell = 1,         ///< it fell over or down
  kObjectToppled = 2,      ///< it lies where it should stand
  kObjectSlid = 3,         ///< it stands, but slid too far
  kObjectSlipped = 4,      ///< a hand does not hold what it should, or it is not at its place
  kObjectNotReleased = 5,  ///< a hand holds what it should have put down
  kObjectLost = 6,         ///< its pose is no number any more
  kObjectNotSeen = 7,      ///< it should be in sight and is not
  kObjectHeld = 8,         ///< another hand holds it
  kKnockedOver = 9,        ///< things that had nothing to do with the action do not stand any more
  kHandFull = 10,          ///< the hand that should take something holds something
  kGraspFailed = 11,       ///< the hand closed round nothing
  kAreaOccupied = 12,      ///< the subjects stand where something is to be put
  kUnknownModel = 13,      ///< the shape of what was seen is unknown

  // The way there. 100 .. 199
  kRobotCollision = 100,     ///< a part of the robot touched something
  kNoPath = 101,             ///< an arm, or the base, finds no way
  kUnreachable = 102,        ///< an arm does not reach so far, or the goal lies in a wall
  kStartBlocked = 103,       ///< it touches something before it begins
  kGoalBlocked = 104,        ///< something stands at the goal, or too near to it
  kGoalMissed = 105,         ///< it stopped too far from the goal
  kNoValidTrajectory = 106,  ///< the local planner sees no velocity that is safe
  kOscillating = 107,        ///< it goes to and fro
  kStuck = 108,              ///< it does not come nearer
  kOutOfView = 109,          ///< the head cannot turn to it
  kTimedOut = 110,           ///< it took too long
  kRobotTips = 111,          ///< the motion of its base tips the robot itself over

  // The robot, its drivers and what watches over it. 200 .. 299
  kMotorsHalted = 200,
  kNoMotorsState = 201,
  kNoPose = 202,
  kStalePose = 203,
  kNoScan = 204,
  kStaleScan = 205,
  kNoLocalisation = 206,
  kLocalisationLost = 207,
  kStaleObservation = 208,
  kNoController = 209,  ///< a driver that is needed does not listen
  kNoPermit = 210,      ///< the base guard permits no driving
  kSilentMiddleLayer = 211,
  kSilentCommands = 212,
  kBadRequest = 213,
  kBadCommand = 214,
  kRequestOver = 215,
  kMotionSetRefused = 216,  ///< the robot's own planner does not take the limits
  kInterrupted = 217,       ///< somebody else took the robot over
  kInternalError = 218,     ///< a defect of this program
  kBusy = 219,              ///< another action needs the same joints
  kGuardEnds = 220,
  kLateGuard = 221,       ///< the base guard itself was not called in time
  kNoRequest = 222,       ///< no request to drive reached the base guard
  kGuardRestarted = 223,  ///< it knows nothing of the drive that it allowed
  kDryRun = 224,          ///< nothing is moved

  // A plan that is carried out. 300 .. 399
  kPreempted = 300,
  kUnavailable = 301,    ///< who should do it is not there
  kEffectMissing = 302,  ///< what the action should have brought about is not so
  kEffectUnknown = 303,  ///< it could not be seen whether it is so
  kConditionLost = 304,  ///< what the action rests on does not hold any more
  kDidNotStop = 305,
  kInvalidAction = 306,    ///< no such action, or its arguments make no sense
  kImaginedFailure = 307,  ///< imagination expects that no alternative succeeds

  // Imagination. 400 .. 499
  kBadStart = 400,   ///< the drawn start cannot be
  kNoSamples = 401,  ///< there was something to watch, and nothing was sampled
  kUnfinished = 402,
  kUnplayable = 403,    ///< no worker got it done
  kPhysicsBroke = 404,  ///< something gained energy that nothing gave it: the rollout is void

  kOther = 900  ///< of an action from another package; the detail tells
};

/// Whom a failure speaks of.
enum class FailureScope {
  kAction,  ///< the way that was taken: another arm, place or speed may do
  kRobot,   ///< the robot or the programs that drive it: no other way helps
  kPlan     ///< what was expected and what was observed differ
};

/// What is known about a code.
struct FailureInfo {
  FailureCode code;
  const char* word;  ///< lower case with underscores: "object_fell"
  FailureScope scope;
  bool may_pass;  ///< trying the same again from there makes sense
};

/// All codes but kNone, by number.
const std::vector<FailureInfo>& AllFailures();
/// @pre code != kNone and it is one of the enumerators.  @throws std::logic_error
const FailureInfo& InfoOf(FailureCode code);
/// "object_fell"; "" for kNone.
std::string ToString(FailureCode code);
/// The code of a word or of a number; none: there is no such code. The only place where words
/// become codes.
std::optional<FailureCode> ParseFailureCode(const std::string& word);
std::optional<FailureCode> FailureCodeOf(std::uint16_t number);

/// One failure: what, whom it is about, and words for people. Valid from birth as "no failure".
struct Failure {
  FailureCode code{FailureCode::kNone};
  std::vector<std::string> subjects;  ///< names of objects or links, lower case
  std::string detail;                 ///< for people, never taken apart

  Failure() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a code alone is a failure.
  Failure(FailureCode what, std::vector<std::string> whom = {}, std::string words = {});

  explicit operator bool() const { return code != FailureCode::kNone; }
  /// Same code and subjects; words for people do not count.
  bool operator==(const Failure& other) const;
  bool operator!=(const Failure& other) const { return !(*this == other); }
  bool operator<(const Failure& other) const;
};

/// "area_occupied: book1, book2"; "stale_pose: 0.41 s old" where there are words for people; "" for
/// no failure.
std::string ToString(const Failure& failure);

}  // namespace hires::base
