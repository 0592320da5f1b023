#include <gmock/gmock.h>

#include <filesystem>

#include "cli/exit_code.h"
#include "hires/base/text.h"
#include "hires/knowledge/experience.h"
#include "lab/test/lab_run.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiences_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunLab;
using knowledge::ExperienceStore;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

knowledge::ToppleEpisodePart PartAt(double time, std::uint32_t episode) {
  knowledge::ToppleEpisodePart part;
  part.time = time;
  part.episode = episode;
  return part;
}

/// Two runs, and a CSV file that was written before.
class ExperiencesCommandTest : public ::testing::Test {
 protected:
  ExperiencesCommandTest() {
    ExperienceStore store(store_, ExperienceStore::Mode::kWrite);
    store.Write({"fast/0", "drive(NT1, fast)", {PartAt(1.0, 0), PartAt(2.0, 1)}});
    store.Write({"slow/0", "drive(ST1, slow)", {PartAt(3.0, 0)}});
  }

  Ended Export(const std::vector<std::string>& selection) const {
    return RunLab({"experiences", "export", store_, "--csv", csv_}, selection);
  }

  /// What an export that is refused says.
  std::string RefusalOf(const std::vector<std::string>& selection) const {
    const Ended ended = Export(selection);
    EXPECT_EQ(ended.code, cli::kExitBadInput);
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(base::ReadTextFile(csv_), "before\n") << "the file stays";
    EXPECT_FALSE(std::filesystem::exists(csv_ + ".unfinished"));
    return ended.err;
  }

  const hires::test_support::TemporaryFolder folder_;
  const std::string store_{(folder_.path() / "e.db").string()};
  const std::string csv_{folder_.Write("parts.csv", "before\n")};
};

TEST_F(ExperiencesCommandTest, WhatIsAskedForIsExported) {
  const Ended ended = Export({"--run", "fast/0", "--action", "NT1", "--episode", "1"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out, "1 parts in " + csv_ + "\n");
  EXPECT_THAT(base::ReadTextFile(csv_), StartsWith("2000000000,0,2000000000,,1,notopple,"));
  EXPECT_THAT(Export({}).out, StartsWith("3 parts in "));
}

TEST_F(ExperiencesCommandTest, ANameThatIsNotThereIsRefused) {
  EXPECT_THAT(RefusalOf({"--run", "fsat/0"}),
              HasSubstr("e.db: --run: run 'fsat/0' is unknown; did you mean 'fast/0'?"));
  EXPECT_THAT(RefusalOf({"--action", "NT9"}),
              AllOf(HasSubstr("e.db: --action: action 'NT9' is unknown; did you mean"),
                    HasSubstr("'drive(NT1, fast)'")));
  EXPECT_THAT(RefusalOf({"--episode", "7"}),
              HasSubstr("e.db: --episode: no part is of episode 7; wanted one from 0 to 1"));
}

TEST_F(ExperiencesCommandTest, ANameOfAnotherRunIsRefused) {
  EXPECT_THAT(RefusalOf({"--run", "slow/0", "--action", "fast"}),
              HasSubstr("--action of run 'slow/0': action 'fast' is unknown; did you mean "
                        "'drive(ST1, slow)'?"));
  EXPECT_THAT(RefusalOf({"--run", "slow/0", "--episode", "1"}),
              HasSubstr("--episode of run 'slow/0': no part is of episode 1; wanted one from 0"));
}

TEST_F(ExperiencesCommandTest, WhatIsThereAndNeverSoGivesAnEmptyFile) {
  for (const std::vector<std::string>& selection :
       {std::vector<std::string>{"--from", "100", "--to", "200"},
        {"--state", "topple", "--run", "slow/0"},
        {"--run", "fast/0", "--episode", "1", "--to", "1.5"}}) {
    const Ended ended = Export(selection);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out, "0 parts in " + csv_ + "\n");
    EXPECT_EQ(base::ReadTextFile(csv_), "");
  }
}

TEST_F(ExperiencesCommandTest, TheStoreIsNotWrittenOver) {
  const std::string same = (folder_.path() / "." / "e.db").string();
  const std::string before = base::ReadTextFile(store_);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"export", store_, "--csv", same},
        {"stats", store_, "--json", same},
        {"analyse", store_, "--json", store_}}) {
    const Ended ended = RunLab({"experiences"}, words);
    EXPECT_EQ(ended.code, cli::kExitBadInput);
    EXPECT_THAT(ended.err, HasSubstr("would write over the store; name another file"));
    EXPECT_EQ(base::ReadTextFile(store_), before);
  }
}

TEST_F(ExperiencesCommandTest, NumbersThatAreNoneAreRefused) {
  EXPECT_THAT(RefusalOf({"--from", "nan"}), AllOf(HasSubstr("--from"), HasSubstr("'nan'")));
  EXPECT_THAT(RefusalOf({"--to", "soon"}), AllOf(HasSubstr("--to"), HasSubstr("'soon'")));
  EXPECT_THAT(RefusalOf({"--from", "2", "--to", "1"}), HasSubstr("--from 2 is later than --to 1"));
  EXPECT_THAT(RefusalOf({"--state", "toppled"}), HasSubstr("wanted notopple, shaking or topple"));
}

TEST_F(ExperiencesCommandTest, ASeedIsAWholeNumber) {
  for (const char* seed : {"-3", "2.5", "many"}) {
    const Ended ended = RunLab({"experiences", "analyse", store_, "--seed", seed});
    EXPECT_EQ(ended.code, cli::kExitBadInput);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--seed"), HasSubstr("is no whole number")));
  }
}

}  // namespace
}  // namespace hires::lab::experiences_command_test
