#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/store.h"
#include "knowledge/store/store_parts.h"

namespace hires::knowledge {

/// Reads a store's changes and single fluents.
class StoreReader {
 public:
  explicit StoreReader(StoreParts* parts);

  std::int64_t LastSequence();
  std::optional<Fluent> Find(const std::string& instance);
  std::vector<Change> ChangesSince(std::int64_t sequence, std::size_t limit);
  Store::Statistics Stats();

 private:
  Change OpeningOf(const Validity& validity);
  Change RemovalOf(Rows* removal);

  StoreParts* parts_;
  SQLite::Statement last_, opened_, removed_, counts_;
};

}  // namespace hires::knowledge
