#include "lab/src/publish/publish_catalogue.h"

#include <gmock/gmock.h>

#include "hires/base/text.h"
#include "lab/test/publish_examples.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::publish_catalogue_test {
namespace {

using publish_examples::Catalogue;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class PublishCatalogueTest : public ::testing::Test {
 protected:
  PublishCatalogue Read(const std::string& text) const {
    return ReadPublishCatalogue(folder_.Write("publish.yaml", text));
  }
  std::string ErrorOf(const std::string& text) const {
    return hires::test_support::ConfigErrorOf([&] { Read(text); });
  }
  /// The example with one text in place of another.
  static std::string With(const std::string& old, const std::string& by) {
    std::string text = Catalogue();
    const std::size_t at = text.find(old);
    if (at == std::string::npos) throw std::logic_error("no such text: " + old);
    return text.replace(at, old.size(), by);
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(PublishCatalogueTest, NumbersHaveWhatTheirSeriesShares) {
  const PublishCatalogue catalogue = Read(Catalogue());
  ASSERT_EQ(catalogue.played.size(), 1u);
  ASSERT_EQ(catalogue.played[0].numbers.size(), 3u);
  const PlayedNumber& share = catalogue.played[0].numbers[0];
  EXPECT_EQ(share.number.truth, "same");
  EXPECT_EQ(share.number.seed, 3);
  EXPECT_EQ(share.number.n, 12);
  EXPECT_EQ(share.over, "/all");
  ASSERT_EQ(catalogue.kept.size(), 1u);
  EXPECT_TRUE(catalogue.kept[0].is_kept);
  EXPECT_EQ(catalogue.kept[0].version, "0.1.0");
  EXPECT_EQ(catalogue.kept[0].command, "long series");
  EXPECT_FALSE(catalogue.kept[0].n);
}

TEST_F(PublishCatalogueTest, AllThatIsWrongIsSaidAtOnce) {
  std::string text =
      Catalogue("", R"(  - {what: "lost", ours: "{sped}", against: "-", notes: docs/a.md}
  - {what: "odd", ours: "{speed:often}", against: "-", notes: docs/a.md}
)");
  text.replace(text.find("truth: same"), 11, "truth: mine");
  text.replace(text.find("2026-11-20"), 10, "yesterday!");
  text.replace(text.find("digits: 2"), 9, "digits: 9");
  text.replace(text.find("name: mean"), 10, "name: Mean");
  const std::string error = ErrorOf(text);
  EXPECT_EQ(base::Split(error, '\n').size(), 8u) << error;
  EXPECT_THAT(error, AllOf(HasSubstr("truth is 'mine', wanted"), HasSubstr("date is 'yesterday!'"),
                           HasSubstr("wanted a day such as 2026-11-28; line"),
                           HasSubstr("digits is '9'"), HasSubstr("name is 'Mean'"),
                           HasSubstr("row 'lost': number 'sped' is unknown; did you mean 'speed'"),
                           HasSubstr("row 'odd': has {speed:often}; wanted {name}")));
  EXPECT_THAT(error, AllOf(HasSubstr("row 'tasks': number 'mean' is unknown"),
                           HasSubstr("row 'speed': number 'mean' is unknown")));
}

TEST_F(PublishCatalogueTest, MissingAndUnknownKeysAreRefused) {
  EXPECT_THAT(ErrorOf("intro: a\nplayed: []\n"),
              AllOf(HasSubstr("kept"), HasSubstr("rows"), HasSubstr("remarks")));
  EXPECT_THAT(ErrorOf(With("seed: 3", "sead: 3")), HasSubstr("sead"));
  EXPECT_THAT(ErrorOf(With("at: /time", "")), HasSubstr("both `at` and `largest_of`, or neither"));
  EXPECT_THAT(ErrorOf(With("at: /time", "at: time")), HasSubstr("a JSON pointer such as"));
  EXPECT_THAT(ErrorOf(With("value: 480000", "value: 480000, low: 3")), HasSubstr("one end"));
  EXPECT_THAT(ErrorOf(With("value: 480000", "value: 4, low: 3, high: 2")),
              HasSubstr("above `high`"));
}

TEST_F(PublishCatalogueTest, NamesDiffer) {
  EXPECT_THAT(ErrorOf(With("name: speed", "name: share")),
              HasSubstr("the number 'share' is named twice"));
  const std::string again =
      "  - {name: quick, seconds: 1, inputs: [], command: \"list --json {answer}\", truth: none, "
      "numbers: []}\n";
  EXPECT_THAT(ErrorOf(Catalogue(again)), HasSubstr("the play 'quick' is named twice"));
}

TEST_F(PublishCatalogueTest, ItIsPlayedWithinAnHour) {
  EXPECT_THAT(ErrorOf(With("seconds: 1", "seconds: 3601")),
              HasSubstr("plays take 3601 s together, wanted at most 3600"));
}

TEST_F(PublishCatalogueTest, ATableThatNobodyReadsIsRefused) {
  std::string rows;
  for (int i = 0; i < 19; ++i) rows += "  - {what: a, ours: b, against: c, notes: docs/a.md}\n";
  EXPECT_THAT(ErrorOf(Catalogue("", rows)), HasSubstr("rows has 21 entries, wanted at most 20"));
}

TEST_F(PublishCatalogueTest, PlaysComeAfterThoseWhoseAnswersTheyTake) {
  const std::string before =
      "  - {name: after, seconds: 1, inputs: [], command: \"list {later/folder}/a --json "
      "{answer}\","
      " truth: none, numbers: []}\n"
      "  - {name: later, seconds: 1, inputs: [], command: \"list --json {answer}\", truth: none, "
      "numbers: []}\n";
  const std::vector<Play> plays = PlaysOf(Read(Catalogue(before)));
  ASSERT_EQ(plays.size(), 3u);
  EXPECT_EQ(plays[1].name, "later");
  EXPECT_EQ(plays[2].name, "after");
  EXPECT_THAT(ErrorOf(Catalogue("  - {name: a, seconds: 1, inputs: [], command: \"list {nobody} "
                                "--json {answer}\", truth: none, numbers: []}\n")),
              HasSubstr("play a: play 'nobody' is unknown"));
}

}  // namespace
}  // namespace hires::lab::publish_catalogue_test
