#include "hires/knowledge/ontology.h"

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/keys.h"
#include "hires/base/text.h"
#include "knowledge/ontology/ontology_builder.h"
#include "knowledge/ontology/ontology_rdf.h"

namespace hires::knowledge {
namespace {

/// Names come from anywhere, and a message must stay readable (and cheap: the nearest names are
/// found letter by letter).
std::string Shortened(std::string_view name) {
  constexpr std::size_t kMaxShown = 80;
  if (name.size() <= kMaxShown) return std::string(name);
  return std::string(name.substr(0, kMaxShown)) + "...";
}

}  // namespace

Ontology Ontology::FromFiles(const std::vector<std::string>& paths) {
  if (paths.empty()) throw base::ConfigError("no ontology is given; name at least one Turtle file");
  std::vector<RdfDocument> documents;
  documents.reserve(paths.size());
  for (const std::string& path : paths) {
    documents.push_back(ReadRdf(base::ReadTextFile(path, kMaxRdfBytes), path));
  }
  return OntologyBuilder(std::move(documents)).Build();
}

Ontology Ontology::FromText(std::string_view text, const std::string& source) {
  std::vector<RdfDocument> documents;
  documents.push_back(ReadRdf(text, source));
  return OntologyBuilder(std::move(documents)).Build();
}

Ontology::ConceptId Ontology::Find(std::string_view name) const {
  const auto found = ids_.find(name);
  return found == ids_.end() ? kUnknown : found->second;
}

Ontology::ConceptId Ontology::Require(std::string_view name) const {
  const ConceptId id = Find(name);
  if (id != kUnknown) return id;
  throw base::ConfigError(base::UnknownName("concept", Shortened(name), ConceptNames()));
}

const std::string& Ontology::Name(ConceptId id) const {
  HIRES_CHECK(id < concepts_.size(), "no such concept");
  return concepts_[id].name;
}

std::size_t Ontology::num_concepts() const { return concepts_.size(); }

bool Ontology::IsA(ConceptId below, ConceptId above) const {
  HIRES_CHECK(below < concepts_.size() && above < concepts_.size(), "no such concept");
  return (is_a_[below * words_per_row_ + above / 64] >> (above % 64) & 1u) != 0;
}

const std::vector<Ontology::ConceptId>& Ontology::Below(ConceptId id) const {
  HIRES_CHECK(id < concepts_.size(), "no such concept");
  return concepts_[id].below;
}

const std::vector<Ontology::ConceptId>& Ontology::Above(ConceptId id) const {
  HIRES_CHECK(id < concepts_.size(), "no such concept");
  return concepts_[id].above;
}

const Ontology::Relation* Ontology::FindRelation(std::string_view name) const {
  const auto found = relations_.find(name);
  return found == relations_.end() ? nullptr : &found->second;
}

std::vector<std::string> Ontology::ConceptNames() const { return base::KeysOf(ids_); }

std::vector<std::string> Ontology::RelationNames() const { return base::KeysOf(relations_); }

std::string Ontology::Qualified(std::string_view name) const {
  const auto found = qualified_.find(name);
  if (found != qualified_.end()) return found->second;
  throw base::ConfigError(
      base::UnknownName("concept or relation", Shortened(name), base::KeysOf(qualified_)));
}

std::uint64_t Ontology::hash() const { return hash_; }

}  // namespace hires::knowledge
