#include "hires/control/move_base_keeper.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/move_base_fakes.h"

namespace hires::control::move_base_keeper_test {
namespace {

using base::ConfigError;
using test_support::By;
using test_support::FakePlanner;
using test_support::kFast;
using test_support::kPlanner;
using test_support::kSlow;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class MotionSetKeeperTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = ::testing::TempDir() + "keeper_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    path_ = folder_ + "/originals.yaml";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Another process with the same journal.
  MotionSetKeeper Keeper(const std::string& planner = kPlanner) const {
    RobotNames::MoveBase names = test_support::NamesOfDwa();
    names.planner = planner;
    return MotionSetKeeper(names, path_, By(planner_));
  }

  std::string ComplaintOfApply(const robot::MotionSet& set) const {
    try {
      Keeper().Apply("slow", set);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no complaint";
  }

  bool HasJournal() const { return std::filesystem::exists(path_); }

  std::string folder_, path_;
  const PlannerValues before_ = test_support::OldDwa();
  const std::shared_ptr<FakePlanner> planner_ = std::make_shared<FakePlanner>();
};

TEST_F(MotionSetKeeperTest, ASetIsAppliedAtOnceAndPutBack) {
  MotionSetKeeper keeper = Keeper();
  keeper.Apply("slow", kSlow);
  EXPECT_THAT(planner_->changes, SizeIs(1));  // all in one call: no mixture is ever in force
  EXPECT_EQ(planner_->values.at("max_vel_x"), 0.30);
  EXPECT_EQ(planner_->values.at("max_trans_vel"), 0.30);
  EXPECT_EQ(planner_->values.at("acc_lim_x"), 1.4);
  EXPECT_EQ(planner_->values.at("acc_lim_y"), 1.4);
  EXPECT_EQ(planner_->values.at("acc_lim_th"), 2.0);
  EXPECT_EQ(planner_->values.at("max_vel_y"), 0.1);    // not ours to change
  EXPECT_EQ(planner_->values.at("min_rot_vel"), 0.3);  // likewise
  EXPECT_NO_THROW(keeper.Verify());
  keeper.Restore();
  EXPECT_EQ(planner_->values, before_);
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, AnotherProcessPutsBackWhatAKilledOneLeft) {
  Keeper().Apply("slow", kSlow);
  ASSERT_TRUE(HasJournal());
  Keeper().Restore();
  EXPECT_EQ(planner_->values, before_);
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, AKilledOnesSetIsNotTakenForTheOriginal) {
  planner_->values["max_vel_x"] = 0.45;
  Keeper().Apply("slow", kSlow);
  MotionSetKeeper next = Keeper();
  next.Apply("fast", kFast);
  EXPECT_EQ(planner_->values.at("max_vel_x"), 0.55);
  next.Restore();
  EXPECT_EQ(planner_->values.at("max_vel_x"), 0.45);
}

TEST_F(MotionSetKeeperTest, NothingIsChangedBeforeTheJournalIsOnDisk) {
  std::filesystem::create_directories(path_ + ".new");  // where it would be written first
  EXPECT_THAT(ComplaintOfApply(kSlow), HasSubstr("cannot be written"));
  EXPECT_THAT(planner_->changes, IsEmpty());
}

TEST_F(MotionSetKeeperTest, AClampedValueIsAnErrorAndEverythingIsPutBack) {
  planner_->lower["max_vel_x"] = 0.4;
  const std::string complaint = ComplaintOfApply(kSlow);
  EXPECT_THAT(complaint, HasSubstr(kPlanner));
  EXPECT_THAT(complaint, HasSubstr("motion set slow"));
  EXPECT_THAT(complaint, HasSubstr("max_vel_x is 0.4, wanted 0.3"));
  EXPECT_EQ(planner_->values, before_);
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, AnIgnoredValueIsAnErrorAndEverythingIsPutBack) {
  planner_->ignored = {"acc_lim_th"};
  EXPECT_THAT(ComplaintOfApply(kSlow), HasSubstr("acc_lim_th is 3.2, wanted 2"));
  EXPECT_EQ(planner_->values, before_);
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, AParameterThatIsNotThereIsNamedAndNothingIsChanged) {
  planner_->values.erase("acc_lim_th");
  EXPECT_THAT(ComplaintOfApply(kSlow), HasSubstr("max_angular_acceleration"));
  EXPECT_THAT(planner_->changes, IsEmpty());
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, AMissingServerIsNamed) {
  planner_->is_missing = true;
  EXPECT_THAT(ComplaintOfApply(kSlow), HasSubstr("no service /move_base_node/DWAPlannerROS"));
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, TheJournalStaysWhereThePlannerIsGone) {
  MotionSetKeeper keeper = Keeper();
  keeper.Apply("slow", kSlow);
  planner_->is_missing = true;
  EXPECT_THROW(keeper.Restore(), ConfigError);
  EXPECT_TRUE(HasJournal());
  planner_->is_missing = false;
  keeper.Restore();
  EXPECT_EQ(planner_->values, before_);
}

TEST_F(MotionSetKeeperTest, TheJournalStaysWhereThePlannerTakesNothingBack) {
  MotionSetKeeper keeper = Keeper();
  keeper.Apply("slow", kSlow);
  planner_->ignored = {"max_vel_x"};
  EXPECT_THROW(keeper.Restore(), ConfigError);
  EXPECT_TRUE(HasJournal());
}

TEST_F(MotionSetKeeperTest, WhatSomebodyElseChangedSinceStays) {
  MotionSetKeeper keeper = Keeper();
  keeper.Apply("slow", kSlow);
  planner_->values["max_vel_x"] = 0.2;
  EXPECT_THROW(keeper.Verify(), ConfigError);
  keeper.Restore();
  PlannerValues wanted = before_;
  wanted["max_vel_x"] = 0.2;
  EXPECT_EQ(planner_->values, wanted);
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, WhatWasLeftAtAPlannerOfAnotherNameIsPutBackFirst) {
  Keeper().Apply("slow", kSlow);
  MotionSetKeeper renamed = Keeper("/move_base/DWAPlannerROS");  // which nobody runs
  EXPECT_THROW(renamed.Apply("fast", kFast), ConfigError);
  EXPECT_EQ(planner_->values, before_);
  EXPECT_FALSE(HasJournal());
}

TEST_F(MotionSetKeeperTest, AnUnreadableJournalForbidsToChangeAnything) {
  std::ofstream(path_) << "server: /move_base_node/DWAPlannerROS\nmotion_set: slow\nparameters: {x";
  EXPECT_THAT(ComplaintOfApply(kSlow), HasSubstr("remove the file"));
  EXPECT_THROW(Keeper().Restore(), ConfigError);
  EXPECT_THAT(planner_->changes, IsEmpty());
  EXPECT_TRUE(HasJournal());
}

TEST_F(MotionSetKeeperTest, WithoutAJournalNothingIsPutBack) {
  planner_->is_missing = true;  // who calls it is told so
  EXPECT_NO_THROW(Keeper().Restore());
  EXPECT_THROW(Keeper().Verify(), ConfigError);
}

}  // namespace
}  // namespace hires::control::move_base_keeper_test
