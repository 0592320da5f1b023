#include "hires/knowledge/old_stores.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <ratio>
#include <tuple>

#include "hires/base/error.h"
#include "hires/base/files/writer_lock.h"
#include "knowledge/store/store_schema.h"

namespace hires::knowledge {
namespace {

namespace fs = std::filesystem;

const char* const kParts[] = {"-wal", "-shm", ""};  // the file last: without it the rest is nothing

struct OldStore {
  fs::path path;
  fs::file_time_type changed;
  std::uint64_t bytes{0};
};

/// By the header of SQLite's file, whatever it is called.
bool IsStore(const fs::path& path) {
  constexpr std::size_t kPlace = 68;  // of the application's id, four bytes, the highest first
  std::array<char, kPlace + 4> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(head.data(), head.size())) return false;
  std::uint32_t id = 0;
  for (std::size_t i = kPlace; i < head.size(); ++i) {
    id = id << 8 | static_cast<unsigned char>(head[i]);
  }
  return id == static_cast<std::uint32_t>(kApplicationId);
}

bool IsOfARun(const fs::path& path) {
  return path.extension() == ".db" && path.filename().string().find("_run_") != std::string::npos;
}

std::uint64_t BytesOf(const fs::path& path) {
  std::uint64_t bytes = 0;
  for (const char* part : kParts) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path.string() + part, error);
    if (!error) bytes += size;
  }
  return bytes;
}

/// Oldest first.
std::vector<OldStore> StoresBeside(const fs::path& store) {
  std::vector<OldStore> stores;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(store.parent_path(), error)) {
    if (!IsOfARun(entry.path()) || entry.path().filename() == store.filename()) continue;
    if (!entry.is_regular_file(error) || entry.is_symlink(error)) continue;
    if (!IsStore(entry.path())) continue;
    const fs::file_time_type changed = entry.last_write_time(error);
    if (!error) stores.push_back({entry.path(), changed, BytesOf(entry.path())});
  }
  std::sort(stores.begin(), stores.end(), [](const OldStore& a, const OldStore& b) {
    return std::tie(a.changed, a.path) < std::tie(b.changed, b.path);
  });
  return stores;
}

/// False where another process writes it, or it cannot be removed.
bool Remove(const fs::path& path) {
  try {
    const base::WriterLock lock(path.string(), "open the store read-only");
    std::error_code error;
    for (const char* part : kParts) fs::remove(path.string() + part, error);
    std::error_code ignored;
    fs::remove(path.string() + ".lock", ignored);  // runs have names of their own: none comes again
    return !error;
  } catch (const base::ConfigError&) {
    return false;
  }
}

}  // namespace

std::vector<std::string> PruneOldStores(const std::string& store, const OldStoreLimits& limits,
                                        fs::file_time_type now) {
  std::vector<std::string> gone;
  if (!IsOfARun(store)) return gone;
  const std::vector<OldStore> stores = StoresBeside(store);
  std::uint64_t bytes = 0;
  for (const OldStore& old : stores) bytes += old.bytes;
  using Days = std::chrono::duration<double, std::ratio<86400>>;
  for (const OldStore& old : stores) {
    const bool is_old = limits.max_age > 0.0 && Days(now - old.changed).count() > limits.max_age;
    const bool are_many = limits.max_bytes > 0 && bytes > limits.max_bytes;
    if ((!is_old && !are_many) || !Remove(old.path)) continue;
    bytes -= old.bytes;
    gone.push_back(old.path.string());
  }
  return gone;
}

}  // namespace hires::knowledge
