#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace hires::knowledge {

/// Concepts and relations, from OWL in Turtle. Constant once read. Names are the last parts of the
/// IRIs ("Mug" of race:Mug); they compare exactly, and no two concepts share one.
class Ontology {
 public:
  using ConceptId = std::uint32_t;
  static constexpr ConceptId kUnknown = 0xffffffffu;

  /// @throws ConfigError naming file, line and what is wrong: unreadable Turtle, a cycle of
  ///   subclasses, a relation without range, a superclass nobody declares (with the nearest names).
  static Ontology FromFiles(const std::vector<std::string>& paths);
  static Ontology FromTurtle(std::string_view text, const std::string& source);

  ConceptId Find(std::string_view name) const;     ///< kUnknown if there is none
  ConceptId Require(std::string_view name) const;  ///< @throws ConfigError with nearest names
  const std::string& Name(ConceptId id) const;
  std::size_t num_concepts() const;
  bool IsA(ConceptId below, ConceptId above) const;  ///< reflexive, transitive. Constant time
  const std::vector<ConceptId>& Below(ConceptId id) const;  ///< with itself, ascending
  const std::vector<ConceptId>& Above(ConceptId id) const;  ///< with itself, ascending

  struct Relation {
    std::string name;
    std::vector<ConceptId> domain;  ///< empty: any
    std::string range;              ///< a concept, or xsd:...; "" any
    bool functional{false};
  };
  const Relation* FindRelation(std::string_view name) const;  ///< null if there is none
  std::vector<std::string> ConceptNames() const;              ///< sorted
  std::vector<std::string> RelationNames() const;             ///< sorted
  /// Prefix and name of a concept or relation, "race:Mug", for SPARQL and export.
  std::string Qualified(std::string_view name) const;
  std::uint64_t hash() const;
};

}  // namespace hires::knowledge
