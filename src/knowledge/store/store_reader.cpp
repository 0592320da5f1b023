#include "knowledge/store/store_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "knowledge/store/store_error.h"

namespace hires::knowledge {
namespace {

Episode::Label LabelOf(std::int64_t world) {
  return world == 0 ? Episode::Label::kReal : Episode::Label::kImagined;
}

}  // namespace

StoreReader::StoreReader(StoreParts* parts)
    : parts_(parts),
      last_(parts->file->database(),
            "SELECT max((SELECT ifnull(max(id), 0) FROM validity), "
            "(SELECT ifnull(max(sequence), 0) FROM removal))"),
      opened_(parts->file->database(),
              std::string("SELECT") + kValidityColumns + "FROM validity WHERE id > ? ORDER BY id"),
      removed_(parts->file->database(),
               "SELECT sequence, validity, time, episode, source FROM removal "
               "WHERE sequence > ? ORDER BY sequence"),
      counts_(parts->file->database(),
              "SELECT (SELECT count(*) FROM removal), (SELECT ifnull(max(id), 0) FROM instance), "
              "(SELECT count(*) FROM episode)") {}

std::int64_t StoreReader::LastSequence() {
  Rows rows(last_);
  rows.Next();
  return rows.Integer(0);
}

std::optional<Fluent> StoreReader::Find(const std::string& instance) {
  const auto named = parts_->instances.Find(instance);
  if (!named) return std::nullopt;
  const auto last = parts_->validities.Last(named->id, 0);
  if (!last || !last->IsOpen()) return std::nullopt;
  return ToFluent(*last, last->id, parts_);
}

Change StoreReader::OpeningOf(const Validity& validity) {
  Change change;
  change.sequence = static_cast<std::uint64_t>(validity.id);
  change.kind = validity.updated ? Change::Kind::kUpdated : Change::Kind::kAdded;
  change.fluent = ToFluent(validity, validity.id, parts_);
  change.time = validity.start.earliest;
  change.episode = validity.episode;
  change.label = LabelOf(validity.world);
  change.source = validity.source;
  return change;
}

Change StoreReader::RemovalOf(Rows* removal) {
  const auto validity = parts_->validities.Find(removal->Integer(1));
  if (!validity) FailDamaged(fmt::format("change {} ends nothing", removal->Integer(0)));
  Change change;
  change.sequence = static_cast<std::uint64_t>(removal->Integer(0));
  change.kind = Change::Kind::kRemoved;
  change.fluent = ToFluent(*validity, removal->Integer(0), parts_);
  change.time = removal->Real(2);
  change.episode = removal->Integer(3);
  change.label = LabelOf(validity->world);
  change.source = static_cast<Source>(removal->Integer(4));
  return change;
}

std::vector<Change> StoreReader::ChangesSince(std::int64_t sequence, std::size_t limit) {
  std::vector<Change> changes;
  Rows opened(opened_, sequence), removed(removed_, sequence);
  bool more_opened = opened.Next(), more_removed = removed.Next();
  while (changes.size() < limit && (more_opened || more_removed)) {
    if (!more_removed || (more_opened && opened.Integer(0) < removed.Integer(0))) {
      changes.push_back(OpeningOf(ReadValidity(&opened)));
      more_opened = opened.Next();
    } else {
      changes.push_back(RemovalOf(&removed));
      more_removed = removed.Next();
    }
  }
  return changes;
}

Store::Statistics StoreReader::Stats() {
  Rows rows(counts_);
  rows.Next();
  Store::Statistics statistics;
  statistics.changes = static_cast<std::uint64_t>(LastSequence());
  // Every change opens a validity or removes one.
  statistics.fluents = statistics.changes - static_cast<std::uint64_t>(rows.Integer(0));
  statistics.instances = static_cast<std::uint64_t>(rows.Integer(1));
  statistics.episodes = static_cast<std::uint64_t>(rows.Integer(2));
  statistics.bytes = parts_->file->Bytes();
  statistics.schema = kStoreSchema;
  return statistics;
}

}  // namespace hires::knowledge
