#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace hires::knowledge {

// Vocabularies that everybody knows, and names within IRIs.

inline const std::string kRdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
inline const std::string kRdfs = "http://www.w3.org/2000/01/rdf-schema#";
inline const std::string kOwl = "http://www.w3.org/2002/07/owl#";
inline const std::string kXsd = "http://www.w3.org/2001/XMLSchema#";
inline const std::string kThing = kOwl + "Thing";

/// "rdf", "rdfs", "owl" and "xsd", each with its IRI.
const std::map<std::string, std::string>& KnownPrefixes();
bool Starts(std::string_view text, std::string_view with);
bool IsOfOwl(const std::string& iri);  ///< or of RDFS, or RDF
/// "rdf:type" of an IRI that everybody knows, else the IRI itself, for messages.
std::string Readable(const std::string& iri);
/// Why an IRI of these vocabularies was meant to be another: it is no word of theirs and looks like
/// one. Nothing for what is one, or like none.
std::optional<std::string> WhyNoWord(const std::string& iri);

bool IsClass(const std::string& type);
/// Whether only relations between instances can be of a type of OWL, beside owl:ObjectProperty.
bool IsKindOfLink(const std::string& type);
/// Whether what is of a type of OWL is a concept or a relation.
bool Declares(const std::string& type);
/// Whether an IRI stands for values, be they of a type that is read or not.
bool IsOfValues(const std::string& iri);
bool IsValueType(const std::string& iri);  ///< of one that is read

/// IRIs as queries can name them between < and >.
bool IsPlain(const std::string& iri);
/// Names stand in YAML and in SPARQL, unquoted where possible.
bool IsName(const std::string& text);
std::string NamespaceOf(const std::string& iri);
std::string LastPart(const std::string& iri);

}  // namespace hires::knowledge
