#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hires::knowledge {

/// What a statement in Turtle is about.
struct RdfNode {
  enum class Kind { kIri, kBlank, kLiteral };
  Kind kind{Kind::kIri};
  std::string value;  ///< IRI, blank node's label, or text of the literal
};

/// One statement in Turtle.
struct RdfStatement {
  RdfNode subject;
  std::string predicate;  ///< IRI
  RdfNode object;
  int line{0};  ///< from 1; in which its last word stands, or the next one
};

struct RdfDocument {
  std::string source;
  std::vector<RdfStatement> statements;
  std::map<std::string, std::string> prefixes;  ///< "race" -> IRI up to the name
};

constexpr std::size_t kMaxRdfBytes = 4u << 20;

/// Reads Turtle with raptor, which is kept from the network and from every file. Safe to call from
/// any thread.
/// @throws ConfigError naming source and line: a text that is no Turtle, a prefix with two
/// meanings,
///   more than 4 MB, 100 nested brackets or 200,000 statements, an IRI of more than 200 bytes, a
///   text of more than 64 KB.
RdfDocument ReadRdf(std::string_view text, const std::string& source);

}  // namespace hires::knowledge
