#include "knowledge/store/store_error.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace hires::knowledge {
namespace {

/// What to do, by SQLite's primary result code (https://sqlite.org/rescode.html).
const char* Remedy(int code) {
  switch (code) {
    case SQLITE_FULL:
      return "there is no room for more; nothing of this call was written; free room on the disk, "
             "or raise the store's max_bytes if one is set";
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return "it cannot be written; check the permissions of the file and of its folder, or open "
             "it read-only";
    case SQLITE_CORRUPT:
      return "the file is damaged; keep a copy of it, then try `sqlite3 FILE .recover`, or restore "
             "a backup";
    case SQLITE_NOTADB:
      return "the file is no Blackboard store; name another one, or move it away";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds it; end that one, or try again";
    case SQLITE_CANTOPEN:
      return "it cannot be opened; check that its folder exists and may be written";
    case SQLITE_IOERR:
      return "reading or writing failed; nothing of this call was written; check the disk and "
             "quotas";
    case SQLITE_NOMEM:
      return "memory ran out; nothing of this call was written; ask for smaller pages or batches";
    default:
      return "nothing of this call was written";
  }
}

}  // namespace

base::ConfigError StoreError(const std::string& path, const SQLite::Exception& error) {
  const int code = error.getErrorCode() & 0xff;  // the primary one; the rest tells details
  return base::ConfigError(fmt::format("{}: {} (SQLite {}: {})", path, Remedy(code),
                                       error.getExtendedErrorCode(), error.what()));
}

void FailDamaged(const std::string& what) { throw SQLite::Exception(what, SQLITE_CORRUPT); }

}  // namespace hires::knowledge
