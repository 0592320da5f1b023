#include "lab/src/decision/decision_journal.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/imagination/client_config.h"
#include "lab/src/decision/decision_record.h"
#include "lab/test/decision_examples.h"
#include "support/temporary_folder.h"

namespace hires::lab::decision_journal_test {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string kConfig = HIRES_SOURCE_DIR "/config/";
const std::string kFiles = "0123456789abcdef";

const imagination::ImaginationSetup& TheSetup() {
  static const imagination::ImaginationSetup setup =
      imagination::LoadImaginationSetup(imagination::ReadSetupConfig(kConfig + "scene.yaml"));
  return setup;
}

DecisionTask Block(int number = 1) {
  DecisionTask task;
  task.number = number;
  task.load = "block";
  task.from = "premanipulationareaeastcounter1";
  task.to = "premanipulationareasouthtable1";
  task.torso = "torsomiddleposture";
  task.imagination_seed = static_cast<std::uint64_t>(number);
  return task;
}

/// Imagination itself on few rollouts; the truth is made up.
class DecisionJournalTest : public ::testing::Test {
 protected:
  DecisionParts Parts() {
    DecisionParts parts{
        TheSetup(), imagination::ReadClientConfig(kConfig + "imagination_client.yaml").scheduler};
    parts.scheduler.rollouts = 4;
    parts.oracle_plays = 2;
    parts.play = [this](const DecisionTask&, const std::string& set, std::uint64_t seed) {
      plays.push_back(set + std::to_string(seed));
      return std::make_optional(TruthPlay{{}, set == "fast" ? 10.0 : 20.0, 25.0, 0.1, 0.05});
    };
    return parts;
  }
  std::string path() const { return (folder_.path() / "j").string(); }
  /// All that the series lacks; how many pieces that were.
  static std::size_t PlayAll(const std::vector<DecisionTask>& tasks, const DecisionNeeds& needs,
                             const DecisionParts& parts, DecisionJournal* journal) {
    const auto missing = journal->Missing(tasks, needs, parts);
    for (const DecisionPiece& piece : missing) {
      EXPECT_TRUE(journal->Play(piece, needs.truth, parts));
    }
    return missing.size();
  }
  /// What is said of a line of a journal.
  std::string ErrorOf(const ordered_json& line) const {
    std::ofstream(path(), std::ios::trunc)
        << ordered_json{{"journal", "hires decision 2"}, {"seed", 1}, {"files", kFiles}}.dump()
        << '\n'
        << line.dump() << '\n';
    try {
      DecisionJournal(path(), 1, kFiles);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  std::vector<std::string> plays;
  hires::test_support::TemporaryFolder folder_;
};

TEST_F(DecisionJournalTest, ArmsShareRolloutsAndTasksOfACellThePlaysOfTheOracle) {
  DecisionJournal journal(path(), 1, kFiles);
  const DecisionParts parts = Parts();
  const DecisionNeeds needs{"foreign", true, true};
  EXPECT_EQ(PlayAll({Block(1)}, needs, parts, &journal), 1U + 1U + 2U);
  const DecisionRecord record = journal.RecordOf(Block(1), needs, parts);
  EXPECT_EQ(record.imagined.drives.at("slow").num_rollouts, 4);
  EXPECT_EQ(record.imagined.drives.at("fast").num_success,
            static_cast<int>(record.imagined.drives.at("fast").durations.size()));
  const auto& decided = record.imagined.decided;
  EXPECT_THAT(decided.at(kImaginationArm).advice, SizeIs(PriceScales().size()));
  EXPECT_LT(decided.at(kDissertationArm).simulated_seconds,
            decided.at(kImaginationArm).simulated_seconds / 3.0);
  ASSERT_THAT(plays, SizeIs(2 + 4)) << "one of each motion set, two of each for the oracle";
  EXPECT_EQ(plays[2].substr(4), plays[4].substr(4)) << "the oracle's seeds are those of both";
  EXPECT_THAT(record.oracle.at("fast"), SizeIs(2));
  DecisionNeeds constant = needs;
  constant.imagines = false;
  EXPECT_EQ(PlayAll({Block(2)}, constant, parts, &journal), 1U) << "the cell is known";
}

TEST_F(DecisionJournalTest, WhatWasImaginedIsSharedByTruthsAndOutlivesTheProgram) {
  const DecisionParts parts = Parts();
  ordered_json before;
  {
    DecisionJournal journal(path(), 1, kFiles);
    PlayAll({Block()}, {"same", true, false}, parts, &journal);
    before = ToJson(journal.RecordOf(Block(), {"same", true, false}, parts).imagined);
  }
  DecisionJournal journal(path(), 1, kFiles);
  const DecisionNeeds harsh{"harsh", true, false};
  const auto missing = journal.Missing({Block()}, harsh, parts);
  ASSERT_THAT(missing, SizeIs(1));
  EXPECT_EQ(missing[0].kind, DecisionPiece::Kind::kPlays);
  EXPECT_TRUE(journal.Play(missing[0], "harsh", parts));
  EXPECT_EQ(ToJson(journal.RecordOf(Block(), harsh, parts).imagined), before);
  EXPECT_THAT(journal.Missing({Block()}, {"same", true, false}, parts), IsEmpty());
}

TEST_F(DecisionJournalTest, IsLeftAsItWasWhenCancelled) {
  DecisionParts parts = Parts();
  parts.cancelled = [] { return true; };
  parts.play = [](const DecisionTask&, const std::string&, std::uint64_t) { return std::nullopt; };
  DecisionJournal journal(path(), 1, kFiles);
  const DecisionNeeds needs;
  for (const DecisionPiece& piece : journal.Missing({Block()}, needs, parts)) {
    EXPECT_FALSE(journal.Play(piece, needs.truth, parts));
  }
  EXPECT_THAT(journal.Missing({Block()}, needs, parts), SizeIs(4));
}

TEST_F(DecisionJournalTest, SaysWhatIsWrongWithALine) {
  const auto plays = [](const ordered_json& slow) {
    return ordered_json{{"truth", "same"}, {"task", 1}, {"plays", {{"slow", slow}}}};
  };
  EXPECT_THAT(ErrorOf(plays({1.0, "odd", 1.0, 1.0, 1.0})), HasSubstr("line 2: no failure code"));
  EXPECT_THAT(ErrorOf(plays({1.0, "", 1.0, 1.0, 1.0})), HasSubstr("lacks motion set 'fast'"));
  EXPECT_THAT(ErrorOf(plays({1.0, ""})), HasSubstr("line 2: "));
  EXPECT_THAT(ErrorOf({{"truth", "same"}}), HasSubstr("line 2: "));
  ordered_json imagined = ToJson(DecisionOf(1, "slow", true).imagined);
  imagined["decided"].erase(kDissertationArm);
  EXPECT_THAT(ErrorOf({{"request", "00"}, {"imagined", imagined}}),
              HasSubstr("lacks arm 'dissertation'"));
}

TEST_F(DecisionJournalTest, LinesComeBackFromText) {
  const DecisionRecord record = DecisionOf(3, "", true);
  EXPECT_EQ(ToJson(ParseImagined(ToJson(record.imagined))), ToJson(record.imagined));
  EXPECT_EQ(ToJson(ParseAlternatives(ToJson(record.plays))), ToJson(record.plays));
  EXPECT_EQ(ToJson(ParsePlays(ToJson(record.oracle.at("fast")))), ToJson(record.oracle.at("fast")));
}

TEST_F(DecisionJournalTest, TheHashOfARequestIsOfAllThatImaginationIsHanded) {
  const DecisionParts parts = Parts();
  std::set<std::uint64_t> hashes{RequestHash(Block(), parts)};
  const auto differs = [&](const DecisionTask& task, const DecisionParts& with) {
    return hashes.insert(RequestHash(task, with)).second;
  };
  const auto task = [](auto change) {
    DecisionTask changed = Block();
    change(&changed);
    return changed;
  };
  EXPECT_TRUE(differs(task([](auto* t) { t->load = "book"; }), parts));
  EXPECT_TRUE(differs(task([](auto* t) { t->from = "premanipulationareanorthtable1"; }), parts));
  EXPECT_TRUE(differs(task([](auto* t) { t->to = "premanipulationareawesttable2"; }), parts));
  EXPECT_TRUE(differs(task([](auto* t) { t->torso = "torsoupposture"; }), parts));
  EXPECT_TRUE(differs(task([](auto* t) { t->deadline = 9.0; }), parts));
  EXPECT_TRUE(differs(task([](auto* t) { t->price_factor = 0.5; }), parts));
  EXPECT_TRUE(differs(task([](auto* t) { t->imagination_seed = 2; }), parts));
  DecisionParts dearer = Parts(), fewer = Parts();
  dearer.scheduler.criteria.prices.late = 3.0;
  fewer.scheduler.rollouts = 2;
  EXPECT_TRUE(differs(Block(), dearer));
  EXPECT_TRUE(differs(Block(), fewer));
  // What the truth is like is none of it.
  EXPECT_FALSE(differs(task([](auto* t) { t->truth_seed = t->oracle_seed = 77; }), parts));
}

}  // namespace
}  // namespace hires::lab::decision_journal_test
