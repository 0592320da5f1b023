#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/fluent.h"
#include "knowledge/store/store_file.h"

namespace hires::knowledge {

/// The episodes of a store.
class Episodes {
 public:
  explicit Episodes(StoreFile* file);

  /// Within writing transactions. @throws ConfigError, see Store.
  Episode Start(const std::string& task, Episode::Label label, std::int64_t parent, double time);
  Episode Finish(std::int64_t id, const std::string& outcome, double time);

  std::optional<Episode> Find(std::int64_t id);
  std::optional<Episode> Find(const std::string& id_or_name);
  Episode Require(std::int64_t id);  ///< @throws ConfigError
  std::vector<Episode> All();
  std::vector<std::int64_t> Imagined();  ///< their ids, ascending

 private:
  std::string NewName(double time);

  SQLite::Statement insert_, finish_, by_id_, by_name_, alike_, all_, imagined_;
};

}  // namespace hires::knowledge
