#include "hires/knowledge/loading.h"

#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"

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
