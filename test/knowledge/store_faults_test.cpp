// Disks that are full or may not be written, files that something else has damaged, and input that
// nobody means well with: each is an error that names the file, and nothing is lost.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/knowledge/loading.h"
#include "knowledge/support/store_workload.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::store_faults_test {
namespace {

using test_support::At;
using test_support::Ever;
using test_support::MakeFluent;
using test_support::PoseAt;
using test_support::QueryAll;
using test_support::SmallOntology;
using test_support::StoreWorkload;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

namespace fs = std::filesystem;

/// "" if there is none. Another exception than this is a mistake, and let through.
std::string ErrorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

StoreOptions ReadOnly() {
  StoreOptions options;
  options.read_only = true;
  return options;
}

class StoreFaultsTest : public ::testing::Test {
 protected:
  Store Open(StoreOptions options = {}) { return Store(path_, SmallOntology(), options); }
  std::string ErrorOfOpening(StoreOptions options = {}) {
    return ErrorOf([&] { Open(options); });
  }
  /// Reads all there is.
  std::string ErrorOfUse() {
    return ErrorOf([&] {
      const Store store = Open();
      QueryAll(store, Ever());
      store.ChangesSince(0, 100'000);
      store.Stats();
    });
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "blackboard.db").string();
};

// Another process, with limits or disks of its own ------------------------------------------------

constexpr int kSkipped = 77;

/// Runs `call` in a process of its own. What fails there fails here.
/// @return false if `prepare` could not be done there.
bool RunApart(const std::function<bool()>& prepare, const std::function<void()>& call) {
  std::cout << std::flush;
  const pid_t child = fork();
  if (child == 0) {
    if (!prepare()) _exit(kSkipped);
    try {
      call();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    std::cout << std::flush;
    _exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  const bool skipped = WIFEXITED(status) && WEXITSTATUS(status) == kSkipped;
  if (skipped) return false;
  EXPECT_EQ(status, 0) << "it failed, see above, or ended by a signal";
  return true;
}

void WriteFile(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ASSERT_GE(file, 0);
  ASSERT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  close(file);
}

/// File systems that are mounted from now on are seen by this process alone. Who is not root may do
/// so as the root of a namespace.
bool HaveOwnMounts() {
  const int user = static_cast<int>(geteuid()), group = static_cast<int>(getegid());
  if (unshare(CLONE_NEWNS) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    WriteFile("/proc/self/setgroups", "deny");
    WriteFile("/proc/self/uid_map", fmt::format("0 {} 1", user));
    WriteFile("/proc/self/gid_map", fmt::format("0 {} 1", group));
  }
  return mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
}

bool MountSmallDisk(const std::string& folder) {
  return HaveOwnMounts() && mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=4m") == 0;
}

/// Writes until there is no room.
/// @return the number of the batch that did not fit.
int FillUp(const StoreWorkload& workload, const std::string& path, Store* store) {
  for (int number = StoreWorkload::Next(*store);; ++number) {
    const std::string error = ErrorOf([&] { workload.Write(number, store); });
    if (error.empty()) continue;
    EXPECT_THAT(error, AllOf(StartsWith(path), HasSubstr("nothing of this call was written")));
    EXPECT_THAT(error, AnyOf(HasSubstr("free room on the disk"), HasSubstr("check the disk")));
    return number;
  }
}

/// All batches before `next` are there, and nothing else.
void ExpectBatchesBefore(int next, const StoreWorkload& workload, const Store& store) {
  Store wanted(":memory:", SmallOntology());
  for (int number = 1; number < next; ++number) workload.Write(number, &wanted);
  EXPECT_EQ(store.last_sequence(), wanted.last_sequence());
  EXPECT_EQ(QueryAll(store, Ever()), QueryAll(wanted, Ever()));
}

TEST_F(StoreFaultsTest, AFullDiskRefusesKeepsAllAndGoesOnWhenThereIsRoom) {
  const StoreWorkload workload{1, 20'000};
  const std::string ballast = (folder_.path() / "ballast").string();
  const auto fill = [&] {
    WriteFile(ballast, std::string(1u << 20, 'x'));
    int next = 0;
    {
      Store store = Open();
      next = FillUp(workload, path_, &store);
      EXPECT_GT(next, 20);
      EXPECT_EQ(FillUp(workload, path_, &store), next);  // still full, still there
      ExpectBatchesBefore(next, workload, store);
      ExpectBatchesBefore(next, workload, Open(ReadOnly()));
    }
    {
      Store store = Open();  // the log did not fit into the file
      ExpectBatchesBefore(next, workload, store);
      fs::remove(ballast);
      const int later = FillUp(workload, path_, &store);
      EXPECT_GT(later, next);
      next = later;
    }
    ExpectBatchesBefore(next, workload, Open());
  };
  if (!RunApart([&] { return MountSmallDisk(folder_.path()); }, fill)) {
    GTEST_SKIP() << "this computer allows no disks of one's own (unshare, mount)";
  }
}

TEST_F(StoreFaultsTest, ADiskThatIsFullFromTheFirstIsNamed) {
  const auto open = [&] {
    WriteFile((folder_.path() / "ballast").string(), std::string((4u << 20) - 4096, 'x'));
    EXPECT_THAT(ErrorOfOpening(), StartsWith(path_));
    fs::remove(folder_.path() / "ballast");
    Open().Add({PoseAt("pose1", 1.0)}, At(1.0));
  };
  if (!RunApart([&] { return MountSmallDisk(folder_.path()); }, open)) {
    GTEST_SKIP() << "this computer allows no disks of one's own (unshare, mount)";
  }
}

TEST_F(StoreFaultsTest, AReadOnlyDiskIsReadAndNotWritten) {
  Open().Add({PoseAt("pose1", 1.0)}, At(1.0));
  const auto read_only = [&] {
    const char* folder = folder_.path().c_str();
    return HaveOwnMounts() && mount(folder, folder, nullptr, MS_BIND, nullptr) == 0 &&
           mount(nullptr, folder, nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY, nullptr) == 0;
  };
  const auto use = [&] {
    EXPECT_THAT(ErrorOfOpening(), AllOf(StartsWith(path_), HasSubstr("Read-only file system"),
                                        HasSubstr("open the store read-only")));
    EXPECT_THAT(QueryAll(Open(ReadOnly()), Ever()), SizeIs(1));
  };
  if (!RunApart(read_only, use)) GTEST_SKIP() << "this computer allows no mounts of one's own";
  EXPECT_EQ(ErrorOfUse(), "");
}

TEST_F(StoreFaultsTest, AQuotaOnFilesRefusesAndKeepsWhatIsThere) {
  const StoreWorkload workload{2, 20'000};
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const auto limit = [] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit bytes{500'000, 500'000};
    return setrlimit(RLIMIT_FSIZE, &bytes) == 0;
  };
  ASSERT_TRUE(RunApart(limit, [&] {
    Store store = Open();
    const int next = FillUp(workload, path_, &store);
    ExpectBatchesBefore(next, workload, store);
    EXPECT_EQ(write(ends[1], &next, sizeof next), static_cast<ssize_t>(sizeof next));
  }));
  int next = 0;
  ASSERT_EQ(read(ends[0], &next, sizeof next), static_cast<ssize_t>(sizeof next));
  close(ends[0]);
  close(ends[1]);
  EXPECT_GT(next, 5);
  Store store = Open();
  ExpectBatchesBefore(next, workload, store);
  workload.Write(next, &store);
}

// Damage ------------------------------------------------------------------------------------------

class DamagedStoreTest : public StoreFaultsTest {
 protected:
  void SetUp() override {
    {
      Store store = Open();
      for (int number = 1; number <= 40; ++number) workload_.Write(number, &store);
    }
    whole_ = base::ReadTextFile(path_);
    ASSERT_GT(whole_.size(), 20u * 4096u);
  }
  /// Every damage is an error that names the file, or (SQLite has no check sums) passes unseen.
  /// @return whether it was seen.
  bool IsSeen(const std::string& damaged) {
    folder_.Write("blackboard.db", damaged);
    const std::string error = ErrorOfUse();
    EXPECT_THAT(error, AnyOf("", StartsWith(path_)));
    fs::remove(path_ + "-wal");
    fs::remove(path_ + "-shm");
    return !error.empty();
  }
  void ExpectTheGoodFileOpens() {
    folder_.Write("blackboard.db", whole_);
    ExpectBatchesBefore(41, workload_, Open());
  }

  StoreWorkload workload_{3, 2000};
  std::string whole_;
};

TEST_F(DamagedStoreTest, BitsOfTheHeaderThatTurn) {
  int seen = 0;
  for (std::size_t bit = 0; bit < 100 * 8; bit += 3) {
    std::string damaged = whole_;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    seen += IsSeen(damaged) ? 1 : 0;
    if (bit < 16 * 8) {
      EXPECT_EQ(seen, static_cast<int>(bit / 3) + 1) << "the file's signature";
    }
  }
  EXPECT_GT(seen, 60);  // others are counters and unused bytes
  ExpectTheGoodFileOpens();
}

TEST_F(DamagedStoreTest, BytesAnywhereThatChange) {
  base::Rng rng(1);
  int seen = 0;
  for (int i = 0; i < 200; ++i) {
    std::string damaged = whole_;
    // Beginnings of pages hold what pages are made of; a byte elsewhere is often a fluent's.
    const int page = rng.Index(static_cast<int>(whole_.size() / 4096));
    const int byte = rng.Index(rng.Bernoulli(0.7) ? 40 : 4096);
    damaged[static_cast<std::size_t>(page * 4096 + byte)] = static_cast<char>(rng.Index(256));
    seen += IsSeen(damaged) ? 1 : 0;
  }
  EXPECT_GT(seen, 20);
  ExpectTheGoodFileOpens();
}

TEST_F(DamagedStoreTest, FilesThatWereCut) {
  base::Rng rng(2);
  for (int i = 0; i < 60; ++i) {
    const int size = 1 + rng.Index(static_cast<int>(whole_.size()) - 1);
    EXPECT_TRUE(IsSeen(whole_.substr(0, static_cast<std::size_t>(size)))) << size;
  }
  ExpectTheGoodFileOpens();
}

/// A log that a dead writer left holds whole calls up to the damage.
TEST_F(StoreFaultsTest, ADamagedLogGivesWhatWasWrittenBeforeTheDamage) {
  const StoreWorkload workload{4, 2000};
  ASSERT_TRUE(RunApart([] { return true; },
                       [&] {
                         Store store = Open();
                         for (int number = 1; number <= 40; ++number)
                           workload.Write(number, &store);
                         _exit(0);  // as a killed one, which closes nothing
                       }));
  const std::string file = base::ReadTextFile(path_);
  const std::string log = base::ReadTextFile(path_ + "-wal");
  ASSERT_GT(log.size(), 100'000u);
  base::Rng rng(3);
  for (int i = 0; i < 40; ++i) {
    std::string damaged = log;
    const auto at = static_cast<std::size_t>(
        32 + rng.Index(static_cast<int>(log.size()) - 32));  // behind the log's own header
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    folder_.Write("blackboard.db", file);
    folder_.Write("blackboard.db-wal", i % 2 == 0 ? damaged : log.substr(0, at));
    fs::remove(path_ + "-shm");
    const Store store = Open();
    const int next = StoreWorkload::Next(store);
    EXPECT_LE(next, 41);
    ExpectBatchesBefore(next, workload, store);
  }
}

// Paths -------------------------------------------------------------------------------------------

TEST_F(StoreFaultsTest, PathsOnWhichNoStoreCanBe) {
  const std::string file = folder_.Write("file", "text");
  EXPECT_THAT(ErrorOf([&] { Store(file + "/x.db", SmallOntology()); }),
              AllOf(StartsWith(file + "/x.db"), HasSubstr("there is no folder")));
  EXPECT_THAT(ErrorOf([] { Store("/proc/x.db", SmallOntology()); }),
              AllOf(StartsWith("/proc/x.db"), HasSubstr("cannot be written")));
  EXPECT_THAT(ErrorOf([] { Store("/dev/null", SmallOntology()); }), StartsWith("/dev/null"));
  const std::string name(300, 'a');
  EXPECT_THAT(ErrorOf([&] { Store((folder_.path() / name).string(), SmallOntology()); }),
              HasSubstr(name));
  for (const std::string end : {".lock", "-wal", "-shm"}) {
    fs::create_directory(path_ + end);
    EXPECT_THAT(ErrorOfOpening(), StartsWith(path_)) << end;
    fs::remove(path_ + end);
  }
  fs::remove(path_);
  fs::create_symlink(path_, path_);
  EXPECT_THAT(ErrorOfOpening(), StartsWith(path_));
  fs::remove(path_);
  Open().Add({PoseAt("pose1", 1.0)}, At(1.0));
}

// Input -------------------------------------------------------------------------------------------

std::string BillionLaughs() {
  std::string text =
      "!Fluent\nClass_Instance: [Pose, pose9]\nProperties:\n  - &a0 [hasX, 'xsd:float', 1.0]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string one = fmt::format("*a{}", i - 1);
    text += fmt::format("  - &a{} [{}, {}, {}, {}]\n", i, one, one, one, one);
  }
  return text + "StartTime: [0, 0]\nFinishTime: [0, 0]\n";
}

std::string MugOfColour(const std::string& colour) {
  return "!Fluent\nClass_Instance: [Mug, mug9]\nProperties:\n  - [hasColour, 'xsd:string', '" +
         colour + "']\nStartTime: [0, 0]\nFinishTime: [0, 0]\n";
}

std::string FluentOf(const std::string& concept_name, const std::string& rest) {
  return fmt::format("!Fluent\nClass_Instance: [{}, pose9]\nProperties: []\n{}", concept_name,
                     rest);
}

std::string Times(const std::string& start, const std::string& finish) {
  return fmt::format("StartTime: {}\nFinishTime: {}\n", start, finish);
}

class BadTextTest : public ::testing::Test {
 protected:
  BadTextTest() { store_.Add({PoseAt("pose1", 1.0)}, At(1.0)); }
  /// What is said against a good fluent and this text together.
  std::string ErrorOfLoading(const std::string& text) {
    const std::string good = FluentOf("Pose", Times("[0, 0]", "[0, 0]"));
    return ErrorOf([&] {
      Load(ReadKnowledge(good + "--- " + text, "bad.yaml"), base::Rng(1), At(2.0), &store_);
    });
  }
  void ExpectNothingWasWritten() {
    EXPECT_EQ(store_.last_sequence(), 1u);
    EXPECT_THAT(QueryAll(store_, Ever()), SizeIs(1));
  }

  Store store_{":memory:", SmallOntology()};
};

TEST_F(BadTextTest, WhatIsTooMuchIsRefused) {
  const auto too_much = AllOf(StartsWith("bad.yaml: document 2"), SizeIs(::testing::Lt(500u)));
  EXPECT_THAT(ErrorOfLoading(BillionLaughs()), too_much);
  EXPECT_THAT(ErrorOfLoading(MugOfColour(std::string(std::size_t{10} << 20, 'a'))), too_much);
  EXPECT_THAT(ErrorOfLoading(std::string(200'000, '[')), too_much);
  EXPECT_THAT(ErrorOfLoading(MugOfColour(std::string(std::size_t{65} << 20, 'a'))),
              AllOf(StartsWith("bad.yaml"), SizeIs(::testing::Lt(500u))));
  ExpectNothingWasWritten();
}

TEST_F(BadTextTest, TimesThatCannotBeAreRefused) {
  const auto error_of = [&](const std::string& start, const std::string& finish) {
    return ErrorOfLoading(FluentOf("Pose", Times(start, finish)));
  };
  EXPECT_THAT(error_of("[2, 1]", "[0, 0]"), HasSubstr("StartTime"));
  EXPECT_THAT(error_of("[.nan, 1]", "[0, 0]"), HasSubstr("StartTime"));
  EXPECT_THAT(error_of("[5, 5]", "[1, 2]"), AllOf(HasSubstr("2"), HasSubstr("5")));
  EXPECT_THAT(error_of("[.inf, .inf]", "[.inf, .inf]"), HasSubstr("inf"));
  ExpectNothingWasWritten();
}

TEST_F(BadTextTest, WhatTheStoreCannotKnowIsRefused) {
  EXPECT_THAT(ErrorOfLoading(FluentOf("Posse", Times("[0, 0]", "[0, 0]"))),
              HasSubstr("did you mean 'Pose'"));
  EXPECT_THAT(ErrorOfLoading(MugOfColour("\xff\xfe")), StartsWith("bad.yaml"));
  EXPECT_THAT(ErrorOfLoading("!FluentPoseModification\nInstance: pose8\nGroup: g\nChoices: 1\n"
                             "Modifications: [[hasX, [1.0]]]\n"),
              HasSubstr("'pose8'"));
  ExpectNothingWasWritten();
  EXPECT_EQ(ErrorOfLoading(MugOfColour("red")), "");  // so the rest of these texts is good
  EXPECT_EQ(store_.last_sequence(), 3u);
}

TEST_F(StoreFaultsTest, QueriesOfIllWillAreRefusedAndTheStoreAnswersTheNext) {
  Store store = Open();
  store.Add({PoseAt("pose1", 1.0)}, At(1.0));
  const auto error_of = [&](const std::string& sparql) {
    FluentQuery query;
    query.sparql = sparql;
    return ErrorOf([&] { store.Query(query); });
  };
  std::string nested, unions;
  for (int i = 0; i < 60'000; ++i) nested += "{";
  for (int i = 0; i < 2000; ++i) unions += "{ ?x a upper:Pose } union ";
  EXPECT_THAT(error_of("select ?x where " + nested), HasSubstr("query"));
  EXPECT_THAT(error_of("select ?x where { " + unions), HasSubstr("query"));
  EXPECT_THAT(error_of("select ?x where { ?x a \"" + std::string(std::size_t{10} << 20, 'a')),
              AllOf(::testing::Not(""), SizeIs(::testing::Lt(1000u))));
  EXPECT_THAT(error_of(std::string("select ?x where { ?x a \0 }", 26)), ::testing::Not(""));
  EXPECT_THAT(error_of("drop table validity"), ::testing::Not(""));
  FluentQuery query;
  query.instance = "'; drop table validity; --";
  EXPECT_THAT(QueryAll(store, query), SizeIs(0));
  query.instance.clear();
  query.properties = {{"hasX", Filler(std::string("1.0' or '1'='1"))}};
  EXPECT_THAT(ErrorOf([&] { store.Query(query); }), HasSubstr("wanted a number"));
  EXPECT_THAT(QueryAll(store, FluentQuery()), SizeIs(1));
}

}  // namespace
}  // namespace hires::knowledge::store_faults_test
