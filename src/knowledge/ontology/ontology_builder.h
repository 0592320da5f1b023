#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/faults.h"
#include "hires/knowledge/ontology.h"
#include "knowledge/ontology/ontology_rdf.h"

namespace hires::knowledge {

/// Turns the statements of Turtle documents into an ontology: declarations first, from all of them,
/// then what is said about the declared, then the numbers and closures. Used once.
class OntologyBuilder {
 public:
  explicit OntologyBuilder(std::vector<RdfDocument> documents);
  /// @throws ConfigError, see Ontology::FromFiles.
  Ontology Build();

 private:
  struct Place {
    const RdfDocument* document{nullptr};
    int line{0};
  };
  struct Term {
    std::string iri;
    std::string qualified;
    Place place;  // of its first declaration
  };
  struct Superclass {
    std::string name;
    Place place;
  };
  struct ConceptTerm : Term {
    std::vector<Superclass> above;
  };
  struct RelationTerm : Term {
    std::optional<bool> is_link{};  // ObjectProperty, or DatatypeProperty
    bool functional{false};
    std::optional<std::vector<std::string>> domain{};
    std::optional<std::string> range{};
    bool has_domain{false};  // one of which something is read or not
    bool is_dropped{false};  // its values are of no type that is read
  };
  /// What of a document is beyond what is read of OWL, and says nothing of how names are used.
  struct PassedOver {
    int first_line{0};
    std::map<std::string, int> kinds;                    // "owl:disjointWith" -> how often
    std::map<std::string, std::set<std::string>> names;  // of those kinds that have any
  };
  using BlankId = std::pair<const RdfDocument*, std::string>;

  void Declare(const RdfDocument& document);
  void AddPrefixes();
  void InventPrefixes();
  void DeclareOne(const RdfStatement& statement, Place place);
  void DeclareIndividuals();
  void DescribeAll();
  bool IsForeign(const RdfNode& node, Place place) const;
  bool ImportsMore(const RdfDocument& document) const;
  void PassOver(const std::string& kind, Place place, const std::string& name = "");
  void WarnOfPassedOver() const;
  void DeclareConcept(const std::string& iri, Place place);
  void DeclareRelation(const std::string& iri, const std::string& type, Place place);
  static void SetIsLink(RelationTerm* relation, bool is_link, Place place);
  bool CanBeNamed(const std::string& iri, Place place);
  Term NewTerm(const std::string& iri, Place place) const;
  std::string QualifiedName(const std::string& iri, Place place) const;

  void Describe(const RdfDocument& document);
  bool IsPassedOver(const RdfStatement& statement) const;
  static void RequireNoSlip(const std::string& iri, Place place);
  void DescribeOne(const RdfStatement& statement, Place place);
  void AddSuperclass(const RdfStatement& statement, Place place);
  void SetDomain(const RdfStatement& statement, Place place);
  void SetRange(const RdfStatement& statement, Place place);
  void SetRangeOfLinks(const RdfStatement& statement, Place place, RelationTerm* relation);
  void SetRangeOfValues(const RdfStatement& statement, Place place, RelationTerm* relation);
  RelationTerm& RequireRelation(const RdfNode& node, Place place);
  std::string RequireConcept(const RdfNode& node, Place place) const;
  std::optional<std::vector<std::string>> UnionOf(const RdfStatement& statement, Place place);
  std::optional<std::vector<std::string>> Members(RdfNode list, Place place);
  const RdfNode* ObjectOf(Place place, const std::string& blank,
                          const std::string& predicate) const;
  void CheckRelations();
  bool IsWhole(RelationTerm* relation);
  void CheckBlanks();

  void NumberConcepts(Ontology* ontology) const;
  void FillIsA(Ontology* ontology) const;
  static void FillClosures(Ontology* ontology);
  std::vector<std::string> FromTheTop() const;
  void FillRelations(Ontology* ontology) const;
  static void FillHash(Ontology* ontology);

  [[noreturn]] static void Fail(Place place, const std::string& what);
  [[noreturn]] static void FailOnSubset(const RdfStatement& statement, Place place);
  [[noreturn]] static void FailOnSameName(const Term& known, const Term& other);
  [[noreturn]] static void FailOnKindOfRange(const RelationTerm& relation, const RdfNode& range,
                                             Place place);
  [[noreturn]] void FailOnCycle(const std::map<std::string, std::size_t>& open) const;

  std::vector<RdfDocument> documents_;
  base::Faults faults_;
  std::map<std::string, std::string> prefixes_;  // of all documents
  std::map<std::string, ConceptTerm> concepts_;  // by name
  std::map<std::string, RelationTerm> relations_;
  std::map<std::string, std::string> names_;                  // IRI of what is declared -> name
  std::set<std::string> headers_;                             // IRIs of owl:Ontology
  std::set<std::string> annotations_;                         // IRIs of owl:AnnotationProperty
  std::set<std::string> individuals_;                         // their IRIs
  std::set<std::string> others_;                              // IRIs of what is passed over
  std::set<std::string> own_namespaces_;                      // of what is declared
  std::set<const RdfDocument*> importing_;                    // what is not given
  std::vector<std::pair<const RdfStatement*, Place>> typed_;  // by a class that is not OWL's
  std::map<const RdfDocument*, PassedOver> passed_over_;
  std::map<BlankId, std::vector<const RdfStatement*>> blanks_;  // what is said about them
  std::set<BlankId> used_blanks_;                               // that somebody referred to
};

}  // namespace hires::knowledge
