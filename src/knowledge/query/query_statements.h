#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>

#include "knowledge/store/store_file.h"

namespace hires::knowledge {

/// What an index tells about a validity without its row being read.
struct IndexEntry {
  std::int64_t id{0}, instance{0}, world{0}, concept_id{0};
  double start{0.0};  ///< [s] start.earliest
};

/// Statements that queries use.
struct QueryStatements {
  explicit QueryStatements(StoreFile* file);

  /// Each row is an IndexEntry.
  SQLite::Statement window, open_of_concept, open_filler, replaced, removed, filler, episode;
  /// Each row is a validity.
  SQLite::Statement stretch, newest;
  SQLite::Statement levels, of_concept, instances, worlds, reach;
};

IndexEntry ReadIndexEntry(Rows* rows);

}  // namespace hires::knowledge
