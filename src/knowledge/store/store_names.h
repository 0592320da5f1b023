#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "knowledge/store/store_file.h"

namespace hires::knowledge {

/// Concepts, relations and types of values as numbers. There are as many as the ontology has, so
/// all are kept in memory.
class Words {
 public:
  Words(SQLite::Database* database, bool read_only);
  std::optional<std::int64_t> Find(const std::string& word);
  std::int64_t Intern(const std::string& word);  ///< within a writing transaction
  const std::string& Text(std::int64_t id);      ///< damaged file if there is none
  void Settle(bool committed);                   ///< at the end of a writing transaction
  void Reload();                                 ///< what others may have written

 private:
  SQLite::Database* database_;
  bool read_only_;
  SQLite::Statement insert_;
  std::size_t settled_{0};  // texts that are in the file for good
  std::unordered_map<std::string, std::int64_t> ids_;
  std::vector<std::string> texts_;  // by id
};

/// Instances as numbers. Names compare without regard to the case of ASCII letters and are spelled
/// as they first came. The names used last are kept in memory.
class Instances {
 public:
  struct Named {
    std::int64_t id{0};
    std::string name;
  };
  explicit Instances(StoreFile* file);
  std::optional<Named> Find(const std::string& name);
  Named Intern(const std::string& name);  ///< within a writing transaction
  const std::string& Name(std::int64_t id);
  void Settle(bool committed);  ///< at the end of a writing transaction

 private:
  void Keep(const Named& named, const std::string& key);

  std::vector<Named> fresh_;  // of a transaction that has not ended
  SQLite::Statement find_, insert_, name_;
  std::unordered_map<std::string, std::int64_t> ids_;  // by lower-case name
  std::unordered_map<std::int64_t, std::string> names_;
};

}  // namespace hires::knowledge
