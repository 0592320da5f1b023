#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// One message of a demand topic: the fluents that match, either all of them (a snapshot) or those
/// that one transaction changed.
struct DemandUpdate {
  bool snapshot{false};
  std::uint64_t first_sequence{0};  ///< Blackboard sequence of the first change told here
  std::uint64_t last_sequence{0};   ///< ... of the last one looked at, told or not
  std::uint64_t previous{0};        ///< last_sequence of the topic's message before: a reader that
                                    ///< has another one missed something and asks `ChangesSince`
  std::vector<Change> changes;  ///< entered (kAdded), changed (kUpdated), left (kRemoved) the set
};

/// Keeps for one filter which fluents match now, and says what every transaction changes about it.
/// A fluent can enter or leave through a change of another one that it links to (SPARQL joins).
class Demand {
 public:
  /// @throws ConfigError naming topic and what is wrong with its filter.
  Demand(const DemandTopic& topic, std::shared_ptr<const Ontology> ontology);
  Demand(Demand&&) noexcept;
  Demand& operator=(Demand&&) noexcept;
  ~Demand();

  const std::string& name() const;
  DemandUpdate Snapshot(const Store& store);
  /// What `changes` (one transaction, already in the store, real world) mean for this topic. No
  /// changes in the answer: nothing to publish.
  DemandUpdate Apply(const std::vector<Change>& changes, const Store& store);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hires::knowledge
