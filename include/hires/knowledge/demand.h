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
  /// ... of the last one looked at, told or not. A snapshot has that of the message before it, if
  /// nothing was told since: a program that starts with it goes on with the next message as all
  /// others.
  std::uint64_t last_sequence{0};
  std::uint64_t previous{0};  ///< last_sequence of the topic's message before: a reader that
                              ///< has another one missed something and asks `ChangesSince`
  /// Entered (kAdded), changed (kUpdated), left (kRemoved) the set, in the order of the changes
  /// that made them do so (their sequence). In a snapshot: kAdded, by name, sequence 0.
  std::vector<Change> changes;
};

/// Keeps for one filter which fluents match now, and says what every transaction changes about it.
/// A fluent can enter or leave through a change of another one that it links to (SPARQL joins).
///
/// A fluent matches if it passes the concept and property filters (where any is given), or if one
/// of the queries selects it (where any is given) by its first variable. It passes if its concept
/// fits any of the concept filters (or there is none), and its properties fit the property filter:
/// each of them with `all_properties`, else one of them (or there is none).
class Demand {
 public:
  /// @throws ConfigError naming topic and what is wrong with its filter: none at all, a concept or
  ///   relation that is unknown (nearest names), a text that is no query, or a query that selects
  ///   no instances.
  Demand(const DemandTopic& topic, std::shared_ptr<const Ontology> ontology);
  Demand(Demand&&) noexcept;
  Demand& operator=(Demand&&) noexcept;
  ~Demand();

  const std::string& name() const;
  /// All that match now. Changes that the store holds by then are done with: `Apply` passes over
  /// them. Ask once before the first `Apply`.
  /// @throws ConfigError where a query needs a million rows or more; so does `Apply`, which leaves
  ///   the topic as it was: ask for a snapshot then.
  DemandUpdate Snapshot(const Store& store);
  /// What `changes` (one transaction, already in the store, real world) mean for this topic. No
  /// changes in the answer: nothing to publish. Imagined changes are passed over.
  /// Where no query joins fluents, every change is told that a matching fluent has; with joins,
  /// each fluent once for the transaction, as it is after it. The store should stand right behind
  /// the changes: one that is ahead tells early that fluents entered or left through others.
  /// @pre Snapshot was asked for.  @throws std::logic_error if broken.
  DemandUpdate Apply(const std::vector<Change>& changes, const Store& store);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hires::knowledge
