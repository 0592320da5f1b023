#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hires/base/rng.h"
#include "hires/knowledge/fluent.h"

namespace hires::knowledge {

/// A change of poses, as the original's scenarios draw it: `!FluentPoseModification`.
struct PoseModification {
  struct Delta {
    std::string property;         ///< hasX, hasY, hasZ, hasYaw
    std::vector<double> choices;  ///< [m] or [rad], added; one per choice
  };
  std::string instance;  ///< of a pose
  std::string group;     ///< all of a group take the same choice
  int choices{1};
  std::vector<Delta> modifications;
  std::vector<std::string> attachments;  ///< poses that get the same deltas, and so do theirs
};

/// A wish for a topic: `!DemandTopic`.
struct DemandTopic {
  std::string name;                              ///< below blackboard/
  std::vector<std::string> exact, below, above;  ///< ClassFilter, SubclassFilter, SuperclassFilter
  std::vector<std::string> properties;           ///< PropertyFilter
  bool all_properties{false};                    ///< PropertyFilterMode: intersection, else union
  std::vector<std::string> queries;              ///< QueryFilter, SPARQL
};

/// What a YAML stream of the original's format holds, in its order.
struct KnowledgeFile {
  std::vector<Fluent> fluents;
  std::vector<PoseModification> modifications;
  std::vector<DemandTopic> topics;
};

/// @throws ConfigError naming source, document, line and key: unknown tag or key, wrong shape or
///   type, a modification with another number of deltas than its choices (naming instance and
///   axis), cyclic attachments, a name that YAML 1.1 reads as a truth value (On must be quoted),
///   more than 64 MB or aliases that unfold beyond that.
KnowledgeFile ReadKnowledge(std::string_view text, const std::string& source);
KnowledgeFile LoadKnowledge(const std::string& path);

/// The same YAML for the same fluents; what ReadKnowledge reads back is equal.
std::string WriteFluents(const std::vector<Fluent>& fluents);

/// Applies modifications to the poses among `fluents`; each group draws one choice.
/// @throws ConfigError where an instance is missing or no pose.
void ApplyModifications(const std::vector<PoseModification>& modifications, base::Rng rng,
                        std::vector<Fluent>* fluents);

}  // namespace hires::knowledge
