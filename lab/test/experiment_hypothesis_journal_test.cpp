#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "lab/src/experiment/hypothesis_journal.h"
#include "lab/test/hypothesis_examples.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiment_hypothesis_journal_test {
namespace {

using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class HypothesisJournalTest : public ::testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "runs.journal").string(); }
  std::string Text() const { return base::ReadTextFile(path()); }
  void Overwrite(const std::string& text) const {
    std::ofstream(path(), std::ios::binary | std::ios::trunc) << text;
  }
  void WriteTwoRuns() const {
    HypothesisJournal journal(path(), Setting(4));
    journal.Append(RecordOf(1, true, true));
    journal.Append(RecordOf(1, false, false));
  }
  std::string ErrorWith(const HypothesisSetting& setting) const {
    return ErrorOf([&] { HypothesisJournal(path(), setting); });
  }

  TemporaryFolder folder_;
};

TEST_F(HypothesisJournalTest, GoesOnWithWhatIsThere) {
  WriteTwoRuns();
  const HypothesisJournal journal(path(), Setting(4));
  ASSERT_THAT(journal.runs(), SizeIs(2));
  EXPECT_EQ(ToJson(journal.runs()[0]), ToJson(RecordOf(1, true, true)));
  EXPECT_EQ(ToJson(journal.runs()[1]), ToJson(RecordOf(1, false, false)));
  EXPECT_TRUE(journal.Has(1, false));
  EXPECT_FALSE(journal.Has(2, true));
}

TEST_F(HypothesisJournalTest, DropsALineThatWasCutOffAnywhere) {
  WriteTwoRuns();
  const std::string whole = Text();
  const std::size_t head = whole.find('\n') + 1;
  const std::size_t second = whole.find('\n', head) + 1;
  for (std::size_t size = 1; size < whole.size(); size += 7) {
    Overwrite(whole.substr(0, size));
    {
      HypothesisJournal journal(path(), Setting(4));
      ASSERT_THAT(journal.runs(), SizeIs(size >= second ? 1 : 0)) << size;
      if (!journal.Has(1, true)) journal.Append(RecordOf(1, true, true));
      journal.Append(RecordOf(1, false, false));
    }
    EXPECT_EQ(Text(), whole) << size;
  }
}

TEST_F(HypothesisJournalTest, RefusesOtherArguments) {
  WriteTwoRuns();
  const std::string before = Text();
  HypothesisSetting other = Setting(4);
  other.seed = 2;
  EXPECT_THAT(ErrorWith(other), AllOf(HasSubstr(path()), HasSubstr("seed 1, now it is 2")));
  other = Setting(4);
  other.pace = 1.0;
  EXPECT_THAT(ErrorWith(other), HasSubstr("pace 4.0, now it is 1.0"));
  other = Setting(4);
  other.files = "f";
  EXPECT_THAT(ErrorWith(other), HasSubstr("files"));
  EXPECT_THAT(ErrorWith(Setting(5)), HasSubstr("runs 4, now it is 5"));
  EXPECT_EQ(Text(), before) << "what is there stays";
}

TEST_F(HypothesisJournalTest, RefusesWhatIsBrokenElsewhereThanAtItsEnd) {
  WriteTwoRuns();
  std::string text = Text();
  text.insert(text.find('\n') + 1, "{\"run\": 1}\n");
  Overwrite(text);
  EXPECT_THAT(ErrorWith(Setting(4)), AllOf(HasSubstr("line 2"), HasSubstr("'imagination'")));
  Overwrite("a letter to a friend\n");
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("line 1"));
  Overwrite("a letter to a friend");
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("line 1"));
  EXPECT_EQ(Text(), "a letter to a friend") << "another's file stays whole";
  Overwrite("{\"journal\": 7}\n");
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("line 1"));
}

TEST_F(HypothesisJournalTest, RefusesARunThatIsThereTwice) {
  WriteTwoRuns();
  const std::string text = Text();
  Overwrite(text + text.substr(text.find('\n') + 1));
  EXPECT_THAT(ErrorWith(Setting(4)), AllOf(HasSubstr("line 4"), HasSubstr("twice")));
}

TEST_F(HypothesisJournalTest, HasOneWriterAtATime) {
  const HypothesisJournal journal(path(), Setting(4));
  EXPECT_THAT(ErrorWith(Setting(4)), HasSubstr("another run of this experiment writes to it"));
}

}  // namespace
}  // namespace hires::lab::experiment_hypothesis_journal_test
