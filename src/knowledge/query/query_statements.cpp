#include "knowledge/query/query_statements.h"

#include <fmt/format.h>

#include <string>

#include "knowledge/store/store_schema.h"
#include "knowledge/store/store_validity.h"

namespace hires::knowledge {
namespace {

const std::string kEntry = "SELECT v.id, v.instance, v.world, v.concept, v.start_earliest FROM ";
const std::string kAll = std::string("SELECT") + kValidityColumns + "FROM validity ";

}  // namespace

QueryStatements::QueryStatements(StoreFile* file)
    : window(file->database(),
             kEntry +
                 "validity AS v INDEXED BY validity_when WHERE world = ? AND level = ? "
                 "AND start_earliest >= ? AND start_earliest <= ? AND finish_latest > ?"),
      open_of_concept(file->database(),
                      kEntry + fmt::format("validity AS v INDEXED BY validity_open "
                                           "WHERE level = {} AND concept = ? "
                                           "AND world BETWEEN ? AND ?",
                                           kLevelOpen)),
      open_filler(file->database(),
                  kEntry +
                      "open_filler AS f CROSS JOIN validity AS v ON v.id = f.validity "
                      "WHERE f.hash = ? AND f.world BETWEEN ? AND ?"),
      replaced(file->database(),
               kEntry +
                   "validity AS later CROSS JOIN validity AS v ON v.id = later.previous "
                   "WHERE later.id > ? AND later.updated = 1"),
      removed(file->database(), kEntry +
                                    "removal AS r CROSS JOIN validity AS v ON v.id = r.validity "
                                    "WHERE r.sequence > ?"),
      filler(file->database(), kEntry +
                                   "filler AS f CROSS JOIN validity AS v ON v.id = f.validity "
                                   "WHERE f.hash = ?"),
      episode(file->database(), kEntry + "validity AS v WHERE episode = ? AND episode <> 0"),
      stretch(file->database(),
              kAll +
                  "WHERE instance = ? AND world = ? AND (start_earliest, id) > (?, ?) "
                  "AND start_earliest <= ? ORDER BY start_earliest, id"),
      newest(file->database(), kAll +
                                   "WHERE instance = ? AND world = ? AND id <= ? "
                                   "ORDER BY start_earliest DESC, id DESC LIMIT 1"),
      levels(file->database(), "SELECT min(level) FROM validity WHERE world = ? AND level > ?"),
      of_concept(file->database(), "SELECT instance FROM instance_concept WHERE concept = ?"),
      instances(file->database(), "SELECT id, name FROM instance WHERE name >= ? ORDER BY name"),
      worlds(file->database(), "SELECT min(world) FROM validity WHERE instance = ? AND world >= ?"),
      reach(file->database(),
            "SELECT start_earliest, id, ended_before FROM validity WHERE instance = ? "
            "AND world = ? AND start_earliest <= ? AND id <= ? "
            "ORDER BY start_earliest DESC, id DESC") {}

IndexEntry ReadIndexEntry(Rows* rows) {
  return {rows->Integer(0), rows->Integer(1), rows->Integer(2), rows->Integer(3), rows->Real(4)};
}

}  // namespace hires::knowledge
