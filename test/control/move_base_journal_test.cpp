#include "hires/control/move_base_journal.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::control::move_base_journal_test {
namespace {

using base::ConfigError;
using ::testing::AllOf;
using ::testing::HasSubstr;

class MoveBaseJournalTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = ::testing::TempDir() + "journal_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    path_ = folder_ + "/hires/originals.yaml";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void Put(const std::string& text) {
    std::filesystem::create_directories(folder_ + "/hires");
    std::ofstream(path_) << text;
  }

  /// What is said about a journal that is none.
  std::string Complaint(const std::string& text) {
    Put(text);
    try {
      ReadJournal(path_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no complaint";
  }

  std::string folder_, path_;
  // 0.1 + 0.2 is not 0.3: what is put back is what was there, to the last bit.
  const MoveBaseJournal journal_{"/move_base_node/DWAPlannerROS",
                                 "slow",
                                 {{"max_vel_x", 0.1 + 0.2}, {"acc_lim_th", 3.2}},
                                 {{"max_vel_x", 0.3}, {"acc_lim_th", 2.0}}};
};

TEST_F(MoveBaseJournalTest, WhatWasWrittenIsReadToTheLastBit) {
  WriteJournal(path_, journal_);
  EXPECT_EQ(ReadJournal(path_), journal_);
}

TEST_F(MoveBaseJournalTest, WritingAgainReplacesAndLeavesNothingElse) {
  WriteJournal(path_, journal_);
  MoveBaseJournal other = journal_;
  other.set_name = "fast";
  WriteJournal(path_, other);
  EXPECT_EQ(ReadJournal(path_), other);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ + "/hires")) {
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(files, 1);
}

TEST_F(MoveBaseJournalTest, NoFileIsNoJournalAndCanBeRemoved) {
  EXPECT_EQ(ReadJournal(path_), std::nullopt);
  EXPECT_NO_THROW(RemoveJournal(path_));
  WriteJournal(path_, journal_);
  RemoveJournal(path_);
  EXPECT_EQ(ReadJournal(path_), std::nullopt);
}

TEST_F(MoveBaseJournalTest, AFolderThatIsAFileIsNamedBeforeAnythingIsChanged) {
  std::ofstream(folder_ + "/hires") << "in the way";
  try {
    WriteJournal(path_, journal_);
    FAIL() << "where should it have written to?";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(path_), HasSubstr("cannot be written")));
  }
}

TEST_F(MoveBaseJournalTest, AFileThatWasCutOffIsNamedWithWhatCouldBeRead) {
  const std::string complaint = Complaint(
      "server: /move_base_node/DWAPlannerROS\n"
      "motion_set: slow\n"
      "parameters:\n"
      "  acc_lim_th: {original: 3.2, in_force: 2}\n"
      "  max_vel_x: {original: 0.55, in_fo}\n");
  EXPECT_THAT(complaint, HasSubstr(path_ + ": line 5: max_vel_x"));
  EXPECT_THAT(complaint, HasSubstr("/move_base_node/DWAPlannerROS: acc_lim_th 3.2"));
  EXPECT_THAT(complaint, HasSubstr("dynparam set"));
  EXPECT_THAT(complaint, HasSubstr("remove the file"));
}

TEST_F(MoveBaseJournalTest, WhatIsNoJournalIsAnError) {
  EXPECT_THAT(Complaint(""), HasSubstr("is no map"));
  EXPECT_THAT(Complaint("{"), HasSubstr("is no YAML"));
  EXPECT_THAT(Complaint("server: /a\nparameters: {x: {original: 0.5, in"),
              HasSubstr("\"server: /a / parameters: {x: {original: 0.5, in\""));
  EXPECT_THAT(Complaint("motion_set: slow\n"), HasSubstr("has no server"));
  EXPECT_THAT(Complaint("server: /a\nmotion_set: [slow]\n"), HasSubstr("has no motion_set"));
  EXPECT_THAT(Complaint("server: /a\nmotion_set: slow\n"), HasSubstr("has no parameters"));
  EXPECT_THAT(Complaint("server: /a\nmotion_set: slow\nparameters: {}\n"),
              HasSubstr("has no parameters"));
  EXPECT_THAT(Complaint("server: /a\nmotion_set: slow\nparametres: {}\n"),
              HasSubstr("line 3: has 'parametres', which is no key"));
  EXPECT_THAT(
      Complaint("server: /a\nmotion_set: slow\nparameters: {x: {original: fast, in_force: 1}}\n"),
      HasSubstr("x: original is 'fast', wanted a number"));
  EXPECT_THAT(
      Complaint("server: /a\nmotion_set: slow\nparameters: {x: {original: .nan, in_force: 1}}\n"),
      HasSubstr("wanted a number"));
}

TEST_F(MoveBaseJournalTest, AFolderInItsPlaceIsAnError) {
  std::filesystem::create_directories(path_);
  EXPECT_THROW(ReadJournal(path_), ConfigError);
  EXPECT_THROW(RemoveJournal(path_), ConfigError);
}

TEST_F(MoveBaseJournalTest, ItsDefaultPlaceIsInRosHome) {
  setenv("ROS_HOME", "/somewhere", 1);
  EXPECT_EQ(DefaultJournalPath(), "/somewhere/hires/move_base_originals.yaml");
  unsetenv("ROS_HOME");
  setenv("HOME", "/home/robot", 1);
  EXPECT_EQ(DefaultJournalPath(), "/home/robot/.ros/hires/move_base_originals.yaml");
}

}  // namespace
}  // namespace hires::control::move_base_journal_test
