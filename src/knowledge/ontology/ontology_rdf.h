#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hires::knowledge {

/// What a statement of RDF is about.
struct RdfNode {
  enum class Kind { kIri, kBlank, kLiteral };
  Kind kind{Kind::kIri};
  std::string value;  ///< IRI, blank node's label, or text of the literal
};

/// One statement of RDF.
struct RdfStatement {
  RdfNode subject;
  std::string predicate;  ///< IRI
  RdfNode object;
  int line{0};  ///< from 1; in which its last word stands, or the next one
};

struct RdfDocument {
  std::string source;
  std::vector<RdfStatement> statements;
  /// "race" -> IRI up to the name; where RDF/XML gives a prefix several meanings, the first.
  std::map<std::string, std::string> prefixes;
};

constexpr std::size_t kMaxRdfBytes = 4u << 20;

/// Reads Turtle or RDF/XML, whichever it is by how it begins, with raptor, which is kept from the
/// network and from every file. Safe to call from any thread.
/// @throws ConfigError naming source and line: a text that is neither (of other notations of OWL:
///   which, and what converts it), a prefix that is not declared, more than 4 MB, 100 nested
///   brackets or elements, or 200,000 statements; in Turtle a prefix with two meanings, an IRI of
///   more than 200 bytes, a text of more than 64 KB.
RdfDocument ReadRdf(std::string_view text, const std::string& source);

}  // namespace hires::knowledge
