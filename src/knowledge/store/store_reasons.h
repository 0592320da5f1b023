#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "knowledge/store/store_names.h"

namespace hires::knowledge {

/// From schema 3 to 4: records of failed steps said why in one text, `hasReason`
/// ("no_path: r_hand touches book1"). They become what is written since: `hasFailure`, the word of
/// a code, and `hasDetail`, text for people. What has no `hasAction`, such as the end of a plan,
/// keeps its reason, which is a sentence there; whom a failure was about is not guessed from texts.
class ReasonMigration {
 public:
  explicit ReasonMigration(SQLite::Database* database);
  void Run();  ///< within a transaction. What is damaged stays as it is.

 private:
  struct Record {
    std::int64_t id{0}, world{0};
    bool is_open{false};
    std::vector<Property> properties;  ///< before
  };
  std::vector<Record> OldRecords();
  void Rewrite(const Record& record);

  SQLite::Database* database_;
  Words words_;
  SQLite::Statement write_, unlist_, unlist_open_, list_, list_open_;
};

}  // namespace hires::knowledge
