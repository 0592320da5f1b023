#include "knowledge/store/store_parts.h"

#include "knowledge/store/store_codec.h"

namespace hires::knowledge {

Fluent ToFluent(const Validity& validity, std::int64_t as_of, StoreParts* parts) {
  Fluent fluent;
  fluent.concept_name = parts->words.Text(validity.concept_id);
  fluent.instance = parts->instances.Name(validity.instance);
  fluent.properties = DecodeProperties(validity.properties, &parts->words);
  fluent.start = validity.start;
  fluent.finish = validity.closed > as_of ? validity.given : validity.finish;
  return fluent;
}

}  // namespace hires::knowledge
