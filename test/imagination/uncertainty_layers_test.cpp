#include "imagination/uncertainty_layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "hires/base/text.h"
#include "hires/imagination/start_spread.h"
#include "support/property.h"

namespace hires::imagination::uncertainty_layers_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr hires::test_support::PropertyCases kPropertyCases{200};
constexpr char kShipped[] = HIRES_SOURCE_DIR "/config/uncertainty.yaml";
constexpr char kFriction[] =
    "object_friction: {distribution: fixed, value: 0.7, unit: factor, source: measured}\n";

Uncertainty Parse(const std::string& yaml) { return ParseUncertainty(yaml, "u.yaml"); }

bool AreSame(const Distribution& a, const Distribution& b) {
  return a.kind == b.kind && a.first == b.first && a.second == b.second;
}

/// The quantities of the shipped file, each as a piece of it.
std::vector<std::pair<std::string, std::string>> Pieces() {
  std::vector<std::pair<std::string, std::string>> pieces;
  std::istringstream lines(base::ReadTextFile(kShipped));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] != ' ') pieces.emplace_back(line.substr(0, line.find(':')), "");
    pieces.back().second += line + '\n';
  }
  return pieces;
}

/// Quantities of the file, drawn one by one; at least one.
std::string DrawSome(std::set<std::string>* names) {
  const auto pieces = Pieces();
  std::string yaml;
  const std::size_t sure = *rc::gen::inRange<std::size_t>(0, pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i != sure && !*rc::gen::arbitrary<bool>()) continue;
    names->insert(pieces[i].first);
    yaml += pieces[i].second;
  }
  return yaml;
}

HIRES_PROPERTY(LaidOverTest, WhatIsNamedReplacesWhatIsNotStays, ()) {
  std::set<std::string> below_names, over_names;
  const Uncertainty below = Parse(DrawSome(&below_names));
  Uncertainty over = Parse(DrawSome(&over_names));
  // Whatever the numbers are, they are told from those below.
  std::string yaml = over.yaml;
  const std::string from = "source: \"", to = "source: \"mine, ";
  for (std::size_t at = 0; (at = yaml.find(from, at)) != std::string::npos; at += to.size())
    yaml.replace(at, from.size(), to);
  over = Parse(yaml);
  const Uncertainty both = LaidOver(below, over);
  std::set<std::string> all = below_names;
  all.insert(over_names.begin(), over_names.end());
  RC_ASSERT(both.quantities.size() == all.size());
  for (const auto& [name, distribution] : both.quantities) {
    const auto& wanted = over_names.count(name) > 0 ? over.quantities : below.quantities;
    RC_ASSERT(AreSame(distribution, wanted.at(name)));
  }
  const Uncertainty again = UncertaintyFromText(both.yaml, "as it travels");
  RC_ASSERT(again.hash == both.hash);
  RC_ASSERT(CertainQuantities(both).size() + all.size() == QuantityNames().size());
  RC_ASSERT(LaidOver(both, over).hash == both.hash);
}

HIRES_PROPERTY(LaidOverTest, OnlyTakesAwayWhatLiesBelow, ()) {
  std::set<std::string> below_names, over_names;
  const Uncertainty below = Parse(DrawSome(&below_names));
  const std::string some = DrawSome(&over_names);
  const Uncertainty only = Parse("only: true\n" + some);
  RC_ASSERT(LaidOver(below, only).hash == Parse(some).hash);
  RC_ASSERT(LaidOver(below, NoUncertainty()).hash == NoUncertainty().hash);
  RC_ASSERT(LaidOver(NoUncertainty(), Parse(some)).hash == Parse(some).hash);
}

TEST(LaidOverTest, OneQuantityLeavesTheOthersUncertain) {
  const Uncertainty both = LaidOver(LoadUncertainty(kShipped), Parse(kFriction));
  EXPECT_THAT(CertainText(both), IsEmpty());
  EXPECT_EQ(both.quantities.at("object_friction").first, 0.7);
  EXPECT_GT(both.quantities.at("start_x").second, 0.0);
}

TEST(LaidOverTest, CorrelationsGoWithTheStartPosesThatTheyAreOf) {
  const Uncertainty below =
      WithStartSpread(LoadUncertainty(kShipped), {0.1, 0.1, 0.1, {0.5, 0.0, 0.0}});
  ASSERT_TRUE(below.start_correlation);
  EXPECT_TRUE(LaidOver(below, Parse(kFriction)).start_correlation);
  const std::string start = "start_x: {distribution: fixed, value: 0, unit: m, source: t}";
  EXPECT_FALSE(LaidOver(below, Parse(start)).start_correlation);
}

TEST(CertainTextTest, SaysTheShorterHalf) {
  EXPECT_THAT(CertainText(Parse(kFriction)), HasSubstr("nothing is uncertain"));
  EXPECT_THAT(CertainText(Parse("start_x: {distribution: normal, mean: 0, sd: 0.1, unit: m, "
                                "source: measured}")),
              HasSubstr("35 of 36 quantities, all but start_x"));
  EXPECT_THAT(CertainText(NoUncertainty()), HasSubstr("nothing is uncertain"));
  Uncertainty fixed = LoadUncertainty(kShipped);
  for (auto& [name, distribution] : fixed.quantities)
    distribution = {Distribution::Kind::kNormal, 1.0, 0.0};
  EXPECT_THAT(CertainText(fixed), HasSubstr("nothing is uncertain"));
  Uncertainty nearly = LoadUncertainty(kShipped);
  nearly.quantities.erase("start_x");
  EXPECT_THAT(CertainText(nearly), HasSubstr("does not name it: start_x"));
}

}  // namespace
}  // namespace hires::imagination::uncertainty_layers_test
