#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>
#include <filesystem>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/files/writer_lock.h"
#include "hires/knowledge/experience.h"
#include "knowledge/store/store_error.h"

namespace hires::knowledge {
namespace {

namespace fs = std::filesystem;

constexpr int kApplication = 0x48455850;  // "HEXP": what kind of SQLite file it is
constexpr std::size_t kNumbers = 17;
using Numbers = std::array<float, kNumbers>;

/// Rare states alone are worth an index; the others are read in the order of the table anyway.
constexpr char kSchema[] = R"(
CREATE TABLE IF NOT EXISTS words (id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE);
CREATE TABLE IF NOT EXISTS parts (id INTEGER PRIMARY KEY, run INTEGER NOT NULL, action INTEGER NOT NULL,
  episode INTEGER NOT NULL, state INTEGER NOT NULL, time REAL NOT NULL, numbers BLOB NOT NULL);
CREATE INDEX IF NOT EXISTS rare_states ON parts (state) WHERE state > 0;
)";

Numbers Packed(const ToppleEpisodePart& part) {
  const Dynamics &o = part.object, &b = part.base;
  const std::array<double, kNumbers> numbers{
      part.alpha,  part.deviation, o.v,    o.a,    o.j,     o.angular_v,
      o.angular_a, o.angular_j,    b.v,    b.a,    b.j,     b.angular_v,
      b.angular_a, b.angular_j,    part.x, part.y, part.yaw};
  Numbers packed;
  for (std::size_t i = 0; i < kNumbers; ++i) packed[i] = static_cast<float>(numbers[i]);
  return packed;
}

void Unpack(const Numbers& n, ToppleEpisodePart* part) {
  part->alpha = n[0];
  part->deviation = n[1];
  part->object = {n[2], n[3], n[4], n[5], n[6], n[7]};
  part->base = {n[8], n[9], n[10], n[11], n[12], n[13]};
  part->x = n[14];
  part->y = n[15];
  part->yaw = n[16];
}

std::string WhereOf(const ExperienceQuery& query) {
  std::string where = "WHERE time BETWEEN ? AND ?";
  if (query.state && *query.state != ToppleState::kNoTopple) where += " AND state > 0";
  if (query.state) where += " AND state = ?";
  if (query.episode) where += " AND episode = ?";
  if (!query.run.empty()) where += " AND run = (SELECT id FROM words WHERE text = ?)";
  if (!query.action.empty()) {
    where += " AND action IN (SELECT id FROM words WHERE instr(text, ?) > 0)";
  }
  return where;
}

void Bind(const ExperienceQuery& query, SQLite::Statement* statement) {
  constexpr double kEver = 1e300;  // SQLite has no infinity
  int place = 0;
  statement->bind(++place, std::max(query.from, -kEver));
  statement->bind(++place, std::min(query.to, kEver));
  if (query.state) statement->bind(++place, static_cast<int>(*query.state));
  if (query.episode) statement->bind(++place, static_cast<std::int64_t>(*query.episode));
  if (!query.run.empty()) statement->bind(++place, query.run);
  if (!query.action.empty()) statement->bind(++place, query.action);
}

constexpr char kMakers[] =
    "`hires_lab experiment lab/config/experiments/topple_loop.yaml --experiences FILE` makes them, "
    "or "
    "`roslaunch hires topple.launch experiences:=FILE`";

[[noreturn]] void FailWithoutExperiences(const std::string& path) {
  throw base::ConfigError(fmt::format(
      "{}: holds no experiences; name a new file, or one that holds them: {}", path, kMakers));
}

void CheckPath(const std::string& path, ExperienceStore::Mode mode) {
  if (mode == ExperienceStore::Mode::kRead && !fs::is_regular_file(path)) {
    throw base::ConfigError(fmt::format("{}: no such file; wanted experiences: {}", path, kMakers));
  }
  std::error_code error;
  if (mode != ExperienceStore::Mode::kRead && fs::exists(path, error) &&
      !fs::is_regular_file(path, error)) {
    throw base::ConfigError(fmt::format("{}: is no regular file; name a file", path));
  }
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder)) {
    throw base::ConfigError(
        fmt::format("{}: there is no folder {}; make it first", path, folder.string()));
  }
}

std::uint64_t BytesOf(const std::string& path) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  return error ? 0 : bytes;
}

bool IsEmpty(SQLite::Database* database) {
  return database->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
}

void RequireExperiences(SQLite::Database* database, const std::string& path) {
  if (database->execAndGet("PRAGMA application_id").getInt() != kApplication) {
    FailWithoutExperiences(path);
  }
}

/// Of a database that is open: all that was committed lies in its one file, with no log beside it.
/// SQLite refuses it while another program has the file open with its log.
void TakeInLog(SQLite::Database* database) { database->exec("PRAGMA journal_mode = DELETE"); }

/// A database that is written beside the one that it shall replace; gone with its owner.
/// @pre the owner alone may write both.
class Replacement {
 public:
  explicit Replacement(const std::string& path) {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(path, error);  // a link goes on leading there
    target_ = error ? path : canonical.string();
    path_ = target_ + ".unfinished";
    if (fs::exists(target_, error)) {
      SQLite::Database old(target_, SQLite::OPEN_READWRITE, kBusyTimeout);
      if (!IsEmpty(&old)) RequireExperiences(&old, path);
      TakeInLog(&old);  // now: in the end, after hours of work, another program might hold it
    }
    Remove();  // what a process that was killed left
  }
  ~Replacement() {
    if (!path_.empty()) Remove();
  }
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  const std::string& path() const { return path_; }

  /// @pre the database is closed, and its log taken in.
  void Finish() {
    RemoveLogs(target_);  // SQLite would take one that lies there for the new file's
    std::error_code error;
    fs::rename(path_, target_, error);
    const std::string written = std::exchange(path_, "");
    if (!error) return;
    throw base::ConfigError(fmt::format("{}: cannot be replaced ({}); what was written is in {}",
                                        target_, error.message(), written));
  }

 private:
  static void RemoveLogs(const std::string& path) {
    std::error_code ignored;
    for (const char* ending : {"-wal", "-shm", "-journal"}) fs::remove(path + ending, ignored);
  }

  void Remove() const {
    std::error_code ignored;
    fs::remove(path_, ignored);
    RemoveLogs(path_);
  }

  std::string target_;
  std::string path_;  // empty: nothing is to be removed
};

}  // namespace

struct ExperienceStore::Implementation {
  Implementation(std::string file, Mode mode)
      : path(std::move(file)),
        lock(mode == Mode::kRead ? nullptr
                                 : std::make_unique<base::WriterLock>(path, "name another file")),
        replacement(mode == Mode::kReplace ? std::make_unique<Replacement>(path) : nullptr),
        database(replacement ? replacement->path() : path,
                 mode == Mode::kRead ? SQLite::OPEN_READONLY
                                     : SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                 kBusyTimeout) {
    if (mode == Mode::kRead || !IsEmpty(&database)) RequireExperiences(&database, path);
    if (mode == Mode::kRead) return;
    // As the Blackboard's store: a dead process loses nothing that was committed.
    database.exec("PRAGMA journal_mode = WAL");
    database.exec("PRAGMA synchronous = NORMAL");
    database.exec(fmt::format("PRAGMA application_id = {}", kApplication));
    database.exec(kSchema);
  }

  std::int64_t IdOf(const std::string& word) {
    const auto known = ids.find(word);
    if (known != ids.end()) return known->second;
    SQLite::Statement add(database, "INSERT OR IGNORE INTO words (text) VALUES (?)");
    add.bind(1, word);
    add.exec();
    SQLite::Statement find(database, "SELECT id FROM words WHERE text = ?");
    find.bind(1, word);
    find.executeStep();
    return ids[word] = find.getColumn(0).getInt64();
  }

  void Write(const ExperienceBatch& batch) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    const std::int64_t run = IdOf(batch.run), action = IdOf(batch.action);
    SQLite::Statement insert(
        database,
        "INSERT INTO parts (run, action, episode, state, time, numbers) VALUES (?, ?, ?, ?, ?, ?)");
    for (const ToppleEpisodePart& part : batch.parts) {
      const Numbers numbers = Packed(part);
      insert.bind(1, run);
      insert.bind(2, action);
      insert.bind(3, static_cast<std::int64_t>(part.episode));
      insert.bind(4, static_cast<int>(part.state));
      insert.bind(5, part.time);
      insert.bind(6, numbers.data(), static_cast<int>(sizeof(numbers)));
      insert.exec();
      insert.reset();
    }
    transaction.commit();
  }

  void ReadWords(std::map<std::int64_t, std::string>* words) const {
    SQLite::Statement all(database, "SELECT id, text FROM words");
    while (all.executeStep()) (*words)[all.getColumn(0).getInt64()] = all.getColumn(1).getString();
  }

  std::string path;
  std::unique_ptr<base::WriterLock> lock;    // given back after the database is closed
  std::unique_ptr<Replacement> replacement;  // of kReplace alone; removed before that
  SQLite::Database database;
  std::map<std::string, std::int64_t> ids;
};

ExperienceStore::ExperienceStore(const std::string& path, Mode mode) {
  CheckPath(path, mode);
  Guarded(path, [&] {
    try {
      implementation_ = std::make_unique<Implementation>(path, mode);
    } catch (const SQLite::Exception& error) {
      // Of other files the store's remedy would speak of the Blackboard.
      if ((error.getErrorCode() & 0xff) == SQLITE_NOTADB) FailWithoutExperiences(path);
      throw;
    }
  });
}
ExperienceStore::ExperienceStore(ExperienceStore&&) noexcept = default;
ExperienceStore::~ExperienceStore() = default;

void ExperienceStore::Write(const ExperienceBatch& batch) {
  try {
    Guarded(implementation_->path, [&] { implementation_->Write(batch); });
  } catch (...) {
    implementation_->ids.clear();  // what was undone has no number
    throw;
  }
}

void ExperienceStore::Finish() {
  HIRES_CHECK(implementation_->replacement, "only what is opened to be replaced is finished");
  const std::string path = implementation_->path;
  Guarded(path, [&] {
    TakeInLog(&implementation_->database);
    // Kept while the database is closed and renamed.
    const std::unique_ptr<base::WriterLock> lock = std::move(implementation_->lock);
    const std::unique_ptr<Replacement> replacement = std::move(implementation_->replacement);
    implementation_.reset();
    replacement->Finish();
    implementation_ = std::make_unique<Implementation>(path, Mode::kRead);
  });
}

void ExperienceStore::ForEach(const ExperienceQuery& query,
                              const std::function<void(const Stored&)>& take) const {
  Guarded(implementation_->path, [&] {
    std::map<std::int64_t, std::string> words;
    implementation_->ReadWords(&words);
    SQLite::Statement select(implementation_->database,
                             "SELECT run, action, episode, state, time, numbers FROM parts " +
                                 WhereOf(query) + " ORDER BY id");
    Bind(query, &select);
    while (select.executeStep()) {
      Stored stored;
      stored.run = &words[select.getColumn(0).getInt64()];
      stored.action = &words[select.getColumn(1).getInt64()];
      stored.part.episode = select.getColumn(2).getUInt();
      stored.part.state = static_cast<ToppleState>(select.getColumn(3).getInt());
      stored.part.time = select.getColumn(4).getDouble();
      const SQLite::Column blob = select.getColumn(5);
      Numbers numbers;
      if (blob.getBytes() != static_cast<int>(sizeof(numbers))) {
        FailDamaged("a part of " + std::to_string(blob.getBytes()) + " bytes");
      }
      std::memcpy(numbers.data(), blob.getBlob(), sizeof(numbers));
      Unpack(numbers, &stored.part);
      take(stored);
    }
  });
}

std::uint64_t ExperienceStore::num_parts() const {
  return Guarded(implementation_->path, [&] {
    return static_cast<std::uint64_t>(
        implementation_->database.execAndGet("SELECT count(*) FROM parts").getInt64());
  });
}

std::uint64_t ExperienceStore::bytes() const {
  const std::string& file = implementation_->database.getFilename();
  return BytesOf(file) + BytesOf(file + "-wal");
}

}  // namespace hires::knowledge
