#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <string>

namespace hires::knowledge {

constexpr int kApplicationId = 0x48495245;  ///< "HIRE", in the header of SQLite's file

/// The schema this program writes. Older files are brought up to it, newer ones refused.
constexpr int kStoreSchema = 4;

/// Levels of validities in the index by time, see docs/notes_blackboard.md. A closed validity that
/// lasts at least 2^(n-1) and less than 2^n seconds has level n.
constexpr int kLevelSinceEver = 5000;  ///< closed, without a beginning
constexpr int kLevelOpen = 6000;       ///< not closed
/// `closed` of a validity that is not.
constexpr std::int64_t kNotClosed = 0x7fffffffffffffff;

/// Checks that the file is a store (or empty) and brings its schema up to date, each step in one
/// transaction.  @throws ConfigError naming `path`: another program's file, a newer schema; with
///   `read_only` also an older one or an empty file.
void PrepareSchema(const std::string& path, bool read_only, SQLite::Database* database);

}  // namespace hires::knowledge
