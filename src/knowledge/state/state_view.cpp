#include "hires/knowledge/state_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <tuple>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/state/live_view_match.h"
#include "knowledge/state/state_view_rules.h"

namespace hires::knowledge {
namespace {

using Visit = std::function<bool(const Fluent&)>;
using Fluents = std::vector<const Fluent*>;

bool AtomLess(const base::Atom& a, const base::Atom& b) {
  return std::tie(a.predicate, a.arguments) < std::tie(b.predicate, b.arguments);
}

bool SameAtom(const base::Atom& a, const base::Atom& b) {
  return std::tie(a.predicate, a.arguments) == std::tie(b.predicate, b.arguments);
}

bool NameBefore(const Fluent& fluent, const std::string& instance) {
  return NameLess(fluent.instance, instance);
}

/// The first `count` arguments are the same, or all if there are no more.
bool AgreesIn(std::size_t count, const base::Atom& said, const base::Atom& atom) {
  const std::size_t compared = std::min(count, atom.arguments.size());
  if (count == AtomRule::kAll && said.arguments.size() != compared) return false;
  return said.arguments.size() >= compared &&
         std::equal(said.arguments.begin(),
                    said.arguments.begin() + static_cast<std::ptrdiff_t>(compared),
                    atom.arguments.begin(), SameName);
}

/// Fluents that a rule may find the atom's first arguments in.
void VisitCandidates(const AtomRule& rule, std::size_t count, const base::Atom& atom,
                     const FluentView& view, const Ontology& ontology, const Visit& visit) {
  const AtomPart& first = rule.parts.front();
  if (count > 0 && first.kind == AtomPart::Kind::kFirst && !atom.arguments.empty()) {
    return view.WithFiller(std::string(first.role), atom.arguments.front(), visit);
  }
  const Ontology::ConceptId id = ontology.Find(rule.concept_name);
  if (id == Ontology::kUnknown) return;
  for (const Ontology::ConceptId below : ontology.Below(id)) {
    view.OfConcept(ontology.Name(below), visit);
  }
}

/// Fluents of the view that say an atom which agrees in the first `count` arguments.
Fluents Saying(const AtomRule& rule, std::size_t count, const base::Atom& atom,
               const FluentView& view, const Ontology& ontology) {
  Fluents found;
  VisitCandidates(rule, count, atom, view, ontology, [&](const Fluent& fluent) {
    if (!Covers(rule, fluent, ontology)) return true;
    const auto said = AtomsOf(rule, fluent, view, ontology);
    const bool agrees = std::any_of(said.begin(), said.end(), [&](const base::Atom& one) {
      return AgreesIn(count, one, atom);
    });
    if (agrees) found.push_back(&fluent);
    return true;
  });
  return found;
}

/// "place_object" and "mug1" as they stand within an instance's name: PlaceObject, Mug1.
std::string Capitalised(const std::string& name) {
  std::string text;
  for (const std::string& word : base::Split(name, '_')) {
    text += word;
    if (word.empty()) continue;
    char& first = text[text.size() - word.size()];
    first = static_cast<char>(std::toupper(static_cast<unsigned char>(first)));
  }
  return text;
}

const Fluent* FirstOf(std::string_view concept_name, const FluentView& view,
                      const Ontology& ontology) {
  const Fluent* first = nullptr;
  const Ontology::ConceptId id = ontology.Find(concept_name);
  if (id == Ontology::kUnknown) return nullptr;
  for (const Ontology::ConceptId below : ontology.Below(id)) {
    view.OfConcept(ontology.Name(below), [&](const Fluent& fluent) {
      if (first == nullptr || NameBefore(fluent, first->instance)) first = &fluent;
      return false;
    });
  }
  return first;
}

/// Named after the rule's word and its thing; with a number behind where another holds that name.
std::string NewInstance(const std::string& start, const FluentView& view) {
  std::string name = start;
  for (int number = 2; view.Find(name) != nullptr; ++number) {
    name = fmt::format("{}_{}", start, number);
  }
  return name;
}

/// A fluent that says nothing yet, for an atom of a rule.
Fluent NewFluent(const AtomRule& rule, const base::Atom& atom, const FluentView& view,
                 const Ontology& ontology) {
  Fluent fluent;
  fluent.concept_name = std::string(rule.concept_name);
  std::string thing = atom.arguments.empty() ? "" : atom.arguments.front();
  if (!rule.owner_role.empty()) {
    const Fluent* owner = FirstOf(rule.owner_concept, view, ontology);
    thing = owner == nullptr ? std::string(rule.owner_concept) : owner->instance;
    if (owner != nullptr) {
      fluent.properties.push_back(
          {std::string(rule.owner_role), owner->concept_name, owner->instance});
    }
  } else if (const Fluent* known = view.Find(thing)) {
    thing = known->instance;  // as it is spelled
  }
  fluent.instance = NewInstance(std::string(rule.word) + Capitalised(thing), view);
  return fluent;
}

std::string Changeable() {
  std::vector<std::string> names;
  for (const AtomRule& rule : AtomRules()) {
    if (!rule.word.empty()) names.emplace_back(rule.predicate);
  }
  return base::Join(names, ", ");
}

[[noreturn]] void FailFixed(const base::Atom& atom) {
  throw base::ConfigError(
      fmt::format("{}: follows from what is known, which effects cannot change; they may change {}",
                  base::ToString(atom), Changeable()));
}

std::vector<const AtomRule*> RequireRules(const base::Atom& atom) {
  std::vector<const AtomRule*> rules = RulesOf(atom.predicate);
  if (!rules.empty()) return rules;
  std::vector<std::string> known;
  for (const AtomRule& rule : AtomRules()) known.emplace_back(rule.predicate);
  throw base::ConfigError(base::ToString(atom) + ": " +
                          base::UnknownName("predicate", atom.predicate, known));
}

}  // namespace

std::vector<base::Atom> StateAtoms(const FluentView& view, const Ontology& ontology) {
  return StateAtoms(view, ontology, [](const std::string&) { return true; });
}

std::vector<base::Atom> StateAtoms(const FluentView& view, const Ontology& ontology,
                                   const std::function<bool(const std::string&)>& is_wanted) {
  std::vector<base::Atom> atoms;
  for (const AtomRule& rule : AtomRules()) {
    if (!is_wanted(std::string(rule.predicate))) continue;
    const Ontology::ConceptId id = ontology.Find(rule.concept_name);
    if (id == Ontology::kUnknown) continue;
    for (const Ontology::ConceptId below : ontology.Below(id)) {
      view.OfConcept(ontology.Name(below), [&](const Fluent& fluent) {
        if (!Covers(rule, fluent, ontology)) return true;
        for (base::Atom& atom : AtomsOf(rule, fluent, view, ontology)) {
          atoms.push_back(std::move(atom));
        }
        return true;
      });
    }
  }
  std::sort(atoms.begin(), atoms.end(), AtomLess);
  atoms.erase(std::unique(atoms.begin(), atoms.end(), SameAtom), atoms.end());
  return atoms;
}

ProjectedView::ProjectedView(const FluentView* below, const Ontology* ontology)
    : below_(below), ontology_(ontology) {}

void ProjectedView::Delete(const base::Atom& atom) {
  for (const AtomRule* rule : RulesOf(atom.predicate)) {
    std::vector<std::string> gone;
    for (const Fluent* fluent : Saying(*rule, AtomRule::kAll, atom, *this, *ontology_)) {
      if (rule->word.empty()) FailFixed(atom);
      gone.push_back(fluent->instance);
    }
    for (const std::string& instance : gone) Hide(instance);
  }
}

void ProjectedView::Add(const base::Atom& atom) {
  const std::vector<const AtomRule*> rules = RequireRules(atom);
  const AtomRule& rule = *rules.front();
  CheckArguments(rule, atom);
  if (rule.word.empty()) {
    for (const AtomRule* other : rules) {
      if (!Saying(*other, AtomRule::kAll, atom, *this, *ontology_).empty()) return;
    }
    FailFixed(atom);
  }
  // The fluent that holds the old value; else the one that held it before it was deleted.
  const Fluents old = Saying(rule, rule.num_keys, atom, *this, *ontology_);
  const Fluents before = Saying(rule, rule.num_keys, atom, *below_, *ontology_);
  const bool revives = old.empty() && !before.empty() && FindAdded(before[0]->instance) == nullptr;
  Fluent fluent = !old.empty() ? *old[0]
                  : revives    ? *before[0]
                               : NewFluent(rule, atom, *this, *ontology_);
  Say(rule, atom, *this, *ontology_, &fluent);
  std::vector<std::string> gone;
  for (const Fluent* one : old) gone.push_back(one->instance);
  for (const std::string& instance : gone) Hide(instance);
  Put(std::move(fluent));
}

const Fluent* ProjectedView::Find(const std::string& instance) const {
  const Fluent* added = FindAdded(instance);
  if (added != nullptr) return added;
  return IsHidden(instance) ? nullptr : below_->Find(instance);
}

void ProjectedView::OfConcept(const std::string& concept_name, const Visit& visit) const {
  Merge([&](const Visit& each) { below_->OfConcept(concept_name, each); },
        [&](const Fluent& fluent) { return fluent.concept_name == concept_name; }, visit);
}

void ProjectedView::All(const Visit& visit) const {
  Merge([&](const Visit& each) { below_->All(each); }, [](const Fluent&) { return true; }, visit);
}

void ProjectedView::WithFiller(const std::string& role, const Filler& filler,
                               const Visit& visit) const {
  const auto fits = [&](const Fluent& fluent) {
    return std::any_of(fluent.properties.begin(), fluent.properties.end(),
                       [&](const Property& property) {
                         return property.role == role && SameFiller(property.filler, filler);
                       });
  };
  Merge([&](const Visit& each) { below_->WithFiller(role, filler, each); }, fits, visit);
}

const Fluent* ProjectedView::FindAdded(const std::string& instance) const {
  const auto place = std::lower_bound(added_.begin(), added_.end(), instance, NameBefore);
  return place != added_.end() && SameName(place->instance, instance) ? &*place : nullptr;
}

bool ProjectedView::IsHidden(const std::string& instance) const {
  return std::binary_search(hidden_.begin(), hidden_.end(), instance, NameLess);
}

/// Whether the view below has it or not: it may come to have it.
void ProjectedView::Hide(const std::string& instance) {
  const auto added = std::lower_bound(added_.begin(), added_.end(), instance, NameBefore);
  if (added != added_.end() && SameName(added->instance, instance)) added_.erase(added);
  const auto hidden = std::lower_bound(hidden_.begin(), hidden_.end(), instance, NameLess);
  if (hidden == hidden_.end() || !SameName(*hidden, instance)) hidden_.insert(hidden, instance);
}

void ProjectedView::Put(Fluent fluent) {
  Hide(fluent.instance);
  const auto place = std::lower_bound(added_.begin(), added_.end(), fluent.instance, NameBefore);
  added_.insert(place, std::move(fluent));
}

void ProjectedView::Merge(const std::function<void(const Visit&)>& below,
                          const std::function<bool(const Fluent&)>& fits,
                          const Visit& visit) const {
  auto added = added_.begin();
  bool going = true;
  const auto visit_added_before = [&](const std::string* instance) {
    for (; going && added != added_.end(); ++added) {
      if (instance != nullptr && !NameBefore(*added, *instance)) return;
      if (fits(*added)) going = visit(*added);
    }
  };
  below([&](const Fluent& fluent) {
    if (IsHidden(fluent.instance)) return true;
    visit_added_before(&fluent.instance);
    if (going) going = visit(fluent);
    return going;
  });
  visit_added_before(nullptr);
}

}  // namespace hires::knowledge
