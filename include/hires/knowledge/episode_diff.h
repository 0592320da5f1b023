#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// What counts as the same when two episodes are compared.
struct EpisodeDiffOptions {
  std::map<std::string, double> tolerances;  ///< by role, in its unit: numbers may differ so much
  double tolerance{0.0};                     ///< of the roles not named
  double time_tolerance{0.0};                ///< [s] a change that is more off than this is late
  /// [rad] Roles whose numbers are angles: whole turns between them do not count.
  std::set<std::string> angles{"hasYaw", "hasRoll", "hasPitch"};
};

/// One change that an episode made.
struct EpisodeChange {
  Change::Kind kind{Change::Kind::kAdded};
  /// Which moment of the episode it was, from 1; changes of the same time share it.
  std::size_t moment{0};
  double time{0.0};  ///< [s] since the episode's start; -infinity: since ever
  Fluent fluent;
};

/// The fillers of a role where they are not the same, in their order; none: the role is not given.
struct PropertyDifference {
  std::string role;
  std::vector<Filler> a, b;
};

/// A change of one episode and what answers it in the other one. To begin to hold and to hold with
/// other content is one kind here (an imagined world knows nothing from before), to end is another.
struct ComparedChange {
  std::optional<EpisodeChange> a, b;  ///< at least one of them
  bool other_concept{false};
  std::vector<PropertyDifference> differences;
  double delay{0.0};         ///< [s] how much later in b; 0 if in one of them only
  bool late{false};          ///< |delay| is above the tolerance
  bool out_of_order{false};  ///< of the fewest that must be moved for the orders to agree

  bool InBoth() const { return a && b; }
  bool SameContent() const { return InBoth() && !other_concept && differences.empty(); }
};

/// What became of one instance.
struct InstanceDiff {
  enum class Verdict { kOnlyInA, kOnlyInB, kDiffering, kSame };
  std::string instance;
  Verdict verdict{Verdict::kSame};  ///< by content; times and order do not count
  std::vector<ComparedChange> changes;
};

/// "What was predicted, and what happened": two episodes side by side.
struct EpisodeDiff {
  Episode a, b;
  std::vector<InstanceDiff> instances;  ///< that either has changed; by name, case ignored

  std::size_t Count(InstanceDiff::Verdict verdict) const;
  std::size_t num_late() const;          ///< changes
  std::size_t num_out_of_order() const;  ///< changes
  bool Same() const;                     ///< content, times and order
};

/// Lines up the changes that the episodes made to each instance so that as few as possible differ;
/// of an instance with more than a million ways to pair two of its changes, the n-th with the n-th.
/// Text compares exactly, names of instances without regard to case; types of links do not count.
/// @throws ConfigError for a tolerance that is negative or no number.
EpisodeDiff Compare(const Store& store, const Episode& a, const Episode& b,
                    const EpisodeDiffOptions& options = {});
/// The same for changes at hand, in the order of their sequence numbers.
EpisodeDiff Compare(const Episode& a, const std::vector<Change>& changes_a, const Episode& b,
                    const std::vector<Change>& changes_b, const EpisodeDiffOptions& options = {});

}  // namespace hires::knowledge
