#pragma once

#include <map>
#include <string>

#include "hires/knowledge/ontology.h"
#include "knowledge/sparql/sparql_lexer.h"

namespace hires::knowledge::sparql {

/// A name of a query, taken apart.
struct Name {
  std::string
      space;  ///< "race", "rdf", ... where it is a well-known one, else the IRI's first part
  std::string local;  ///< behind the last `#` or `/`, or the prefix
  std::string written;
  Place place;

  bool Is(const char* wanted_space, const char* wanted_local) const {
    return space == wanted_space && local == wanted_local;
  }
};

/// What the prefixes of a query mean, and what its names are in the ontology.
class Names {
 public:
  explicit Names(const Ontology& ontology);

  void Declare(const std::string& prefix, const std::string& iri);
  /// @pre the token is a prefixed name or an IRI.  @throws ConfigError for an unknown prefix.
  Name Read(const Token& token) const;
  /// @throws ConfigError with the nearest names, also where the prefix is not the ontology's.
  Ontology::ConceptId Concept(const Name& name) const;
  const Ontology::Relation& Relation(const Name& name) const;

 private:
  Name ReadIri(const Token& token) const;
  void CheckSpace(const Name& name) const;

  const Ontology& ontology_;
  std::map<std::string, std::string> iris_;  // by prefix
};

}  // namespace hires::knowledge::sparql
