#pragma once

#include <cstdint>
#include <string>

#include "hires/knowledge/query.h"
#include "knowledge/query/query_conditions.h"
#include "knowledge/query/query_cursor.h"

namespace hires::knowledge {

/// Fills one page with what matches, in the order in which validities are offered to it.
class PageBuilder {
 public:
  PageBuilder(const QueryConditions& conditions, StoreParts* parts);

  /// @param name  of the validity's instance.
  /// @return False if it matches and the page is full: then the page has a cursor to go on from.
  bool Offer(const Validity& validity, const std::string& name);
  /// Rows that were looked at elsewhere for this page.
  void AddVisited(std::uint64_t rows) { page_.visited += rows; }
  FluentPage Take() { return std::move(page_); }

 private:
  const QueryConditions& conditions_;
  StoreParts* parts_;
  FluentPage page_;
  QueryPosition last_;  // of the page so far
};

}  // namespace hires::knowledge
