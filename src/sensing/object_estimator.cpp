#include "hires/sensing/object_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/error.h"

namespace hires::sensing {
namespace {

using base::ConfigError;
using geometry::Pose3;

constexpr double kFramePatience = 0.2;  // [s] that the transform of a look's frame may be late
constexpr double kNever = -1e9;         // [s]
constexpr std::size_t kMaxLooks = 100;  // that wait
constexpr double kScanWait = 1.0;       // [s] of a scan for the other sensors
constexpr double kSameMoment = 1e-6;    // [s]

/// Empty: it is one, or none was told.
std::string WhyNoTable(const std::vector<Eigen::Vector3d>& corners) {
  const bool is_finite = std::all_of(corners.begin(), corners.end(),
                                     [](const Eigen::Vector3d& p) { return p.allFinite(); });
  if (is_finite && (corners.empty() || corners.size() >= 3)) return "";
  return fmt::format("table has {} corners{}, wanted none or at least 3, all of them finite",
                     corners.size(), is_finite ? "" : " that are not finite");
}

/// Empty: it is one.
std::string WhyNoScan(const robot::ScanReading& scan) {
  if (scan.ranges.empty()) return "it has no ranges, wanted one for each beam";
  const bool is_finite = std::isfinite(scan.angle_min) && std::isfinite(scan.angle_increment);
  if (!is_finite || scan.angle_increment == 0.0) {
    return fmt::format(
        "angle_min is {}, angle_increment {}, wanted finite angles, the second not 0",
        scan.angle_min, scan.angle_increment);
  }
  if (scan.range_min >= 0.0) return "";
  return fmt::format("range_min is {}, wanted 0 or more", scan.range_min);
}

}  // namespace

ObjectEstimator::ObjectEstimator(std::shared_ptr<const perception::Surroundings> surroundings,
                                 std::shared_ptr<const robot::Robot> robot,
                                 const MemoryParams& params, const RobotStateEstimator* state)
    : surroundings_(std::move(surroundings)),
      robot_(std::move(robot)),
      state_(state),
      memory_(surroundings_, robot_, params) {}

// ---- What comes in.

std::vector<std::string> ObjectEstimator::OnLook(Look look) {
  FollowClock();
  if (!robot_->profile.upper_body) {
    return {
        fmt::format("robot '{}' has no camera (upper_body in its profile)", robot_->model.name)};
  }
  if (!(look.stamp > 0.0)) return {ToString(Receipt{Reception::kNoStamp, {}})};
  if (look.frame.empty()) return {ToString(Receipt{Reception::kUnknownFrame, {}})};
  if (state_->IsAhead(look.stamp)) return {ToString(state_->Ahead("header.stamp"))};
  if (const std::string why = WhyNoTable(look.table); !why.empty()) return {why};
  std::vector<std::string> left_out;
  std::vector<perception::Detection> sound;
  for (perception::Detection& detection : look.detections) {
    try {
      memory_.Check(detection);
      sound.push_back(std::move(detection));
    } catch (const ConfigError& error) {  // the others are good
      left_out.push_back(error.what());
    }
  }
  look.detections = std::move(sound);
  const auto place =
      std::upper_bound(looks_.begin(), looks_.end(), look.stamp,
                       [](double stamp, const Waiting& one) { return stamp < one.look.stamp; });
  looks_.insert(place, {std::move(look), false});
  if (looks_.size() > kMaxLooks) looks_.pop_front();
  return left_out;
}

std::vector<std::string> ObjectEstimator::OnTrayScan(double stamp, const std::string& frame,
                                                     robot::ScanReading scan) {
  FollowClock();
  std::vector<std::string> problems = std::exchange(scan_problems_, {});
  if (!(stamp > 0.0)) {
    problems.push_back(ToString(Receipt{Reception::kNoStamp, {}}));
  } else if (state_->IsAhead(stamp)) {
    problems.push_back(ToString(state_->Ahead("header.stamp")));
  } else if (const std::string why = WhyNoScan(scan); !why.empty()) {
    problems.push_back(why);
  } else if (stamp > scanned_) {
    scans_.Insert(stamp, {frame, std::move(scan)});
    scans_.KeepBetween(stamp - kScanWait, stamp + kScanWait);
  }
  return problems;
}

std::vector<std::string> ObjectEstimator::OnStated(const std::vector<StatedObject>& stated) {
  std::vector<std::string> refused;
  std::vector<std::string> names;
  for (const StatedObject& object : stated) {
    names.push_back(object.name);
    try {
      memory_.Believe(object.name, object.model, object.link, object.X_LO);
    } catch (const ConfigError& error) {
      refused.push_back(error.what());
    }
  }
  memory_.DisbelieveAllBut(names);
  return refused;
}

std::vector<std::string> ObjectEstimator::OnStated(const world::WorldState& stated,
                                                   const RobotEstimate& at) {
  std::vector<std::string> refused;
  std::vector<StatedObject> objects;
  for (const world::ObjectState& object : stated.objects) {
    try {
      const Pose3 X_WL = state_->LinkInWorld(object.attached_to, at);
      objects.push_back(
          {object.name, object.model, object.attached_to, X_WL.Inverse() * object.X_MO});
    } catch (const ConfigError& error) {
      refused.push_back(fmt::format("object '{}': {}", object.name, error.what()));
    }
  }
  for (std::string& why : OnStated(objects)) refused.push_back(std::move(why));
  return refused;
}

// ---- What is made of it.

/// A clock that began again makes older stamps worthless.
void ObjectEstimator::FollowClock() {
  if (restarts_ == state_->num_restarts()) return;
  restarts_ = state_->num_restarts();
  looks_.clear();
  scans_.Clear();
  felt_ = hands_changed_ = scanned_ = kNever;
}

void ObjectEstimator::Feel(const BodyReading& body, LookNews* news) {
  if (body.time < felt_) return;
  felt_ = body.time;
  if (!memory_.Feel(body)) return;
  hands_changed_ = body.time;
  news->has_changed_hands = true;
}

LookNews ObjectEstimator::Update(const RobotEstimate& now) {
  FollowClock();
  LookNews news;
  for (auto one = looks_.begin(); one != looks_.end() && one->look.stamp <= now.time;) {
    one->is_tried = true;
    one = Remember(one->look, now.time, &news) ? looks_.erase(one) : std::next(one);
  }
  Feel(now.Body(), &news);
  ScanTray(now.time);
  return news;
}

/// Uses the scans up to this moment; those of before a hand changed say nothing of now.
void ObjectEstimator::ScanTray(double now) {
  while (!scans_.empty() && scans_.front().stamp <= now) {
    const double stamp = scans_.front().stamp;
    const bool is_due = stamp >= scanned_ + kScanPeriod - kSameMoment && stamp > hands_changed_;
    const std::string why = is_due ? Use(stamp, scans_.front().value) : "";
    if (!why.empty()) scan_problems_ = {why};
    scans_.KeepBetween(std::nextafter(stamp, stamp + kScanWait), stamp + 1e9);
  }
}

/// @return why it was not used; empty: it was.
std::string ObjectEstimator::Use(double stamp, const TrayScan& scan) {
  scanned_ = stamp;
  const auto then = state_->At(stamp);
  if (!then || !state_->IsPostureKnown(stamp)) {
    return "the posture of the robot when the tray was scanned is unknown";
  }
  const FramePose X_BL = state_->InBase(scan.frame, *then);
  if (!X_BL.is_found()) return ToString(ReceiptOf(X_BL.status, scan.frame));
  std::string why = memory_.ScanTray(then->Body(), scan.reading, X_BL.X_PC);
  num_scans_ += why.empty() ? 1 : 0;
  return why;
}

/// @return whether the look is done with; else it waits for its frame.
bool ObjectEstimator::Remember(const Look& look, double now, LookNews* news) {
  if (look.stamp < felt_ && look.stamp <= hands_changed_) {
    ++num_outdated_;
    return true;
  }
  const auto then = state_->At(look.stamp);
  if (!then || !state_->IsPostureKnown(look.stamp)) {
    Drop("the posture of the robot when the picture was taken is unknown", news);
    return true;
  }
  Look seen = look;
  const FrameStatus status = PutInCamera(*then, &seen);
  if (status == FrameStatus::kNotThen && now < look.stamp + kFramePatience) return false;
  if (status == FrameStatus::kFound) {
    Feel(then->Body(), news);
    memory_.Look(then->Body(), seen.detections, seen.table);
    ++news->num_looks;
    news->newest_look = std::max(news->newest_look, look.stamp);
  } else {
    Drop(ToString(ReceiptOf(status, look.frame)), news);
  }
  return true;
}

/// Turns poses in a frame into poses in the camera's; those that are in it keep their bits.
FrameStatus ObjectEstimator::PutInCamera(const RobotEstimate& then, Look* look) const {
  const std::string& camera = robot_->profile.upper_body->camera_link;
  if (BareFrame(look->frame) == camera) return FrameStatus::kFound;
  const FramePose X_BF = state_->InBase(look->frame, then);
  if (!X_BF.is_found()) return X_BF.status;
  const Pose3 X_CF = state_->InBase(camera, then).X_PC.Inverse() * X_BF.X_PC;
  for (perception::Detection& detection : look->detections) detection.X_CO = X_CF * detection.X_CO;
  for (Eigen::Vector3d& corner : look->table) corner = X_CF * corner;
  return FrameStatus::kFound;
}

void ObjectEstimator::Drop(const std::string& why, LookNews* news) {
  ++num_dropped_;
  news->warnings.push_back("look: " + why);
}

int ObjectEstimator::DropUntil(double time) {
  // Of a look that waits for its frame it was known how the robot stood.
  const auto first = std::remove_if(looks_.begin(), looks_.end(), [&](const Waiting& one) {
    return !one.is_tried && one.look.stamp <= time;
  });
  const int num_dropped = static_cast<int>(looks_.end() - first);
  looks_.erase(first, looks_.end());
  num_dropped_ += num_dropped;
  return num_dropped;
}

std::optional<double> ObjectEstimator::NextLook(double time) const {
  for (const Waiting& one : looks_) {
    if (!one.is_tried && one.look.stamp >= time) return one.look.stamp;
  }
  return std::nullopt;
}

}  // namespace hires::sensing
