#include "hires/knowledge/experience.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::experience_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kParts = 100;  // of a batch

ToppleEpisodePart PartAt(double time, ToppleState state = ToppleState::kNoTopple) {
  ToppleEpisodePart part;
  part.time = time;
  part.episode = static_cast<std::uint32_t>(time);
  part.state = state;
  part.alpha = 0.25;
  part.deviation = 0.5;
  part.object = {1.0, -2.0, 3.0, 4.0, -5.0, 6.0};
  part.base = {7.0, -8.0, 9.0, 10.0, -11.0, 12.0};
  part.x = 13.0;
  part.y = -14.0;
  part.yaw = 1.5;
  return part;
}

class ExperienceStoreTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name = "e.db") const {
    return (folder_.path() / name).string();
  }
  ExperienceStore Writer() const { return ExperienceStore(Path(), ExperienceStore::Mode::kWrite); }
  std::vector<double> TimesOf(const ExperienceQuery& query) const {
    const ExperienceStore store(Path(), ExperienceStore::Mode::kRead);
    std::vector<double> times;
    store.ForEach(query, [&](const auto& stored) { times.push_back(stored.part.time); });
    return times;
  }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  /// A process that writes and is killed before it closes what it wrote.
  /// @param write  gives the store.
  template <typename Write>
  static void KillAfter(const Write& write) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const ExperienceStore store = write();
      kill(getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(ExperienceStoreTest, WhatIsWrittenIsRead) {
  Writer().Write({"fast/0", "move_base_param(nt1, fast)", {PartAt(1.5, ToppleState::kShaking)}});
  const ExperienceStore store(Path(), ExperienceStore::Mode::kRead);
  EXPECT_EQ(store.num_parts(), 1u);
  EXPECT_GT(store.bytes(), 68u);
  store.ForEach({}, [](const ExperienceStore::Stored& stored) {
    EXPECT_EQ(*stored.run, "fast/0");
    EXPECT_EQ(*stored.action, "move_base_param(nt1, fast)");
    EXPECT_EQ(stored.part.state, ToppleState::kShaking);
    EXPECT_EQ(CsvOf(stored.part), CsvOf(PartAt(1.5, ToppleState::kShaking)));
  });
}

TEST_F(ExperienceStoreTest, PartsAreAskedForByStateTimeActionRunAndEpisode) {
  {
    ExperienceStore store = Writer();
    store.Write(
        {"fast/0",
         "drive(a, fast)",
         {PartAt(0.0), PartAt(1.0, ToppleState::kShaking), PartAt(2.0, ToppleState::kTopple)}});
    store.Write({"slow/0", "drive(a, slow)", {PartAt(3.0), PartAt(4.0, ToppleState::kShaking)}});
  }
  ExperienceQuery query;
  query.state = ToppleState::kShaking;
  EXPECT_THAT(TimesOf(query), ElementsAre(1.0, 4.0));
  query.run = "slow/0";
  EXPECT_THAT(TimesOf(query), ElementsAre(4.0));
  query = {};
  query.state = ToppleState::kNoTopple;
  EXPECT_THAT(TimesOf(query), ElementsAre(0.0, 3.0));
  query = {};
  query.from = 1.0;
  query.to = 3.0;
  EXPECT_THAT(TimesOf(query), ElementsAre(1.0, 2.0, 3.0));
  query = {};
  query.action = "slow";
  EXPECT_THAT(TimesOf(query), ElementsAre(3.0, 4.0));
  query = {};
  query.episode = 2;
  EXPECT_THAT(TimesOf(query), ElementsAre(2.0));
  query.run = "nobody";
  EXPECT_THAT(TimesOf(query), ElementsAre());
}

TEST_F(ExperienceStoreTest, WhatHasBegunIsWholeOrGoneAfterAKill) {
  Writer();
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ExperienceStore store = Writer();
    for (double time = 0.0;; time += kParts) {
      ExperienceBatch batch{"r", "a", {}};
      for (int i = 0; i < kParts; ++i) batch.parts.push_back(PartAt(time + i));
      store.Write(batch);
      if (write(told[1], "x", 1) != 1) _exit(1);
    }
  }
  std::string written(20, ' ');
  for (char& byte : written) ASSERT_EQ(read(told[0], &byte, 1), 1);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const std::size_t found = TimesOf({}).size();
  EXPECT_GE(found, 20u * kParts) << "what was acknowledged is there";
  EXPECT_EQ(found % kParts, 0u) << "no half batch";
}

TEST_F(ExperienceStoreTest, OneWritesAtATime) {
  const ExperienceStore writer = Writer();
  for (const auto mode : {ExperienceStore::Mode::kWrite, ExperienceStore::Mode::kReplace}) {
    EXPECT_THAT(
        ConfigErrorOf([&] { ExperienceStore(Path(), mode); }),
        AllOf(HasSubstr("e.db: is being written by process"), HasSubstr("name another file")));
  }
  EXPECT_EQ(TimesOf({}).size(), 0u) << "others may read";
}

TEST_F(ExperienceStoreTest, WhatIsReplacedIsThereUntilTheEnd) {
  Writer().Write({"old", "a", {PartAt(1.0), PartAt(2.0)}});
  {
    ExperienceStore given_up(Path(), ExperienceStore::Mode::kReplace);
    given_up.Write({"never", "b", {PartAt(3.0)}});
  }
  EXPECT_THAT(TimesOf({}), ElementsAre(1.0, 2.0));
  ExperienceStore store(Path(), ExperienceStore::Mode::kReplace);
  store.Write({"new", "b", {PartAt(4.0)}});
  EXPECT_THAT(TimesOf({}), ElementsAre(1.0, 2.0)) << "others read what was there";
  EXPECT_EQ(store.num_parts(), 1u) << "what was given up is gone";
  EXPECT_GT(store.bytes(), 68u);
  store.Finish();
  EXPECT_EQ(store.num_parts(), 1u);
  EXPECT_THAT(TimesOf({}), ElementsAre(4.0));
  EXPECT_THAT(Files(), ElementsAre("e.db", "e.db.lock"));
  EXPECT_THROW(store.Finish(), std::logic_error);
  Writer().Write({"more", "b", {PartAt(5.0)}});
  EXPECT_THAT(TimesOf({}), ElementsAre(4.0, 5.0)) << "it is written as any other";
  EXPECT_THROW(Writer().Finish(), std::logic_error);
}

TEST_F(ExperienceStoreTest, AKillLeavesWhatWasToBeReplaced) {
  Writer().Write({"old", "a", {PartAt(1.0)}});
  KillAfter([&] {
    ExperienceStore store(Path(), ExperienceStore::Mode::kReplace);
    store.Write({"killed", "b", {PartAt(2.0)}});
    return store;
  });
  EXPECT_THAT(TimesOf({}), ElementsAre(1.0));
  EXPECT_THAT(Files(), Contains("e.db.unfinished"));
  ExperienceStore store(Path(), ExperienceStore::Mode::kReplace);
  store.Write({"new", "b", {PartAt(3.0)}});
  store.Finish();
  EXPECT_THAT(TimesOf({}), ElementsAre(3.0)) << "nothing of the one that was killed";
  EXPECT_THAT(Files(), ElementsAre("e.db", "e.db.lock"));
}

TEST_F(ExperienceStoreTest, ALogThatAKillLeftGoesToNoOtherFile) {
  const auto leave_a_log = [&] {
    KillAfter([&] {
      ExperienceStore store = Writer();
      store.Write({"old", "a", {PartAt(1.0)}});
      return store;
    });
    ASSERT_GT(std::filesystem::file_size(Path("e.db-wal")), 0u);
  };
  leave_a_log();
  {
    const ExperienceStore given_up(Path(), ExperienceStore::Mode::kReplace);
    EXPECT_THAT(TimesOf({}), ElementsAre(1.0)) << "what is in the log is kept";
  }
  EXPECT_THAT(TimesOf({}), ElementsAre(1.0));
  std::filesystem::remove(Path());
  leave_a_log();
  std::filesystem::remove(Path());  // its log stays
  ExperienceStore store(Path(), ExperienceStore::Mode::kReplace);
  store.Write({"new", "b", {PartAt(2.0)}});
  store.Finish();
  EXPECT_THAT(TimesOf({}), ElementsAre(2.0));
}

TEST_F(ExperienceStoreTest, WhatOthersHoldIsRefusedBeforeItIsReplaced) {
  Writer().Write({"old", "a", {PartAt(1.0)}});
  const ExperienceStore reader(Path(), ExperienceStore::Mode::kRead);
  EXPECT_EQ(reader.num_parts(), 1u);
  EXPECT_THAT(ConfigErrorOf([&] { ExperienceStore(Path(), ExperienceStore::Mode::kReplace); }),
              AllOf(HasSubstr("e.db: another program holds it"), HasSubstr("end that one")));
}

TEST_F(ExperienceStoreTest, WhatCannotBeReplacedIsKeptBesideIt) {
  ExperienceStore store(Path(), ExperienceStore::Mode::kReplace);
  store.Write({"new", "a", {PartAt(1.0)}});
  std::filesystem::create_directory(Path());
  EXPECT_THAT(ConfigErrorOf([&] { store.Finish(); }),
              AllOf(HasSubstr("e.db: cannot be replaced ("), HasSubstr("what was written is in "),
                    HasSubstr("e.db.unfinished")));
  EXPECT_EQ(ExperienceStore(Path("e.db.unfinished"), ExperienceStore::Mode::kRead).num_parts(), 1u);
}

TEST_F(ExperienceStoreTest, ALinkGoesOnLeadingToTheFile) {
  Writer().Write({"old", "a", {PartAt(1.0)}});
  std::filesystem::create_symlink(Path(), Path("link.db"));
  ExperienceStore store(Path("link.db"), ExperienceStore::Mode::kReplace);
  store.Write({"new", "a", {PartAt(2.0)}});
  store.Finish();
  EXPECT_TRUE(std::filesystem::is_symlink(Path("link.db")));
  EXPECT_THAT(TimesOf({}), ElementsAre(2.0));
}

TEST_F(ExperienceStoreTest, OtherFilesAreRefusedByName) {
  const auto open = [&](const std::string& path, ExperienceStore::Mode mode) {
    return ConfigErrorOf([&] { ExperienceStore(path, mode); });
  };
  EXPECT_THAT(open(Path("none.db"), ExperienceStore::Mode::kRead),
              AllOf(HasSubstr("none.db: no such file; wanted experiences: `hires_lab experiment "),
                    HasSubstr("topple_loop.yaml --experiences FILE` makes them")));
  EXPECT_THAT(open(Path("x/none.db"), ExperienceStore::Mode::kWrite),
              HasSubstr("there is no folder"));
  std::filesystem::create_directory(Path("folder.db"));
  for (const auto mode : {ExperienceStore::Mode::kWrite, ExperienceStore::Mode::kReplace}) {
    EXPECT_THAT(open(Path("folder.db"), mode), HasSubstr("folder.db: is no regular file; name"));
  }
  std::ofstream(Path("text.db")) << std::string(5000, 'x');
  for (const auto mode : {ExperienceStore::Mode::kRead, ExperienceStore::Mode::kWrite,
                          ExperienceStore::Mode::kReplace}) {
    EXPECT_THAT(open(Path("text.db"), mode), HasSubstr("text.db: holds no experiences; name"));
  }
  std::ofstream(Path("empty.db"));
  EXPECT_THAT(open(Path("empty.db"), ExperienceStore::Mode::kRead),
              HasSubstr("holds no experiences"));
}

TEST(ExperienceCsvTest, ALineHasTheFieldsOfTheListing) {
  EXPECT_EQ(CsvOf(PartAt(2.0)),
            "2000000000,0,2000000000,,2,notopple,0,2000000000,/base_footprint,0.25,0.5,0.0,"
            "0,1925000000,/map,1,-2,3,4,-5,6,0,0,,0.0,0.0,0.0,"
            "0,1925000000,/map,7,-8,9,10,-11,12,0,2000000000,/map,13,-14,1.5");
  EXPECT_THAT(ConfigErrorOf([] { ParseToppleState("toppled"); }),
              AllOf(HasSubstr("'toppled'"), HasSubstr("wanted notopple, shaking or topple")));
}

}  // namespace
}  // namespace hires::knowledge::experience_test
