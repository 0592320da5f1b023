#include "hires/execution/record_fluent.h"

#include <cmath>
#include <utility>

#include "hires/base/text.h"
#include "hires/knowledge/name.h"

namespace hires::execution {
namespace {

std::string RangeOf(const std::string& role, const std::string& otherwise,
                    const knowledge::Ontology& ontology) {
  const knowledge::Ontology::Relation* relation = ontology.FindRelation(role);
  return relation == nullptr ? otherwise : relation->range;
}

knowledge::Property NumberProperty(const std::string& role, double value,
                                   const knowledge::Ontology& ontology) {
  const std::string type = RangeOf(role, "xsd:double", ontology);
  if (type == "xsd:integer" || type == "xsd:int") return {role, type, std::llround(value)};
  if (type == "xsd:boolean") return {role, type, value != 0.0};
  return {role, type, value};
}

}  // namespace

knowledge::Fluent FluentOf(const Record& record, double start,
                           const knowledge::Ontology& ontology) {
  knowledge::Fluent fluent;
  const bool is_known = record.general_concept.empty() ||
                        ontology.Find(record.concept_name) != knowledge::Ontology::kUnknown;
  fluent.concept_name = is_known ? record.concept_name : record.general_concept;
  fluent.instance = record.instance;
  fluent.start = {start, start};
  for (const auto& [role, text] : record.texts) {
    fluent.properties.push_back({role, "xsd:string", text});
  }
  for (const auto& [role, number] : record.numbers) {
    fluent.properties.push_back(NumberProperty(role, number, ontology));
  }
  for (const auto& [role, instance] : record.links) {
    fluent.properties.push_back({role, RangeOf(role, "Thing", ontology), instance});
  }
  return fluent;
}

std::string EpisodeOutcome(const std::string& outcome, const std::string& reason) {
  return knowledge::AsName(reason.empty() ? outcome : outcome + ": " + reason);
}

void EpisodeRecords::Begin(const std::string& name) {
  name_ = name;
  begun_.clear();
}

RecordWrites EpisodeRecords::WritesOf(const Record& record, double time,
                                      const knowledge::Ontology& ontology) {
  const std::string key = base::ToLower(record.instance);
  RecordWrites writes;
  if (record.kind == Record::Kind::kBegin) {
    begun_[key] = time;
    writes.added = FluentOf(record, time, ontology);
    writes.added->properties.push_back({"hasEpisode", "xsd:string", name_});
    return writes;
  }
  const auto begun = begun_.find(key);
  const double start = begun == begun_.end() ? time : begun->second;
  knowledge::Fluent fluent = FluentOf(record, start, ontology);
  if (!fluent.properties.empty()) writes.updated = std::move(fluent);
  if (record.kind == Record::Kind::kEnd) writes.ended = record.instance;
  return writes;
}

void EpisodeRecords::Forget(const std::string& instance) { begun_.erase(base::ToLower(instance)); }

}  // namespace hires::execution
