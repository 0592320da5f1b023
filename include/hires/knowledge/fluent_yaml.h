#pragma once

#include <cstdint>
#include <map>
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
  std::vector<std::string> attachments;  ///< poses that move along rigidly, and so do theirs
  std::string where{};                   ///< for messages: "kitchen.yaml: document 3, line 12"
};

/// What a series of scenario runs begins from, or varies: `!Scenario`. Texts are not looked up
/// here.
struct ScenarioSetting {
  std::string group;  ///< whose choice it takes; empty: it is the same in all runs
  int choices{1};
  /// By key: Scenario, Instruction, Truth, World; one text per choice.
  std::map<std::string, std::vector<std::string>> values;
  double z_origin{0.0};  ///< [m] ZOrigin: what hasZ says of a thing that keeps its height
  std::string where;     ///< for messages
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
  std::vector<ScenarioSetting>
      scenarios{};                    ///< for a runner of scenarios; who loads passes them over
  std::vector<std::string> places{};  ///< "document 3, line 12": of each fluent; empty: not known
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
/// Likewise for fluents, then modifications, then topics.
std::string WriteKnowledge(const KnowledgeFile& file);

/// Applies modifications to the poses among `fluents`, all or none. Each group draws one choice, in
/// the order in which groups first appear; see MovePoses.
/// @throws ConfigError as MovePoses.
void ApplyModifications(const std::vector<PoseModification>& modifications, base::Rng rng,
                        std::vector<Fluent>* fluents);

}  // namespace hires::knowledge
