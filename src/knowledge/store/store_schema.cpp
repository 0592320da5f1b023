#include "knowledge/store/store_schema.h"

#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <array>

#include "hires/base/error.h"
#include "knowledge/store/store_reasons.h"

namespace hires::knowledge {
namespace {

// Version 1. Rows of `validity` are only ever appended; their end is written once, over
// placeholders of at least its size, so that no page overflows.
constexpr const char* kTables = R"sql(
CREATE TABLE word(          -- concepts, relations, types of values
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE);
CREATE TABLE instance(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE COLLATE NOCASE);
CREATE TABLE instance_concept(  -- which concepts an instance ever had
  concept INTEGER NOT NULL,
  instance INTEGER NOT NULL,
  PRIMARY KEY(concept, instance)) WITHOUT ROWID;
CREATE TABLE validity(
  id INTEGER PRIMARY KEY,           -- sequence number of the change that opened it
  instance INTEGER NOT NULL,
  world INTEGER NOT NULL,           -- 0 the real one, else the imagined episode
  concept INTEGER NOT NULL,
  source INTEGER NOT NULL,
  updated INTEGER NOT NULL,         -- 1: it took the place of `previous`
  episode INTEGER NOT NULL,
  previous INTEGER NOT NULL,        -- validity of the same instance and world before, or 0
  closed INTEGER NOT NULL,          -- sequence number of the change that ended it, or 2^63 - 1
  level INTEGER,                    -- of the index by time; NULL: holds at no time
  start_earliest REAL NOT NULL,
  start_latest REAL NOT NULL,
  finish_earliest REAL NOT NULL,    -- as it stands: as given, or since when it is closed
  finish_latest REAL NOT NULL,
  given_earliest REAL,              -- finish as given; NULL: for ever
  given_latest REAL,
  ended_before REAL NOT NULL,       -- latest finish of all earlier validities of the same instance
  properties BLOB NOT NULL);
CREATE INDEX validity_of ON validity(instance, world, start_earliest);
CREATE INDEX validity_when ON
  validity(world, level, start_earliest, finish_latest, instance, concept);
CREATE TABLE removal(
  sequence INTEGER PRIMARY KEY,
  validity INTEGER NOT NULL,
  time REAL NOT NULL,
  episode INTEGER NOT NULL,
  source INTEGER NOT NULL);
CREATE TABLE filler(        -- validities by hash of role and text
  hash INTEGER NOT NULL,
  validity INTEGER NOT NULL,
  PRIMARY KEY(hash, validity)) WITHOUT ROWID;
CREATE TABLE episode(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  task TEXT NOT NULL,
  outcome TEXT NOT NULL,
  imagined INTEGER NOT NULL,
  parent INTEGER NOT NULL,
  start REAL NOT NULL,
  finish REAL NOT NULL);
)sql";

// Version 2: an episode is found and written out without reading all the others.
constexpr const char* kEpisodeIndex =
    "CREATE INDEX validity_in ON validity(episode, id) WHERE episode <> 0;";

// Version 3: what is open is found without looking at what ended. Level 6000 is kLevelOpen, the
// other number kNotClosed.
constexpr const char* kOpenIndexes = R"sql(
CREATE TABLE open_filler(   -- as `filler`, of open validities only
  hash INTEGER NOT NULL,
  world INTEGER NOT NULL,
  validity INTEGER NOT NULL,
  PRIMARY KEY(hash, world, validity)) WITHOUT ROWID;
INSERT INTO open_filler
  SELECT f.hash, v.world, v.id FROM filler AS f CROSS JOIN validity AS v ON v.id = f.validity
  WHERE v.closed = 9223372036854775807;
CREATE INDEX validity_open ON validity(concept, world, instance, start_earliest, level)
  WHERE level = 6000;       -- level is in it so that no row is read for it
)sql";
static_assert(kLevelOpen == 6000 && kNotClosed == 9223372036854775807, "as in kOpenIndexes");

using Step = void (*)(SQLite::Database&);
/// What brings schema i to i + 1. Version 4 has the tables of version 3.
constexpr std::array<Step, kStoreSchema> kSteps = {
    [](SQLite::Database& database) { database.exec(kTables); },
    [](SQLite::Database& database) { database.exec(kEpisodeIndex); },
    [](SQLite::Database& database) { database.exec(kOpenIndexes); },
    [](SQLite::Database& database) { ReasonMigration(&database).Run(); }};

int Number(SQLite::Database& database, const char* query) {
  return database.execAndGet(query).getInt();
}

bool IsEmpty(SQLite::Database& database) {
  return Number(database, "SELECT count(*) FROM sqlite_master") == 0 &&
         Number(database, "PRAGMA user_version") == 0;
}

void RequireStore(const std::string& path, SQLite::Database& database) {
  if (Number(database, "PRAGMA application_id") == kApplicationId) return;
  if (IsEmpty(database)) return;
  throw base::ConfigError(fmt::format(
      "{}: is a file of SQLite, but no Blackboard store; name another file, or move it away",
      path));
}

void RequireKnownSchema(const std::string& path, int schema) {
  if (schema <= kStoreSchema) return;
  throw base::ConfigError(
      fmt::format("{}: has schema {}, this program knows up to {}; use the newer program that "
                  "wrote it, or another file",
                  path, schema, kStoreSchema));
}

void RequireCurrentSchema(const std::string& path, int schema) {
  if (schema == kStoreSchema) return;
  throw base::ConfigError(
      fmt::format("{}: {}; open it once for writing to bring it up to schema {}", path,
                  schema == 0 ? "is empty" : fmt::format("has schema {}", schema), kStoreSchema));
}

void TakeStep(int schema, SQLite::Database& database) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  kSteps.at(static_cast<std::size_t>(schema))(database);
  database.exec(fmt::format("PRAGMA application_id = {}", kApplicationId));
  database.exec(fmt::format("PRAGMA user_version = {}", schema + 1));
  transaction.commit();
}

}  // namespace

void PrepareSchema(const std::string& path, bool read_only, SQLite::Database* database) {
  RequireStore(path, *database);
  const int schema = Number(*database, "PRAGMA user_version");
  RequireKnownSchema(path, schema);
  if (read_only) return RequireCurrentSchema(path, schema);
  for (int step = schema; step < kStoreSchema; ++step) TakeStep(step, *database);
}

}  // namespace hires::knowledge
