#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/geometry/polygon.h"
#include "hires/world/unknown_box.h"
#include "sensing/memory/memory_parts.h"

namespace hires::sensing {

using geometry::Pose3;
using perception::CameraView;
using perception::Detection;
using perception::LineOfSight;

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
  const auto is_length = [](double edge) { return edge >= 0.0 && edge <= 10.0; };
  if (!std::all_of(detection.size.begin(), detection.size.end(), is_length)) {
    throw base::ConfigError(
        what + fmt::format("its box is {} x {} x {} m, wanted 0 (not told) .. 10",
                           detection.size.x(), detection.size.y(), detection.size.z()));
  }
  for (const perception::LabelConfidence& other : detection.alternatives) {
    if (other.confidence >= 0.0 && other.confidence <= 1.0) continue;
    throw base::ConfigError(what +
                            fmt::format("confidence of alternative '{}' is {}, wanted 0 .. 1",
                                        other.label, other.confidence));
  }
}

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
  LookedAt look{view, detections, {}};
  for (const Eigen::Vector3d& corner : table_C) look.table_M.push_back(view.X_MC * corner);
  std::vector<Named> named = NamesOf(links, look);
  // What is seen hides what is behind it before it has a name, but nothing in whose place it is.
  for (std::size_t i = 0; i < named.size(); ++i) {
    const Detection& one = detections[i];
    const bool is_unknown = one.label == perception::kUnknownLabel;
    const bool has_shape = !is_unknown || one.size.minCoeff() > 0.0;
    const Pose3 X_MO = look.X_MO(i);
    const bool may_be_known = std::any_of(objects_.begin(), objects_.end(), [&](const auto& known) {
      const double way = (PlaceOf(links, known.second) - X_MO.translation).norm();
      return known.first == named[i].name || way <= params_.instance_distance;
    });
    if (!has_shape || may_be_known) continue;
    expected.push_back({fmt::format("newcomer {}", i),
                        is_unknown ? world::UnknownBoxModel(one.size) : one.label,
                        X_MO,
                        {},
                        ""});
  }
  const LineOfSight sight(surroundings_, expected,
                          perception::ShapesOf(*robot_, body.X_MB, body.joints));
  num_ambiguous_ = static_cast<int>(
      std::count_if(named.begin(), named.end(), [](const Named& n) { return n.is_ambiguous; }));
  num_beside_ =
      static_cast<int>(std::count_if(detections.begin(), detections.end(),
                                     [](const Detection& one) { return one.may_be_beside; }));
  Miss(sight, links, look, named);
  Appear(links, look, &named);
  Reveal(links, look, named);
  for (std::size_t i = 0; i < detections.size(); ++i) {
    if (named[i].name.empty()) continue;
    Pose3 X_MO = look.X_MO(i);
    if (!detections[i].instance && world::SaysUnknownBox(named[i].model))
      named[i].model = BoxOf(links, named[i].name, detections[i], &X_MO);
    if (!detections[i].instance) {
      X_MO = TurnedAlike(links, named[i].name, named[i].model, X_MO);
      X_MO = AsHeld(links, named[i].name, X_MO);
    }
    See(links, named[i].name, named[i].model, X_MO, body.time);
    RememberedObject& object = objects_.at(named[i].name);
    if (object.num_points > 0 && detections[i].label == object.model)
      object.num_points = std::max(object.num_points, detections[i].num_points);
  }
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
  const double distance = (X_MO.translation - view.X_MC.translation).norm();
  if (distance > params_.expected_distance) return false;
  const double size = SizeInView(view, object.model, X_MO);
  const Eigen::Vector3d left_M = view.X_MC.rotation * Eigen::Vector3d::UnitY();
  for (const double beside : {0.0, params_.expected_margin, -params_.expected_margin}) {
    const Pose3 X_MBeside{X_MO.translation + beside * left_M, X_MO.rotation};
    const double share = sight.VisibleShareAt(view, object.model, X_MBeside, object.name);
    if (share < params_.expected_share || share * size < params_.expected_size) return false;
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
    // What stands on the floor and is of no kind no recogniser of things looks for.
    if (world::SaysUnknownBox(object.model) && PlaceOf(links, object).z() < kFloor) continue;
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
  object.num_missed = object.num_looked_through = 0;
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

}  // namespace hires::sensing
