#include "knowledge/ontology/ontology_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <vector>

#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

// Classes, and what says something of a name.
constexpr const char* kWords =
    "owl:AllDifferent owl:AllDisjointClasses owl:AllDisjointProperties owl:Annotation "
    "owl:AnnotationProperty owl:AsymmetricProperty owl:Axiom owl:Class owl:DataRange "
    "owl:DatatypeProperty owl:DeprecatedClass owl:DeprecatedProperty owl:FunctionalProperty "
    "owl:InverseFunctionalProperty owl:IrreflexiveProperty owl:NamedIndividual "
    "owl:NegativePropertyAssertion owl:ObjectProperty owl:Ontology owl:OntologyProperty "
    "owl:ReflexiveProperty owl:Restriction owl:SymmetricProperty owl:Thing "
    "owl:TransitiveProperty owl:annotatedProperty owl:annotatedSource owl:annotatedTarget "
    "owl:backwardCompatibleWith owl:complementOf owl:deprecated owl:differentFrom "
    "owl:disjointUnionOf owl:disjointWith owl:equivalentClass owl:equivalentProperty "
    "owl:hasKey owl:imports owl:incompatibleWith owl:intersectionOf owl:inverseOf owl:oneOf "
    "owl:priorVersion owl:propertyChainAxiom owl:propertyDisjointWith owl:sameAs owl:unionOf "
    "owl:versionIRI owl:versionInfo rdf:Alt rdf:Bag rdf:List rdf:Property rdf:Seq "
    "rdf:Statement rdf:first rdf:object rdf:predicate rdf:rest rdf:subject rdf:type "
    "rdf:value rdfs:Class rdfs:Container rdfs:Datatype rdfs:Literal rdfs:Resource "
    "rdfs:comment rdfs:domain rdfs:isDefinedBy rdfs:label rdfs:member rdfs:range "
    "rdfs:seeAlso rdfs:subClassOf rdfs:subPropertyOf";

std::size_t EndOfNamespace(const std::string& iri) {
  const std::size_t last = iri.find_last_of("#/");
  const std::size_t end = last != std::string::npos ? last : iri.rfind(':');
  return end == std::string::npos ? 0 : end + 1;
}

}  // namespace

const std::map<std::string, std::string>& KnownPrefixes() {
  static const std::map<std::string, std::string> kKnown{
      {"rdf", kRdf}, {"rdfs", kRdfs}, {"owl", kOwl}, {"xsd", kXsd}};
  return kKnown;
}

bool Starts(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

bool IsOfOwl(const std::string& iri) {
  return Starts(iri, kOwl) || Starts(iri, kRdfs) || Starts(iri, kRdf);
}

std::string Readable(const std::string& iri) {
  for (const auto& [prefix, known] : KnownPrefixes()) {
    if (Starts(iri, known)) return prefix + ":" + iri.substr(known.size());
  }
  return "<" + iri + ">";
}

std::optional<std::string> WhyNoWord(const std::string& iri) {
  static const std::vector<std::string> words = base::SplitWords(kWords);
  const std::string word = Readable(iri);
  if (std::find(words.begin(), words.end(), word) != words.end()) return std::nullopt;
  const std::vector<std::string> likely = base::LikelyNames(word, words);
  if (likely.empty()) return std::nullopt;
  return fmt::format("'{}' is no word of OWL; did you mean '{}'?", word,
                     base::Join(likely, "' or '"));
}

bool IsClass(const std::string& type) { return type == kOwl + "Class" || type == kRdfs + "Class"; }

bool IsKindOfLink(const std::string& type) {
  static const std::set<std::string> kKinds{
      kOwl + "TransitiveProperty",        kOwl + "SymmetricProperty",
      kOwl + "AsymmetricProperty",        kOwl + "ReflexiveProperty",
      kOwl + "InverseFunctionalProperty", kOwl + "IrreflexiveProperty"};
  return kKinds.count(type) > 0;
}

bool Declares(const std::string& type) {
  return IsClass(type) || IsKindOfLink(type) || type == kOwl + "ObjectProperty" ||
         type == kOwl + "DatatypeProperty" || type == kOwl + "FunctionalProperty";
}

bool IsOfValues(const std::string& iri) {
  return Starts(iri, kXsd) || iri == kRdfs + "Literal" || Starts(iri, kRdf) ||
         iri == kOwl + "real" || iri == kOwl + "rational";
}

bool IsValueType(const std::string& iri) {
  constexpr std::array kTypes{"float", "double", "int", "integer", "boolean", "string"};
  return std::any_of(kTypes.begin(), kTypes.end(),
                     [&](const char* type) { return iri == kXsd + type; });
}

bool IsPlain(const std::string& iri) {
  return std::none_of(iri.begin(), iri.end(), [](unsigned char c) {
    return c <= ' ' ||
           std::string_view("<>\"{}|^`\\").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

bool IsName(const std::string& text) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !text.empty() && text.size() <= 200 && std::isalpha(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), fits);
}

std::string NamespaceOf(const std::string& iri) { return iri.substr(0, EndOfNamespace(iri)); }
std::string LastPart(const std::string& iri) { return iri.substr(EndOfNamespace(iri)); }

}  // namespace hires::knowledge
