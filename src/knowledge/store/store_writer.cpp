#include "knowledge/store/store_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "knowledge/fluents/store_check.h"
#include "knowledge/store/store_codec.h"

namespace hires::knowledge {

/// One call that writes.
struct StoreWriter::Writing {
  Assertion by;
  std::int64_t world{0};
  Episode::Label label{Episode::Label::kReal};
  std::uint64_t* last{nullptr};
  std::vector<Change> changes;

  std::int64_t NextSequence() { return static_cast<std::int64_t>(++*last); }
};

namespace {

constexpr temporal::Bounds kSinceEver{-temporal::kForever, -temporal::kForever};

void CheckTime(double time) {
  if (time < temporal::kForever) return;  // false for NaN as well
  throw base::ConfigError(
      fmt::format("an assertion at {} s; wanted a time, or -infinity for 'since ever'", time));
}

/// When the old validity ends: with the assertion, or before if the new one begins before.
temporal::Bounds EndOfOld(double time, const temporal::Bounds& start) {
  return {std::min(time, start.earliest), std::min(time, start.latest)};
}

/// A validity that had run out by its own bounds keeps them.
temporal::Bounds Closed(const Validity& validity, const temporal::Bounds& end) {
  return end.latest <= validity.finish.latest ? end : validity.finish;
}

[[noreturn]] void FailTooEarly(const std::string& instance, const char* what, double begins,
                               double time) {
  throw base::ConfigError(
      fmt::format("fluent '{}': {} at {} s, which is later than {} s; give a later time", instance,
                  what, begins, time));
}

/// The properties of an update: roles that are given replace their old fillers, in their place;
/// new ones come last.
std::vector<Property> Merged(const std::vector<Property>& old, const std::vector<Property>& given) {
  std::vector<Property> merged;
  std::vector<bool> taken(given.size(), false);
  const auto take = [&](const std::string& role) {
    bool found = false;
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i].role != role) continue;
      found = true;
      if (!taken[i]) merged.push_back(given[i]);
      taken[i] = true;
    }
    return found;
  };
  for (const Property& property : old) {
    if (!take(property.role)) merged.push_back(property);
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!taken[i]) merged.push_back(given[i]);
  }
  return merged;
}

Change MakeChange(Change::Kind kind, const Fluent& fluent, double time, std::int64_t sequence,
                  const Assertion& by, Episode::Label label) {
  Change change;
  change.sequence = static_cast<std::uint64_t>(sequence);
  change.kind = kind;
  change.fluent = fluent;
  change.time = time;
  change.episode = by.episode;
  change.label = label;
  change.source = by.source;
  return change;
}

}  // namespace

StoreWriter::StoreWriter(StoreParts* parts, std::shared_ptr<const Ontology> ontology)
    : parts_(parts),
      ontology_(std::move(ontology)),
      concept_(parts->file->database(),
               "INSERT OR IGNORE INTO instance_concept(concept, instance) VALUES(?, ?)"),
      filler_(parts->file->database(), "INSERT OR IGNORE INTO filler(hash, validity) VALUES(?, ?)"),
      open_filler_(parts->file->database(),
                   "INSERT OR IGNORE INTO open_filler(hash, world, validity) VALUES(?, ?, ?)"),
      closed_filler_(parts->file->database(),
                     "DELETE FROM open_filler WHERE hash = ? AND world = ? AND validity = ?"),
      removal_(parts->file->database(),
               "INSERT INTO removal(sequence, validity, time, episode, source) "
               "VALUES(?, ?, ?, ?, ?)") {}

StoreWriter::Writing StoreWriter::Begin(const Assertion& by, std::uint64_t* last) {
  CheckTime(by.time);
  Writing writing;
  writing.by = by;
  writing.last = last;
  if (by.episode == 0) return writing;
  const Episode episode = parts_->episodes.Require(by.episode);
  if (std::isfinite(episode.finish)) {
    throw base::ConfigError(
        fmt::format("episode {} ({}) finished at {} s; nothing can be written in it any more",
                    episode.id, episode.name, episode.finish));
  }
  writing.label = episode.label;
  if (episode.label == Episode::Label::kImagined) writing.world = episode.id;
  return writing;
}

std::vector<Change> StoreWriter::Add(const std::vector<Fluent>& fluents, const Assertion& by,
                                     std::uint64_t* last) {
  Writing writing = Begin(by, last);
  for (const Fluent& fluent : fluents) Put(fluent, &writing);
  return std::move(writing.changes);
}

std::vector<Change> StoreWriter::Update(const std::vector<Fluent>& fluents, const Assertion& by,
                                        std::uint64_t* last) {
  Writing writing = Begin(by, last);
  for (const Fluent& fluent : fluents) Merge(fluent, &writing);
  return std::move(writing.changes);
}

std::vector<Change> StoreWriter::Remove(const std::vector<std::string>& instances,
                                        const Assertion& by, std::uint64_t* last) {
  Writing writing = Begin(by, last);
  for (const std::string& instance : instances) End(instance, &writing);
  return std::move(writing.changes);
}

Validity StoreWriter::RequireOpen(const std::string& instance, const Writing& writing) {
  CheckName("fluent", instance);
  const auto named = parts_->instances.Find(instance);
  if (named) {
    if (auto last = parts_->validities.Last(named->id, writing.world); last && last->IsOpen()) {
      return *last;
    }
  }
  throw base::ConfigError(fmt::format("fluent '{}': does not hold{}; add it first", instance,
                                      writing.world == 0 ? "" : " in this imagined episode"));
}

/// The monitor may not end what others observed by giving its name to something of its own.
void StoreWriter::CheckHolder(const std::string& instance, const Validity& open,
                              const Writing& writing) {
  Fluent holder;
  holder.instance = instance;
  holder.concept_name = parts_->words.Text(open.concept_id);
  CheckSource(writing.by.source, holder, *ontology_);
}

void StoreWriter::Merge(const Fluent& fluent, Writing* writing) {
  const Validity open = RequireOpen(fluent.instance, *writing);
  Fluent merged = fluent;
  merged.properties = Merged(DecodeProperties(open.properties, &parts_->words), fluent.properties);
  Put(merged, writing);
}

void StoreWriter::Put(const Fluent& given, Writing* writing) {
  CheckFluent(given, *ontology_);
  CheckSource(writing->by.source, given, *ontology_);
  const Instances::Named named = parts_->instances.Intern(given.instance);
  Fluent fluent = given;
  fluent.instance = named.name;
  const double time = writing->by.time;
  if (fluent.start == kSinceEver) fluent.start = {time, time};

  Validity validity;
  validity.instance = named.id;
  validity.concept_id = parts_->words.Intern(fluent.concept_name);
  validity.properties = EncodeProperties(fluent.properties, &parts_->words);
  std::optional<Validity> last = parts_->validities.Last(named.id, writing->world);
  if (!last) return Open(fluent, std::move(validity), nullptr, writing);

  if (last->IsOpen()) {
    CheckHolder(fluent.instance, *last, *writing);
    const bool same = last->concept_id == validity.concept_id && last->given == fluent.finish &&
                      last->properties == validity.properties;
    if (same) return;
    const temporal::Bounds end = EndOfOld(time, fluent.start);
    if (end.earliest < last->start.earliest) {
      FailTooEarly(fluent.instance, "holds, having begun", last->start.earliest, end.earliest);
    }
    last->finish = Closed(*last, end);
    validity.updated = true;
  } else {
    const double end = std::max(last->start.earliest, last->finish.earliest);
    if (fluent.start.earliest < end) {
      FailTooEarly(fluent.instance, "held before, and ended", end, fluent.start.earliest);
    }
  }
  Open(fluent, std::move(validity), &*last, writing);
}

void StoreWriter::Open(const Fluent& fluent, Validity validity, const Validity* before,
                       Writing* writing) {
  CheckOrder(fluent.instance, fluent.start, fluent.finish);
  validity.id = writing->NextSequence();
  validity.world = writing->world;
  validity.source = writing->by.source;
  validity.episode = writing->by.episode;
  validity.start = fluent.start;
  validity.finish = validity.given = fluent.finish;
  if (before != nullptr) {
    validity.previous = before->id;
    validity.ended_before = std::max(before->ended_before, before->finish.latest);
  }
  if (validity.updated) {
    Validity ended = *before;
    ended.closed = validity.id;
    Close(ended);
  }
  parts_->validities.Insert(validity);
  if (before == nullptr || before->concept_id != validity.concept_id) {
    Rows(concept_, validity.concept_id, validity.instance).Run();
  }
  IndexFillers(fluent.properties, validity);
  const auto kind = validity.updated ? Change::Kind::kUpdated : Change::Kind::kAdded;
  writing->changes.push_back(
      MakeChange(kind, fluent, fluent.start.earliest, validity.id, writing->by, writing->label));
}

void StoreWriter::IndexFillers(const std::vector<Property>& properties, const Validity& opened) {
  for (const std::int64_t hash : TextHashes(properties)) {
    Rows(filler_, hash, opened.id).Run();
    Rows(open_filler_, hash, opened.world, opened.id).Run();
  }
}

void StoreWriter::Close(const Validity& ended) {
  parts_->validities.Close(ended);
  std::vector<Property> properties;
  try {
    properties = DecodeProperties(ended.properties, &parts_->words);
  } catch (const SQLite::Exception&) {
    return;  // damaged, and can still be replaced: what stays in the index changes no answer
  }
  for (const std::int64_t hash : TextHashes(properties)) {
    Rows(closed_filler_, hash, ended.world, ended.id).Run();
  }
}

void StoreWriter::End(const std::string& instance, Writing* writing) {
  Validity ended = RequireOpen(instance, *writing);
  CheckHolder(instance, ended, *writing);
  const double time = writing->by.time;
  if (time < ended.start.earliest) {
    FailTooEarly(instance, "holds, having begun", ended.start.earliest, time);
  }
  ended.finish = Closed(ended, {time, time});
  ended.closed = writing->NextSequence();
  Close(ended);
  Rows(removal_, ended.closed, ended.id, time, writing->by.episode,
       static_cast<int>(writing->by.source))
      .Run();
  Fluent fluent;
  fluent.concept_name = parts_->words.Text(ended.concept_id);
  fluent.instance = parts_->instances.Name(ended.instance);
  fluent.properties = DecodeProperties(ended.properties, &parts_->words);
  fluent.start = ended.start;
  fluent.finish = ended.finish;
  writing->changes.push_back(
      MakeChange(Change::Kind::kRemoved, fluent, time, ended.closed, writing->by, writing->label));
}

}  // namespace hires::knowledge
