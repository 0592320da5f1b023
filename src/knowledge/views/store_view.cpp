#include "knowledge/views/store_view.h"

#include <utility>

#include "hires/base/text.h"
#include "knowledge/fluents/store_check.h"

namespace hires::knowledge {
namespace {

// Every page begins with a search for a short cut; with fewer pages there are fewer of them.
constexpr std::size_t kPageSize = 20'000;

}  // namespace

void StoreView::Remember(const Change& change) {
  std::optional<Fluent>& place = found_[base::ToLower(change.fluent.instance)];
  place.reset();
  if (change.kind != Change::Kind::kRemoved) place = change.fluent;
}

const Fluent* StoreView::Find(const std::string& instance) const {
  const auto [place, is_new] = found_.try_emplace(base::ToLower(instance));
  if (is_new) place->second = store_.Find(instance);
  return place->second ? &*place->second : nullptr;
}

void StoreView::OfConcept(const std::string& concept_name,
                          const std::function<bool(const Fluent&)>& visit) const {
  FluentQuery query;
  query.concepts = {{concept_name, FluentQuery::ConceptFilter::Reach::kExact}};
  ForEach(std::move(query), visit);
}

void StoreView::All(const std::function<bool(const Fluent&)>& visit) const { ForEach({}, visit); }

void StoreView::WithFiller(const std::string& role, const Filler& filler,
                           const std::function<bool(const Fluent&)>& visit) const {
  const Ontology::Relation* relation = store_.ontology().FindRelation(role);
  if (relation != nullptr && !CanHave(*relation, filler)) return;  // a query would be refused
  FluentQuery query;
  query.properties = {{role, filler}};
  ForEach(std::move(query), visit);
}

void StoreView::ForEach(FluentQuery query, const std::function<bool(const Fluent&)>& visit) const {
  query.limit = kPageSize;
  do {
    const FluentPage page = store_.Query(query);
    for (const Fluent& fluent : page.fluents) {
      if (!visit(fluent)) return;
    }
    query.cursor = page.next;
  } while (!query.cursor.empty());
}

}  // namespace hires::knowledge
