#include "hires/translation/observed_fluents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/state_view.h"
#include "hires/world/unknown_box.h"
#include "translation/body.h"
#include "translation/place.h"
#include "translation/stated_pose.h"

namespace hires::translation {
namespace {

using base::Atom;
using knowledge::Fluent;
using ConceptId = knowledge::Ontology::ConceptId;

bool SameName(const std::string& a, const std::string& b) {
  return base::ToLower(a) == base::ToLower(b);
}

bool SameAtom(const Atom& a, const Atom& b) {
  return SameName(a.predicate, b.predicate) &&
         std::equal(a.arguments.begin(), a.arguments.end(), b.arguments.begin(), b.arguments.end(),
                    SameName);
}

bool Has(const std::vector<Atom>& atoms, const Atom& atom) {
  return std::any_of(atoms.begin(), atoms.end(),
                     [&](const Atom& one) { return SameAtom(one, atom); });
}

/// "WineGlass" of "wine_glass".
std::string Joined(const std::string& model) { return NameFor("", model); }

/// A view with some fluents besides, that the view below does not have.
class ViewWith : public knowledge::FluentView {
 public:
  using Visit = std::function<bool(const Fluent&)>;
  ViewWith(const FluentView* below, const std::vector<Fluent>* more) : below_(below), more_(more) {}

  const Fluent* Find(const std::string& instance) const override {
    for (const Fluent& fluent : *more_) {
      if (SameName(fluent.instance, instance)) return &fluent;
    }
    return below_->Find(instance);
  }
  void OfConcept(const std::string& concept_name, const Visit& visit) const override {
    below_->OfConcept(concept_name, visit);
  }
  void All(const Visit& visit) const override { below_->All(visit); }
  void WithFiller(const std::string& role, const knowledge::Filler& filler,
                  const Visit& visit) const override {
    below_->WithFiller(role, filler, visit);
  }

 private:
  const FluentView* below_;
  const std::vector<Fluent>* more_;
};

class Comparison {
 public:
  Comparison(const TranslatorContext& context, const knowledge::FluentView& said,
             const ObservedWorld& observed, const ChangeParams& params)
      : context_(context),
        ontology_(*context.ontology),
        said_(said),
        observed_(observed),
        params_(params),
        body_(*context.robot, observed.state.robot) {}

  FluentUpdate Make() {
    CompareRobotPose();
    for (const world::ObjectState& object : observed_.state.world.objects) CompareObject(object);
    for (const std::string& object : observed_.vanished) ForgetPose(object);
    for (const auto& [object, degrees] : observed_.temperatures) Warm(object, degrees);
    CompareSymbols();
    return std::move(update_);
  }

 private:
  // ---- Things and their poses.

  /// The first fluent of a concept or below it.
  const Fluent* FirstBelow(const std::string& concept_name) const {
    const Fluent* first = nullptr;
    for (const auto below : ontology_.Below(ontology_.Require(concept_name))) {
      said_.OfConcept(ontology_.Name(below), [&](const Fluent& fluent) {
        if (first == nullptr) first = &fluent;
        return false;
      });
    }
    return first;
  }

  void CompareRobotPose() {
    const Fluent* robot = FirstBelow("Robot");
    if (robot == nullptr) return;  // there is no robot to say it of
    ComparePose(*robot, "", geometry::Lift(observed_.state.robot.X_MB), params_.robot_position,
                params_.robot_angle);
  }

  void CompareObject(const world::ObjectState& object) {
    if (!object.X_MO.IsFinite()) {
      throw base::ConfigError(fmt::format("object '{}': its pose is not finite", object.name));
    }
    const Fluent* fluent = said_.Find(object.name);
    const bool is_new = fluent == nullptr;
    if (is_new) {
      new_things_.push_back(NewThing(object));
      fluent = &new_things_.back();
    }
    std::string frame;
    if (!object.attached_to.empty()) frame = object.attached_to;
    const Area* tray = context_.areas.Find(kTrayArea);
    if (frame.empty() && tray && IsOverTray(*tray, object.X_MO)) {
      frame = context_.robot->profile.base_link;
    }
    const geometry::Pose3 X_FO =
        frame.empty() ? object.X_MO : body_.X_ML(frame).Inverse() * object.X_MO;
    const Fluent copy = *fluent;  // new_things_ may grow
    const std::string pose =
        ComparePose(copy, frame, X_FO, params_.position, params_.angle, is_new);
    const std::string box = CompareBox(copy, object, pose, is_new);
    if (!is_new) return;
    Fluent& added = new_things_.back();
    added.properties = {{"hasPose", "Pose", pose}, {"hasBoundingBox", "BoundingBox", box}};
    update_.added.push_back(added);
  }

  /// What lies on the tray moves along as well.
  bool IsOverTray(const Area& tray, const geometry::Pose3& X_MO) const {
    return IsOver(tray, body_, X_MO, context_.classify, context_.classify.placing_hysteresis);
  }

  Fluent NewThing(const world::ObjectState& object) const {
    Fluent thing;
    thing.instance = object.name;
    thing.concept_name = world::SaysUnknownBox(object.model)
                             ? kUnknownConcept
                             : ontology_.Name(ConceptSeenOf(object.model));
    return thing;
  }

  ConceptId ConceptOf(const world::ObjectModel& model) const {
    if (!model.concept_name.empty()) return ontology_.Require(model.concept_name);
    const ConceptId named = ontology_.Find(Joined(model.name));
    return named != knowledge::Ontology::kUnknown ? named : ontology_.Require("TabletopObject");
  }

  /// Of a thing that was recognised as a model: nobody sees which of the models of its form it is.
  ConceptId ConceptSeenOf(const std::string& model) const {
    const auto seen = context_.world->RequireModel(model);
    ConceptId known = ConceptOf(*seen);
    for (const auto& [name, other] : context_.world->models) {
      const bool is_kind = !world::SaysUnknownBox(name);
      if (is_kind && geometry::AreAlike(seen->collisions, other->collisions))
        known = CommonConcept(known, ConceptOf(*other));
    }
    return known;
  }

  /// The lowest that both are below; of several such the first by name.
  ConceptId CommonConcept(ConceptId a, ConceptId b) const {
    ConceptId lowest = ontology_.Require("Thing");
    for (const ConceptId above : ontology_.Above(a)) {
      if (ontology_.IsA(b, above) && above != lowest && ontology_.IsA(above, lowest))
        lowest = above;
    }
    return lowest;
  }

  /// @return the instance of the pose.
  std::string ComparePose(const Fluent& owner, const std::string& frame,
                          const geometry::Pose3& X_FO, double position, double angle,
                          bool is_new = false) {
    const auto stated = PoseStatedBy(said_, owner);
    const std::string linked = LinkOf(owner, "hasPose");
    StatedPose pose{linked.empty() ? NameFor("pose", owner.instance) : linked, frame, X_FO};
    const bool is_same = stated && SameName(stated->frame, frame) &&
                         (stated->X_FO.translation - X_FO.translation).norm() <= position &&
                         stated->X_FO.rotation.angularDistance(X_FO.rotation) <= angle;
    if (!is_same) update_.added.push_back(PoseFluent(pose));
    if (linked.empty() && !is_new) Link(owner, "hasPose", "Pose", pose.instance);
    return pose.instance;
  }

  /// A box that is there already is left alone: only what is measured changes its size.
  std::string CompareBox(const Fluent& owner, const world::ObjectState& object,
                         const std::string& pose, bool is_new) {
    const std::string linked = LinkOf(owner, "hasBoundingBox");
    const Fluent* said = linked.empty() ? nullptr : said_.Find(linked);
    if (said != nullptr && !world::SaysUnknownBox(object.model)) return linked;
    const geometry::Aabb bounds = BoundsOf(*context_.world->ModelOf(object));
    const Eigen::Vector3d size = bounds.upper - bounds.lower;
    if (said != nullptr && SaysSize(*said, size)) return linked;
    Fluent box;
    box.concept_name = "BoundingBox";
    box.instance = linked.empty() ? NameFor("boundingBox", owner.instance) : linked;
    box.properties = {{"hasXSize", "xsd:float", size.x()},
                      {"hasYSize", "xsd:float", size.y()},
                      {"hasZSize", "xsd:float", size.z()},
                      {"hasPose", "Pose", pose}};
    update_.added.push_back(box);
    if (linked.empty() && !is_new) Link(owner, "hasBoundingBox", "BoundingBox", box.instance);
    return box.instance;
  }

  static bool SaysSize(const Fluent& box, const Eigen::Vector3d& size) {
    constexpr double kSame = 0.0005;  // [m] boxes are told to a millimetre
    const auto says = [&](const char* role, double edge) {
      const auto said = NumberOf(box, role);
      return said && std::abs(*said - edge) <= kSame;
    };
    return says("hasXSize", size.x()) && says("hasYSize", size.y()) && says("hasZSize", size.z());
  }

  void Link(const Fluent& owner, const std::string& role, const std::string& type,
            const std::string& instance) {
    for (Fluent& fluent : update_.updated) {
      if (SameName(fluent.instance, owner.instance)) {
        fluent.properties.push_back({role, type, instance});
        return;
      }
    }
    Fluent fluent;
    fluent.concept_name = owner.concept_name;
    fluent.instance = owner.instance;
    fluent.properties = {{role, type, instance}};
    update_.updated.push_back(fluent);
  }

  void ForgetPose(const std::string& object) {
    const auto stated = PoseStatedOf(said_, object);
    if (stated) update_.removed.push_back(stated->instance);
  }

  // ---- Temperatures.

  /// Nothing is said of an object that nobody knows, nor where the ontology knows no temperatures.
  void Warm(const std::string& object, double degrees) {
    if (!std::isfinite(degrees)) {
      throw base::ConfigError(fmt::format("object '{}': its temperature is not finite", object));
    }
    const Fluent* thing = ViewWith(&said_, &new_things_).Find(object);
    if (thing == nullptr || ontology_.Find("HasTemperature") == knowledge::Ontology::kUnknown) {
      return;
    }
    Fluent fluent;
    fluent.concept_name = "HasTemperature";
    fluent.instance = NameFor("hasTemperature", thing->instance);
    said_.OfConcept("HasTemperature", [&](const Fluent& said) {
      if (SameName(LinkOf(said, "hasPhysicalEntity"), object)) fluent = said;
      return true;
    });
    for (const knowledge::Property& property : fluent.properties) {
      const auto* said = std::get_if<double>(&property.filler);
      if (said != nullptr && std::abs(*said - degrees) <= params_.temperature) return;
    }
    fluent.start = Fluent().start;  // from when on is the assertion's to say
    fluent.finish = Fluent().finish;
    fluent.properties = {{"hasPhysicalEntity", thing->concept_name, thing->instance},
                         {"hasDegrees", "xsd:float", std::round(10.0 * degrees) / 10.0}};
    update_.added.push_back(fluent);
  }

  // ---- Symbols.

  bool IsSpokenOf(const std::string& object) const {
    return observed_.state.world.Find(object) != nullptr ||
           std::any_of(observed_.vanished.begin(), observed_.vanished.end(),
                       [&](const std::string& name) { return SameName(name, object); });
  }

  void CompareSymbols() {
    const std::vector<Atom> before =
        knowledge::StateAtoms(said_, ontology_, [](const std::string& predicate) {
          return IsObservable({predicate, {}});
        });
    const auto after = AtomsOf(context_, observed_.state, &before);
    const ViewWith base(&said_, &new_things_);
    knowledge::ProjectedView projected(&base, &ontology_);
    for (const Atom& atom : before) {
      const bool ends =
          atom.predicate == "RobotAt" || (atom.predicate == "On" && IsSpokenOf(atom.arguments[0]));
      if (ends && !Has(after, atom)) projected.Delete(atom);
    }
    for (const Atom& atom : after) {
      if (!Has(before, atom)) projected.Add(Spelled(atom));
    }
    for (const char* concept_name : {"RobotAt", "RobotPosture", "Holding", "On"}) {
      CollectChanges(projected, concept_name);
    }
  }

  /// Areas that the Blackboard does not know are called as the world's file calls them.
  Atom Spelled(Atom atom) const {
    for (std::string& argument : atom.arguments) {
      const auto spelled = context_.world->frame_names.find(argument);
      if (spelled != context_.world->frame_names.end()) argument = spelled->second;
    }
    return atom;
  }

  void CollectChanges(const knowledge::FluentView& projected, const std::string& concept_name) {
    for (const auto below : ontology_.Below(ontology_.Require(concept_name))) {
      projected.OfConcept(ontology_.Name(below), [&](const Fluent& fluent) {
        const Fluent* old = said_.Find(fluent.instance);
        if (old && old->concept_name == fluent.concept_name &&
            old->properties == fluent.properties) {
          return true;
        }
        Fluent added = fluent;
        added.start = Fluent().start;  // from when on is the assertion's to say
        added.finish = Fluent().finish;
        update_.added.push_back(added);
        return true;
      });
      said_.OfConcept(ontology_.Name(below), [&](const Fluent& fluent) {
        if (!projected.Find(fluent.instance)) update_.removed.push_back(fluent.instance);
        return true;
      });
    }
  }

  const TranslatorContext& context_;
  const knowledge::Ontology& ontology_;
  const knowledge::FluentView& said_;
  const ObservedWorld& observed_;
  const ChangeParams& params_;
  const Body body_;
  std::vector<Fluent> new_things_;
  FluentUpdate update_;
};

}  // namespace

ChangeParams ReadChangeParams(base::ParamReader in) {
  using base::Between;
  ChangeParams params;
  params.position = in.Get("position", Between(0.0, 1.0));
  params.angle = in.Get("angle", Between(0.0, 3.2));
  params.robot_position = in.Get("robot_position", Between(0.0, 5.0));
  params.robot_angle = in.Get("robot_angle", Between(0.0, 3.2));
  params.temperature = in.Get("temperature", Between(0.0, 100.0));
  return params;
}

void RefuseConcepts(const base::ParamReader& in) {
  if (in.Has("concepts")) {
    in.Fail("concepts",
            "which is said in the block of that name of the catalogue of objects "
            "(worlds/objects.yaml); move it there");
  }
}

FluentUpdate ChangesFrom(const TranslatorContext& context, const knowledge::FluentView& said,
                         const ObservedWorld& observed, const ChangeParams& params) {
  HIRES_CHECK(context.ontology, "fluents cannot be compared without an ontology");
  return Comparison(context, said, observed, params).Make();
}

}  // namespace hires::translation
