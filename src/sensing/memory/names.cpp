#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/world/unknown_box.h"
#include "sensing/anchoring.h"
#include "sensing/memory/memory_parts.h"

namespace hires::sensing {
namespace {

using geometry::Pose3;
using perception::Detection;

constexpr double kResized = 0.015;   // [m] by which boxes of one thing differ between looks
constexpr double kAboutHand = 0.15;  // [m] to the side of a box
constexpr double kBesideBox = 0.02;  // [m] that the origin of what is in its place may lie

/// What is remembered of a thing of unknown kind is its box, which looks measure anew.
std::string KindOf(const std::string& model) {
  return world::SaysUnknownBox(model) ? perception::kUnknownLabel : model;
}

/// What a thing without a name may be, each with a doubt that grows as its odds against the label
/// shrink: a mill of which little is seen, and which looks more like a bottle, is the mill that was
/// there before rather than a bottle that took its place.
/// @param least  share of the label's confidence below which a kind is left out.
std::vector<SeenKind> KindsOf(const Detection& detection, double least) {
  if (detection.label == perception::kUnknownLabel) return {{perception::kUnknownLabel, 0.0}};
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

bool MayBeOfKind(const Detection& detection, const std::string& kind) {
  const auto kinds = KindsOf(detection, kAsLikely);
  return std::any_of(kinds.begin(), kinds.end(),
                     [&](const SeenKind& one) { return one.kind == kind; });
}

}  // namespace

/// Whether a thing that has no name, seen at X_MO, may be the object: as NamesOf anchors it, so
/// that nothing is too doubtful to be an object and yet keeps it from being missed. One that no
/// model explains may be whatever is expected there, unless looks that showed less of it said what
/// that is; and where looks that showed more of it found no model, a look that does is mistaken.
bool ObjectMemory::MayBe(const Links& links, const RememberedObject& object,
                         const Detection& detection, const Pose3& X_MO) const {
  const Eigen::Vector3d p_M = PlaceOf(links, object);
  if ((p_M - X_MO.translation).norm() > params_.instance_distance) return false;
  if (detection.label == perception::kUnknownLabel)
    return object.num_points == 0 || detection.num_points <= object.num_points;
  if (world::SaysUnknownBox(object.model))
    return detection.num_points > 0 && detection.num_points < object.num_points;
  const SeenThing thing{KindsOf(detection, kHardly), X_MO.translation};
  return CostOf(thing, {object.model, p_M}, params_.instance_distance).has_value();
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
      const bool has_kind = one.label != perception::kUnknownLabel;
      const bool is_known_better =
          std::any_of(objects_.begin(), objects_.end(), [&](const auto& known) {
            return world::SaysUnknownBox(known.second.model) &&
                   MayBe(links, known.second, one, look.X_MO(i));
          });
      if (has_kind && is_known_better) things.back().kinds.push_back({perception::kUnknownLabel});
    }
  }
  std::vector<std::string> names;
  std::vector<Anchor> anchors;
  for (const auto& [name, object] : objects_) {
    if (Contains(given, name)) continue;
    // What a hand holds no look tells apart from a taller thing on the table below it.
    if (object.is_held && world::SaysUnknownBox(object.model)) continue;
    names.push_back(name);
    anchors.push_back({KindOf(object.model), PlaceOf(links, object)});
  }
  // What has no name yet is not its neighbour, in the one look that overlooks that one.
  for (const Newcomer& newcomer : newcomers_) {
    if (newcomer.num_looks >= params_.looks_to_appear) continue;
    names.emplace_back();
    anchors.push_back({newcomer.kind, newcomer.p_M});
  }
  const Anchoring found =
      AnchorThings(things, anchors, params_.instance_distance, params_.instance_margin);
  for (std::size_t k = 0; k < nameless.size(); ++k) {
    named[nameless[k]].is_ambiguous = found.is_ambiguous[k];
    if (found.anchor[k] < 0 || names[found.anchor[k]].empty()) continue;
    named[nameless[k]].name = names[found.anchor[k]];
    named[nameless[k]].model = objects_.at(names[found.anchor[k]]).model;
  }
  return named;
}

/// What is about a hand may be the hand above the table, what it holds, or what it is about to
/// take, half hidden: whatever that looks like. What has no kind may be a part of something known
/// that is seen in pieces, as behind an arm.
bool ObjectMemory::MayBeNew(const Links& links, const Detection& detection,
                            const Pose3& X_MO) const {
  const bool has_kind = detection.label != perception::kUnknownLabel;
  if (!has_kind && !(detection.size.minCoeff() > 0.0)) return false;  // nobody measured it
  if (!has_kind && X_MO.translation.z() < kFloor) return false;       // FloorWatch remembers it
  if (!has_kind && detection.may_be_beside) return false;             // furniture, perhaps
  const double reach = kAboutHand + 0.5 * detection.size.head<2>().norm();
  for (const auto& [arm, unused] : hands_) {
    const std::string& tool = robot_->profile.upper_body->arms.at(arm).tool_link;
    const Eigen::Vector3d way = links.X_ML(tool).translation - X_MO.translation;
    if (way.head<2>().norm() <= reach) return false;
  }
  if (has_kind) return true;
  return std::none_of(objects_.begin(), objects_.end(), [&](const auto& known) {
    return MayBe(links, known.second, detection, X_MO) && LiesIn(links, known.second, X_MO);
  });
}

/// Whether the origin of a thing is within an object, seen from above.
bool ObjectMemory::LiesIn(const Links& links, const RememberedObject& object,
                          const Pose3& X_MO) const {
  const geometry::Aabb box = BoundsOf(surroundings_->Model(object.model).collisions);
  const Pose3 X_OM = (links.X_ML(object.link) * object.X_LO).Inverse();
  const Eigen::Array2d p_O = (X_OM * X_MO.translation).head<2>();
  return (p_O >= box.lower.head<2>().array() - kBesideBox).all() &&
         (p_O <= box.upper.head<2>().array() + kBesideBox).all();
}

/// Counts for how long things have been seen that are none of the known.
void ObjectMemory::Appear(const Links& links, const LookedAt& look, std::vector<Named>* named) {
  std::vector<Newcomer> seen;
  for (std::size_t i = 0; i < named->size(); ++i) {
    const Detection& one = look.detections[i];
    const Pose3 X_MO = look.X_MO(i);
    if (one.instance || !(*named)[i].name.empty() || (*named)[i].is_ambiguous) continue;
    if (!MayBeNew(links, one, X_MO)) continue;
    const bool may_be_known = std::any_of(objects_.begin(), objects_.end(), [&](const auto& known) {
      const auto has_it = [&](const Named& n) { return n.name == known.first; };
      return std::none_of(named->begin(), named->end(), has_it) &&
             MayBe(links, known.second, one, X_MO);
    });
    if (may_be_known) continue;
    Newcomer newcomer{one.label, X_MO.translation, 1, static_cast<int>(i)};
    for (const Newcomer& before : newcomers_) {
      if ((before.p_M - newcomer.p_M).norm() > params_.moved_distance) continue;
      // One look alone may mistake its kind: the last two before it gets a name have to agree.
      const bool agrees = before.kind == newcomer.kind;
      const int num_looks = std::min(before.num_looks + 1, params_.looks_to_appear - !agrees);
      newcomer.num_looks = std::max(newcomer.num_looks, num_looks);
    }
    seen.push_back(newcomer);
  }
  newcomers_ = seen;
  NameNewcomers(links, look, named);
}

/// Of a thing that is none of the known. Boxes of unknown kind have nothing but their place that
/// tells them apart: one that vanished just there is there again.
std::string ObjectMemory::NewName(const std::string& kind, const Eigen::Vector3d& p_M) const {
  if (kind == perception::kUnknownLabel) {
    for (const auto& [name, vanished] : vanished_) {
      const bool is_there = (vanished.p_M - p_M).norm() <= params_.instance_distance;
      if (is_there && world::SaysUnknownBox(vanished.model) && objects_.count(name) == 0)
        return name;
    }
  }
  return FreeName(kind);
}

/// What is known by hearsay alone, was not seen this time either, and is said to stand so near that
/// the newcomer may be it: who says where things are errs more than who sees them.
std::vector<std::string> ObjectMemory::ToldNear(const Links& links, const Newcomer& newcomer,
                                                const std::vector<Named>& named) const {
  std::vector<std::string> names;
  for (const auto& [name, object] : objects_) {
    const auto has_it = [&name = name](const Named& one) { return one.name == name; };
    if (object.is_observed || std::any_of(named.begin(), named.end(), has_it)) continue;
    if ((PlaceOf(links, object) - newcomer.p_M).norm() <= params_.told_distance)
      names.push_back(name);
  }
  return names;
}

/// Whether it may be something told of, while another thing that may be that is seen nearer to
/// where it was told to be, and not for long enough yet.
bool ObjectMemory::MustWait(const Links& links, const LookedAt& look, const Newcomer& newcomer,
                            const std::vector<Named>& named) const {
  const auto has_no_name_yet = [&](std::size_t i) {
    return named[i].name.empty() &&
           std::none_of(newcomers_.begin(), newcomers_.end(), [&](const Newcomer& other) {
             return other.detection == static_cast<int>(i) &&
                    other.num_looks >= params_.looks_to_appear;
           });
  };
  for (const std::string& name : ToldNear(links, newcomer, named)) {
    const RememberedObject& object = objects_.at(name);
    const Eigen::Vector3d told_M = PlaceOf(links, object);
    if (!MayBeOfKind(look.detections[newcomer.detection], object.model)) continue;
    for (std::size_t i = 0; i < named.size(); ++i) {
      const Eigen::Vector3d p_M = look.X_MO(i).translation;
      // From afar a thing may be seen in pieces.
      if ((p_M - newcomer.p_M).norm() <= params_.instance_distance) continue;
      const bool is_nearer = (p_M - told_M).norm() < (newcomer.p_M - told_M).norm();
      if (is_nearer && has_no_name_yet(i) && MayBeOfKind(look.detections[i], object.model))
        return true;
    }
  }
  return false;
}

/// Things that were seen for long enough are known ones that were moved or stand elsewhere than was
/// told, or new.
void ObjectMemory::NameNewcomers(const Links& links, const LookedAt& look,
                                 std::vector<Named>* named) {
  constexpr double kAnywhere = 100.0;  // [m]
  std::vector<const Newcomer*> ripe;
  std::vector<SeenThing> things;
  for (const Newcomer& newcomer : newcomers_) {
    if (newcomer.num_looks < params_.looks_to_appear) continue;
    if (MustWait(links, look, newcomer, *named)) {
      (*named)[newcomer.detection].is_ambiguous = true;
      ++num_ambiguous_;
      continue;
    }
    ripe.push_back(&newcomer);
    things.push_back({KindsOf(look.detections[newcomer.detection], kAsLikely), newcomer.p_M});
  }
  std::vector<std::string> names;
  std::vector<Anchor> anchors;
  for (const auto& [name, vanished] : vanished_) {
    if (world::SaysUnknownBox(vanished.model)) continue;
    names.push_back(name);
    anchors.push_back({vanished.model, vanished.p_M});
  }
  for (const Newcomer* newcomer : ripe) {
    for (const std::string& name : ToldNear(links, *newcomer, *named)) {
      const RememberedObject& object = objects_.at(name);
      if (Contains(names, name) || world::SaysUnknownBox(object.model)) continue;
      names.push_back(name);
      anchors.push_back({object.model, PlaceOf(links, object)});
    }
  }
  const Anchoring found = AnchorThings(things, anchors, kAnywhere, params_.instance_margin);
  for (std::size_t k = 0; k < ripe.size(); ++k) {
    Named& one = (*named)[ripe[k]->detection];
    one.is_ambiguous = found.is_ambiguous[k];
    num_ambiguous_ += one.is_ambiguous;
    if (one.is_ambiguous) continue;
    const int anchor = found.anchor[k];
    one.name = anchor < 0 ? NewName(one.model, ripe[k]->p_M) : names[anchor];
    if (anchor >= 0) one.model = anchors[anchor].kind;
    const Detection& seen = look.detections[ripe[k]->detection];
    if (one.model == perception::kUnknownLabel) one.model = world::UnknownBoxModel(seen.size);
    RememberedObject& object = objects_[one.name];
    object.model = one.model;  // so that the next one gets another name
    const auto vanished = vanished_.find(one.name);
    if (vanished != vanished_.end()) object.num_points = vanished->second.num_points;
    if (anchor < 0) object.num_points = std::max(1, seen.num_points);
  }
}

/// What was of unknown kind is gone where something else turns out to be in its place.
void ObjectMemory::Reveal(const Links& links, const LookedAt& look,
                          const std::vector<Named>& named) {
  std::vector<std::string> gone;
  for (const auto& [name, object] : objects_) {
    if (!world::SaysUnknownBox(object.model) || object.is_held) continue;
    const Pose3 X_OM = (links.X_ML(object.link) * object.X_LO).Inverse();
    const Eigen::Array2d reach =
        0.5 * world::SizeOfUnknownBox(object.model).head<2>().array() + kBesideBox;
    bool is_seen = false, is_taken = false;
    for (std::size_t i = 0; i < named.size(); ++i) {
      is_seen = is_seen || named[i].name == name;
      const Eigen::Vector3d p_O = X_OM * look.X_MO(i).translation;
      is_taken = is_taken || (!named[i].name.empty() && named[i].name != name &&
                              (p_O.head<2>().array().abs() <= reach).all());
    }
    if (is_taken && !is_seen) gone.push_back(name);
  }
  for (const std::string& name : gone) Lose(links, name);
}

/// The box of a thing of unknown kind: as it was remembered, until several looks in a row measure
/// another.
/// @param X_MO  comes as it was measured, and leaves turned so that x and y are the remembered
/// ones.
std::string ObjectMemory::BoxOf(const Links& links, const std::string& name,
                                const Detection& detection, Pose3* X_MO) {
  RememberedObject& object = objects_.at(name);
  if (detection.label !=
      perception::kUnknownLabel) {  // taken for something else: no box of its own
    X_MO->rotation = (links.X_ML(object.link) * object.X_LO).rotation;
    return object.model;
  }
  object.num_points = std::max(object.num_points, detection.num_points);
  const Eigen::Vector3d before = world::SizeOfUnknownBox(object.model);
  Eigen::Vector3d size = detection.size;
  const Eigen::Vector3d turned(size.y(), size.x(), size.z());
  if ((turned - before).norm() < (size - before).norm()) {
    size = turned;
    X_MO->rotation =
        X_MO->rotation * Eigen::AngleAxisd(0.5 * geometry::kPi, Eigen::Vector3d::UnitZ());
  }
  const bool is_other =
      size.minCoeff() > 0.0 && !object.is_held && (size - before).cwiseAbs().maxCoeff() > kResized;
  object.num_resized = is_other ? object.num_resized + 1 : 0;
  if (object.num_resized < params_.looks_to_appear) return object.model;
  object.num_resized = 0;
  return world::UnknownBoxModel(size);
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

}  // namespace hires::sensing
