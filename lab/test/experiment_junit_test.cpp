#include <gmock/gmock.h>
#include <tinyxml2.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "lab/src/experiment/report.h"

namespace hires::lab::experiment_junit_test {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;
using Relation = Expectation::Relation;

ExperimentReport TwoOfThreeHold() {
  ExperimentReport report;
  report.name = "paired";
  report.kind = "paired";
  report.seed = 7;
  report.params_hash = 0x1f;
  report.wall_seconds = 1.5;
  report.checks = {{{"fall <difference> & \"more\"", Relation::kAbove, 0.0}, 0.25, true},
                   {{"ratio", Relation::kAtMost, 1.0}, 1.125, false},
                   {{"share", Relation::kAtLeast, 0.5}, 0.5, true}};
  return report;
}

/// What the schema of JUnit reports, as build servers read them, allows in each element:
/// attributes, those that must be there, and elements inside.
struct Allowed {
  std::set<std::string> attributes, required, inside;
};
const std::map<std::string, Allowed> kSchema{
    {"testsuites",
     {{"name", "time", "tests", "failures", "disabled", "errors"}, {}, {"testsuite"}}},
    {"testsuite",
     {{"name", "tests", "failures", "errors", "time", "disabled", "skipped", "timestamp",
       "hostname", "id", "package"},
      {"name", "tests"},
      {"properties", "testcase", "system-out", "system-err"}}},
    {"properties", {{}, {}, {"property"}}},
    {"property", {{"name", "value"}, {"name", "value"}, {}}},
    {"testcase",
     {{"name", "assertions", "time", "classname", "status"},
      {"name"},
      {"skipped", "error", "failure", "system-out", "system-err"}}},
    {"failure", {{"type", "message"}, {}, {}}}};

void ExpectAllowed(const XMLElement& element) {
  ASSERT_EQ(kSchema.count(element.Name()), 1u) << element.Name();
  const Allowed& allowed = kSchema.at(element.Name());
  std::set<std::string> attributes;
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    EXPECT_TRUE(attributes.insert(a->Name()).second) << "twice: " << a->Name();
    EXPECT_EQ(allowed.attributes.count(a->Name()), 1u) << element.Name() << ' ' << a->Name();
  }
  for (const std::string& name : allowed.required) EXPECT_EQ(attributes.count(name), 1u) << name;
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    EXPECT_EQ(allowed.inside.count(child->Name()), 1u) << element.Name() << ' ' << child->Name();
    ExpectAllowed(*child);
  }
}

class JunitXmlTest : public ::testing::Test {
 protected:
  /// The document's suite.
  const XMLElement& Read(const ExperimentReport& report) {
    EXPECT_EQ(document_.Parse(JunitXml(report).c_str()), tinyxml2::XML_SUCCESS);
    return *document_.FirstChildElement("testsuites")->FirstChildElement("testsuite");
  }
  XMLDocument document_;
};

TEST_F(JunitXmlTest, HasTheElementsAndAttributesOfTheSchema) {
  Read(TwoOfThreeHold());
  ExpectAllowed(*document_.RootElement());
  EXPECT_STREQ(document_.RootElement()->Name(), "testsuites");
}

TEST_F(JunitXmlTest, CountsAgreeWithTheCases) {
  const XMLElement& suite = Read(TwoOfThreeHold());
  const XMLElement* root = document_.RootElement();
  for (const XMLElement* element : {root, &suite}) {
    EXPECT_EQ(element->IntAttribute("tests"), 3);
    EXPECT_EQ(element->IntAttribute("failures"), 1);
    EXPECT_EQ(element->IntAttribute("errors", -1), 0);
    EXPECT_STREQ(element->Attribute("time"), "1.500");
  }
  int cases = 0, failures = 0;
  for (const auto* one = suite.FirstChildElement("testcase"); one != nullptr;
       one = one->NextSiblingElement("testcase")) {
    ++cases;
    failures += one->FirstChildElement("failure") != nullptr;
  }
  EXPECT_EQ(cases, 3);
  EXPECT_EQ(failures, 1);
}

TEST_F(JunitXmlTest, AFailureSaysWhatWasWantedAndFound) {
  const XMLElement* second =
      Read(TwoOfThreeHold()).FirstChildElement("testcase")->NextSiblingElement("testcase");
  EXPECT_STREQ(second->Attribute("classname"), "hires.paired");
  EXPECT_STREQ(second->Attribute("name"), "ratio at most 1");
  EXPECT_STREQ(second->FirstChildElement("failure")->Attribute("message"),
               "wanted ratio at most 1, found 1.125");
}

TEST_F(JunitXmlTest, WhatIsNoNumberIsSaid) {
  ExperimentReport report = TwoOfThreeHold();
  report.checks[1].value = std::numeric_limits<double>::quiet_NaN();
  const XMLElement* second =
      Read(report).FirstChildElement("testcase")->NextSiblingElement("testcase");
  EXPECT_STREQ(second->FirstChildElement("failure")->Attribute("message"),
               "wanted ratio at most 1, found no number");
}

TEST_F(JunitXmlTest, NamesKeepTheirSigns) {
  EXPECT_STREQ(Read(TwoOfThreeHold()).FirstChildElement("testcase")->Attribute("name"),
               "fall <difference> & \"more\" above 0");
}

TEST_F(JunitXmlTest, SaysFromWhatItCame) {
  const XMLElement* property =
      Read(TwoOfThreeHold()).FirstChildElement("properties")->FirstChildElement("property");
  std::map<std::string, std::string> properties;
  for (; property != nullptr; property = property->NextSiblingElement("property")) {
    properties[property->Attribute("name")] = property->Attribute("value");
  }
  EXPECT_EQ(properties.at("seed"), "7");
  EXPECT_EQ(properties.at("parameters"), "000000000000001f");
}

}  // namespace
}  // namespace hires::lab::experiment_junit_test
