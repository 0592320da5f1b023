#include "knowledge/views/demand_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

using ConceptId = Ontology::ConceptId;
using Reach = FluentQuery::ConceptFilter::Reach;

bool HasRole(const Fluent& fluent, const std::string& role) {
  return std::any_of(fluent.properties.begin(), fluent.properties.end(),
                     [&](const Property& property) { return property.role == role; });
}

void ForEachPattern(const sparql::Group& group,
                    const std::function<void(const sparql::Pattern&)>& visit) {
  for (const sparql::Element& element : group.elements) {
    if (!element.IsUnion()) visit(element.pattern);
    for (const sparql::Group& inner : element.alternatives) ForEachPattern(inner, visit);
  }
}

/// A world of one fluent, for queries that look at nothing else.
class SingleView : public FluentView {
 public:
  explicit SingleView(const Fluent& fluent)
      : fluent_(fluent), key_(base::ToLower(fluent.instance)) {}

  const Fluent* Find(const std::string& instance) const override {
    return base::ToLower(instance) == key_ ? &fluent_ : nullptr;
  }
  void OfConcept(const std::string& concept_name,
                 const std::function<bool(const Fluent&)>& visit) const override {
    if (fluent_.concept_name == concept_name) visit(fluent_);
  }
  void All(const std::function<bool(const Fluent&)>& visit) const override { visit(fluent_); }
  void WithFiller(const std::string& role, const Filler& /*filler*/,
                  const std::function<bool(const Fluent&)>& visit) const override {
    if (HasRole(fluent_, role)) visit(fluent_);  // the query looks at the filler itself
  }

 private:
  const Fluent& fluent_;
  std::string key_;
};

}  // namespace

FluentFilter::FluentFilter(const DemandTopic& topic, const Ontology& ontology) {
  query_.all_properties = topic.all_properties;
  ReadConcepts(topic, ontology);
  ReadProperties(topic, ontology);
  is_given_ = !query_.concepts.empty() || !query_.properties.empty();
}

void FluentFilter::ReadConcepts(const DemandTopic& topic, const Ontology& ontology) {
  std::set<ConceptId> passing;
  const auto read = [&](const std::vector<std::string>& names, Reach reach) {
    for (const std::string& name : names) {
      const ConceptId concept_id = ontology.Require(name);
      query_.concepts.push_back({name, reach});
      passing.insert(concept_id);
      if (reach == Reach::kExact) continue;
      const auto& more =
          reach == Reach::kBelow ? ontology.Below(concept_id) : ontology.Above(concept_id);
      passing.insert(more.begin(), more.end());
    }
  };
  read(topic.exact, Reach::kExact);
  read(topic.below, Reach::kBelow);
  read(topic.above, Reach::kAbove);
  concepts_.assign(ontology.num_concepts(), query_.concepts.empty());
  for (const ConceptId concept_id : passing) concepts_[concept_id] = true;
}

void FluentFilter::ReadProperties(const DemandTopic& topic, const Ontology& ontology) {
  for (const std::string& role : topic.properties) {
    if (ontology.FindRelation(role) == nullptr) {
      throw base::ConfigError(base::UnknownName("relation", role, ontology.RelationNames()));
    }
    query_.properties.push_back({role, std::nullopt});
  }
}

bool FluentFilter::Matches(const Fluent& fluent, ConceptId concept_id) const {
  return is_given_ && concept_id < concepts_.size() && concepts_[concept_id] &&
         HasProperties(fluent);
}

bool FluentFilter::HasProperties(const Fluent& fluent) const {
  const auto has = [&](const FluentQuery::PropertyFilter& filter) {
    return HasRole(fluent, filter.role);
  };
  const auto& wanted = query_.properties;
  if (wanted.empty() || query_.all_properties)
    return std::all_of(wanted.begin(), wanted.end(), has);
  return std::any_of(wanted.begin(), wanted.end(), has);
}

QueryFilter::QueryFilter(const std::string& text, std::shared_ptr<const Ontology> ontology)
    : ontology_(std::move(ontology)),
      engine_(std::make_unique<sparql::Engine>(text, ontology_)),
      reach_(sparql::FindReach(engine_->query())) {
  const sparql::Query& query = engine_->query();
  const auto root = static_cast<std::size_t>(query.root());
  if (query.kinds[root] != sparql::Kind::kInstance) {
    throw base::ConfigError(fmt::format(
        "query: came {} as the first selected variable, which stands for concepts or values; "
        "wanted one that stands for instances",
        query.variables[root]));
  }
  ForEachPattern(query.where, [&](const sparql::Pattern& pattern) {
    asks_roles_ = asks_roles_ || pattern.verb == sparql::Pattern::Verb::kRole;
  });
  may_.resize(query.variables.size());
}

bool QueryFilter::MayBe(int variable, ConceptId concept_id) const {
  if (concept_id >= ontology_->num_concepts()) return false;
  std::vector<May>& concepts = may_[static_cast<std::size_t>(variable)];
  concepts.resize(ontology_->num_concepts(), May::kUnknown);
  May& may = concepts[concept_id];
  if (may == May::kUnknown) may = AskWhetherItMayBe(variable, concept_id);
  return may == May::kYes;
}

QueryFilter::May QueryFilter::AskWhetherItMayBe(int variable, ConceptId concept_id) const {
  try {
    return engine_->MayBe(variable, concept_id) ? May::kYes : May::kNo;
  } catch (const base::ConfigError&) {
    return May::kYes;  // too many rows without the properties; with them they may be few
  }
}

bool QueryFilter::Matches(const Fluent& fluent, ConceptId concept_id,
                          const FluentView& view) const {
  if (!MayBe(engine_->query().root(), concept_id)) return false;
  if (!reach_.is_local) return engine_->Accepts(view, fluent.instance);
  return !asks_roles_ || engine_->Accepts(SingleView(fluent), fluent.instance);
}

bool QueryFilter::IsPart(const Fluent& fluent, const std::string& key) const {
  const auto has_all = [&](const std::vector<std::string>& roles) {
    return std::all_of(roles.begin(), roles.end(),
                       [&](const std::string& role) { return HasRole(fluent, role); });
  };
  const ConceptId concept_id = ontology_->Find(fluent.concept_name);
  return std::any_of(reach_.parts.begin(), reach_.parts.end(), [&](const sparql::Part& part) {
    const bool fits =
        part.variable == sparql::kNoVariable ? part.key == key : MayBe(part.variable, concept_id);
    return fits && std::any_of(part.roles.begin(), part.roles.end(), has_all);
  });
}

void QueryFilter::FindParts(const FluentView& view) {
  parts_.clear();
  const auto note = [&](const Fluent& fluent) {
    const std::string key = base::ToLower(fluent.instance);
    if (IsPart(fluent, key)) parts_.insert(key);
    return true;
  };
  for (const sparql::Part& part : reach_.parts) {
    const Fluent* constant = part.key.empty() ? nullptr : view.Find(part.key);
    if (constant != nullptr) note(*constant);
    if (part.variable == sparql::kNoVariable) continue;
    for (ConceptId id = 0; id < ontology_->num_concepts(); ++id) {
      if (MayBe(part.variable, id)) view.OfConcept(ontology_->Name(id), note);
    }
  }
}

bool QueryFilter::NoticePart(const Change& change) {
  if (reach_.parts.empty()) return false;
  const std::string key = base::ToLower(change.fluent.instance);
  const bool was = parts_.erase(key) > 0;
  const bool is = change.kind != Change::Kind::kRemoved && IsPart(change.fluent, key);
  if (is) parts_.insert(key);
  return was || is;
}

}  // namespace hires::knowledge
