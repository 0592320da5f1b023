#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"
#include "hires/knowledge/query.h"

namespace hires::knowledge {

enum class Durability {
  kProcess,  ///< survives the death of the process: handed to the operating system on every commit
  kPower,    ///< survives the loss of power: flushed to the disk on every commit
};

struct StoreOptions {
  Durability durability{Durability::kProcess};
  bool read_only{false};
  std::size_t cache_bytes{64u << 20};  ///< of SQLite's page cache
  std::uint64_t max_bytes{0};  ///< what the file may grow to; a write beyond fails. 0: no bound
};

/// A write: what, and who says it, in which episode, from when on.
struct Assertion {
  Source source{Source::kObservation};
  std::int64_t episode{0};
  /// [s] What a fluent without a start (that is, one "since ever") begins at, and what ends the old
  /// validity. -infinity, when knowledge is loaded, leaves "since ever" as it is.
  double time{0.0};
};

/// Everything that was ever said, in one SQLite file. An instance has one validity at a time:
/// adding or updating it ends the old one and opens the new one, so the state of any time can be
/// asked for. Imagined worlds (episodes labelled so) have their own validity of each instance. One
/// object writes; any number of others may read the same file at the same time. Every call is one
/// transaction: all of it or nothing, and what returned is as durable as the options say. An object
/// belongs to one thread at a time; other threads take an object of their own.
///
/// Instance names compare without regard to case (of ASCII letters) and are given back as they were
/// spelled first. A new validity ends the old one at the time of the assertion, or at its own start
/// where that is earlier; one that had run out by its own bounds keeps them. What was said once
/// again (concept, properties in their order, finish; the start does not count) changes nothing.
class Store {
 public:
  /// Opens or makes the file (":memory:" keeps nothing). Migrates older schemas.
  /// @throws ConfigError naming the path: not a store, newer schema, read-only folder, damaged
  /// file.
  Store(const std::string& path, std::shared_ptr<const Ontology> ontology,
        StoreOptions options = {});
  Store(Store&&) noexcept;
  ~Store();

  /// Says that these fluents hold. An instance that holds already with another content is updated.
  /// @return one change for each fluent that changed something, in order.
  /// @throws ConfigError, and nothing is written: unknown concept or relation (nearest names),
  /// wrong
  ///   filler type, impossible times (ends before it begins; earlier than what holds now began), a
  ///   source that may not say this, unknown or finished episode, disk full, a value over 1 MB,
  ///   more than 1000 properties, a name over 1000 bytes or with control characters.
  std::vector<Change> Add(const std::vector<Fluent>& fluents, const Assertion& by);
  /// As Add, but an instance that does not hold is an error, and properties that are not given
  /// stay. A role that is given replaces all its old fillers.
  std::vector<Change> Update(const std::vector<Fluent>& fluents, const Assertion& by);
  /// Ends the validity of these instances. One that does not hold is an error.
  std::vector<Change> Remove(const std::vector<std::string>& instances, const Assertion& by);

  /// Pages of one query show the store as it was at the first of them, whatever is written between.
  /// @throws ConfigError for an unknown concept or relation, bad times, or a cursor of no page.
  FluentPage Query(const FluentQuery& query) const;
  std::optional<Fluent> Find(const std::string& instance) const;  ///< as it holds now, really
  /// Changes after `sequence`, oldest first, at most `limit`.
  std::vector<Change> ChangesSince(std::uint64_t sequence, std::size_t limit) const;
  std::uint64_t last_sequence() const;

  Episode StartEpisode(const std::string& task, Episode::Label label, std::int64_t parent,
                       double time);
  Episode FinishEpisode(std::int64_t id, const std::string& outcome, double time);
  std::vector<Episode> Episodes() const;  ///< by id
  std::optional<Episode> FindEpisode(const std::string& id_or_name) const;

  struct Statistics {
    std::uint64_t fluents{0};  ///< validities, ended ones included
    std::uint64_t instances{0};
    std::uint64_t changes{0};
    std::uint64_t episodes{0};
    std::uint64_t bytes{0};  ///< of the files
    int schema{0};
  };
  Statistics Stats() const;
  const Ontology& ontology() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hires::knowledge
