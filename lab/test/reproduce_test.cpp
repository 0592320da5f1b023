#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "lab/src/reproduce/catalogue.h"
#include "lab/src/reproduce/judge.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::reproduce_test {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kPlays = R"(
plays:
  - {name: loop, seconds: 3, inputs: [config], command: "experiment loop --json {answer}"}
  - {name: looked, seconds: 1, inputs: [], command: "look {loop} --json {answer}", done_codes: ["0", "2"]}
)";

std::string Item(const std::string& value, const std::string& plays = "[loop]") {
  return "items:\n  - {item: Table 1, section: \"6.3.1\", title: t, plays: " + plays +
         ", holds: yes, fails: \"no, slower\", bounds: ours, values: [" + value + "]}\n";
}

class CatalogueTest : public ::testing::Test {
 protected:
  Catalogue Read(const std::string& text) {
    return ReadCatalogue(folder_.Write("catalogue.yaml", text));
  }
  std::string ErrorOf(const std::string& text) {
    return hires::test_support::ConfigErrorOf([&] { Read(text); });
  }
  static std::vector<std::string> NamesOf(const Catalogue& catalogue,
                                          const std::vector<std::string>& wanted) {
    std::vector<std::string> found;
    for (const CatalogueItem& item : ItemsOf(catalogue, wanted)) found.push_back(item.name);
    return found;
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(CatalogueTest, PlaysComeAfterThoseWhoseAnswersTheyTake) {
  const Catalogue catalogue = Read(R"(
plays:
  - {name: looked, seconds: 1, inputs: [], command: "look {loop/folder} {loop} --json {answer}"}
  - {name: loop, seconds: 3, inputs: [config], command: "experiment loop --json {answer}"}
  - {name: other, seconds: 3, inputs: [], command: "other --json {answer}"}
items:
  - {item: Fig. 1, section: A.2, title: t, plays: [looked], holds: yes, drawings: ["looked:lines"]}
)");
  EXPECT_THAT(NeededBy(catalogue.plays[0]), ElementsAre("loop", "loop"));
  std::vector<std::string> order;
  for (const Play& play : PlaysFor(catalogue, catalogue.items)) order.push_back(play.name);
  EXPECT_THAT(order, ElementsAre("loop", "looked"));
}

TEST_F(CatalogueTest, WhatIsJudgedByNothingPublishedMustSayThatItIsOurOwn) {
  const std::string value = "{name: v, at: /x, at_least: 1}, {name: s, at: /y, ";
  const std::string error = ErrorOf(kPlays + Item(value + "published: 1, shown: true}"));
  EXPECT_THAT(error, AllOf(HasSubstr("catalogue.yaml: "), HasSubstr("item is 'Table 1'"),
                           HasSubstr("write `own: true`"), HasSubstr("line 6")));
  EXPECT_FALSE(Read(kPlays + Item(value + "published: 1, at_most: 2}")).items[0].is_own);
  std::string own = Item(value + "shown: true}");
  own.insert(own.find("title:"), "own: true, ");
  EXPECT_TRUE(Read(kPlays + own).items[0].is_own);
}

TEST_F(CatalogueTest, WhoAsksForWhatIsNotThereLearnsHowToListAll) {
  const Catalogue catalogue = ReadCatalogue(HIRES_SOURCE_DIR "/lab/config/reproduce.yaml");
  const auto error = [&](const std::string& wanted) {
    return hires::test_support::ConfigErrorOf([&] { NamesOf(catalogue, {wanted}); });
  };
  for (const char* wanted : {"9.9.9", "foo", "Figure 6.55"}) {
    EXPECT_THAT(error(wanted), HasSubstr("`hires_lab reproduce --list` lists")) << wanted;
  }
  EXPECT_THAT(error("Figure 6.55"), HasSubstr("did you mean 'Fig. 6.5'"));
}

TEST_F(CatalogueTest, ItemsAreAskedForBySectionOrName) {
  const Catalogue catalogue = Read(kPlays + R"(
items:
  - {item: Table 6.1, section: "6.1", title: t, holds: x}
  - {item: Table 6.5, section: "6.3.2", title: t, holds: x}
  - {item: Fig. 6.13, section: "6.3.3", title: t, holds: x}
  - {item: Fig. A.2, section: "A.2", title: t, holds: x}
)");
  const auto names = [&](const std::vector<std::string>& wanted) {
    return NamesOf(catalogue, wanted);
  };
  EXPECT_THAT(names({"6.3"}), ElementsAre("Table 6.5", "Fig. 6.13"));
  EXPECT_THAT(names({"a", "table 6.5"}), ElementsAre("Table 6.5", "Fig. A.2"));
  EXPECT_EQ(names({"all"}).size(), 4u);
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { names({"6.4"}); }),
              AllOf(HasSubstr("'6.4' is unknown"), HasSubstr("6.1")));
}

TEST_F(CatalogueTest, KindsMayBeWrittenOutOrShort) {
  const Catalogue catalogue = Read(kPlays + R"(
items:
  - {item: List. 5.1, section: "5.7.2", title: t, holds: x}
  - {item: Section 5.9, section: "5.9", title: t, holds: x}
  - {item: Fig. 6.5, section: "6.1.4", title: t, holds: x}
  - {item: Table 6.5, section: "6.3.2", title: t, holds: x}
  - {item: Fig. A.2, section: "A.2", title: t, holds: x}
)");
  const auto names = [&](const std::vector<std::string>& wanted) {
    return NamesOf(catalogue, wanted);
  };
  for (const char* figure : {"Fig 6.5", "Figure 6.5", "fig. 6.5", "Fig. 6.5", " figure  6.5 "}) {
    EXPECT_THAT(names({figure}), ElementsAre("Fig. 6.5")) << figure;
  }
  for (const char* table : {"Tab. 6.5", "tab 6.5", "TABLE 6.5"}) {
    EXPECT_THAT(names({table}), ElementsAre("Table 6.5")) << table;
  }
  for (const char* listing : {"Listing 5.1", "list. 5.1", "List 5.1"}) {
    EXPECT_THAT(names({listing}), ElementsAre("List. 5.1")) << listing;
  }
  EXPECT_THAT(names({"chapter 5"}), ElementsAre("List. 5.1", "Section 5.9"));
  EXPECT_THAT(names({"section 6.1"}), ElementsAre("Fig. 6.5"));
  EXPECT_THAT(names({"Sec. 5.9"}), ElementsAre("Section 5.9"));
  EXPECT_THAT(names({"appendix A"}), ElementsAre("Fig. A.2"));
  EXPECT_THAT(names({"Figure", "6.5", "A"}), ElementsAre("Fig. 6.5", "Fig. A.2"))
      << "as a shell hands over what stands in no quotes";
  const auto error = [&](const std::vector<std::string>& wanted) {
    return hires::test_support::ConfigErrorOf([&] { names(wanted); });
  };
  EXPECT_THAT(error({"Figure 6.55"}), HasSubstr("'Fig. 6.55' is unknown; did you mean 'Fig. 6.5'"));
  EXPECT_THAT(error({"Tabel 6.5"}), HasSubstr("did you mean 'Table 6.5'"));
  EXPECT_THAT(error({"Figure"}), HasSubstr("did you mean"));
}

TEST_F(CatalogueTest, WhatIsWrongIsNamed) {
  EXPECT_THAT(
      ErrorOf("plays: [{name: a, seconds: 1, inputs: [], command: \"list areas\"}]\nitems: []"),
      HasSubstr("wanted --json {answer}"));
  EXPECT_THAT(
      ErrorOf("plays: [{name: a, seconds: 1, inputs: [], command: \"a {b} {answer}\"}]\nitems: []"),
      HasSubstr("play 'b' is unknown"));
  EXPECT_THAT(
      ErrorOf("plays: [{name: a, seconds: 1, inputs: [], command: \"a {a} {answer}\"}]\nitems: []"),
      HasSubstr("in a circle: a -> a"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: /x, published: 1}")),
              AllOf(HasSubstr("accepted by 0 rules"), HasSubstr("catalogue.yaml")));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: /x, published: 1, within: 1, factor: 2}")),
              HasSubstr("accepted by 2 rules"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: /x, published: 1, within: 1, shown: true}")),
              HasSubstr("accepted by 2 rules"));
  EXPECT_THAT(ErrorOf(kPlays + "items:\n  - {item: T, section: s, title: t, holds: x, fails: y, "
                               "plays: [loop], values: [{name: v, at: /x, at_least: 1}]}\n"),
              HasSubstr("bounds"));
  EXPECT_THAT(
      ErrorOf(kPlays + "items:\n  - {item: T, section: s, title: t, holds: x, own: true}\n"),
      HasSubstr("nothing is judged"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: /x, within: 1}")),
              HasSubstr("nothing published to be near to"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: /x, published: 1, factor: 0.5}")),
              HasSubstr("factor is '0.5', below 1"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: x, published: 1, within: 1}")),
              HasSubstr("wanted a JSON pointer"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: \"looked:/x\", published: 1, within: 1}")),
              HasSubstr("the play 'looked', which is none of the item's"));
  EXPECT_THAT(
      ErrorOf(kPlays + Item("{name: v, at: /x, published: 1, within: 1, may_be_better: true}")),
      HasSubstr("to say what is better"));
  EXPECT_THAT(ErrorOf(kPlays + Item("{name: v, at: /x, published: 1, within: 1, wihtin: 2}")),
              HasSubstr("wihtin"));
  EXPECT_THAT(
      ErrorOf(kPlays + "items:\n  - {item: T, section: s, title: t, holds: x, plays: [lop]}\n"),
      HasSubstr("did you mean 'loop'"));
  EXPECT_THAT(ErrorOf(kPlays + "items:\n  - {item: T, section: s, title: t, holds: x}\n"
                               "  - {item: t, section: s, title: t, holds: x}\n"),
              HasSubstr("named twice"));
  EXPECT_THAT(ErrorOf(kPlays +
                      "items:\n  - {item: T, section: s, title: t, holds: x, drawings: [lines]}\n"),
              HasSubstr("wanted PLAY:DRAWING"));
}

ComparedValue Value(Acceptance::Kind kind, double bound, std::optional<double> published) {
  ComparedValue value;
  value.name = "v";
  value.at = {"loop", "/x"};
  value.published = published;
  value.acceptance = {kind, bound};
  return value;
}

TEST(AcceptanceTest, BoundsBelongToIt) {
  const ComparedValue within = Value(Acceptance::Kind::kWithin, 0.5, 2.0);
  const auto is_accepted = [](const ComparedValue& value, double number) {
    return IsAccepted(value, FoundNumber{number});
  };
  EXPECT_TRUE(is_accepted(within, 2.5));
  EXPECT_TRUE(is_accepted(within, 1.5));
  EXPECT_FALSE(is_accepted(within, 2.51));
  const ComparedValue factor = Value(Acceptance::Kind::kFactor, 2.0, 3.0);
  EXPECT_TRUE(is_accepted(factor, 6.0));
  EXPECT_TRUE(is_accepted(factor, 1.5));
  EXPECT_FALSE(is_accepted(factor, 1.4));
  EXPECT_FALSE(is_accepted(factor, 6.1));
  EXPECT_FALSE(is_accepted(factor, 0.0));
  EXPECT_TRUE(is_accepted(Value(Acceptance::Kind::kAtLeast, 1.0, {}), 1.0));
  EXPECT_FALSE(is_accepted(Value(Acceptance::Kind::kAtMost, 1.0, {}), 1.1));
  for (const ComparedValue& value : {within, factor, Value(Acceptance::Kind::kAtMost, 1.0, {})}) {
    EXPECT_FALSE(is_accepted(value, std::numeric_limits<double>::quiet_NaN()));
  }
  const ComparedValue above = Value(Acceptance::Kind::kAbove, 1.0, {});
  EXPECT_TRUE(IsAccepted(above, {1.2, 1.01, 1.4}));
  EXPECT_FALSE(IsAccepted(above, {1.2, 1.0, 1.4}));
  EXPECT_FALSE(is_accepted(above, 1.2)) << "without an interval nothing is shown";
  EXPECT_TRUE(IsAccepted(Value(Acceptance::Kind::kBelow, 0.0, {}), {-0.2, -0.3, -0.1}));
}

CatalogueItem ItemOf(std::vector<ComparedValue> values) {
  CatalogueItem item;
  item.name = "Table 1";
  item.plays = {"loop"};
  item.values = std::move(values);
  item.holds = "as there";
  item.fails = "slower";
  return item;
}

Verdict VerdictOn(std::vector<ComparedValue> values, const ordered_json& answer) {
  return Judge(ItemOf(std::move(values)), {{"loop", answer}}, {}).verdict;
}

TEST(ReproducedJudgeTest, AVerdictIsThatOfItsWorstNumber) {
  const ComparedValue near = Value(Acceptance::Kind::kWithin, 0.5, 2.0);
  ComparedValue fast = Value(Acceptance::Kind::kAtLeast, 1.0, 1.0);
  fast.may_be_better = true;
  EXPECT_EQ(VerdictOn({near}, {{"x", 2.1}}), Verdict::kReproduced);
  EXPECT_EQ(VerdictOn({near}, {{"x", 3.0}}), Verdict::kNotReproduced);
  EXPECT_EQ(VerdictOn({near}, {{"x", nullptr}}), Verdict::kNotReproduced)
      << "no number holds nothing";
  EXPECT_EQ(VerdictOn({near, fast}, {{"x", 2.1}}), Verdict::kBetter);
  EXPECT_EQ(VerdictOn({fast}, {{"x", 1.0}}), Verdict::kReproduced) << "no better than published";
  EXPECT_EQ(VerdictOn({near, fast}, {{"x", 5.0}}), Verdict::kNotReproduced);
  EXPECT_EQ(VerdictOn({}, {{"x", 5.0}}), Verdict::kShown);
  CatalogueItem words = ItemOf({});
  words.plays.clear();
  EXPECT_EQ(Judge(words, {}, {}).verdict, Verdict::kDescribed);
}

TEST(ReproducedJudgeTest, AnIntervalThatHoldsTheBoundDecidesNothing) {
  const ComparedValue above = Value(Acceptance::Kind::kAbove, 1.0, {});
  const ComparedValue near = Value(Acceptance::Kind::kShown, 0.0, 1.1);
  const auto interval = [](double estimate, double lower, double upper) {
    return ordered_json{{"x", {{"estimate", estimate}, {"lower", lower}, {"upper", upper}}}};
  };
  EXPECT_EQ(VerdictOn({above}, interval(1.2, 1.1, 1.3)), Verdict::kReproduced);
  EXPECT_EQ(VerdictOn({above}, interval(1.2, 0.9, 1.5)), Verdict::kUndecided);
  EXPECT_EQ(VerdictOn({above}, interval(0.8, 0.7, 0.9)), Verdict::kNotReproduced);
  EXPECT_EQ(VerdictOn({above}, {{"x", 1.2}}), Verdict::kNotReproduced) << "no interval";
  ComparedValue below = Value(Acceptance::Kind::kBelow, 1.0, {});
  EXPECT_EQ(VerdictOn({above, below}, interval(1.2, 1.1, 1.3)), Verdict::kNotReproduced)
      << "what is against it outweighs";
  const JudgedItem judged = Judge(ItemOf({above, near}), {{"loop", interval(1.2, 0.9, 1.5)}}, {});
  EXPECT_EQ(judged.reason, "Not decided: v: 1.2 (0.9 .. 1.5) (interval above 1). slower");
  const ordered_json json = ToJson({judged});
  EXPECT_EQ(json[0]["values"][0]["lower"], 0.9);
  EXPECT_EQ(json[0]["values"][0]["undecided"], true);
  EXPECT_EQ(json[0]["values"][1]["upper"], 1.5) << "what is shown has its interval, too";
}

TEST(ReproducedJudgeTest, AMeanOrAShareMayHaveTheInterval) {
  const ComparedValue above = Value(Acceptance::Kind::kAbove, 0.5, {});
  for (const char* key : {"mean", "share"}) {
    const ordered_json answer{{"x", {{key, 0.8}, {"lower", 0.6}, {"upper", 0.9}}}};
    EXPECT_EQ(VerdictOn({above}, answer), Verdict::kReproduced) << key;
  }
  EXPECT_EQ(VerdictOn({above}, {{"x", {{"mean", 0.8}, {"lower", 0.6}}}}), Verdict::kNotPlayed);
}

TEST(ReproducedJudgeTest, WhatIsShownIsNotJudged) {
  const ComparedValue near = Value(Acceptance::Kind::kWithin, 0.5, 2.0);
  ComparedValue shown = Value(Acceptance::Kind::kShown, 0.0, 100.0);
  EXPECT_EQ(VerdictOn({shown}, {{"x", 2.1}}), Verdict::kShown);
  EXPECT_EQ(VerdictOn({near, shown}, {{"x", 2.1}}), Verdict::kReproduced);
  EXPECT_EQ(VerdictOn({near, shown}, {{"x", 9.0}}), Verdict::kNotReproduced);
  EXPECT_EQ(VerdictOn({shown}, {{"y", 2.1}}), Verdict::kNotPlayed) << "it has to be there";
  const JudgedItem judged = Judge(ItemOf({near, shown}), {{"loop", {{"x", 2.1}}}}, {});
  EXPECT_EQ(judged.values[1].found->number, 2.1);
  EXPECT_EQ(ToJson({judged})[0]["values"][1]["judged"], false);
  EXPECT_THAT(VerdictTable({judged}), HasSubstr("1 of 1"));
}

TEST(ReproducedJudgeTest, OurOwnBoundsReproduceNothing) {
  CatalogueItem item = ItemOf({Value(Acceptance::Kind::kAtLeast, 1.0, {})});
  item.is_own = true;
  EXPECT_EQ(Judge(item, {{"loop", {{"x", 2.0}}}}, {}).verdict, Verdict::kCheckHolds);
  const JudgedItem fails = Judge(item, {{"loop", {{"x", 0.0}}}}, {});
  EXPECT_EQ(fails.verdict, Verdict::kCheckFails);
  EXPECT_EQ(fails.reason, "Not as accepted: v: 0 (at least 1). slower");
  const ordered_json wide{{"x", {{"estimate", 1.2}, {"lower", 0.9}, {"upper", 1.5}}}};
  item.values = {Value(Acceptance::Kind::kAbove, 1.0, {})};
  const JudgedItem open = Judge(item, {{"loop", wide}}, {});
  EXPECT_EQ(open.verdict, Verdict::kCheckUndecided) << "no published result is undecided by it";
  EXPECT_EQ(open.reason, "Not decided: v: 1.2 (0.9 .. 1.5) (interval above 1). slower");
  EXPECT_EQ(ToJson({open})[0]["verdict"], "check undecided");
  EXPECT_THAT(VerdictTable({open}), HasSubstr("Table 1: Not decided: v"));
  EXPECT_THAT(VerdictTable({fails}),
              HasSubstr("Table 1: Not as accepted: v: 0 (at least 1). slower"));
}

TEST(ReproducedJudgeTest, EntriesOfListsAreFoundByWhatTheySay) {
  const ordered_json answer{
      {"list", {{{"name", "a, b"}, {"x", 1.0}}, 7, {{"name", "c/d"}, {"n", 3}, {"x", 2.0}}}}};
  const auto found = [&](const std::string& pointer) {
    ComparedValue value = Value(Acceptance::Kind::kShown, 0.0, {});
    value.at.pointer = pointer;
    const JudgedItem judged = Judge(ItemOf({value}), {{"loop", answer}}, {});
    using Number = std::optional<double>;
    return judged.values.empty() ? Number() : Number(judged.values[0].found->number);
  };
  EXPECT_EQ(found("/list/name=a, b/x"), 1.0);
  EXPECT_EQ(found("/list/name=c~1d/x"), 2.0);
  EXPECT_EQ(found("/list/n=3/x"), 2.0);
  EXPECT_EQ(found("/list/2/x"), 2.0);
  EXPECT_EQ(found("/list/name=e/x"), std::nullopt);
  EXPECT_EQ(found("/list/n/x"), std::nullopt);
}

TEST(ReproducedJudgeTest, AReasonStandsBesideEachVerdict) {
  const ComparedValue near = Value(Acceptance::Kind::kWithin, 0.5, 2.0);
  EXPECT_EQ(Judge(ItemOf({near}), {{"loop", {{"x", 2.0}}}}, {}).reason, "as there");
  EXPECT_EQ(Judge(ItemOf({near}), {{"loop", {{"x", 9.0}}}}, {}).reason,
            "Not as accepted: v: 9 (published 2, within 0.5). slower");
  const JudgedItem missing = Judge(ItemOf({near}), {}, {{"loop", "signal 9 (Killed)"}});
  EXPECT_EQ(missing.verdict, Verdict::kNotPlayed);
  EXPECT_EQ(missing.reason, "loop: signal 9 (Killed)");
}

TEST(ReproducedJudgeTest, NumbersMayBeDividedAndTruthsCount) {
  ComparedValue ratio = Value(Acceptance::Kind::kWithin, 0.0, 2.0);
  ratio.over = AnswerField{"loop", "/y"};
  EXPECT_EQ(VerdictOn({ratio}, {{"x", 3.0}, {"y", 1.5}}), Verdict::kReproduced);
  EXPECT_EQ(VerdictOn({Value(Acceptance::Kind::kAtLeast, 1.0, {})}, {{"x", true}}),
            Verdict::kReproduced);
}

TEST(ReproducedJudgeTest, ARatioToWhatNeverCameHasNoValueAndDecidesNothing) {
  ComparedValue ratio = Value(Acceptance::Kind::kAtLeast, 2.0, {});
  ratio.over = AnswerField{"loop", "/y"};
  for (const ordered_json& never : {ordered_json(0.0), ordered_json(0), ordered_json(nullptr)}) {
    for (const double number : {3.0, 0.0}) {
      const ordered_json answer{{"x", number}, {"y", never}};
      if (number == 0.0 && never.is_null()) continue;
      const JudgedItem judged = Judge(ItemOf({ratio}), {{"loop", answer}}, {});
      EXPECT_EQ(judged.verdict, Verdict::kUndecided) << answer;
      EXPECT_EQ(judged.reason,
                "Not decided: v: no value, what it rests on never came (at least 2). slower");
      EXPECT_EQ(ToJson({judged})[0]["values"][0]["found"], nullptr);
    }
  }
  EXPECT_EQ(VerdictOn({ratio}, {{"x", nullptr}, {"y", 1.0}}), Verdict::kNotReproduced)
      << "no number holds nothing";
  EXPECT_EQ(VerdictOn({ratio, Value(Acceptance::Kind::kAtMost, 1.0, {})}, {{"x", 3.0}, {"y", 0.0}}),
            Verdict::kNotReproduced)
      << "what is against it outweighs";
  ratio.acceptance.kind = Acceptance::Kind::kShown;
  EXPECT_EQ(VerdictOn({ratio}, {{"x", 3.0}, {"y", 0.0}}), Verdict::kShown);
}

TEST(ReproducedJudgeTest, AnIntervalWithoutAnEstimateOrAnEndIsNoMissingField) {
  const ComparedValue above = Value(Acceptance::Kind::kAbove, 2.0, {});
  const ComparedValue below = Value(Acceptance::Kind::kBelow, 2.0, {});
  const auto interval = [](const ordered_json& estimate, const ordered_json& lower,
                           const ordered_json& upper) {
    return ordered_json{{"x", {{"estimate", estimate}, {"lower", lower}, {"upper", upper}}}};
  };
  EXPECT_EQ(VerdictOn({above}, interval(nullptr, nullptr, nullptr)), Verdict::kUndecided);
  EXPECT_EQ(VerdictOn({above}, interval(nullptr, 3.0, nullptr)), Verdict::kUndecided);
  EXPECT_EQ(VerdictOn({above}, interval(4.0, 3.0, nullptr)), Verdict::kReproduced);
  EXPECT_EQ(VerdictOn({above}, interval(4.0, 1.0, nullptr)), Verdict::kUndecided);
  EXPECT_EQ(VerdictOn({above}, interval(1.0, nullptr, 1.5)), Verdict::kNotReproduced);
  EXPECT_EQ(VerdictOn({below}, interval(1.0, nullptr, 1.5)), Verdict::kReproduced);
  const JudgedItem judged = Judge(ItemOf({above}), {{"loop", interval(4.0, 1.0, nullptr)}}, {});
  EXPECT_EQ(judged.reason, "Not decided: v: 4 (1 .. inf) (interval above 2). slower");
  EXPECT_EQ(ToJson({judged})[0]["values"][0]["upper"], nullptr);
}

TEST(ReproducedJudgeTest, AFieldThatIsNotThereIsTold) {
  const ComparedValue near = Value(Acceptance::Kind::kWithin, 0.5, 2.0);
  const JudgedItem nothing = Judge(ItemOf({near}), {{"loop", {{"z", 1.0}}}}, {});
  EXPECT_EQ(nothing.verdict, Verdict::kNotPlayed);
  EXPECT_THAT(nothing.reason, AllOf(HasSubstr("loop:/x"), HasSubstr("nothing there")));
  EXPECT_THAT(Judge(ItemOf({near}), {{"loop", {{"x", "two"}}}}, {}).reason,
              HasSubstr("wanted a number"));
}

TEST(ShippedCatalogueTest, NoTableOrFigureOfTheChaptersIsMissing) {
  const Catalogue catalogue = ReadCatalogue(HIRES_SOURCE_DIR "/lab/config/reproduce.yaml");
  std::vector<std::string> missing;
  const auto require = [&](const std::string& name) {
    const bool is_there = std::any_of(catalogue.items.begin(), catalogue.items.end(),
                                      [&](const CatalogueItem& item) { return item.name == name; });
    if (!is_there) missing.push_back(name);
  };
  for (int i = 1; i <= 18; ++i) require("Fig. 5." + std::to_string(i));
  for (int i = 1; i <= 13; ++i) require("Fig. 6." + std::to_string(i));
  for (int i = 1; i <= 30; ++i) require("Fig. A." + std::to_string(i));
  require("Table 5.1");
  for (int i = 1; i <= 7; ++i) require("Table 6." + std::to_string(i));
  for (int i = 1; i <= 4; ++i) require("List. 5." + std::to_string(i));
  for (const char* name : {"List. 6.1", "List. 6.2", "List. A.1", "List. A.2"}) require(name);
  EXPECT_THAT(missing, ElementsAre());
}

TEST(ShippedCatalogueTest, NoPlayIsPlayedForNothing) {
  const Catalogue catalogue = ReadCatalogue(HIRES_SOURCE_DIR "/lab/config/reproduce.yaml");
  EXPECT_EQ(PlaysFor(catalogue, catalogue.items).size(), catalogue.plays.size());
}

}  // namespace
}  // namespace hires::lab::reproduce_test
