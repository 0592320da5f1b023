#include "knowledge/store/store_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "hires/base/error.h"
#include "knowledge/store/store_error.h"
#include "knowledge/store/store_schema.h"

namespace hires::knowledge {
namespace {

constexpr int kLogPages = 8000;              // [4 KiB] of the log before it goes into the file
constexpr int kLogBytes = kLogPages * 4096;  // to which a longer log is cut back

const std::string kInMemory = ":memory:";
const std::string kReadOnly = "open the store read-only";

std::filesystem::path FolderOf(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

void CheckPath(const std::string& path, bool read_only) {
  std::error_code ignored;
  if (path.empty()) throw base::ConfigError("the store has no path; name a file, or :memory:");
  if (std::filesystem::is_directory(path, ignored)) {
    throw base::ConfigError(fmt::format("{}: is a folder; name a file in it", path));
  }
  if (!std::filesystem::is_directory(FolderOf(path), ignored)) {
    throw base::ConfigError(fmt::format("{}: there is no folder {}; make it, or name another one",
                                        path, FolderOf(path).string()));
  }
  if (read_only && !std::filesystem::exists(path, ignored)) {
    throw base::ConfigError(fmt::format("{}: no such file; check the path", path));
  }
}

std::uint64_t FileBytes(const std::string& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  return error ? 0 : bytes;
}

/// A reader needs the shared memory beside the log, which it cannot make in a folder that it may
/// not write. Where no process can write there and no log is left over, the file alone is all there
/// is, and SQLite reads it as unchanging (https://sqlite.org/wal.html, "Read-Only Databases").
bool IsAtRest(const std::string& path) {
  const bool closed_folder = faccessat(AT_FDCWD, FolderOf(path).c_str(), W_OK, AT_EACCESS) != 0;
  return closed_folder && FileBytes(path + "-wal") == 0;
}

std::string AsUri(const std::string& path) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    uri += c == '?' || c == '#' || c == '%' ? fmt::format("%{:02X}", c) : std::string(1, c);
  }
  return uri + "?immutable=1";
}

std::unique_ptr<SQLite::Database> Open(const std::string& path, bool read_only) {
  if (!read_only) {
    return std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                                              kBusyTimeout);
  }
  if (path != kInMemory && IsAtRest(path)) {
    return std::make_unique<SQLite::Database>(AsUri(path), SQLite::OPEN_READONLY | SQLite::OPEN_URI,
                                              kBusyTimeout);
  }
  return std::make_unique<SQLite::Database>(path, SQLite::OPEN_READONLY, kBusyTimeout);
}

}  // namespace

StoreFile::StoreFile(const std::string& path, const StoreOptions& options)
    : path_(path), read_only_(options.read_only) {
  if (path == kInMemory && read_only_) {
    throw base::ConfigError(":memory: holds nothing to read; name a file, or open it for writing");
  }
  if (path != kInMemory) CheckPath(path, read_only_);
  if (path != kInMemory && !read_only_) lock_ = std::make_unique<base::WriterLock>(path, kReadOnly);
  Guarded(path, [&] {
    database_ = Open(path, read_only_);
    Configure(options);
    PrepareSchema(path, read_only_, database_.get());
  });
}

StoreFile::~StoreFile() {
  if (read_only_ || path_ == kInMemory) return;
  try {
    database_->exec("PRAGMA wal_checkpoint(TRUNCATE)");
  } catch (const SQLite::Exception&) {  // the log stays beside the file, and is read with it
  }
}

void StoreFile::Configure(const StoreOptions& options) {
  database_->exec(fmt::format("PRAGMA cache_size = -{}", options.cache_bytes / 1024));
  database_->exec("PRAGMA temp_store = MEMORY");
  if (read_only_) return;
  // In WAL mode a commit is an append to the log. NORMAL hands it to the operating system and syncs
  // at checkpoints only: a dead process loses nothing, a power cut the newest commits, but never
  // the file's consistency (OFF could: the log might reach the disk after the file). FULL syncs the
  // log at each commit, which survives a power cut as well. https://sqlite.org/pragma.html
  // #pragma_synchronous and https://sqlite.org/wal.html, "Performance Considerations".
  database_->exec("PRAGMA journal_mode = WAL");
  const bool power = options.durability == Durability::kPower;
  database_->exec(power ? "PRAGMA synchronous = FULL" : "PRAGMA synchronous = NORMAL");
  database_->exec(fmt::format("PRAGMA wal_autocheckpoint = {}", kLogPages));
  database_->exec(fmt::format("PRAGMA journal_size_limit = {}", kLogBytes));
  if (options.max_bytes == 0) return;
  const int page = database_->execAndGet("PRAGMA page_size").getInt();
  database_->exec(fmt::format("PRAGMA max_page_count = {}",
                              options.max_bytes / static_cast<std::uint64_t>(page) + 1));
}

std::uint64_t StoreFile::Bytes() {
  if (path_ != kInMemory) return FileBytes(path_) + FileBytes(path_ + "-wal");
  const std::int64_t pages = database_->execAndGet("PRAGMA page_count").getInt64();
  const std::int64_t page = database_->execAndGet("PRAGMA page_size").getInt64();
  return static_cast<std::uint64_t>(pages * page);
}

}  // namespace hires::knowledge
