#include "knowledge/state/state_view_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/state/live_view_match.h"

namespace hires::knowledge {
namespace {

using PartKind = AtomPart::Kind;
using Words = std::vector<std::string>;

AtomRule TypeRule(AtomPart type) {
  AtomRule rule{"Type", "PassiveObject", {type, {PartKind::kInstance}}};
  rule.except = "NoObject";
  return rule;
}

std::vector<AtomRule> MakeRules() {
  return {
      {"RobotAt", "RobotAt", {{PartKind::kFirst, "hasArea"}}, "robotAt", 0, "hasRobot", "Robot"},
      {"On",
       "On",
       {{PartKind::kFirst, "hasPhysicalEntity"}, {PartKind::kFirst, "hasArea"}},
       "on",
       1},
      {"Holding",
       "Holding",
       {{PartKind::kFirst, "hasArm"}, {PartKind::kFirst, "hasPassiveObject"}},
       "holding",
       1},
      {"HasArmPosture",
       "ArmPosture",
       {{PartKind::kFirst, "hasArm"}, {PartKind::kConcept}},
       "posture",
       1},
      {"HasTorsoPosture",
       "TorsoPosture",
       {{PartKind::kConcept}},
       "posture",
       0,
       "hasTorso",
       "Torso"},
      {"At",
       "At",
       {{PartKind::kFirst, "hasPhysicalEntity"}, {PartKind::kFirst, "hasArea"}},
       "at",
       1},
      {"HasTemperature",
       "HasTemperature",
       {{PartKind::kFirst, "hasPhysicalEntity"}, {PartKind::kFirst, "hasDegrees"}}},
      {"TemperatureKnown", "HasTemperature", {{PartKind::kFirst, "hasPhysicalEntity"}}},
      {"Connected",
       "Connected",
       {{PartKind::kFirst, "hasPlacingArea"},
        {PartKind::kFirst, "hasManipulationArea"},
        {PartKind::kFirst, "hasPreManipulationArea"}},
       "connected"},
      {"imagine", "ImagineWish", {{PartKind::kFirst, "hasAction"}}, "imagine"},
      {"observe", "ObserveWish", {{PartKind::kFirst, "hasAction"}}, "observe"},
      {"imagined_failure",
       "ImaginedFailure",
       {{PartKind::kFirst, "hasAction"}, {PartKind::kRest, "hasArgument"}},
       "imaginedFailure"},
      TypeRule({PartKind::kConceptAndAbove}),
      TypeRule({PartKind::kContent, "hasContent"}),
      {"hasPlacingArea",
       "Furniture",
       {{PartKind::kInstance}, {PartKind::kRanked, "hasPlacingArea"}}},
      {"hasPlacingAreaLeft",
       "SittingArea",
       {{PartKind::kInstance}, {PartKind::kEach, "hasPlacingAreaLeft"}}},
      {"hasPlacingAreaRight",
       "SittingArea",
       {{PartKind::kInstance}, {PartKind::kEach, "hasPlacingAreaRight"}}},
  };
}

bool IsBelow(const std::string& concept_name, std::string_view above, const Ontology& ontology) {
  const Ontology::ConceptId id = ontology.Find(concept_name);
  const Ontology::ConceptId limit = ontology.Find(above);
  return id != Ontology::kUnknown && limit != Ontology::kUnknown && ontology.IsA(id, limit);
}

std::string TextOf(const Filler& filler) {
  if (const auto* text = std::get_if<std::string>(&filler)) return base::ToLower(*text);
  if (const auto* number = std::get_if<double>(&filler)) return fmt::format("{}", *number);
  if (const auto* integer = std::get_if<std::int64_t>(&filler)) return fmt::format("{}", *integer);
  return std::get<bool>(filler) ? "true" : "false";
}

Words ConceptsUpTo(const std::string& limit, const Fluent& fluent, const Ontology& ontology) {
  Words names;
  for (const Ontology::ConceptId id : ontology.Above(ontology.Require(fluent.concept_name))) {
    if (IsBelow(ontology.Name(id), limit, ontology))
      names.push_back(base::ToLower(ontology.Name(id)));
  }
  return names;
}

/// Where the view does not know the content, the type of the link says what it is.
std::string ContentOf(const Property& link, const FluentView& view) {
  const auto* name = std::get_if<std::string>(&link.filler);
  const Fluent* content = name == nullptr ? nullptr : view.Find(*name);
  return base::ToLower(content == nullptr ? link.type : content->concept_name);
}

std::vector<const Property*> OfRole(const Fluent& fluent, std::string_view role) {
  std::vector<const Property*> found;
  for (const Property& property : fluent.properties) {
    if (property.role == role) found.push_back(&property);
  }
  return found;
}

/// The ways to fill a part, each one or several arguments. None: the fluent says nothing.
class Expansion {
 public:
  Expansion(const AtomRule& rule, const Fluent& fluent, const FluentView& view,
            const Ontology& ontology)
      : rule_(rule), fluent_(fluent), view_(view), ontology_(ontology) {}

  std::vector<Words> Of(const AtomPart& part) const {
    switch (part.kind) {
      case PartKind::kInstance:
        return {{base::ToLower(fluent_.instance)}};
      case PartKind::kConcept:
        return {{base::ToLower(fluent_.concept_name)}};
      case PartKind::kConceptAndAbove:
        return Above();
      case PartKind::kRest:
        return {Rest(part.role)};
      case PartKind::kFirst:
      case PartKind::kEach:
      case PartKind::kRanked:
      case PartKind::kContent:
        break;
    }
    return OfFillers(part);
  }

 private:
  std::vector<Words> Above() const {
    std::vector<Words> ways;
    for (std::string& name : ConceptsUpTo(std::string(rule_.concept_name), fluent_, ontology_)) {
      ways.push_back({std::move(name)});
    }
    return ways;
  }

  Words Rest(std::string_view role) const {
    Words words;
    for (const Property* property : OfRole(fluent_, role))
      words.push_back(TextOf(property->filler));
    return words;
  }

  std::vector<Words> OfFillers(const AtomPart& part) const {
    std::vector<Words> ways;
    for (const Property* property : OfRole(fluent_, part.role)) {
      const bool is_content = part.kind == PartKind::kContent;
      ways.push_back({is_content ? ContentOf(*property, view_) : TextOf(property->filler)});
      if (part.kind == PartKind::kRanked) ways.back().push_back(fmt::format("{}", ways.size()));
      if (part.kind == PartKind::kFirst) break;
    }
    return ways;
  }

  const AtomRule& rule_;
  const Fluent& fluent_;
  const FluentView& view_;
  const Ontology& ontology_;
};

/// Every atom with one of the ways behind it.
std::vector<base::Atom> Continued(const std::vector<base::Atom>& atoms,
                                  const std::vector<Words>& ways) {
  std::vector<base::Atom> continued;
  for (const base::Atom& atom : atoms) {
    for (const Words& words : ways) {
      continued.push_back(atom);
      Words& arguments = continued.back().arguments;
      arguments.insert(arguments.end(), words.begin(), words.end());
    }
  }
  return continued;
}

/// Fills `role` with these and nothing else, where it stood.
void Fill(const std::string& role, std::vector<Property> fillers, Fluent* fluent) {
  std::vector<Property>& all = fluent->properties;
  const auto is_role = [&](const Property& property) { return property.role == role; };
  const auto place = std::find_if(all.begin(), all.end(), is_role) - all.begin();
  all.erase(std::remove_if(all.begin(), all.end(), is_role), all.end());
  all.insert(all.begin() + place, std::make_move_iterator(fillers.begin()),
             std::make_move_iterator(fillers.end()));
}

/// A link is spelled and typed as the instance that it leads to, if that is known.
Property MakeProperty(std::string_view role, const std::string& argument, const FluentView& view,
                      const Ontology& ontology) {
  const Ontology::Relation* relation = ontology.FindRelation(role);
  if (relation == nullptr) {
    throw base::ConfigError(
        base::UnknownName("relation", std::string(role), ontology.RelationNames()));
  }
  Property property{relation->name, relation->range, argument};
  const Fluent* linked = property.IsLink() ? view.Find(argument) : nullptr;
  if (linked != nullptr) property = {relation->name, linked->concept_name, linked->instance};
  return property;
}

std::string ConceptFor(const AtomRule& rule, const std::string& argument,
                       const Ontology& ontology) {
  std::vector<std::string> known;
  for (const Ontology::ConceptId id : ontology.Below(ontology.Require(rule.concept_name))) {
    known.push_back(ontology.Name(id));
    if (SameName(known.back(), argument)) return known.back();
  }
  throw base::ConfigError(
      base::UnknownName(fmt::format("{}: {}", rule.predicate, rule.concept_name), argument, known));
}

/// Of the single parts; `kRest` takes any number more.
std::size_t NumArguments(const AtomRule& rule) {
  std::size_t count = 0;
  for (const AtomPart& part : rule.parts) {
    if (part.kind != PartKind::kRest) count += part.kind == PartKind::kRanked ? 2 : 1;
  }
  return count;
}

bool TakesMore(const AtomRule& rule) { return rule.parts.back().kind == PartKind::kRest; }

}  // namespace

const std::vector<AtomRule>& AtomRules() {
  static const std::vector<AtomRule> rules = MakeRules();
  return rules;
}

std::vector<const AtomRule*> RulesOf(std::string_view predicate) {
  std::vector<const AtomRule*> found;
  for (const AtomRule& rule : AtomRules()) {
    if (SameName(rule.predicate, predicate)) found.push_back(&rule);
  }
  return found;
}

bool Covers(const AtomRule& rule, const Fluent& fluent, const Ontology& ontology) {
  return IsBelow(fluent.concept_name, rule.concept_name, ontology) &&
         !(!rule.except.empty() && IsBelow(fluent.concept_name, rule.except, ontology));
}

std::vector<base::Atom> AtomsOf(const AtomRule& rule, const Fluent& fluent, const FluentView& view,
                                const Ontology& ontology) {
  const Expansion expansion(rule, fluent, view, ontology);
  std::vector<base::Atom> atoms = {{std::string(rule.predicate), {}}};
  for (const AtomPart& part : rule.parts) atoms = Continued(atoms, expansion.Of(part));
  return atoms;
}

void CheckArguments(const AtomRule& rule, const base::Atom& atom) {
  const std::size_t wanted = NumArguments(rule), came = atom.arguments.size();
  if (came == wanted || (came > wanted && TakesMore(rule))) return;
  throw base::ConfigError(fmt::format("{}: has {} arguments, {} takes {}{}", base::ToString(atom),
                                      came, rule.predicate, wanted,
                                      TakesMore(rule) ? " or more" : ""));
}

void Say(const AtomRule& rule, const base::Atom& atom, const FluentView& view,
         const Ontology& ontology, Fluent* fluent) {
  HIRES_CHECK(!rule.word.empty(), "this predicate has no way back from atoms to fluents");
  auto argument = atom.arguments.begin();
  for (const AtomPart& part : rule.parts) {
    if (part.kind == PartKind::kConcept) {
      fluent->concept_name = ConceptFor(rule, *argument++, ontology);
      continue;
    }
    const auto end = part.kind == PartKind::kRest ? atom.arguments.end() : argument + 1;
    std::vector<Property> fillers;
    for (; argument != end; ++argument) {
      fillers.push_back(MakeProperty(part.role, *argument, view, ontology));
    }
    Fill(std::string(part.role), std::move(fillers), fluent);
  }
}

}  // namespace hires::knowledge
