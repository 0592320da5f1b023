#include "hires/control/head_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/perception/camera_view.h"
#include "hires/skills/head_aim.h"

namespace hires::control {
namespace {

using robot::JointTrajectory;
using robot::SeenObject;

constexpr double kAbove = 0.05;        // [m] over an area: where small things are
constexpr double kShortestTurn = 0.2;  // [s]
constexpr double kAround = 0.15;       // [m] to each side, in view when a place is looked at
constexpr double kArrived = 0.03;      // [rad] of each joint
constexpr double kPatience = 2.0;      // [s] that a turn may come late: commands travel, heads lag

double PositionOf(const robot::JointPositions& joints, const std::string& joint) {
  const auto position = joints.find(joint);
  return position == joints.end() ? 0.0 : position->second;
}

/// Whether the place is well in view: something at the picture's edge cannot be missed there
/// (sensing::ObjectMemory), and would be looked past for good.
bool IsLookedAt(const perception::CameraView& view, const Eigen::Vector3d& p_M) {
  for (const double beside : {-kAround, 0.0, kAround}) {
    for (const double above : {-kAround, 0.0, kAround}) {
      if (!view.Contains(p_M + view.X_MC.rotation * Eigen::Vector3d(0.0, beside, above))) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

SweepParams ReadSweepParams(base::ParamReader in) {
  using base::Between;
  SweepParams params;
  params.enabled = in.GetBool("enabled");
  params.range = in.Get("range", Between(0.5, 30.0));
  params.period = in.Get("period", Between(0.1, 3600.0));
  params.dwell = in.Get("dwell", Between(0.0, 60.0));
  params.speed = in.Get("speed", Between(0.05, 10.0));
  params.hands_off = in.Get("hands_off", Between(0.0, 60.0));
  return params;
}

HeadSweep::HeadSweep(std::shared_ptr<const robot::Robot> robot, SweepParams params)
    : robot_(std::move(robot)), params_(std::move(params)) {}

void HeadSweep::SetPlaces(std::vector<std::string> places, translation::Areas areas) {
  places_ = std::move(places);
  areas_ = std::move(areas);
}

void HeadSweep::SetBusy(bool is_busy, double time) {
  if (is_busy) turn_.reset();
  if (is_busy_ && !is_busy) free_from_ = time + params_.hands_off;
  is_busy_ = is_busy;
}

std::optional<Eigen::Vector3d> HeadSweep::PointOf(const std::string& place,
                                                  const std::vector<SeenObject>& known) const {
  if (const translation::Area* area = areas_.Find(place)) {
    if (!area->link.empty()) return std::nullopt;
    return area->X_FA * Eigen::Vector3d(0.0, 0.0, kAbove);
  }
  for (const SeenObject& object : known) {
    if (object.name == place) return object.X_MO * Eigen::Vector3d(0.0, 0.0, kAbove);
  }
  return std::nullopt;
}

std::optional<JointTrajectory> HeadSweep::Update(const sensing::BodyReading& body, bool has_looked,
                                                 const std::vector<SeenObject>& known) {
  if (!params_.enabled || !robot_->profile.upper_body || places_.empty()) return std::nullopt;
  const auto view = perception::ViewOf(*robot_, body.X_MB, body.joints);
  std::string oldest;
  std::optional<Eigen::Vector3d> point;
  double earliest = body.time - params_.period;
  for (const std::string& place : places_) {
    const auto p_M = PointOf(place, known);
    if (!p_M || (*p_M - view.X_MC.translation).norm() > params_.range) continue;
    if (has_looked && IsLookedAt(view, *p_M)) looked_at_[place] = body.time;
    const auto looked = looked_at_.find(place);
    const double time =
        looked == looked_at_.end() ? -std::numeric_limits<double>::infinity() : looked->second;
    if (time > earliest || (point && time == earliest)) continue;
    oldest = place;
    point = p_M;
    earliest = time;
  }
  if (IsTurning(body) || !point || is_busy_ || body.time < free_from_) return std::nullopt;
  const auto aim = skills::AimHead(*robot_, body.X_MB, body.joints, *point);
  looked_at_[oldest] = body.time;  // or cannot be looked at from here
  if (!aim) return std::nullopt;
  target_ = oldest;
  turn_ = Turn(body.joints, *aim);
  given_up_at_ = body.time + turn_->duration() + kPatience;
  return turn_;
}

/// The looks at a place are counted from when the head has arrived, not from when it should have:
/// else a head that obeys late is sent on before the camera has seen anything.
bool HeadSweep::IsTurning(const sensing::BodyReading& body) {
  if (!turn_) return false;
  bool has_arrived = true;
  for (std::size_t i = 0; i < turn_->joints.size(); ++i) {
    const double off =
        PositionOf(body.joints, turn_->joints[i]) - turn_->points.back().positions[i];
    has_arrived = has_arrived && std::abs(off) <= kArrived;
  }
  if (!has_arrived && body.time < given_up_at_) return true;
  turn_.reset();
  if (has_arrived) free_from_ = body.time + params_.dwell;
  return false;
}

JointTrajectory HeadSweep::Turn(const robot::JointPositions& from,
                                const std::vector<double>& to) const {
  const robot::UpperBodyProfile& upper = *robot_->profile.upper_body;
  JointTrajectory turn;
  turn.joints = {upper.head_pan_joint, upper.head_tilt_joint};
  const std::vector<double> start = {PositionOf(from, upper.head_pan_joint),
                                     PositionOf(from, upper.head_tilt_joint)};
  const double angle = std::max(std::abs(to[0] - start[0]), std::abs(to[1] - start[1]));
  // A cubic that begins and ends at rest is 1.5 times as fast in its middle.
  const double duration = std::max(kShortestTurn, 1.5 * angle / params_.speed);
  turn.points = {{0.0, start, {0.0, 0.0}}, {duration, to, {0.0, 0.0}}};
  return turn;
}

}  // namespace hires::control
