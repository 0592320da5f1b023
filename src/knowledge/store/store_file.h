#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hires/base/files/writer_lock.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// One connection to the file of a store, checked and up to date.
class StoreFile {
 public:
  /// @throws ConfigError naming the path and what to do.
  StoreFile(const std::string& path, const StoreOptions& options);
  ~StoreFile();  ///< What is in the log goes into the file, also while others read it.
  StoreFile(const StoreFile&) = delete;
  StoreFile& operator=(const StoreFile&) = delete;

  SQLite::Database& database() { return *database_; }
  const std::string& path() const { return path_; }
  bool read_only() const { return read_only_; }
  std::uint64_t Bytes();  ///< of the file and its log

 private:
  void Configure(const StoreOptions& options);

  std::string path_;
  bool read_only_;
  std::unique_ptr<base::WriterLock> lock_;  // before the database: given back after it is closed
  std::unique_ptr<SQLite::Database> database_;
};

/// Bytes for a parameter of a statement.
struct Blob {
  const std::string& bytes;
};

/// A prepared statement at work: takes its parameters, gives rows, and is reset in the end, so that
/// it can be used again and keeps no lock.
class Rows {
 public:
  template <typename... Values>
  explicit Rows(SQLite::Statement& statement, const Values&... values) : statement_(statement) {
    int index = 0;
    (Bind(++index, values), ...);
  }
  ~Rows() { statement_.tryReset(); }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  bool Next() { return statement_.executeStep(); }
  void Run() { statement_.exec(); }
  std::int64_t Integer(int column) { return statement_.getColumn(column).getInt64(); }
  double Real(int column) { return statement_.getColumn(column).getDouble(); }
  std::string Text(int column) { return statement_.getColumn(column).getString(); }
  bool IsNull(int column) { return statement_.isColumnNull(column); }

 private:
  void Bind(int index, std::int64_t value) { statement_.bind(index, value); }
  void Bind(int index, int value) { statement_.bind(index, value); }
  void Bind(int index, bool value) { statement_.bind(index, value ? 1 : 0); }
  void Bind(int index, double value) { statement_.bind(index, value); }
  void Bind(int index, const std::string& value) { statement_.bind(index, value); }
  void Bind(int index, const Blob& value) {
    statement_.bind(index, value.bytes.data(), static_cast<int>(value.bytes.size()));
  }
  template <typename Value>
  void Bind(int index, const std::optional<Value>& value) {
    if (value) {
      Bind(index, *value);
    } else {
      statement_.bind(index);
    }
  }

  SQLite::Statement& statement_;
};

}  // namespace hires::knowledge
