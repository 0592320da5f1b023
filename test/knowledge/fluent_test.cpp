#include "hires/knowledge/fluent.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/error.h"

namespace hires::knowledge::fluent_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Fluent Mug() {
  Fluent mug;
  mug.concept_name = "Mug";
  mug.instance = "mug1";
  mug.properties = {{"hasPose", "Pose", std::string("poseMug1")}, {"hasMass", "xsd:float", 0.3}};
  return mug;
}

TEST(FluentTest, EqualMeansTheSameInEveryPart) {
  const Fluent mug = Mug();
  EXPECT_EQ(mug, Mug());
  Fluent other = mug;
  other.concept_name = "Vase";
  EXPECT_FALSE(mug == other);
  other = mug;
  other.instance = "mug2";
  EXPECT_FALSE(mug == other);
  other = mug;
  other.start.earliest = 3.0;
  EXPECT_FALSE(mug == other);
  other = mug;
  other.finish.latest = 3.0;
  EXPECT_FALSE(mug == other);
  other = mug;
  std::swap(other.properties[0], other.properties[1]);
  EXPECT_FALSE(mug == other);
}

TEST(FluentTest, ANumberIsNotATruthValueNorALink) {
  const Property number{"r", "xsd:int", std::int64_t{1}};
  EXPECT_FALSE(number == (Property{"r", "xsd:int", true}));
  EXPECT_FALSE(number == (Property{"r", "xsd:int", 1.0}));
  EXPECT_FALSE(number == (Property{"r", "xsd:int", std::string("1")}));
  EXPECT_FALSE(number.IsLink());
  EXPECT_TRUE((Property{"hasPose", "Pose", std::string("poseMug1")}).IsLink());
}

TEST(SourceTest, WordsAreReadBack) {
  for (const Source source :
       {Source::kKnowledge, Source::kObservation, Source::kPerson, Source::kMonitor}) {
    EXPECT_EQ(ReadSource(ToString(source)), source);
  }
}

TEST(SourceTest, AnUnknownWordNamesTheFour) {
  try {
    ReadSource("rumour");
    FAIL() << "was read";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'rumour'"), HasSubstr("knowledge, observation"),
                                    HasSubstr("person, monitor")));
  }
}

}  // namespace
}  // namespace hires::knowledge::fluent_test
