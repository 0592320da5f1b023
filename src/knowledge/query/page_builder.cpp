#include "knowledge/query/page_builder.h"

#include <utility>

namespace hires::knowledge {

PageBuilder::PageBuilder(const QueryConditions& conditions, StoreParts* parts)
    : conditions_(conditions), parts_(parts) {
  page_.sequence = static_cast<std::uint64_t>(conditions.as_of());
}

bool PageBuilder::Offer(const Validity& validity, const std::string& name) {
  ++page_.visited;
  if (!conditions_.Fits(validity)) return true;
  Fluent fluent = ToFluent(validity, conditions_.as_of(), parts_);
  if (!conditions_.FitsProperties(fluent)) return true;
  if (page_.fluents.size() == conditions_.query().limit) {
    page_.next = ToString(QueryCursor{conditions_.as_of(), last_});
    return false;
  }
  last_ = {name, validity.world, validity.start.earliest, validity.id};
  page_.fluents.push_back(std::move(fluent));
  return true;
}

}  // namespace hires::knowledge
