#include "hires/knowledge/old_stores.h"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "hires/base/files/writer_lock.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::old_stores_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class OldStoresTest : public ::testing::Test {
 protected:
  /// A file of that many bytes with the header of a store, changed so many days ago.
  std::string Write(const std::string& name, int days, std::size_t bytes = 100) {
    std::string content(bytes, 'x');
    content.replace(68, 4, "HIRE");
    return WriteFile(name, days, content);
  }

  std::string WriteFile(const std::string& name, int days, const std::string& content) {
    const std::string path = folder_.Write(name, content);
    fs::last_write_time(path, now_ - std::chrono::hours(24 * days));
    return path;
  }

  std::vector<std::string> Prune(const OldStoreLimits& limits,
                                 const std::string& store = "topple_run_new.db") {
    return PruneOldStores((folder_.path() / store).string(), limits, now_);
  }

  const test_support::TemporaryFolder folder_;
  const fs::file_time_type now_ = fs::file_time_type::clock::now();
};

TEST_F(OldStoresTest, WhatIsTooOldGoesWithItsLog) {
  const std::string old = Write("topple_run_a.db", 31);
  Write("topple_run_a.db-wal", 31);
  Write("topple_run_a.db.lock", 31);
  const std::string young = Write("serve_run_b.db", 29);
  EXPECT_THAT(Prune({30.0, 0}), ElementsAre(old));
  EXPECT_FALSE(fs::exists(old));
  EXPECT_FALSE(fs::exists(old + "-wal"));
  EXPECT_FALSE(fs::exists(old + ".lock"));
  EXPECT_TRUE(fs::exists(young));
}

TEST_F(OldStoresTest, TheOldestGoUntilTheRestIsSmallEnough) {
  const std::string first = Write("x_run_1.db", 3, 400), second = Write("x_run_2.db", 2, 400);
  const std::string third = Write("x_run_3.db", 1, 400);
  EXPECT_THAT(Prune({0.0, 500}), ElementsAre(first, second));
  EXPECT_TRUE(fs::exists(third));
}

TEST_F(OldStoresTest, NothingButStoresOfEarlierRunsIsTouched) {
  Write("blackboard.db", 1000);
  Write("notes_run_of_mine.txt", 1000);
  Write("topple_run_new.db", 1000);
  fs::create_directories(folder_.path() / "folder_run_1.db");
  EXPECT_THAT(Prune({1.0, 1}), IsEmpty());
  Write("topple_run_a.db", 1000);
  EXPECT_THAT(Prune({1.0, 1}, "blackboard.db"), IsEmpty()) << "a store that is no run's";
}

TEST_F(OldStoresTest, WhatOnlyBearsSuchANameStays) {
  WriteFile("lab_run_a.db", 1000, std::string(5000, 'x'));
  WriteFile("lab_run_b.db", 1000, "short");
  EXPECT_THAT(Prune({1.0, 1}), IsEmpty());
}

TEST_F(OldStoresTest, AStoreThatIsBeingWrittenStays) {
  const std::string old = Write("topple_run_a.db", 1000);
  const base::WriterLock lock(old, "wait");
  EXPECT_THAT(Prune({1.0, 1}), IsEmpty());
  EXPECT_TRUE(fs::exists(old));
}

TEST_F(OldStoresTest, ZeroKeepsAll) {
  Write("topple_run_a.db", 1000);
  EXPECT_THAT(Prune({0.0, 0}), IsEmpty());
}

}  // namespace
}  // namespace hires::knowledge::old_stores_test
