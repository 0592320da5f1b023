#include "knowledge/store/store_validity.h"

#include <cmath>

namespace hires::knowledge {
namespace {

std::optional<double> UnlessForEver(const temporal::Bounds& given, double end) {
  const temporal::Bounds for_ever{temporal::kForever, temporal::kForever};
  if (given == for_ever) return std::nullopt;
  return end;
}

}  // namespace

const char* const kValidityColumns =
    " id, instance, world, concept, source, updated, episode, previous, closed, start_earliest,"
    " start_latest, finish_earliest, finish_latest, given_earliest, given_latest, ended_before,"
    " properties ";

std::optional<int> LevelOf(double start, double finish) {
  if (!(start < finish)) return std::nullopt;
  const double duration = finish - start;
  if (!std::isfinite(duration)) return kLevelSinceEver;
  int level = 0;
  std::frexp(duration, &level);
  return level;
}

Validity ReadValidity(Rows* rows) {
  Validity validity;
  validity.id = rows->Integer(0);
  validity.instance = rows->Integer(1);
  validity.world = rows->Integer(2);
  validity.concept_id = rows->Integer(3);
  validity.source = static_cast<Source>(rows->Integer(4));
  validity.updated = rows->Integer(5) != 0;
  validity.episode = rows->Integer(6);
  validity.previous = rows->Integer(7);
  validity.closed = rows->Integer(8);
  validity.start = {rows->Real(9), rows->Real(10)};
  validity.finish = {rows->Real(11), rows->Real(12)};
  validity.given = {temporal::kForever, temporal::kForever};
  if (!rows->IsNull(13)) validity.given = {rows->Real(13), rows->Real(14)};
  validity.ended_before = rows->Real(15);
  validity.properties = rows->Text(16);
  return validity;
}

Validities::Validities(StoreFile* file)
    : insert_(file->database(),
              std::string("INSERT INTO validity(") + kValidityColumns +
                  ", level) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      close_(file->database(),
             "UPDATE validity SET closed = ?, finish_earliest = ?, finish_latest = ?, level = ? "
             "WHERE id = ?"),
      last_(file->database(), std::string("SELECT") + kValidityColumns +
                                  "FROM validity WHERE instance = ? AND world = ? "
                                  "ORDER BY start_earliest DESC, id DESC LIMIT 1"),
      find_(file->database(),
            std::string("SELECT") + kValidityColumns + "FROM validity WHERE id = ?") {}

void Validities::Insert(const Validity& v) {
  Rows(insert_, v.id, v.instance, v.world, v.concept_id, static_cast<int>(v.source), v.updated,
       v.episode, v.previous, v.closed, v.start.earliest, v.start.latest, v.finish.earliest,
       v.finish.latest, UnlessForEver(v.given, v.given.earliest),
       UnlessForEver(v.given, v.given.latest), v.ended_before, Blob{v.properties}, kLevelOpen)
      .Run();
}

void Validities::Close(const Validity& v) {
  Rows(close_, v.closed, v.finish.earliest, v.finish.latest,
       LevelOf(v.start.earliest, v.finish.latest), v.id)
      .Run();
}

std::optional<Validity> Validities::Last(std::int64_t instance, std::int64_t world) {
  Rows rows(last_, instance, world);
  if (!rows.Next()) return std::nullopt;
  return ReadValidity(&rows);
}

std::optional<Validity> Validities::Find(std::int64_t id) {
  Rows rows(find_, id);
  if (!rows.Next()) return std::nullopt;
  return ReadValidity(&rows);
}

}  // namespace hires::knowledge
