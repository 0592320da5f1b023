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
  std::string source{};  ///< the file, for messages; empty: none
};

/// Times are finite seconds, or .inf and -.inf; [0, 0] is -infinity in StartTime, infinity in
/// FinishTime, and the moment 0 itself is [-0.0, -0.0]. Documents without content are passed over.
/// Concepts and relations are not looked up: the store does that.
/// @throws ConfigError naming source, document, line and key: unknown tag or key, wrong shape or
///   type, a modification with another number of deltas than its choices (naming instance and
///   axis), cyclic attachments, a name or text that YAML 1.1 reads as a truth value, number or null
///   (On must be quoted), more than 64 MB, 1 MB in a value, 100,000 values or 1,000,000 characters
///   of punctuation in a document, 100 levels, aliases that unfold to 1,000,000 values or 64 MB.
KnowledgeFile ReadKnowledge(std::string_view text, const std::string& source);
KnowledgeFile LoadKnowledge(const std::string& path);

/// The same YAML for the same fluents; what ReadKnowledge reads back is equal (but an integer given
/// as xsd:float comes back as a double).
/// @pre no NaN, fillers finite, text is UTF-8: what the store keeps, meets that.
/// @throws std::logic_error if broken.
std::string WriteFluents(const std::vector<Fluent>& fluents);
/// Likewise for all of it: fluents, then modifications, then topics.
std::string WriteKnowledge(const KnowledgeFile& file);

/// Applies modifications to the poses among `fluents`, all or none. Each group draws one choice, in
/// the order in which groups first appear. What is attached moves along, and so does what is
/// attached to that; each once for a modification, even where two ways lead to it. A pose that has
/// several validities is moved in all of them. Instance names compare without regard to the case of
/// ASCII letters, as in the store.
/// @throws ConfigError where an instance is missing or no pose, or lacks the axis; or where
///   modifications do not fit together, as ReadKnowledge says.
void ApplyModifications(const std::vector<PoseModification>& modifications, base::Rng rng,
                        std::vector<Fluent>* fluents);

}  // namespace hires::knowledge
