#include "knowledge/store/store_names.h"

#include <fmt/format.h>

#include "hires/base/text.h"
#include "knowledge/store/store_error.h"

namespace hires::knowledge {
namespace {

constexpr std::size_t kNamesKept = 100'000;  // some 20 MB

}  // namespace

Words::Words(SQLite::Database* database, bool read_only)
    : database_(database),
      read_only_(read_only),
      insert_(*database, "INSERT INTO word(id, text) VALUES(?, ?)") {
  Reload();
}

void Words::Reload() {
  ids_.clear();
  texts_.assign(1, "");  // numbers count from 1
  SQLite::Statement all(*database_, "SELECT id, text FROM word ORDER BY id");
  Rows rows(all);
  while (rows.Next()) {
    if (rows.Integer(0) != static_cast<std::int64_t>(texts_.size())) FailDamaged("a word is lost");
    texts_.push_back(rows.Text(1));
    ids_.emplace(texts_.back(), rows.Integer(0));
  }
  settled_ = texts_.size();
}

void Words::Settle(bool committed) {
  for (; !committed && texts_.size() > settled_; texts_.pop_back()) ids_.erase(texts_.back());
  settled_ = texts_.size();
}

std::optional<std::int64_t> Words::Find(const std::string& word) {
  const auto found = ids_.find(word);
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

std::int64_t Words::Intern(const std::string& word) {
  if (const auto found = Find(word)) return *found;
  const auto id = static_cast<std::int64_t>(texts_.size());
  Rows(insert_, id, word).Run();
  texts_.push_back(word);
  ids_.emplace(word, id);
  return id;
}

const std::string& Words::Text(std::int64_t id) {
  const auto known = [&] { return id > 0 && id < static_cast<std::int64_t>(texts_.size()); };
  // A writer knows them all; to reload would mix up what its transaction has not committed.
  if (!known() && read_only_) Reload();
  if (!known()) FailDamaged(fmt::format("word {} is missing", id));
  return texts_[static_cast<std::size_t>(id)];
}

Instances::Instances(StoreFile* file)
    : find_(file->database(), "SELECT id, name FROM instance WHERE name = ?"),
      insert_(file->database(),
              "INSERT INTO instance(id, name) SELECT ifnull(max(id), 0) + 1, ? FROM instance "
              "RETURNING id"),
      name_(file->database(), "SELECT name FROM instance WHERE id = ?") {}

void Instances::Keep(const Named& named, const std::string& key) {
  if (names_.size() >= kNamesKept) {
    ids_.clear();
    names_.clear();
  }
  ids_[key] = named.id;
  names_[named.id] = named.name;
}

void Instances::Settle(bool committed) {
  for (const Named& named : fresh_) {
    if (committed) break;
    ids_.erase(base::ToLower(named.name));
    names_.erase(named.id);
  }
  fresh_.clear();
}

std::optional<Instances::Named> Instances::Find(const std::string& name) {
  const std::string key = base::ToLower(name);
  if (const auto kept = ids_.find(key); kept != ids_.end()) {
    return Named{kept->second, names_.at(kept->second)};
  }
  Rows rows(find_, name);
  if (!rows.Next()) return std::nullopt;
  const Named named{rows.Integer(0), rows.Text(1)};
  Keep(named, key);
  return named;
}

Instances::Named Instances::Intern(const std::string& name) {
  if (const auto found = Find(name)) return *found;
  Rows rows(insert_, name);
  rows.Next();
  const Named named{rows.Integer(0), name};
  rows.Next();  // to its end, which completes the insertion
  Keep(named, base::ToLower(name));
  fresh_.push_back(named);
  return named;
}

const std::string& Instances::Name(std::int64_t id) {
  if (const auto kept = names_.find(id); kept != names_.end()) return kept->second;
  Rows rows(name_, id);
  if (!rows.Next()) FailDamaged(fmt::format("instance {} has no name", id));
  const Named named{id, rows.Text(0)};
  Keep(named, base::ToLower(named.name));
  return names_.at(id);
}

}  // namespace hires::knowledge
