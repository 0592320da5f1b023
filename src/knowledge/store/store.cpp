#include "hires/knowledge/store.h"

#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "knowledge/query/query_engine.h"
#include "knowledge/store/store_error.h"
#include "knowledge/store/store_reader.h"
#include "knowledge/store/store_writer.h"

namespace hires::knowledge {
namespace {

/// No change has a higher number.
std::int64_t AsSequence(std::uint64_t sequence) {
  constexpr auto kHighest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(sequence, kHighest));
}

}  // namespace

struct Store::Implementation {
  Implementation(const std::string& path, std::shared_ptr<const Ontology> known,
                 const StoreOptions& options)
      : ontology(std::move(known)),
        file(path, options),
        parts(&file),
        writer(&parts, ontology),
        reader(&parts),
        queries(&parts, ontology) {
    last = static_cast<std::uint64_t>(reader.LastSequence());
  }

  /// Runs a call that writes; undone as a whole if it throws.
  template <typename Call>
  auto Write(Call&& call) {
    if (file.read_only()) {
      throw base::ConfigError(
          fmt::format("{}: was opened read-only; open it for writing", file.path()));
    }
    return Guarded(file.path(), [&] {
      try {
        SQLite::Transaction transaction(file.database(), SQLite::TransactionBehavior::IMMEDIATE);
        std::uint64_t sequence = last;
        auto result = call(&sequence);
        transaction.commit();
        last = sequence;
        Settle(true);
        return result;
      } catch (...) {
        Settle(false);
        throw;
      }
    });
  }

  /// Runs a call that reads, all of it from one state of the file.
  template <typename Call>
  auto Read(Call&& call) {
    return Guarded(file.path(), [&] {
      const SQLite::Transaction transaction(file.database());
      return call();
    });
  }

  void Settle(bool committed) {
    parts.words.Settle(committed);
    parts.instances.Settle(committed);
  }

  std::shared_ptr<const Ontology> ontology;
  StoreFile file;
  StoreParts parts;
  StoreWriter writer;
  StoreReader reader;
  QueryEngine queries;
  std::uint64_t last{0};
};

Store::Store(const std::string& path, std::shared_ptr<const Ontology> ontology,
             StoreOptions options) {
  HIRES_CHECK(ontology != nullptr, "a store needs an ontology");
  implementation_ = Guarded(
      path, [&] { return std::make_unique<Implementation>(path, std::move(ontology), options); });
}

Store::Store(Store&&) noexcept = default;
Store::~Store() = default;

std::vector<Change> Store::Add(const std::vector<Fluent>& fluents, const Assertion& by) {
  return implementation_->Write(
      [&](std::uint64_t* last) { return implementation_->writer.Add(fluents, by, last); });
}

std::vector<Change> Store::Update(const std::vector<Fluent>& fluents, const Assertion& by) {
  return implementation_->Write(
      [&](std::uint64_t* last) { return implementation_->writer.Update(fluents, by, last); });
}

std::vector<Change> Store::Remove(const std::vector<std::string>& instances, const Assertion& by) {
  return implementation_->Write(
      [&](std::uint64_t* last) { return implementation_->writer.Remove(instances, by, last); });
}

FluentPage Store::Query(const FluentQuery& query) const {
  Implementation& self = *implementation_;
  return self.Read([&] { return self.queries.Page(query, self.reader.LastSequence()); });
}

std::optional<Fluent> Store::Find(const std::string& instance) const {
  return implementation_->Read([&] { return implementation_->reader.Find(instance); });
}

std::vector<Change> Store::ChangesSince(std::uint64_t sequence, std::size_t limit) const {
  return implementation_->Read(
      [&] { return implementation_->reader.ChangesSince(AsSequence(sequence), limit); });
}

std::uint64_t Store::last_sequence() const {
  if (!implementation_->file.read_only()) return implementation_->last;
  return implementation_->Read(
      [&] { return static_cast<std::uint64_t>(implementation_->reader.LastSequence()); });
}

Episode Store::StartEpisode(const std::string& task, Episode::Label label, std::int64_t parent,
                            double time) {
  return implementation_->Write([&](std::uint64_t*) {
    return implementation_->parts.episodes.Start(task, label, parent, time);
  });
}

Episode Store::FinishEpisode(std::int64_t id, const std::string& outcome, double time) {
  return implementation_->Write(
      [&](std::uint64_t*) { return implementation_->parts.episodes.Finish(id, outcome, time); });
}

std::vector<Episode> Store::Episodes() const {
  return implementation_->Read([&] { return implementation_->parts.episodes.All(); });
}

std::optional<Episode> Store::FindEpisode(const std::string& id_or_name) const {
  return implementation_->Read([&] { return implementation_->parts.episodes.Find(id_or_name); });
}

Store::Statistics Store::Stats() const {
  return implementation_->Read([&] { return implementation_->reader.Stats(); });
}

const Ontology& Store::ontology() const { return *implementation_->ontology; }

}  // namespace hires::knowledge
