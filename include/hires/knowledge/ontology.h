#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hires::knowledge {

/// Concepts and relations, from OWL in Turtle or RDF/XML; docs/ontology.md says what of OWL is
/// read. Constant once read. Names are the last parts of the IRIs ("Mug" of race:Mug); they compare
/// exactly, and no two concepts or relations share one. Every concept is below owl:Thing, named
/// "Thing".
class Ontology {
 public:
  using ConceptId = std::uint32_t;
  static constexpr ConceptId kUnknown = 0xffffffffu;

  /// Reads the files as one ontology: each may build on what any other declares. Nothing else is
  /// read, and nothing fetched.
  /// @throws ConfigError naming file, line and what is wrong, all at once: text that cannot be
  ///   read, a cycle of subclasses, names of the files' own vocabulary that nothing declares (with
  ///   the nearest ones), more than 4 MB, 5000 concepts or relations each, 100 nested brackets.
  static Ontology FromFiles(const std::vector<std::string>& paths);
  /// @param source  Stands for the file name in messages.
  static Ontology FromText(std::string_view text, const std::string& source);

  /// Concepts are numbered from 0 in the order of their names.
  ConceptId Find(std::string_view name) const;     ///< kUnknown if there is none
  ConceptId Require(std::string_view name) const;  ///< @throws ConfigError with nearest names
  const std::string& Name(ConceptId id) const;
  std::size_t num_concepts() const;
  bool IsA(ConceptId below, ConceptId above) const;  ///< reflexive, transitive. Constant time
  const std::vector<ConceptId>& Below(ConceptId id) const;  ///< with itself, ascending
  const std::vector<ConceptId>& Above(ConceptId id) const;  ///< with itself, ascending

  struct Relation {
    std::string name;
    std::vector<ConceptId> domain;  ///< the fluent's concept is below one of these; empty: any
    std::string range;              ///< a concept (Thing: any), or xsd:...
    bool functional{false};         ///< at most one filler in a fluent
  };
  const Relation* FindRelation(std::string_view name) const;  ///< null if there is none
  std::vector<std::string> ConceptNames() const;              ///< sorted
  std::vector<std::string> RelationNames() const;             ///< sorted
  /// Prefix and name of a concept or relation, "race:Mug", for SPARQL and export.
  /// @throws ConfigError with the nearest names where there is none.
  std::string Qualified(std::string_view name) const;
  std::uint64_t hash() const;  ///< of everything above, whatever files it was spread over

 private:
  friend class OntologyBuilder;
  struct Concept {
    std::string name;
    std::vector<ConceptId> below, above;
  };

  Ontology() = default;
  std::vector<Concept> concepts_;    // by id
  std::vector<std::uint64_t> is_a_;  // bit matrix, a row for each concept below
  std::size_t words_per_row_{0};     // of is_a_
  std::map<std::string, ConceptId, std::less<>> ids_;
  std::map<std::string, Relation, std::less<>> relations_;
  std::map<std::string, std::string, std::less<>> qualified_;  // of concepts and relations
  std::uint64_t hash_{0};
};

}  // namespace hires::knowledge
