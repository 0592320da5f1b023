#include "knowledge/ontology/ontology_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/keys.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "knowledge/ontology/ontology_words.h"

namespace hires::knowledge {
namespace {

using ConceptId = Ontology::ConceptId;
using NodeKind = RdfNode::Kind;

// Of concepts, and of relations. The is-a matrix and the closures grow with the square.
constexpr std::size_t kMaxTerms = 5000;
constexpr std::size_t kMostNamed = 5;  // of names that are passed over
constexpr const char* kTooMany =
    "more than 5000 concepts, or as many relations; keep what the robot does not need out of it";

std::string ReadableNode(const RdfNode& node) {
  switch (node.kind) {
    case NodeKind::kIri:
      return Readable(node.value);
    case NodeKind::kBlank:
      return "a node without a name";
    default:
      return "'" + node.value.substr(0, 40) + "'";
  }
}

/// What a node would be called if it were declared.
std::string NameForMessage(const RdfNode& node) {
  return node.kind == NodeKind::kIri ? LastPart(node.value).substr(0, 80) : ReadableNode(node);
}

}  // namespace

OntologyBuilder::OntologyBuilder(std::vector<RdfDocument> documents)
    : documents_(std::move(documents)) {}

Ontology OntologyBuilder::Build() {
  concepts_["Thing"] = {{kThing, "owl:Thing", {}}, {}};
  names_[kThing] = "Thing";
  names_[kRdfs + "Resource"] = "Thing";
  AddPrefixes();
  InventPrefixes();
  for (const RdfDocument& document : documents_) Declare(document);
  faults_.Require();  // what is not declared would be unknown wherever it is named
  DescribeAll();
  faults_.Require();
  Ontology ontology;
  NumberConcepts(&ontology);
  FillIsA(&ontology);
  FillClosures(&ontology);
  FillRelations(&ontology);
  FillHash(&ontology);
  WarnOfPassedOver();
  return ontology;
}

// Declarations ------------------------------------------------------------------------------------

void OntologyBuilder::Declare(const RdfDocument& document) {
  for (const RdfStatement& statement : document.statements) {
    if (statement.subject.kind == NodeKind::kBlank) {
      blanks_[{&document, statement.subject.value}].push_back(&statement);
    } else if (statement.predicate == kRdf + "type") {
      faults_.Collect([&] { DeclareOne(statement, {&document, statement.line}); });
    }
  }
}

/// The empty prefix is another one in each file, unless all mean the same.
void OntologyBuilder::AddPrefixes() {
  bool is_empty_one = true;
  for (const RdfDocument& document : documents_) {
    for (const auto& [prefix, iri] : document.prefixes) {
      const auto [known, is_new] = prefixes_.emplace(prefix, iri);
      if (is_new || known->second == iri) continue;
      if (prefix.empty()) {
        is_empty_one = false;
        continue;
      }
      faults_.Add(
          fmt::format("{}: prefix '{}:' is <{}>, and <{}> in a file before; all files of one "
                      "ontology use the same prefixes",
                      document.source, prefix, iri, known->second));
    }
  }
  if (!is_empty_one) prefixes_.erase("");
}

/// Queries name concepts and relations by a prefix: namespaces that have none get one, in the order
/// of their names.
void OntologyBuilder::InventPrefixes() {
  std::set<std::string> bare;
  for (const RdfDocument& document : documents_) {
    for (const RdfStatement& statement : document.statements) {
      const bool declares =
          statement.predicate == kRdf + "type" && Declares(statement.object.value);
      if (declares && statement.subject.kind == NodeKind::kIri &&
          statement.subject.value != kThing && IsPlain(statement.subject.value))
        bare.insert(NamespaceOf(statement.subject.value));
    }
  }
  for (const auto& [prefix, iri] : prefixes_) bare.erase(iri);
  std::vector<std::string> invented;
  int number = 0;
  for (const std::string& iri : bare) {
    std::string prefix;
    do {
      prefix = fmt::format("ns{}", ++number);
    } while (prefixes_.count(prefix) > 0);
    prefixes_[prefix] = iri;
    invented.push_back(fmt::format("{}: for <{}>", prefix, iri));
  }
  if (invented.empty()) return;
  base::Log(base::LogLevel::kWarn,
            fmt::format("ontology: what has no prefix gets one, by which queries name it: {}",
                        base::Join(base::FirstLines(std::move(invented)), ", ")));
}

void OntologyBuilder::DeclareOne(const RdfStatement& statement, Place place) {
  const std::string type = statement.object.value;
  if (type == kOwl + "Ontology") {
    headers_.insert(statement.subject.value);
  } else if (IsClass(type)) {
    DeclareConcept(statement.subject.value, place);
  } else if (Declares(type)) {
    DeclareRelation(statement.subject.value, type, place);
  } else if (type == kOwl + "AnnotationProperty") {
    annotations_.insert(statement.subject.value);
  } else if (IsOfOwl(type)) {
    RequireNoSlip(type, place);
    (type == kOwl + "NamedIndividual" ? individuals_ : others_).insert(statement.subject.value);
    PassOver(Readable(type), place);
  } else {
    typed_.emplace_back(&statement, place);
  }
}

/// Only now all classes are known: what is of another type of the files' own names is a slip.
void OntologyBuilder::DeclareIndividuals() {
  for (const auto& [statement, place] : typed_) {
    const Place& where = place;  // captured
    const RdfNode& type = statement->object;
    if (type.kind == NodeKind::kIri && !IsForeign(type, place))
      faults_.Collect([&] { RequireConcept(type, where); });
    if (individuals_.insert(statement->subject.value).second) PassOver("individuals", place);
  }
}

void OntologyBuilder::DescribeAll() {
  for (const auto& [iri, name] : names_) {
    if (!IsOfOwl(iri)) own_namespaces_.insert(NamespaceOf(iri));
  }
  for (const RdfDocument& document : documents_) {
    if (ImportsMore(document)) importing_.insert(&document);
  }
  DeclareIndividuals();
  for (const RdfDocument& document : documents_) Describe(document);
  CheckBlanks();
  CheckRelations();
}

/// Of a vocabulary of which the files declare nothing, or of a file that is imported and not given.
bool OntologyBuilder::IsForeign(const RdfNode& node, Place place) const {
  if (node.kind != NodeKind::kIri || names_.count(node.value) > 0 || IsOfOwl(node.value))
    return false;
  return others_.count(node.value) > 0 || own_namespaces_.count(NamespaceOf(node.value)) == 0 ||
         importing_.count(place.document) > 0;
}

bool OntologyBuilder::ImportsMore(const RdfDocument& document) const {
  return std::any_of(document.statements.begin(), document.statements.end(),
                     [&](const RdfStatement& statement) {
                       return statement.predicate == kOwl + "imports" &&
                              headers_.count(statement.object.value) == 0;
                     });
}

void OntologyBuilder::PassOver(const std::string& kind, Place place, const std::string& name) {
  PassedOver& passed = passed_over_[place.document];
  if (passed.kinds.empty()) passed.first_line = place.line;
  passed.first_line = std::min(passed.first_line, place.line);
  ++passed.kinds[kind];
  if (!name.empty()) passed.names[kind].insert(name);
}

void OntologyBuilder::WarnOfPassedOver() const {
  for (const auto& [document, passed] : passed_over_) {
    std::vector<std::string> kinds;
    for (const auto& [kind, count] : passed.kinds) {
      const auto named = passed.names.find(kind);
      kinds.push_back(
          named == passed.names.end()
              ? fmt::format("{} ({})", kind, count)
              : fmt::format(
                    "{} ({}: {})", kind, count,
                    base::FirstNames({named->second.begin(), named->second.end()}, kMostNamed)));
    }
    base::Log(base::LogLevel::kWarn,
              fmt::format("{}: passed over, as it is beyond what is read of OWL: {}; the first in "
                          "line {}. Individuals belong into files of fluents",
                          document->source, base::Join(kinds, ", "), passed.first_line));
  }
}

void OntologyBuilder::DeclareConcept(const std::string& iri, Place place) {
  if (iri == kThing || iri == kRdfs + "Resource" || !CanBeNamed(iri, place)) return;
  const Term term = NewTerm(iri, place);
  const std::string name = LastPart(iri);
  if (const auto same = relations_.find(name); same != relations_.end()) {
    FailOnSameName(same->second, term);
  }
  const auto [known, is_new] = concepts_.emplace(name, ConceptTerm{term, {}});
  if (known->second.iri != iri) FailOnSameName(known->second, term);
  names_[iri] = name;
  if (is_new && concepts_.size() == kMaxTerms + 1) Fail(place, kTooMany);
}

void OntologyBuilder::DeclareRelation(const std::string& iri, const std::string& type,
                                      Place place) {
  if (!CanBeNamed(iri, place)) return;
  const Term term = NewTerm(iri, place);
  const std::string name = LastPart(iri);
  if (const auto same = concepts_.find(name); same != concepts_.end()) {
    FailOnSameName(same->second, term);
  }
  const auto [known, is_new] = relations_.emplace(name, RelationTerm{term});
  if (known->second.iri != iri) FailOnSameName(known->second, term);
  names_[iri] = name;
  if (is_new && relations_.size() == kMaxTerms + 1) Fail(place, kTooMany);
  if (type == kOwl + "FunctionalProperty") {
    known->second.functional = true;
  } else {
    SetIsLink(&known->second, type != kOwl + "DatatypeProperty", place);
    if (IsKindOfLink(type)) PassOver(Readable(type), place);
  }
}

void OntologyBuilder::SetIsLink(RelationTerm* relation, bool is_link, Place place) {
  if (relation->is_link.value_or(is_link) != is_link) {
    Fail(place, fmt::format("relation {} is an owl:ObjectProperty and an owl:DatatypeProperty; it "
                            "leads to instances or to values, not to both",
                            relation->qualified));
  }
  relation->is_link = is_link;
}

/// What fluents cannot name is of no use.
bool OntologyBuilder::CanBeNamed(const std::string& iri, Place place) {
  if (IsPlain(iri) && IsName(LastPart(iri))) return true;
  if (others_.insert(iri).second) {
    PassOver(
        "concepts and relations whose last part is no name (a letter, then letters, digits, '_' or "
        "'-', 200 at most)",
        place);
  }
  return false;
}

OntologyBuilder::Term OntologyBuilder::NewTerm(const std::string& iri, Place place) const {
  return {iri, QualifiedName(iri, place), place};
}

std::string OntologyBuilder::QualifiedName(const std::string& iri, Place place) const {
  const std::string name_space = NamespaceOf(iri);
  // From the end: the empty prefix, which says least, comes last.
  for (auto prefix = prefixes_.rbegin(); prefix != prefixes_.rend(); ++prefix) {
    if (prefix->second == name_space) return prefix->first + ":" + LastPart(iri);
  }
  Fail(place, fmt::format("<{}> has no prefix", iri));  // InventPrefixes() leaves none without
}

// Descriptions ------------------------------------------------------------------------------------

void OntologyBuilder::Describe(const RdfDocument& document) {
  for (const RdfStatement& statement : document.statements) {
    if (IsPassedOver(statement)) continue;
    faults_.Collect([&] { DescribeOne(statement, Place{&document, statement.line}); });
  }
}

bool OntologyBuilder::IsPassedOver(const RdfStatement& statement) const {
  static const std::set<std::string> kRemarks{kRdfs + "label", kRdfs + "comment", kRdfs + "seeAlso",
                                              kRdfs + "isDefinedBy", kOwl + "versionInfo"};
  // Nodes without a name count where a statement refers to them.
  return statement.subject.kind == NodeKind::kBlank || statement.predicate == kRdf + "type" ||
         kRemarks.count(statement.predicate) > 0 || annotations_.count(statement.predicate) > 0 ||
         annotations_.count(statement.subject.value) > 0 ||
         headers_.count(statement.subject.value) > 0;
}

void OntologyBuilder::DescribeOne(const RdfStatement& statement, Place place) {
  const std::string& subject = statement.subject.value;
  if (individuals_.count(subject) > 0 && names_.count(subject) == 0) {
    PassOver("statements about individuals", place);
  } else if (IsForeign(statement.subject, place)) {
    PassOver(others_.count(subject) > 0 ? "statements about what is passed over"
                                        : "statements about what no file declares",
             place);
  } else if (statement.predicate == kRdfs + "subClassOf") {
    AddSuperclass(statement, place);
  } else if (statement.predicate == kRdfs + "domain") {
    SetDomain(statement, place);
  } else if (statement.predicate == kRdfs + "range") {
    SetRange(statement, place);
  } else if (IsOfOwl(statement.predicate)) {
    RequireNoSlip(statement.predicate, place);
    PassOver(Readable(statement.predicate), place);
  } else {
    const RdfNode predicate{NodeKind::kIri, statement.predicate};
    if (names_.count(predicate.value) == 0 && !IsForeign(predicate, place))
      RequireRelation(predicate, place);
    PassOver("statements by what is no word of OWL", place);
  }
}

void OntologyBuilder::RequireNoSlip(const std::string& iri, Place place) {
  if (const std::optional<std::string> why = WhyNoWord(iri)) Fail(place, *why);
}

void OntologyBuilder::AddSuperclass(const RdfStatement& statement, Place place) {
  if (statement.object.kind == NodeKind::kLiteral) FailOnSubset(statement, place);
  const std::string below = RequireConcept(statement.subject, place);
  if (below == "Thing") Fail(place, "owl:Thing stands above every concept, and below none");
  if (statement.object.kind == NodeKind::kBlank) return;  // a restriction; CheckBlanks tells
  if (statement.object.value == statement.subject.value) return;  // as reasoners write
  if (IsForeign(statement.object, place))
    return PassOver("superclasses that no file declares", place, NameForMessage(statement.object));
  const std::string above = RequireConcept(statement.object, place);
  concepts_.at(below).above.push_back({above, place});
}

void OntologyBuilder::SetDomain(const RdfStatement& statement, Place place) {
  RelationTerm& relation = RequireRelation(statement.subject, place);
  if (relation.has_domain) {
    Fail(place,
         fmt::format("relation {} has two domains, which in OWL means both at once; write one, "
                     "alternatives as [ a owl:Class ; owl:unionOf ( ... ) ]",
                     relation.qualified));
  }
  relation.has_domain = true;
  if (statement.object.kind == NodeKind::kLiteral) FailOnSubset(statement, place);
  if (statement.object.kind == NodeKind::kBlank) {
    relation.domain = UnionOf(statement, place);
  } else if (!IsForeign(statement.object, place)) {
    relation.domain = {RequireConcept(statement.object, place)};
  }
  if (!relation.domain)
    PassOver("domains beyond a concept or a union of them (any is taken)", place);
}

void OntologyBuilder::SetRange(const RdfStatement& statement, Place place) {
  RelationTerm& relation = RequireRelation(statement.subject, place);
  if (relation.range) {
    Fail(place, fmt::format("relation {} has two ranges, wanted one; write a concept above both",
                            relation.qualified));
  }
  if (statement.object.kind == NodeKind::kLiteral) FailOnSubset(statement, place);
  if (!relation.is_link && statement.object.kind == NodeKind::kIri)
    relation.is_link = !IsOfValues(statement.object.value);
  if (relation.is_link.value_or(true)) {
    SetRangeOfLinks(statement, place, &relation);
  } else {
    SetRangeOfValues(statement, place, &relation);
  }
}

void OntologyBuilder::SetRangeOfLinks(const RdfStatement& statement, Place place,
                                      RelationTerm* relation) {
  const RdfNode& object = statement.object;
  if (object.kind == NodeKind::kIri && IsOfValues(object.value))
    FailOnKindOfRange(*relation, object, place);
  if (object.kind == NodeKind::kBlank || IsForeign(object, place)) {
    if (object.kind == NodeKind::kBlank) UnionOf(statement, place);  // which is then no other's
    relation->range = "Thing";
    return PassOver("ranges beyond a concept (any is taken)", place);
  }
  relation->range = RequireConcept(object, place);
}

void OntologyBuilder::SetRangeOfValues(const RdfStatement& statement, Place place,
                                       RelationTerm* relation) {
  const RdfNode& object = statement.object;
  if (object.kind == NodeKind::kIri && names_.count(object.value) > 0)
    FailOnKindOfRange(*relation, object, place);
  relation->range = ReadableNode(object);
  if (IsValueType(object.value)) return;
  relation->is_dropped = true;
  PassOver(object.kind == NodeKind::kBlank
               ? "relations to values of a type without a name"
               : fmt::format("relations to values of {}", ReadableNode(object)),
           place);
}

OntologyBuilder::RelationTerm& OntologyBuilder::RequireRelation(const RdfNode& subject,
                                                                Place place) {
  const auto name = names_.find(subject.value);
  const auto found = name == names_.end() ? relations_.end() : relations_.find(name->second);
  if (found != relations_.end()) return found->second;
  Fail(place, base::UnknownName("relation", NameForMessage(subject), base::KeysOf(relations_)) +
                  "; a relation is declared as owl:ObjectProperty or owl:DatatypeProperty");
}

std::string OntologyBuilder::RequireConcept(const RdfNode& node, Place place) const {
  const auto name = names_.find(node.value);
  if (node.kind == NodeKind::kIri && name != names_.end() && concepts_.count(name->second) > 0) {
    return name->second;
  }
  Fail(place, base::UnknownName("concept", NameForMessage(node), base::KeysOf(concepts_)) +
                  "; a concept is declared as owl:Class");
}

/// The concepts of `[ a owl:Class ; owl:unionOf ( A B ) ]`, where it is one of names.
std::optional<std::vector<std::string>> OntologyBuilder::UnionOf(const RdfStatement& statement,
                                                                 Place place) {
  const std::string& node = statement.object.value;
  const RdfNode* type = ObjectOf(place, node, kRdf + "type");
  const RdfNode* list = ObjectOf(place, node, kOwl + "unionOf");
  const bool is_union = type != nullptr && type->value == kOwl + "Class" && list != nullptr &&
                        blanks_.at({place.document, node}).size() == 2;
  used_blanks_.insert({place.document, node});
  if (!is_union) return std::nullopt;
  return Members(*list, place);
}

std::optional<std::vector<std::string>> OntologyBuilder::Members(RdfNode list, Place place) {
  std::vector<std::string> members;
  bool is_named = true;
  // Each node once: a list that bites its own tail has no end.
  while (list.kind == NodeKind::kBlank &&
         used_blanks_.insert({place.document, list.value}).second) {
    const RdfNode* first = ObjectOf(place, list.value, kRdf + "first");
    const RdfNode* rest = ObjectOf(place, list.value, kRdf + "rest");
    if (first == nullptr || rest == nullptr) break;
    const bool is_concept = first->kind == NodeKind::kIri && !IsForeign(*first, place);
    members.push_back(is_concept ? RequireConcept(*first, place) : "");
    is_named = is_named && is_concept;
    list = *rest;
  }
  if (list.value != kRdf + "nil" || members.empty()) {
    Fail(place, "owl:unionOf has no list of concepts, wanted ( A B ... )");
  }
  if (!is_named) return std::nullopt;
  return members;
}

const RdfNode* OntologyBuilder::ObjectOf(Place place, const std::string& blank,
                                         const std::string& predicate) const {
  const auto said = blanks_.find({place.document, blank});
  if (said == blanks_.end()) return nullptr;
  for (const RdfStatement* statement : said->second) {
    if (statement->predicate == predicate) return &statement->object;
  }
  return nullptr;
}

/// Restrictions, and axioms that stand for themselves, hang on nodes without a name.
void OntologyBuilder::CheckBlanks() {
  for (const auto& [id, statements] : blanks_) {
    if (used_blanks_.count(id) > 0) continue;
    const Place place{id.first, statements.front()->line};
    const RdfNode* type = ObjectOf(place, id.second, kRdf + "type");
    const bool is_list = ObjectOf(place, id.second, kRdf + "first") != nullptr;
    if (type != nullptr && IsOfOwl(type->value)) {
      PassOver(Readable(type->value), place);
    } else if (!is_list) {
      PassOver("nodes without a name", place);
    }
  }
}

void OntologyBuilder::CheckRelations() {
  for (auto relation = relations_.begin(); relation != relations_.end();) {
    relation = IsWhole(&relation->second) ? std::next(relation) : relations_.erase(relation);
  }
}

/// Gives a relation what it may be without; whether it says enough to be read.
bool OntologyBuilder::IsWhole(RelationTerm* relation) {
  if (relation->is_dropped) return false;
  if (!relation->is_link) {
    PassOver("relations that are an owl:FunctionalProperty alone", relation->place);
    return false;
  }
  if (relation->range) return true;
  if (!*relation->is_link) {
    PassOver("relations to values without rdfs:range", relation->place);
    return false;
  }
  PassOver("no rdfs:range (any concept is taken)", relation->place);
  relation->range = "Thing";
  return true;
}

// The ontology ------------------------------------------------------------------------------------

void OntologyBuilder::NumberConcepts(Ontology* ontology) const {
  for (const auto& [name, term] : concepts_) {
    ontology->ids_[name] = static_cast<ConceptId>(ontology->concepts_.size());
    ontology->concepts_.push_back({name, {}, {}});
    ontology->qualified_[name] = term.qualified;
  }
  ontology->words_per_row_ = (ontology->concepts_.size() + 63) / 64;
  ontology->is_a_.assign(ontology->concepts_.size() * ontology->words_per_row_, 0);
}

void OntologyBuilder::FillIsA(Ontology* ontology) const {
  const std::size_t words = ontology->words_per_row_;
  const ConceptId thing = ontology->ids_.at("Thing");
  for (const std::string& name : FromTheTop()) {
    const ConceptId id = ontology->ids_.at(name);
    std::uint64_t* row = &ontology->is_a_[id * words];
    row[id / 64] |= std::uint64_t{1} << (id % 64);
    row[thing / 64] |= std::uint64_t{1} << (thing % 64);
    for (const Superclass& above : concepts_.at(name).above) {
      const std::uint64_t* its = &ontology->is_a_[ontology->ids_.at(above.name) * words];
      for (std::size_t word = 0; word < words; ++word) row[word] |= its[word];
    }
  }
}

void OntologyBuilder::FillClosures(Ontology* ontology) {
  const auto size = static_cast<ConceptId>(ontology->concepts_.size());
  for (ConceptId below = 0; below < size; ++below) {
    for (ConceptId above = 0; above < size; ++above) {
      if (!ontology->IsA(below, above)) continue;
      ontology->concepts_[below].above.push_back(above);
      ontology->concepts_[above].below.push_back(below);
    }
  }
}

/// Every concept after all that are above it.
std::vector<std::string> OntologyBuilder::FromTheTop() const {
  std::map<std::string, std::size_t> open;  // superclasses still to come
  std::map<std::string, std::vector<std::string>> below;
  std::vector<std::string> order;
  for (const auto& [name, term] : concepts_) {
    open[name] = term.above.size();
    if (term.above.empty()) order.push_back(name);
    for (const Superclass& above : term.above) below[above.name].push_back(name);
  }
  for (std::size_t next = 0; next < order.size(); ++next) {
    for (const std::string& name : below[order[next]]) {
      if (--open[name] == 0) order.push_back(name);
    }
  }
  if (order.size() < concepts_.size()) FailOnCycle(open);
  return order;
}

void OntologyBuilder::FillRelations(Ontology* ontology) const {
  for (const auto& [name, term] : relations_) {
    std::set<ConceptId> domain;
    for (const std::string& concept_name : term.domain.value_or(std::vector<std::string>{})) {
      domain.insert(ontology->ids_.at(concept_name));
    }
    if (domain.count(ontology->ids_.at("Thing")) > 0) domain.clear();
    ontology->relations_[name] = {
        name, {domain.begin(), domain.end()}, *term.range, term.functional};
    ontology->qualified_[name] = term.qualified;
  }
}

void OntologyBuilder::FillHash(Ontology* ontology) {
  base::Hasher hasher;
  for (const auto& [name, qualified] : ontology->qualified_) {
    hasher.Add(name);
    hasher.Add(qualified);
  }
  for (const std::uint64_t word : ontology->is_a_) hasher.Add(word);
  for (const auto& [name, relation] : ontology->relations_) {
    hasher.Add(name);
    hasher.Add(static_cast<std::uint64_t>(relation.domain.size()));
    for (const ConceptId id : relation.domain) hasher.Add(static_cast<std::uint64_t>(id));
    hasher.Add(relation.range);
    hasher.Add(static_cast<std::uint64_t>(relation.functional));
  }
  ontology->hash_ = hasher.value();
}

// Errors ------------------------------------------------------------------------------------------

void OntologyBuilder::Fail(Place place, const std::string& what) {
  throw base::ConfigError(fmt::format("{}: {}; line {}", place.document->source, what, place.line));
}

void OntologyBuilder::FailOnSubset(const RdfStatement& statement, Place place) {
  Fail(place,
       fmt::format("{} {} {} is beyond what is read of OWL: owl:Class with rdfs:subClassOf a named "
                   "class; owl:ObjectProperty, owl:DatatypeProperty, owl:FunctionalProperty with "
                   "rdfs:domain (or owl:unionOf named classes) and rdfs:range; labels and comments",
                   ReadableNode(statement.subject), Readable(statement.predicate),
                   ReadableNode(statement.object)));
}

void OntologyBuilder::FailOnSameName(const Term& known, const Term& other) {
  const std::string before =
      known.place.document == nullptr
          ? "of OWL itself"
          : fmt::format("{}, line {}", known.place.document->source, known.place.line);
  Fail(other.place,
       fmt::format("{} and {} ({}) share a name; fluents name concepts and relations by their last "
                   "part alone, so call one of them something else",
                   other.qualified, known.qualified, before));
}

void OntologyBuilder::FailOnKindOfRange(const RelationTerm& relation, const RdfNode& range,
                                        Place place) {
  const bool is_link = relation.is_link.value_or(true);
  Fail(place,
       fmt::format("relation {} is an owl:{}, its range {} does not fit that; wanted {}",
                   relation.qualified, is_link ? "ObjectProperty" : "DatatypeProperty",
                   ReadableNode(range), is_link ? "a concept" : "a type of values, xsd:float"));
}

/// A class that is still open has a superclass that is: following those must end in a cycle.
void OntologyBuilder::FailOnCycle(const std::map<std::string, std::size_t>& open) const {
  const auto is_open = [&](const Superclass& above) { return open.at(above.name) > 0; };
  const auto first =
      std::find_if(open.begin(), open.end(), [](const auto& entry) { return entry.second > 0; });
  std::vector<std::string> way{first->first};
  while (true) {
    const std::vector<Superclass>& above = concepts_.at(way.back()).above;
    const Superclass& next = *std::find_if(above.begin(), above.end(), is_open);
    const auto seen = std::find(way.begin(), way.end(), next.name);
    if (seen != way.end()) {
      Fail(next.place, fmt::format("a concept is below itself: {} -> {}; take one rdfs:subClassOf "
                                   "of these away",
                                   fmt::join(seen, way.end(), " -> "), next.name));
    }
    way.push_back(next.name);
  }
}

}  // namespace hires::knowledge
