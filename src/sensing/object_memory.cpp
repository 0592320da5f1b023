#include "hires/sensing/object_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/polygon.h"
#include "sensing/anchoring.h"

namespace hires::sensing {
namespace {

using geometry::Pose3;
using perception::CameraView;
using perception::Detection;
using perception::LineOfSight;

geometry::Aabb BoundsOf(const std::vector<geometry::Collision>& collisions) {
  geometry::Aabb bounds;
  for (const geometry::Collision& collision : collisions) {
    bounds.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  return bounds;
}

double DistanceTo(const geometry::Aabb& bounds, const Eigen::Vector3d& p) {
  return (bounds.lower - p).cwiseMax(p - bounds.upper).cwiseMax(0.0).norm();
}

/// What fingers that close along a direction may feel of a box: its height if they close from above
/// and below, else one of its sides (round objects are as wide as their box however it turns).
std::vector<double> WidthsAcross(const geometry::Aabb& bounds, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d size = bounds.upper - bounds.lower;
  if (std::abs(direction.z()) > 0.7) return {size.z()};
  return {size.x(), size.y()};
}

/// The largest of the tray's shapes from above: rims are smaller than the plate.
std::optional<geometry::Aabb> PlateOf(const robot::Robot& robot) {
  const auto link = robot.model.FindLink(robot.profile.tray_link);
  if (!link) return std::nullopt;
  std::optional<geometry::Aabb> plate;
  double largest = 0.0;
  for (const geometry::Collision& collision : robot.model.links[*link].collisions) {
    const geometry::Aabb bounds = geometry::BoundsOf(collision.shape, collision.X_BS);
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    if (size.x() * size.y() <= largest) continue;
    largest = size.x() * size.y();
    plate = bounds;
  }
  return plate;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What a thing without a name may be, each with a doubt that grows as its odds against the label
/// shrink: a mill of which little is seen, and which looks more like a bottle, is the mill that was
/// there before rather than a bottle that took its place.
/// @param least  share of the label's confidence below which a kind is left out.
std::vector<SeenKind> KindsOf(const Detection& detection, double least) {
  constexpr double kDoubt = 0.02;  // [m] for odds of 1 : e
  std::vector<SeenKind> kinds;
  const auto add = [&](const std::string& label, double confidence) {
    const double share = std::min(1.0, confidence / detection.confidence);
    if (label == perception::kUnknownLabel || !(share >= least)) return;
    kinds.push_back({label, -kDoubt * std::log(share)});
  };
  add(detection.label, detection.confidence);
  for (const auto& other : detection.alternatives) add(other.label, other.confidence);
  return kinds;
}

constexpr double kHardly = 0.0;          // whatever a recogniser finds worth saying
constexpr double kAsLikely = 1.0 / 3.0;  // of what nothing else speaks for

}  // namespace

bool MemoryParams::operator==(const MemoryParams& other) const {
  const auto numbers = [](const MemoryParams& p) {
    return std::make_tuple(p.expected_share, p.expected_margin, p.expected_size,
                           p.expected_distance, p.looks_to_vanish, p.blending, p.moved_distance,
                           p.moved_angle, p.grasp_distance, p.closed_gap, p.gap_below, p.gap_above,
                           p.open_gap, p.opening, p.still_gap, p.still_time, p.hand_distance,
                           p.instance_distance, p.instance_margin, p.looks_to_appear);
  };
  return numbers(*this) == numbers(other);
}

/// Where the robot's links are in the map; worked out when somebody asks for one of them, as
/// most moments change nothing.
class ObjectMemory::Links {
 public:
  /// Both outlive it.
  Links(const robot::Robot& robot, const BodyReading& body) : robot_(robot), body_(body) {}

  Pose3 X_ML(const std::string& link) const {
    if (link.empty()) return {};
    const robot::RobotModel& model = robot_.model;
    const auto index = model.FindLink(link);
    if (!index) throw base::ConfigError(base::UnknownName("link", link, model.LinkNames()));
    if (X_RL_.empty()) Place();
    return X_MR_ * X_RL_[*index];
  }

 private:
  void Place() const {
    X_RL_ = robot::ForwardKinematics(robot_.model, body_.joints);
    const auto base = robot_.model.FindLink(robot_.profile.base_link);
    X_MR_ = geometry::Lift(body_.X_MB) * (base ? X_RL_[*base].Inverse() : Pose3());
  }

  const robot::Robot& robot_;
  const BodyReading& body_;
  mutable std::vector<Pose3> X_RL_;
  mutable Pose3 X_MR_;
};

ObjectMemory::ObjectMemory(std::shared_ptr<const perception::Surroundings> surroundings,
                           std::shared_ptr<const robot::Robot> robot, const MemoryParams& params)
    : surroundings_(std::move(surroundings)),
      robot_(std::move(robot)),
      params_(params),
      tray_T_(PlateOf(*robot_)) {
  if (!robot_->profile.upper_body) return;
  for (const auto& [arm, unused] : robot_->profile.upper_body->arms) hands_[arm] = {};
}

// ---- Hearsay.

void ObjectMemory::Believe(const std::string& name, const std::string& model,
                           const std::string& link, const Pose3& X_LO) {
  surroundings_->Model(model);
  if (!link.empty() && !robot_->model.FindLink(link)) {
    throw base::ConfigError(fmt::format(
        "object '{}': {}", name, base::UnknownName("link", link, robot_->model.LinkNames())));
  }
  const std::string key = base::ToLower(name);
  const auto known = objects_.find(key);
  if (vanished_.count(key) > 0 || (known != objects_.end() && known->second.is_observed)) return;
  RememberedObject object;
  object.name = key;
  object.model = model;
  object.link = link;
  object.X_LO = X_LO;
  for (auto& [arm, hand] : hands_) {
    const bool is_palm = robot_->profile.upper_body->arms.at(arm).palm_link == link;
    if (hand.holds == key && !is_palm) hand.holds.clear();
    if (!is_palm || (!hand.holds.empty() && hand.holds != key)) continue;
    object.is_held = true;
    hand.holds = key;
    hand.grasp_gap = hand.gap;
  }
  objects_[key] = object;
}

void ObjectMemory::Disbelieve(const std::string& name) {
  const auto known = objects_.find(base::ToLower(name));
  if (known == objects_.end() || known->second.is_observed) return;
  if (Hand* hand = HandOf(known->first)) hand->holds.clear();
  objects_.erase(known);
}

void ObjectMemory::DisbelieveAllBut(const std::vector<std::string>& names) {
  std::vector<std::string> said, unsaid;
  for (const std::string& name : names) said.push_back(base::ToLower(name));
  for (const auto& [name, unused] : objects_) {
    if (!Contains(said, name)) unsaid.push_back(name);
  }
  for (const std::string& name : unsaid) Disbelieve(name);
}

// ---- Feeling.

bool ObjectMemory::Feel(const BodyReading& body) {
  const Links links(*robot_, body);
  bool has_changed = false;
  for (auto& [arm, hand] : hands_) has_changed |= FeelHand(links, arm, &hand, body);
  return has_changed;
}

bool ObjectMemory::FeelHand(const Links& links, const std::string& name, Hand* hand,
                            const BodyReading& body) {
  const robot::ArmProfile& arm = robot_->profile.upper_body->arms.at(name);
  const auto position = body.joints.find(arm.gripper_joint);
  if (position == body.joints.end()) return false;
  const double gap = position->second;
  const double max_gap = robot_->profile.upper_body->gripper.max_gap;
  if (hand->gap < 0.0 && !hand->holds.empty()) hand->grasp_gap = gap;  // believed to hold
  hand->since = std::min(hand->since, body.time);  // the clock may have begun again
  if (hand->gap < 0.0 || std::abs(gap - hand->gap) > params_.still_gap) {
    hand->gap = gap;
    hand->since = body.time;
  }
  if (!hand->holds.empty()) {
    const std::string held = hand->holds;
    const bool is_lost = gap < params_.closed_gap || gap < hand->grasp_gap - params_.gap_below;
    const double most =
        std::min(hand->grasp_gap + params_.opening, max_gap - 0.5 * params_.open_gap);
    if (!is_lost && gap <= most) return false;
    hand->holds.clear();
    is_lost ? Lose(links, held) : LetGo(links, held, body.time);
    return true;
  }
  if (body.time - hand->since < params_.still_time) return false;
  if (gap < params_.closed_gap || gap > max_gap - params_.open_gap) return false;
  const std::string between = Between(links, arm, gap);
  if (between.empty()) return false;
  Take(links, arm, between, hand);
  return true;
}

/// The object that a gap of this width can hold, nearest to the middle between the finger tips.
std::string ObjectMemory::Between(const Links& links, const robot::ArmProfile& arm,
                                  double gap) const {
  const Pose3 X_MT = links.X_ML(arm.tool_link);
  std::string nearest;
  double least = params_.grasp_distance;
  for (const auto& [name, object] : objects_) {
    if (object.is_held) continue;
    const geometry::Aabb bounds = BoundsOf(surroundings_->Model(object.model).collisions);
    const Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
    const Pose3 X_OT = X_MO.Inverse() * X_MT;
    const auto widths = WidthsAcross(bounds, X_OT.rotation * Eigen::Vector3d::UnitY());
    const bool fits = std::any_of(widths.begin(), widths.end(), [&](double width) {
      return gap >= width - params_.gap_below && gap <= width + params_.gap_above;
    });
    if (!fits) continue;
    const double distance = DistanceTo(bounds, X_OT.translation);
    if (distance > least) continue;
    nearest = name;
    least = distance;
  }
  return nearest;
}

void ObjectMemory::Take(const Links& links, const robot::ArmProfile& arm, const std::string& name,
                        Hand* hand) {
  RememberedObject& object = objects_.at(name);
  Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
  // The fingers touch it: where it was seen beside them, it was seen badly.
  const Eigen::Vector3d p_MT = links.X_ML(arm.tool_link).translation;
  const geometry::Aabb bounds = BoundsOf(surroundings_->Model(object.model).collisions);
  const Eigen::Vector3d p_OT = X_MO.Inverse() * p_MT;
  X_MO.translation += p_MT - X_MO * p_OT.cwiseMax(bounds.lower).cwiseMin(bounds.upper).eval();
  object.link = arm.palm_link;
  object.X_LO = links.X_ML(arm.palm_link).Inverse() * X_MO;
  object.is_held = object.is_observed = true;
  object.num_missed = 0;
  hand->holds = name;
  hand->grasp_gap = hand->gap;
}

/// Whether an object at X_MO may be what the hand that is said to hold it holds.
bool ObjectMemory::IsInHand(const Links& links, const RememberedObject& object,
                            const Pose3& X_MO) const {
  for (const auto& [name, arm] : robot_->profile.upper_body->arms) {
    if (arm.palm_link != object.link) continue;
    const geometry::Aabb bounds = BoundsOf(surroundings_->Model(object.model).collisions);
    const Eigen::Vector3d p_OT = X_MO.Inverse() * links.X_ML(arm.tool_link).translation;
    return DistanceTo(bounds, p_OT) <= params_.grasp_distance;
  }
  return false;
}

void ObjectMemory::LetGo(const Links& links, const std::string& name, double time) {
  RememberedObject& object = objects_.at(name);
  const Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
  object.is_held = false;
  object.is_observed = true;
  object.time = time;
  object.num_missed = 0;
  PlaceAt(links, X_MO, &object);
}

void ObjectMemory::Lose(const Links& links, const std::string& name) {
  if (Hand* hand = HandOf(name)) hand->holds.clear();
  const RememberedObject& object = objects_.at(name);
  vanished_[name] = {object.model, PlaceOf(links, object)};
  objects_.erase(name);
}

ObjectMemory::Hand* ObjectMemory::HandOf(const std::string& object) {
  for (auto& [arm, hand] : hands_) {
    if (hand.holds == object) return &hand;
  }
  return nullptr;
}

bool ObjectMemory::IsOverTray(const Links& links, const Pose3& X_MO) const {
  if (!tray_T_) return false;
  constexpr double kBeside = 0.02, kBelow = 0.05, kAbove = 0.10;  // [m]
  const Eigen::Vector3d p_T = links.X_ML(robot_->profile.tray_link).Inverse() * X_MO.translation;
  return p_T.x() >= tray_T_->lower.x() - kBeside && p_T.x() <= tray_T_->upper.x() + kBeside &&
         p_T.y() >= tray_T_->lower.y() - kBeside && p_T.y() <= tray_T_->upper.y() + kBeside &&
         p_T.z() >= tray_T_->upper.z() - kBelow && p_T.z() <= tray_T_->upper.z() + kAbove;
}

void ObjectMemory::PlaceAt(const Links& links, const Pose3& X_MO, RememberedObject* object) const {
  object->link = IsOverTray(links, X_MO) ? robot_->profile.base_link : "";
  object->X_LO = links.X_ML(object->link).Inverse() * X_MO;
}

// ---- Looking.

void ObjectMemory::Check(const Detection& detection) const {
  if (detection.instance || detection.label != perception::kUnknownLabel)
    surroundings_->Model(detection.label);
  const std::string what =
      fmt::format("detection of '{}': ", detection.instance.value_or(detection.label));
  if (!detection.X_CO.IsFinite()) throw base::ConfigError(what + "its pose is not finite");
  if (!(detection.confidence > 0.0 && detection.confidence <= 1.0)) {
    throw base::ConfigError(
        what + fmt::format("confidence is {}, wanted 0 (not told) .. 1", detection.confidence));
  }
  for (const perception::LabelConfidence& other : detection.alternatives) {
    if (other.confidence >= 0.0 && other.confidence <= 1.0) continue;
    throw base::ConfigError(what +
                            fmt::format("confidence of alternative '{}' is {}, wanted 0 .. 1",
                                        other.label, other.confidence));
  }
}

/// What a detection is given to; no name: to nobody.
struct ObjectMemory::Named {
  std::string name{}, model{};
  bool is_ambiguous{false};
};

struct ObjectMemory::LookedAt {
  Pose3 X_MO(std::size_t i) const { return view.X_MC * detections[i].X_CO; }
  bool Covers(const Eigen::Vector3d& p_M) const;

  const CameraView& view;
  const std::vector<Detection>& detections;
  std::vector<Eigen::Vector3d> table_M;
};

/// Whether something that stands there was looked at.
bool ObjectMemory::LookedAt::Covers(const Eigen::Vector3d& p_M) const {
  constexpr double kBeside = 0.06;  // [m] above or below the table: localisation and camera err
  if (table_M.size() < 3) return table_M.empty();
  geometry::Polygon outline;
  double height = 0.0;
  for (const Eigen::Vector3d& corner : table_M) {
    outline.push_back(corner.head<2>());
    height += corner.z() / table_M.size();
  }
  return std::abs(p_M.z() - height) < kBeside && geometry::Contains(outline, p_M.head<2>());
}

void ObjectMemory::Look(const BodyReading& body, const std::vector<Detection>& detections,
                        const std::vector<Eigen::Vector3d>& table_C) {
  for (const Detection& detection : detections) Check(detection);
  const Links links(*robot_, body);
  const CameraView view = perception::ViewOf(*robot_, body.X_MB, body.joints);
  std::vector<world::ObjectState> expected;
  for (const robot::SeenObject& seen : Known(body)) {
    expected.push_back({seen.name, seen.model, seen.X_MO, {}, seen.attached_to});
  }
  const LineOfSight sight(surroundings_, expected,
                          perception::ShapesOf(*robot_, body.X_MB, body.joints));
  LookedAt look{view, detections, {}};
  for (const Eigen::Vector3d& corner : table_C) look.table_M.push_back(view.X_MC * corner);
  std::vector<Named> named = NamesOf(links, look);
  num_ambiguous_ = static_cast<int>(
      std::count_if(named.begin(), named.end(), [](const Named& n) { return n.is_ambiguous; }));
  Miss(sight, links, look, named);
  Appear(links, look, &named);
  for (std::size_t i = 0; i < detections.size(); ++i) {
    if (named[i].name.empty()) continue;
    Pose3 X_MO = look.X_MO(i);
    if (!detections[i].instance) X_MO = TurnedAlike(links, named[i].name, named[i].model, X_MO);
    See(links, named[i].name, named[i].model, X_MO, body.time);
  }
}

Eigen::Vector3d ObjectMemory::PlaceOf(const Links& links, const RememberedObject& object) const {
  return (links.X_ML(object.link) * object.X_LO).translation;
}

/// Whether a thing that has no name, seen at X_MO, may be the object. One that no model explains
/// may be whatever is expected there.
bool ObjectMemory::MayBe(const Links& links, const RememberedObject& object,
                         const Detection& detection, const Pose3& X_MO) const {
  if ((PlaceOf(links, object) - X_MO.translation).norm() > params_.instance_distance) return false;
  if (detection.label == perception::kUnknownLabel) return true;
  const auto kinds = KindsOf(detection, kHardly);
  return std::any_of(kinds.begin(), kinds.end(),
                     [&](const SeenKind& one) { return one.kind == object.model; });
}

std::vector<ObjectMemory::Named> ObjectMemory::NamesOf(const Links& links,
                                                       const LookedAt& look) const {
  std::vector<Named> named(look.detections.size());
  std::vector<std::size_t> nameless;
  std::vector<std::string> given;
  std::vector<SeenThing> things;
  for (std::size_t i = 0; i < named.size(); ++i) {
    const Detection& one = look.detections[i];
    named[i] = {base::ToLower(one.instance.value_or("")), one.label, false};
    if (one.instance) {
      given.push_back(named[i].name);
    } else {
      nameless.push_back(i);
      things.push_back({KindsOf(one, kHardly), look.X_MO(i).translation});
    }
  }
  std::vector<std::string> names;
  std::vector<Anchor> anchors;
  for (const auto& [name, object] : objects_) {
    if (Contains(given, name)) continue;
    names.push_back(name);
    anchors.push_back({object.model, PlaceOf(links, object)});
  }
  const Anchoring found =
      AnchorThings(things, anchors, params_.instance_distance, params_.instance_margin);
  for (std::size_t k = 0; k < nameless.size(); ++k) {
    named[nameless[k]].is_ambiguous = found.is_ambiguous[k];
    if (found.anchor[k] < 0) continue;
    named[nameless[k]].name = names[found.anchor[k]];
    named[nameless[k]].model = anchors[found.anchor[k]].kind;
  }
  return named;
}

/// Counts for how long things have been seen that are none of the known.
void ObjectMemory::Appear(const Links& links, const LookedAt& look, std::vector<Named>* named) {
  std::vector<Newcomer> seen;
  for (std::size_t i = 0; i < named->size(); ++i) {
    const Detection& one = look.detections[i];
    const Pose3 X_MO = look.X_MO(i);
    if (one.instance || !(*named)[i].name.empty() || (*named)[i].is_ambiguous) continue;
    if (one.label == perception::kUnknownLabel) continue;
    const bool may_be_known = std::any_of(objects_.begin(), objects_.end(), [&](const auto& known) {
      const auto has_it = [&](const Named& n) { return n.name == known.first; };
      return std::none_of(named->begin(), named->end(), has_it) &&
             MayBe(links, known.second, one, X_MO);
    });
    if (may_be_known) continue;
    Newcomer newcomer{one.label, X_MO.translation, 1, static_cast<int>(i)};
    for (const Newcomer& before : newcomers_) {
      const bool is_same = (before.p_M - newcomer.p_M).norm() <= params_.moved_distance;
      if (is_same) newcomer.num_looks = std::max(newcomer.num_looks, before.num_looks + 1);
    }
    seen.push_back(newcomer);
  }
  newcomers_ = seen;
  NameNewcomers(look, named);
}

/// Things that were seen for long enough are vanished ones that were moved, or new.
void ObjectMemory::NameNewcomers(const LookedAt& look, std::vector<Named>* named) {
  constexpr double kAnywhere = 100.0;  // [m]
  std::vector<const Newcomer*> ripe;
  std::vector<SeenThing> things;
  for (const Newcomer& newcomer : newcomers_) {
    if (newcomer.num_looks < params_.looks_to_appear) continue;
    ripe.push_back(&newcomer);
    things.push_back({KindsOf(look.detections[newcomer.detection], kAsLikely), newcomer.p_M});
  }
  std::vector<std::string> names;
  std::vector<Anchor> anchors;
  for (const auto& [name, vanished] : vanished_) {
    names.push_back(name);
    anchors.push_back({vanished.model, vanished.p_M});
  }
  const Anchoring found = AnchorThings(things, anchors, kAnywhere, params_.instance_margin);
  for (std::size_t k = 0; k < ripe.size(); ++k) {
    Named& one = (*named)[ripe[k]->detection];
    one.is_ambiguous = found.is_ambiguous[k];
    num_ambiguous_ += one.is_ambiguous;
    if (one.is_ambiguous) continue;
    const int anchor = found.anchor[k];
    one.name = anchor < 0 ? FreeName(one.model) : names[anchor];
    if (anchor >= 0) one.model = anchors[anchor].kind;
    objects_[one.name].model = one.model;  // so that the next one gets another name
  }
}

/// As others of that kind are called, with the first number that is free.
std::string ObjectMemory::FreeName(const std::string& kind) const {
  std::string stem = base::ToLower(kind);
  for (const auto& [name, object] : objects_) {
    if (object.model == kind) stem = name.substr(0, name.find_last_not_of("0123456789") + 1);
  }
  for (int number = 1;; ++number) {
    const std::string name = stem + std::to_string(number);
    if (objects_.count(name) == 0 && vanished_.count(name) == 0) return name;
  }
}

/// Turned by as little as its shape allows against how it was remembered: nobody sees how a round
/// thing is turned, nor which side of a box is its front.
Pose3 ObjectMemory::TurnedAlike(const Links& links, const std::string& name,
                                const std::string& model, Pose3 X_MO) const {
  const int symmetry = geometry::TurnSymmetry(surroundings_->Model(model).collisions);
  const auto known = objects_.find(name);
  const bool is_known = known != objects_.end() && !known->second.name.empty();
  const Pose3 X_ML = is_known ? links.X_ML(known->second.link) : Pose3();
  const double before =
      is_known ? geometry::YawOf(X_ML.rotation * known->second.X_LO.rotation) : 0.0;
  double turn = before - geometry::YawOf(X_MO.rotation);
  if (symmetry != geometry::kRound) {
    const double step = 2.0 * geometry::kPi / symmetry;
    turn = step * std::round(turn / step);
  }
  X_MO.rotation = X_MO.rotation * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  return X_MO;
}

/// [sr] of an object's box, seen from the camera; exact from afar.
double ObjectMemory::SizeInView(const CameraView& view, const std::string& model,
                                const Pose3& X_MO) const {
  const geometry::Aabb box = BoundsOf(surroundings_->Model(model).collisions);
  const Eigen::Vector3d way_O =
      X_MO.Inverse() * view.X_MC.translation - 0.5 * (box.lower + box.upper);
  const Eigen::Array3d size = box.upper - box.lower;
  const Eigen::Array3d faces(size.y() * size.z(), size.x() * size.z(), size.x() * size.y());
  return (faces * way_O.normalized().array().abs()).sum() / way_O.squaredNorm();
}

/// Whether enough of the object is in view where it is believed, and also to both sides of that.
bool ObjectMemory::MustBeSeen(const LineOfSight& sight, const LookedAt& look, const Links& links,
                              const RememberedObject& object) const {
  const CameraView& view = look.view;
  const Pose3 X_MO = links.X_ML(object.link) * object.X_LO;
  const bool is_by_cloud = !look.table_M.empty();
  const double distance = (X_MO.translation - view.X_MC.translation).norm();
  if (is_by_cloud && distance > params_.expected_distance) return false;
  const double least_size = is_by_cloud ? params_.expected_size : 0.0;
  const double size = SizeInView(view, object.model, X_MO);
  const Eigen::Vector3d left_M = view.X_MC.rotation * Eigen::Vector3d::UnitY();
  for (const double beside : {0.0, params_.expected_margin, -params_.expected_margin}) {
    const Pose3 X_MBeside{X_MO.translation + beside * left_M, X_MO.rotation};
    const double share = sight.VisibleShareAt(view, object.model, X_MBeside, object.name);
    if (share < params_.expected_share || share * size < least_size) return false;
  }
  return true;
}

/// Counts the objects that should have been detected.
void ObjectMemory::Miss(const LineOfSight& sight, const Links& links, const LookedAt& look,
                        const std::vector<Named>& named) {
  std::vector<std::string> gone;
  for (auto& [name, object] : objects_) {
    bool may_be_seen = false;
    for (std::size_t i = 0; i < named.size(); ++i) {
      may_be_seen =
          may_be_seen || named[i].name == name ||
          (named[i].name.empty() && MayBe(links, object, look.detections[i], look.X_MO(i)));
    }
    if (may_be_seen || !look.Covers(PlaceOf(links, object))) continue;
    if (!MustBeSeen(sight, look, links, object)) continue;
    if (++object.num_missed >= params_.looks_to_vanish) gone.push_back(name);
  }
  for (const std::string& name : gone) Lose(links, name);
}

void ObjectMemory::See(const Links& links, const std::string& name, const std::string& label,
                       const Pose3& X_MO, double time) {
  vanished_.erase(name);
  RememberedObject& object = objects_[name];
  const bool is_new = object.name.empty() || object.model != label;
  object.name = name;
  object.model = label;
  object.time = time;
  object.num_missed = 0;
  const Pose3 X_LO = links.X_ML(object.link).Inverse() * X_MO;
  const double moved = (X_LO.translation - object.X_LO.translation).norm();
  const double turned = X_LO.rotation.angularDistance(object.X_LO.rotation);
  if (object.is_held && moved > params_.hand_distance && !IsInHand(links, object, X_MO)) {
    HandOf(name)->holds.clear();  // seen elsewhere: it is not in the hand any more
    object.is_held = false;
  }
  const bool is_still = !is_new && object.is_observed && moved <= params_.moved_distance &&
                        turned <= params_.moved_angle;
  object.is_observed = true;
  if (is_still) {
    object.X_LO.translation += params_.blending * (X_LO.translation - object.X_LO.translation);
    object.X_LO.rotation = object.X_LO.rotation.slerp(params_.blending, X_LO.rotation).normalized();
  } else if (object.is_held) {
    object.X_LO = X_LO;
  } else {
    PlaceAt(links, X_MO, &object);
  }
}

// ---- What is known.

std::vector<std::string> ObjectMemory::Vanished() const {
  std::vector<std::string> names;
  for (const auto& [name, unused] : vanished_) names.push_back(name);
  return names;
}

std::vector<robot::SeenObject> ObjectMemory::Known(const BodyReading& body) const {
  const Links links(*robot_, body);
  std::vector<robot::SeenObject> known;
  for (const auto& [name, object] : objects_) {
    known.push_back({name, object.model, links.X_ML(object.link) * object.X_LO, object.time,
                     object.is_held ? object.link : ""});
  }
  return known;
}

}  // namespace hires::sensing
