#include "translation/arrangement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/world/unknown_box.h"
#include "translation/place.h"
#include "translation/stated_pose.h"

namespace hires::translation {
namespace {

using Eigen::Vector3d;
using geometry::Pose3;

constexpr double kGraspHeight = 0.4;  // of an object's height, from its foot
// [m] from the tool up to the top of what hangs from the hand: as deep as a cup of 0.08 m fits
// between the open fingers of the PR2, which stand like a V.
constexpr double kHangingDepth = 0.028;
constexpr double kClearance = 0.01;  // [m] between objects that are put side by side
constexpr double kStep = 0.02;       // [m] of the search for a free spot

/// [m] from an object's origin to the farthest point of its outline from above.
double RadiusOf(const world::ObjectModel& model) {
  constexpr double kAll = 10.0;  // [m] above and below: the whole of it
  double radius = 0.0;
  for (const geometry::Collision& collision : model.collisions) {
    const auto outline = geometry::OutlineInBand(collision.shape, collision.X_BS, -kAll, kAll);
    if (outline) radius = std::max(radius, geometry::CircumscribedRadius(*outline));
  }
  return radius;
}

/// Height of the static top within `slack` [m] of p_M that carries a square round it.
std::optional<double> TopUnder(const world::World& world, const Vector3d& p_M, double half_width,
                               double slack) {
  const Vector3d half(half_width, half_width, 0.0);
  for (const world::StaticBody& body : world.statics) {
    for (const geometry::Collision& collision : body.collisions) {
      const auto bounds = geometry::BoundsOf(collision.shape, body.X_MB * collision.X_BS);
      if (std::abs(bounds.upper.z() - p_M.z()) < slack &&
          ((p_M - half - bounds.lower).head<2>().array() >= 0.0).all() &&
          ((bounds.upper - p_M - half).head<2>().array() >= 0.0).all()) {
        return bounds.upper.z();
      }
    }
  }
  return std::nullopt;
}

/// Whether a static body's top carries a square round p_M.
bool IsCarried(const world::World& world, const Vector3d& p_M, double half_width) {
  constexpr double kSlack = 0.05;  // [m] in height
  return TopUnder(world, p_M, half_width, kSlack).has_value();
}

constexpr double kUpright = 0.1;     // [rad]
constexpr double kSeenAbove = 0.03;  // [m]: several deviations of the detector's error

/// An upright object that was seen a little above or below a top stands on it: the detector's error
/// would have it begin inside the furniture, or fall. Farther below than above, for nothing is in
/// furniture, and a head that turns errs by some cm.
Pose3 Rested(const world::World& world, const world::ObjectModel& model, Pose3 X_MO) {
  constexpr double kSeenBelow = 0.08;  // [m]
  if (geometry::TiltOf(X_MO.rotation) > kUpright) return X_MO;
  const double foot = BoundsOf(model).lower.z();
  const Vector3d p_MFoot = X_MO.translation + foot * Vector3d::UnitZ();
  const auto top = TopUnder(world, p_MFoot, 0.0, kSeenBelow);
  if (top && p_MFoot.z() - *top < kSeenAbove) X_MO.translation.z() = *top - foot;
  return X_MO;
}

/// Likewise, on a tray whose plane X_MA has. What was seen far above stands on something else
/// there.
Pose3 RestedOnTray(const Pose3& X_MA, const world::ObjectModel& model, const Pose3& X_MO) {
  if (geometry::TiltOf(X_MO.rotation) > kUpright) return X_MO;
  Pose3 X_AO = X_MA.Inverse() * X_MO;
  const double foot = BoundsOf(model).lower.z();
  if (X_AO.translation.z() + foot < kSeenAbove) X_AO.translation.z() = -foot;
  return X_MA * X_AO;
}

/// How `object` must be shifted, seen from above, so that it is not in `other`; zero where it is
/// not. What overlaps by less than `slack` in height stands on the other.
Eigen::Vector2d ShiftOutOf(const std::vector<geometry::Collision>& other, const Pose3& X_MOther,
                           const std::vector<geometry::Collision>& object, const Pose3& X_MO) {
  constexpr double kSlack = 0.005;  // [m]
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (const geometry::Collision& first : object) {
    const Pose3 X_MF = X_MO * first.X_BS;
    for (const geometry::Collision& second : other) {
      const Pose3 X_MS = X_MOther * second.X_BS;
      const geometry::Aabb a = geometry::BoundsOf(first.shape, X_MF);
      const geometry::Aabb b = geometry::BoundsOf(second.shape, X_MS);
      const double from = std::max(a.lower.z(), b.lower.z());
      const double to = std::min(a.upper.z(), b.upper.z());
      if (to - from < kSlack) continue;
      const auto outline = geometry::OutlineInBand(first.shape, X_MF, from, to);
      const auto outline_of_other = geometry::OutlineInBand(second.shape, X_MS, from, to);
      if (!outline || !outline_of_other) continue;
      const Eigen::Vector2d shift = geometry::PartingShift(*outline, *outline_of_other);
      if (shift.norm() > longest.norm()) longest = shift;
    }
  }
  return longest;
}

/// Whether a box that was seen is a part of the furniture, such as the back of a chair that rises
/// beside a table: it is in it, and no top carries it. The world has that furniture already.
bool IsSeenFurniture(const world::World& world, const world::ObjectModel& box, const Pose3& X_MO) {
  if (IsCarried(world, X_MO.translation, 0.0)) return false;
  return std::any_of(
      world.statics.begin(), world.statics.end(), [&](const world::StaticBody& body) {
        return !ShiftOutOf(body.collisions, body.X_MB, box.collisions, X_MO).isZero(0.0);
      });
}

/// Pose in the tool's frame of an object whose z axis points along `up_T`, grasped at a height in
/// its own frame [m].
Pose3 GraspedAlong(const world::ObjectModel& model, const Vector3d& up_T, double height) {
  const geometry::Aabb bounds = BoundsOf(model);
  Pose3 X_TO;
  X_TO.rotation = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), up_T);
  const Vector3d grasped_O((bounds.lower.x() + bounds.upper.x()) / 2,
                           (bounds.lower.y() + bounds.upper.y()) / 2, height);
  X_TO.translation = -(X_TO.rotation * grasped_O);
  return X_TO;
}

bool IsPartOfTheWorld(const world::World& world, const std::string& object) {
  return std::any_of(
      world.statics.begin(), world.statics.end(),
      [&](const world::StaticBody& body) { return base::ToLower(body.name) == object; });
}

class Arrangement {
 public:
  Arrangement(const TranslatorContext& context, const knowledge::FluentView* fluents,
              const WantedState& wanted, const Body& body)
      : context_(context), fluents_(fluents), wanted_(wanted), body_(body) {}

  world::WorldState Make() {
    for (const auto& [object, arm] : wanted_.holders) AddHeld(object, arm);
    std::vector<std::string> unplaced;
    for (const auto& [object, area] : wanted_.places) {
      if (!AddWhereSeen(object, context_.areas.Require(area))) unplaced.push_back(object);
    }
    AddOthers();
    Part();
    for (const std::string& object : unplaced) {
      AddAnew(object, context_.areas.Require(wanted_.places.at(object)));
    }
    std::sort(world_.objects.begin(), world_.objects.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
    return std::move(world_);
  }

 private:
  std::optional<StatedPose> SeenPose(const std::string& object) const {
    return fluents_ ? PoseStatedOf(*fluents_, object) : std::nullopt;
  }

  const world::ObjectModel& ModelOf(const std::string& object) const {
    std::shared_ptr<const world::ObjectModel>& model = models_[object];
    if (!model) model = context_.world->ModelOf({object, context_.ModelOf(object), {}, {}, ""});
    return *model;
  }

  void Add(const std::string& object, const Pose3& X_MO, const std::string& attached_to = "") {
    world::ObjectState state;
    state.name = object;
    state.model = ModelOf(object).name;
    state.X_MO = X_MO;
    state.attached_to = attached_to;
    world_.objects.push_back(state);
  }

  void AddHeld(const std::string& object, const std::string& name) {
    const robot::ArmProfile& arm = context_.robot->profile.upper_body->arms.at(name);
    const auto seen = SeenPose(object);
    const bool is_seen_in_hand = seen && base::ToLower(seen->frame) == base::ToLower(arm.palm_link);
    Add(object, is_seen_in_hand ? body_.X_ML(arm.palm_link) * seen->X_FO : GraspedPose(object, arm),
        arm.palm_link);
  }

  /// Between the finger tips, upright in the hand or below it.
  Pose3 GraspedPose(const std::string& object, const robot::ArmProfile& arm) const {
    const Pose3 X_MT = body_.X_ML(arm.tool_link);
    const world::ObjectModel& model = ModelOf(object);
    const geometry::Aabb bounds = BoundsOf(model);
    const double middle = bounds.lower.z() + kGraspHeight * (bounds.upper.z() - bounds.lower.z());
    const double near_top = std::max(middle, bounds.upper.z() - kHangingDepth);
    const std::array<Pose3, 2> grasps = {X_MT * GraspedAlong(model, Vector3d::UnitZ(), middle),
                                         X_MT * GraspedAlong(model, -Vector3d::UnitX(), near_top)};
    const double tilt = geometry::TiltOf(grasps[0].rotation);
    return geometry::TiltOf(grasps[1].rotation) < tilt ? grasps[1] : grasps[0];
  }

  /// Where it was seen, if that is on the area.
  bool AddWhereSeen(const std::string& object, const Area& area) {
    const auto seen = SeenPose(object);
    if (!seen) return false;
    const bool is_on_robot = !seen->frame.empty();
    if (is_on_robot != (area.kind == AreaKind::kTray)) return false;
    const Pose3 X_MO = is_on_robot ? body_.X_ML(seen->frame) * seen->X_FO : seen->X_FO;
    if (!CountsAsOn(area, X_MO)) return false;
    const world::ObjectModel& model = ModelOf(object);
    Add(object, is_on_robot ? RestedOnTray(PoseOf(area, body_), model, X_MO)
                            : Rested(*context_.world, model, X_MO));
    return true;
  }

  /// What only fluents know.
  void AddOthers() {
    if (fluents_ == nullptr) return;
    for (const StatedObject& stated : StatedObjects(context_, *fluents_)) {
      const bool is_named =
          wanted_.holders.count(stated.name) > 0 || wanted_.places.count(stated.name) > 0;
      if (is_named || !stated.link.empty()) continue;
      const world::ObjectModel& model = ModelOf(stated.name);
      const Pose3 X_MO = Rested(*context_.world, model, stated.X_LO);
      if (world::SaysUnknownBox(model.name) && IsSeenFurniture(*context_.world, model, X_MO))
        continue;
      Add(stated.name, X_MO);
    }
  }

  /// Objects that were seen in each other stand side by side: each was seen with an error of its
  /// own. They give way by the same amount, by no more than such errors are; what was seen farther
  /// in another object is left as it was seen; imagination refuses it.
  void Part() {
    constexpr double kFarthest = 0.06;  // [m] that an object may be shifted
    constexpr double kApart = 0.002;    // [m] between them in the end
    constexpr int kRounds = 20;         // each may shift the next into a third one
    std::vector<world::ObjectState>& objects = world_.objects;
    std::sort(objects.begin(), objects.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
    std::vector<world::ObjectState> parted = objects;
    bool is_free = false;
    for (int round = 0; round < kRounds && !is_free; ++round) {
      is_free = true;
      for (std::size_t i = 0; i < parted.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) is_free &= !Part(&parted[i], &parted[j], kApart);
      }
    }
    const auto is_near = [&](const world::ObjectState& now, const world::ObjectState& seen) {
      return (now.X_MO.translation - seen.X_MO.translation).norm() <= kFarthest;
    };
    if (std::equal(parted.begin(), parted.end(), objects.begin(), is_near)) {
      objects = std::move(parted);
    }
  }

  /// Whether they had to be parted. What the robot holds stays in its hand.
  bool Part(world::ObjectState* one, world::ObjectState* other, double apart) const {
    if (!one->attached_to.empty() && !other->attached_to.empty()) return false;
    const Eigen::Vector2d shift = ShiftOutOf(ModelOf(other->name).collisions, other->X_MO,
                                             ModelOf(one->name).collisions, one->X_MO);
    if (shift.isZero(0.0)) return false;
    const Eigen::Vector2d whole = (shift.norm() + apart) * shift.normalized();
    const double share = !one->attached_to.empty() ? 0.0 : !other->attached_to.empty() ? 1.0 : 0.5;
    one->X_MO.translation.head<2>() += share * whole;
    other->X_MO.translation.head<2>() -= (1.0 - share) * whole;
    return true;
  }

  /// As AtomsOf would say of an object that was on the area before.
  bool CountsAsOn(const Area& area, const Pose3& X_MO) const {
    world::ObjectState object;
    object.X_MO = X_MO;
    return AreaUnder(context_, body_, object, area.name) == &area;
  }

  bool IsClear(const world::ObjectModel& model, const Vector3d& p_M) const {
    return std::all_of(world_.objects.begin(), world_.objects.end(), [&](const auto& other) {
      const double apart = RadiusOf(model) + RadiusOf(ModelOf(other.name)) + kClearance;
      const Vector3d way = other.X_MO.translation - p_M;
      return way.head<2>().norm() >= apart || std::abs(way.z()) > 0.5;
    });
  }

  void AddAnew(const std::string& object, const Area& area) {
    const Pose3 X_MA = PoseOf(area, body_);
    if (area.kind == AreaKind::kTray) {
      if (AddToSlot(object)) return;
      const auto X_MO = ClearSpot(object, area, X_MA);
      if (X_MO) return Add(object, *X_MO);
      throw base::ConfigError(
          fmt::format("On({}, {}): there is no room left on the tray; put fewer objects on it",
                      object, kTrayArea));
    }
    Add(object, ClearSpot(object, area, X_MA).value_or(X_MA));
  }

  /// The spot nearest to the area's middle that is clear and that furniture or tray carries.
  std::optional<Pose3> ClearSpot(const std::string& object, const Area& area,
                                 const Pose3& X_MA) const {
    const world::ObjectModel& model = ModelOf(object);
    const double radius = RadiusOf(model);
    const int nx = static_cast<int>(area.size.x() / 2 / kStep);
    const int ny = static_cast<int>(area.size.y() / 2 / kStep);
    std::optional<Pose3> best;
    double least = std::numeric_limits<double>::infinity();
    for (int ix = -nx; ix <= nx; ++ix) {
      for (int iy = -ny; iy <= ny; ++iy) {
        const Pose3 X_AO = geometry::Lift({ix * kStep, iy * kStep, 0.0});
        const double distance = X_AO.translation.norm();
        if (distance >= least || !IsClear(model, X_MA * X_AO.translation)) continue;
        if (!CountsAsOn(area, X_MA * X_AO)) continue;
        const bool is_carried = area.kind == AreaKind::kTray || distance == 0.0 ||
                                IsCarried(*context_.world, X_MA * X_AO.translation, radius);
        if (!is_carried) continue;
        best = X_MA * X_AO;
        least = distance;
      }
    }
    return best;
  }

  bool AddToSlot(const std::string& object) {
    const world::ObjectModel& model = ModelOf(object);
    const Pose3 X_MMiddle =
        body_.X_ML(context_.robot->profile.tray_link) * context_.robot->profile.X_TO;
    for (const double y : {0.0, -context_.slot_distance, context_.slot_distance}) {
      const Pose3 X_MO = X_MMiddle * geometry::Lift({0.0, y, 0.0});
      if (!IsClear(model, X_MO.translation)) continue;
      Add(object, X_MO);
      return true;
    }
    return false;
  }

  const TranslatorContext& context_;
  const knowledge::FluentView* fluents_;
  mutable std::map<std::string, std::shared_ptr<const world::ObjectModel>> models_;  // asked for
  const WantedState& wanted_;
  const Body& body_;
  world::WorldState world_;
};

}  // namespace

std::vector<StatedObject> StatedObjects(const TranslatorContext& context,
                                        const knowledge::FluentView& fluents) {
  std::vector<StatedObject> objects;
  if (context.ontology == nullptr) return objects;
  const auto root = context.ontology->Find("PassiveObject");
  if (root == knowledge::Ontology::kUnknown) return objects;
  for (const auto below : context.ontology->Below(root)) {
    fluents.OfConcept(context.ontology->Name(below), [&](const knowledge::Fluent& fluent) {
      const std::string name = base::ToLower(fluent.instance);
      const auto stated = PoseStatedBy(fluents, fluent);
      const std::string model = context.FindModel(name);
      if (stated && !model.empty() && !IsPartOfTheWorld(*context.world, name)) {
        objects.push_back({name, model, stated->frame, stated->X_FO});
      }
      return true;
    });
  }
  return objects;
}

world::WorldState Arrange(const TranslatorContext& context, const knowledge::FluentView* fluents,
                          const WantedState& wanted, const Body& body) {
  return Arrangement(context, fluents, wanted, body).Make();
}

double WidthOf(const world::ObjectModel& model) {
  const geometry::Aabb bounds = BoundsOf(model);
  return (bounds.upper - bounds.lower).head<2>().minCoeff();
}

}  // namespace hires::translation
