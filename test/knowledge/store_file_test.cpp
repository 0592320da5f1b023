#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/knowledge/store.h"
#include "knowledge/support/store_world.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::store_file_test {
namespace {

using test_support::At;
using test_support::Ever;
using test_support::HoldsAt;
using test_support::Names;
using test_support::PoseAt;
using test_support::QueryAll;
using test_support::SmallOntology;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string ErrorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

StoreOptions ReadOnly() {
  StoreOptions options;
  options.read_only = true;
  return options;
}

class StoreFileTest : public ::testing::Test {
 protected:
  Store Open(StoreOptions options = {}) { return Store(path_, SmallOntology(), options); }
  std::string ErrorOfOpening(StoreOptions options = {}) {
    return ErrorOf([&] { Open(options); });
  }
  /// A file as an older version wrote it.
  void WriteOld(const std::string& name) {
    SQLite::Database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec(base::ReadTextFile(HIRES_SOURCE_DIR "/test/knowledge/data/" + name));
  }
  /// Runs `call` in a process of its own, which ends by SIGKILL.
  static void RunAndDie(const std::function<void()>& call) {
    const pid_t child = fork();
    if (child == 0) {
      call();
      kill(getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "blackboard.db").string();
};

TEST_F(StoreFileTest, TheFileIsWholeAfterItsWriterEndedThoughAReaderHasItOpen) {
  std::optional<Store> writer(std::in_place, path_, SmallOntology(), StoreOptions{});
  const Store reader = Open(ReadOnly());
  reader.Stats();
  writer->Add({PoseAt("pose1", 1.0)}, At(1.0));
  EXPECT_GT(std::filesystem::file_size(path_ + "-wal"), 0u);
  writer.reset();
  EXPECT_EQ(std::filesystem::file_size(path_ + "-wal"), 0u);
}

TEST_F(StoreFileTest, NoLogIsLeftWhereTheWriterIsTheLastToEnd) {
  {
    Store writer = Open();
    const Store reader = Open(ReadOnly());
    reader.Stats();
    writer.Add({PoseAt("pose1", 1.0)}, At(1.0));
  }
  EXPECT_FALSE(std::filesystem::exists(path_ + "-wal"));
}

TEST_F(StoreFileTest, WhatWasWrittenIsThereAfterReopening) {
  {
    Store store = Open();
    store.StartEpisode("task", Episode::Label::kReal, 0, 1.0);
    store.Add({PoseAt("pose1", 1.0)}, At(1.0));
    store.Add({PoseAt("pose1", 2.0), PoseAt("pose2", 2.0)}, At(2.0, 1));
    store.Remove({"pose2"}, At(3.0));
  }
  Store store = Open();
  EXPECT_EQ(store.last_sequence(), 4u);
  EXPECT_THAT(store.ChangesSince(0, 10), SizeIs(4));
  EXPECT_THAT(QueryAll(store, Ever()), SizeIs(3));
  EXPECT_THAT(store.Episodes(), SizeIs(1));
  EXPECT_EQ(store.Add({PoseAt("pose3", 1.0)}, At(3.0)).at(0).sequence, 5u);
}

TEST_F(StoreFileTest, WhatWasAcknowledgedSurvivesAKilledProcess) {
  for (const Durability durability : {Durability::kProcess, Durability::kPower}) {
    StoreOptions options;
    options.durability = durability;
    std::filesystem::remove(path_);
    RunAndDie([&] {
      Store store = Open(options);
      for (int i = 0; i < 50; ++i) store.Add({PoseAt("pose1", i)}, At(i));
    });
    const Store store = Open();  // the dead one's lock is gone
    EXPECT_THAT(store.ChangesSince(0, 100), SizeIs(50));
    EXPECT_EQ(store.Find("pose1")->properties, PoseAt("", 49.0).properties);
  }
}

TEST_F(StoreFileTest, ASecondWriterLearnsWhoTheFirstIs) {
  Store store = Open();
  EXPECT_THAT(ErrorOfOpening(), AllOf(HasSubstr(path_), HasSubstr("being written by process " +
                                                                  std::to_string(getpid()))));
  const std::string other_way = (folder_.path() / "." / "blackboard.db").string();
  EXPECT_THAT(ErrorOf([&] { Store(other_way, SmallOntology()); }), HasSubstr("being written"));
  store.Add({PoseAt("pose1", 1.0)}, At(1.0));  // the first goes on
}

TEST_F(StoreFileTest, ReadersSeeEveryAcknowledgedChange) {
  Store writer = Open();
  const Store reader = Open(ReadOnly());
  const Store another = Open(ReadOnly());
  for (int i = 1; i <= 20; ++i) {
    writer.Add({PoseAt("pose" + std::to_string(i), i)}, At(i));
    if (i == 10) {
      writer.Add({test_support::MakeFluent("Mug", "mug1")}, At(i));
      FluentQuery mugs;
      mugs.concepts = {{"Mug"}};
      EXPECT_THAT(Names(QueryAll(reader, mugs)), ElementsAre("mug1"));  // a concept of later
    }
    EXPECT_EQ(reader.last_sequence(), writer.last_sequence());
    EXPECT_EQ(QueryAll(reader, FluentQuery()), QueryAll(writer, FluentQuery()));
    EXPECT_TRUE(another.Find("pose" + std::to_string(i)).has_value());
  }
}

TEST_F(StoreFileTest, AReaderCannotWrite) {
  Open();
  Store reader = Open(ReadOnly());
  EXPECT_THAT(ErrorOf([&] { reader.Add({PoseAt("pose1", 1.0)}, At(1.0)); }),
              AllOf(HasSubstr(path_), HasSubstr("read-only")));
  EXPECT_THAT(QueryAll(reader, FluentQuery()), SizeIs(0));
}

TEST_F(StoreFileTest, AFullStoreRefusesAndKeepsWhatItHas) {
  StoreOptions options;
  options.max_bytes = 400'000;
  Store store = Open(options);
  const std::string text(100'000, 'a');
  const auto add = [&](int i) {
    store.Add({PoseAt("pose" + std::to_string(i), 1.0),
               test_support::MakeFluent("Mug", "mug" + std::to_string(i),
                                        {{"hasColour", "xsd:string", text}})},
              At(i));
  };
  add(1);
  add(2);
  EXPECT_THAT(ErrorOf([&] {
                for (int i = 3; i < 9; ++i) add(i);
              }),
              AllOf(HasSubstr(path_), HasSubstr("no room"), HasSubstr("max_bytes")));
  const std::uint64_t last = store.last_sequence();
  EXPECT_EQ(last % 2, 0u);  // no half of a batch
  EXPECT_THAT(store.ChangesSince(0, 100), SizeIs(last));
  EXPECT_EQ(store.Stats().instances, last);
  store.Add({PoseAt("small", 1.0)}, At(10.0));  // there is room for this one
  EXPECT_EQ(store.last_sequence(), last + 1);
  EXPECT_EQ(store.Find("small")->instance, "small");
}

TEST_F(StoreFileTest, AFullStoreCanGrowAgain) {
  StoreOptions options;
  options.max_bytes = 200'000;
  int refused = 0;
  {
    Store store = Open(options);
    for (int i = 0; i < 3000; ++i) {
      try {
        store.Add({PoseAt("pose" + std::to_string(i), i)}, At(i));
      } catch (const base::ConfigError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 0);
    EXPECT_EQ(store.last_sequence(), 3000u - static_cast<unsigned>(refused));
  }
  Store store = Open();
  EXPECT_EQ(store.last_sequence(), 3000u - static_cast<unsigned>(refused));
  store.Add({PoseAt("more", 1.0)}, At(4000.0));
  EXPECT_THAT(QueryAll(store, Ever()), SizeIs(3001 - refused));
}

TEST_F(StoreFileTest, WhatIsNoStoreIsRefusedAndLeftAlone) {
  const std::string text(5000, 'x');
  folder_.Write("blackboard.db", text);
  EXPECT_THAT(ErrorOfOpening(), AllOf(HasSubstr(path_), HasSubstr("no Blackboard store")));
  EXPECT_EQ(base::ReadTextFile(path_), text);
  std::filesystem::remove(path_);
  {
    SQLite::Database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE a(b)");
  }
  EXPECT_THAT(ErrorOfOpening(), AllOf(HasSubstr("no Blackboard store"), HasSubstr("SQLite")));
}

TEST_F(StoreFileTest, APathThatLeadsNowhereIsRefused) {
  EXPECT_THAT(ErrorOf([] { Store("", SmallOntology()); }), HasSubstr("no path"));
  EXPECT_THAT(ErrorOf([&] { Store(folder_.path().string(), SmallOntology()); }),
              HasSubstr("is a folder"));
  EXPECT_THAT(ErrorOf([&] { Store((folder_.path() / "no" / "x.db").string(), SmallOntology()); }),
              HasSubstr("there is no folder"));
  EXPECT_THAT(ErrorOfOpening(ReadOnly()), HasSubstr("no such file"));
  EXPECT_THAT(ErrorOf([] { Store(":memory:", SmallOntology(), ReadOnly()); }),
              HasSubstr(":memory:"));
  folder_.Write("blackboard.db", "");
  EXPECT_THAT(ErrorOfOpening(ReadOnly()), HasSubstr("is empty"));
}

TEST_F(StoreFileTest, ANewerSchemaIsRefused) {
  Open();
  SQLite::Database(path_, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 5");
  EXPECT_THAT(ErrorOfOpening(), AllOf(HasSubstr("schema 5"), HasSubstr("up to 4")));
  EXPECT_THAT(ErrorOfOpening(ReadOnly()), HasSubstr("schema 5"));
}

TEST_F(StoreFileTest, TheFirstSchemaIsMigrated) {
  WriteOld("store_v1.sql");  // without the index by episode
  EXPECT_THAT(ErrorOfOpening(ReadOnly()), HasSubstr("has schema 1"));
  Store store = Open();
  EXPECT_EQ(store.Stats().schema, 4);
  EXPECT_EQ(store.last_sequence(), 5u);
  EXPECT_THAT(Names(QueryAll(store, FluentQuery())), ElementsAre("mug1", "pose1"));
  EXPECT_EQ(QueryAll(store, HoldsAt(15.0)).at(1).properties, PoseAt("", 1.5).properties);
  FluentQuery query = Ever();
  query.episode = 1;
  EXPECT_THAT(Names(QueryAll(store, query)), ElementsAre("pose1", "pose1", "pose1"));
  store.Add({PoseAt("pose1", 9.0)}, At(50.0, 1));
  SQLite::Database raw(path_, SQLite::OPEN_READONLY);
  EXPECT_EQ(raw.execAndGet("PRAGMA user_version").getInt(), 4);
  EXPECT_EQ(
      raw.execAndGet("SELECT count(*) FROM sqlite_master WHERE name = 'validity_in'").getInt(), 1);
}

FluentQuery OnMug1() {
  FluentQuery query;
  query.properties = {{"hasObject", Filler(std::string("MUG1"))}};
  return query;
}

TEST_F(StoreFileTest, TheSecondSchemaIsMigrated) {
  WriteOld("store_v2.sql");  // without the indexes of what is open
  EXPECT_THAT(ErrorOfOpening(ReadOnly()), HasSubstr("has schema 2"));
  {
    Store store = Open();
    EXPECT_EQ(store.Stats().schema, 4);
    EXPECT_EQ(store.last_sequence(), 8u);
    const FluentPage now = store.Query(OnMug1());  // said three times, one holds
    ASSERT_THAT(Names(now.fluents), ElementsAre("on1"));
    EXPECT_EQ(now.fluents[0].start.earliest, 3.0);
    FluentQuery imagined = OnMug1();
    imagined.label = Episode::Label::kImagined;
    EXPECT_THAT(Names(QueryAll(store, imagined)), ElementsAre("on1"));
    FluentQuery states;
    states.concepts = {{"State"}};
    EXPECT_THAT(QueryAll(store, states), SizeIs(1));
    states.time = HoldsAt(3.5).time;
    EXPECT_THAT(Names(QueryAll(store, states)), ElementsAre("on1", "on2"));
    store.Add({test_support::MakeFluent("On", "on2", {{"hasObject", "Mug", std::string("mug1")}})},
              At(7.0));
    store.Remove({"on1"}, At(8.0));
    EXPECT_THAT(Names(QueryAll(store, OnMug1())), ElementsAre("on2"));
  }
  EXPECT_THAT(Names(QueryAll(Open(ReadOnly()), OnMug1())), ElementsAre("on2"));
}

TEST_F(StoreFileTest, TheIndexOfOpenFillersIsThatOfWhatIsOpen) {
  WriteOld("store_v2.sql");
  {
    Store store = Open();
    for (int i = 0; i < 20; ++i) {
      store.Add({test_support::MakeFluent("On", "on" + std::to_string(i % 3),
                                          {{"hasObject", "Mug", std::string("mug1")},
                                           {"hasArea", "Area", "area" + std::to_string(i % 5)}})},
                At(10.0 + i, i % 2));  // by turns in the imagined episode
      if (i % 4 == 3) store.Remove({"on" + std::to_string(i % 3)}, At(10.0 + i, i % 2));
    }
  }
  SQLite::Database raw(path_, SQLite::OPEN_READONLY);
  const std::string wanted =
      "SELECT f.hash, v.world, v.id FROM filler AS f JOIN validity AS v ON v.id = f.validity "
      "WHERE v.closed = 9223372036854775807";
  const std::string kept = "SELECT hash, world, validity FROM open_filler";
  const auto count = [&](const std::string& rows) {
    return raw.execAndGet("SELECT count(*) FROM (" + rows + ")").getInt();
  };
  EXPECT_GE(count(wanted), 8);
  EXPECT_EQ(count(wanted + " EXCEPT " + kept), 0);
  EXPECT_EQ(count(kept + " EXCEPT " + wanted), 0);
}

TEST_F(StoreFileTest, AMigrationThatFailsLeavesTheOldSchema) {
  WriteOld("store_v1.sql");
  const auto run = [&](const std::string& sql) {
    SQLite::Database(path_, SQLite::OPEN_READWRITE).exec(sql);
  };
  const auto schema = [&] {
    return SQLite::Database(path_).execAndGet("PRAGMA user_version").getInt();
  };
  run("CREATE TABLE validity_in(a)");  // stands where a new index belongs
  EXPECT_THAT(ErrorOfOpening(), HasSubstr(path_));
  EXPECT_EQ(schema(), 1);
  run("DROP TABLE validity_in; CREATE TABLE validity_open(a)");  // and that of the next step
  EXPECT_THAT(ErrorOfOpening(), HasSubstr(path_));
  EXPECT_EQ(schema(), 2);
  run("DROP TABLE validity_open");
  EXPECT_THAT(QueryAll(Open(), FluentQuery()), SizeIs(2));
  EXPECT_EQ(schema(), 4);
}

TEST_F(StoreFileTest, DamageIsNamedAndOtherFluentsAreStillRead) {
  Open().Add({PoseAt("pose1", 1.0), PoseAt("pose2", 2.0)}, At(1.0));
  SQLite::Database(path_, SQLite::OPEN_READWRITE)
      .exec("UPDATE validity SET properties = x'05010203' WHERE id = 1");
  Store store = Open();
  EXPECT_THAT(ErrorOf([&] { store.Find("pose1"); }),
              AllOf(HasSubstr(path_), HasSubstr("damaged"), HasSubstr(".recover")));
  EXPECT_THAT(ErrorOf([&] { store.Query(FluentQuery()); }), HasSubstr("damaged"));
  EXPECT_TRUE(store.Find("pose2").has_value());
  store.Add({PoseAt("pose3", 2.0)}, At(2.0));
  store.Add({PoseAt("pose1", 3.0)}, At(3.0));  // takes the place of the damaged one
  EXPECT_THAT(Names(QueryAll(store, FluentQuery())), ElementsAre("pose1", "pose2", "pose3"));
}

TEST_F(StoreFileTest, AnOverwrittenOrCutFileIsAnErrorNotACrash) {
  {
    Store store = Open();
    for (int i = 0; i < 2000; ++i) store.Add({PoseAt("pose" + std::to_string(i), i)}, At(i));
  }
  const std::string whole = base::ReadTextFile(path_);
  const auto use = [&] {
    Store store = Open();
    QueryAll(store, FluentQuery());
    store.ChangesSince(0, 10'000);
  };
  ASSERT_EQ(ErrorOf(use), "no error");
  std::string broken = whole;
  broken.replace(whole.size() / 3, whole.size() / 3, whole.size() / 3, '\xa5');
  folder_.Write("blackboard.db", broken);
  EXPECT_THAT(ErrorOf(use), AllOf(HasSubstr(path_), HasSubstr("damaged")));
  folder_.Write("blackboard.db", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(ErrorOf(use), AllOf(HasSubstr(path_), HasSubstr("damaged")));
}

/// Root may write everywhere; so another user does it.
class Nobody {
 public:
  Nobody() : root_(geteuid() == 0 && seteuid(65534) == 0) {}
  ~Nobody() {
    if (root_ && seteuid(0) != 0) std::abort();
  }

 private:
  bool root_;
};

TEST_F(StoreFileTest, AFolderThatMayNotBeWrittenIsAnErrorForWritersOnly) {
  Open().Add({PoseAt("pose1", 1.0)}, At(1.0));
  std::filesystem::remove(path_ + ".lock");
  std::filesystem::permissions(folder_.path(), std::filesystem::perms(0555));
  {
    const Nobody nobody;
    EXPECT_THAT(ErrorOfOpening(),
                AllOf(HasSubstr(path_), HasSubstr("Permission denied"), HasSubstr("read-only")));
    EXPECT_THAT(QueryAll(Open(ReadOnly()), FluentQuery()), SizeIs(1));
  }
  std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
  EXPECT_EQ(ErrorOfOpening(), "no error");
}

TEST_F(StoreFileTest, AnotherProgramThatWritesIsNamedBusyAndNothingIsLost) {
  Store store = Open();
  store.Add({PoseAt("pose1", 1.0)}, At(1.0));
  SQLite::Database other(path_, SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  EXPECT_THAT(ErrorOf([&] { store.Add({PoseAt("pose2", 1.0)}, At(2.0)); }),
              AllOf(HasSubstr(path_), HasSubstr("another program")));
  other.exec("ROLLBACK");
  EXPECT_EQ(store.Add({PoseAt("pose2", 1.0)}, At(2.0)).at(0).sequence, 2u);
}

}  // namespace
}  // namespace hires::knowledge::store_file_test
