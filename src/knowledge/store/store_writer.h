#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hires/knowledge/store.h"
#include "knowledge/store/store_parts.h"

namespace hires::knowledge {

/// Writes fluents. Every call is part of a transaction that its caller opens, and undoes if one of
/// them throws.
class StoreWriter {
 public:
  StoreWriter(StoreParts* parts, std::shared_ptr<const Ontology> ontology);

  /// @param last  Sequence number of the last change before; counted on with every new one.
  std::vector<Change> Add(const std::vector<Fluent>& fluents, const Assertion& by,
                          std::uint64_t* last);
  std::vector<Change> Update(const std::vector<Fluent>& fluents, const Assertion& by,
                             std::uint64_t* last);
  std::vector<Change> Remove(const std::vector<std::string>& instances, const Assertion& by,
                             std::uint64_t* last);

 private:
  struct Writing;
  Writing Begin(const Assertion& by, std::uint64_t* last);
  void Put(const Fluent& fluent, Writing* writing);
  void Merge(const Fluent& fluent, Writing* writing);
  void End(const std::string& instance, Writing* writing);
  void Open(const Fluent& fluent, Validity validity, const Validity* before, Writing* writing);
  Validity RequireOpen(const std::string& instance, const Writing& writing);
  void CheckHolder(const std::string& instance, const Validity& open, const Writing& writing);
  void IndexFillers(const std::vector<Property>& properties, const Validity& opened);
  void Close(const Validity& ended);

  StoreParts* parts_;
  std::shared_ptr<const Ontology> ontology_;
  SQLite::Statement concept_, filler_, open_filler_, closed_filler_, removal_;
};

}  // namespace hires::knowledge
