#include "hires/knowledge/loading.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "hires/base/error.h"
#include "hires/base/faults.h"
#include "hires/base/radians.h"
#include "hires/base/text.h"
#include "knowledge/fluents/store_check.h"

namespace hires::knowledge {
namespace {

void AddFromStore(const std::string& instance, const Store& store, std::set<std::string>* present,
                  std::vector<Fluent>* fluents) {
  if (!present->insert(base::ToLower(instance)).second) return;
  if (std::optional<Fluent> fluent = store.Find(instance)) fluents->push_back(std::move(*fluent));
}

std::vector<Fluent> FluentsToLoad(const KnowledgeFile& file, base::Rng rng, const Store& store) {
  std::vector<Fluent> fluents = file.fluents;
  std::set<std::string> present;
  for (const Fluent& fluent : fluents) present.insert(base::ToLower(fluent.instance));
  for (const PoseModification& modification : file.modifications) {
    AddFromStore(modification.instance, store, &present, &fluents);
    for (const std::string& attached : modification.attachments) {
      AddFromStore(attached, store, &present, &fluents);
    }
  }
  ApplyModifications(file.modifications, rng, &fluents);
  return fluents;
}

/// Roles of angles, which people who think in degrees give as such.
bool IsAngle(const std::string& role) {
  return role == "hasYaw" || role == "hasPitch" || role == "hasRoll";
}

void CheckAngles(const Fluent& fluent) {
  for (const Property& property : fluent.properties) {
    if (!IsAngle(property.role)) continue;
    const auto* real = std::get_if<double>(&property.filler);
    const auto* whole = std::get_if<std::int64_t>(&property.filler);
    const double angle = real ? *real : whole ? static_cast<double>(*whole) : 0.0;
    const std::optional<std::string> why = base::WhyNoRadians(angle);
    if (!why) continue;
    throw base::ConfigError(fmt::format("fluent '{}' of {}, property '{}': {}", fluent.instance,
                                        fluent.concept_name, property.role, *why));
  }
}

/// The concepts that the file gives an instance, by its name in lower case.
using ConceptsOf = std::multimap<std::string, std::string>;

ConceptsOf ConceptsIn(const KnowledgeFile& file) {
  ConceptsOf concepts;
  for (const Fluent& fluent : file.fluents) {
    concepts.emplace(base::ToLower(fluent.instance), fluent.concept_name);
  }
  return concepts;
}

/// What is linked to as a Pose and is a Mug a few lines further on was mistaken for its pose.
void CheckLinks(const Fluent& fluent, const ConceptsOf& concepts, const Ontology& ontology) {
  for (const Property& property : fluent.properties) {
    const auto* target = std::get_if<std::string>(&property.filler);
    if (target == nullptr || !property.IsLink()) continue;
    const auto [first, last] = concepts.equal_range(base::ToLower(*target));
    const Ontology::ConceptId type = ontology.Find(property.type);
    const bool is_other = std::none_of(first, last, [&](const auto& entry) {
      const Ontology::ConceptId own = ontology.Find(entry.second);
      return own == Ontology::kUnknown || ontology.IsA(own, type) || ontology.IsA(type, own);
    });
    if (first == last || !is_other) continue;
    throw base::ConfigError(fmt::format(
        "fluent '{}' of {}, property '{}': links to '{}' as a {}, and this file says that it is "
        "a {}; correct one of them",
        fluent.instance, fluent.concept_name, property.role, *target, property.type,
        first->second));
  }
}

/// Tells of all fluents that cannot be, each with its place in the file.
void CheckFluents(const KnowledgeFile& file, const Ontology& ontology) {
  const ConceptsOf concepts = ConceptsIn(file);
  base::Faults faults;
  for (std::size_t i = 0; i < file.fluents.size(); ++i) {
    try {
      CheckFluent(file.fluents[i], ontology);
      CheckAngles(file.fluents[i]);
      CheckLinks(file.fluents[i], concepts, ontology);
    } catch (const base::ConfigError& error) {
      const std::string place = i < file.places.size() ? file.places[i] + ": " : "";
      faults.Add((file.source.empty() ? "" : file.source + ": ") + place + error.what());
    }
  }
  faults.Require();
}

LoadSummary Summarize(const KnowledgeFile& file, std::size_t num_fluents,
                      const std::vector<Change>& changes) {
  LoadSummary summary;
  for (const Change& change : changes) ++summary.concepts[change.fluent.concept_name];
  summary.known = num_fluents - changes.size();
  summary.modifications = file.modifications.size();
  for (const DemandTopic& topic : file.topics) summary.topics.push_back(topic.name);
  return summary;
}

}  // namespace

LoadSummary Load(const KnowledgeFile& file, base::Rng rng, const Assertion& by, Store* store,
                 std::vector<Change>* changes) {
  try {
    CheckFluents(file, store->ontology());
    const std::vector<Fluent> fluents = FluentsToLoad(file, rng, *store);
    std::vector<Change> made = store->Add(fluents, by);
    const LoadSummary summary = Summarize(file, fluents.size(), made);
    if (changes != nullptr) *changes = std::move(made);
    return summary;
  } catch (const base::ConfigError& error) {
    const std::string what = error.what();
    if (what.rfind(file.source, 0) == 0) throw;  // it says itself where, or there is no file
    throw base::ConfigError(file.source + ": " + what);
  }
}

}  // namespace hires::knowledge
