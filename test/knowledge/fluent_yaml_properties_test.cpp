#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/knowledge/fluent_yaml.h"
#include "support/property.h"

namespace hires::knowledge::fluent_yaml_properties_test {
namespace {

using temporal::Bounds;
using temporal::kForever;

constexpr test_support::PropertyCases kPropertyCases{500};

/// What YAML is most likely to trip over.
const std::vector<std::string> kTraps = {
    "On",  "off", "yes",  "n",    "true", "null",   "~",    "12",  "-0.5", "1e5",  "0x1F",
    "010", "1:2", ".inf", ".nan", "<<",   "- a",    "? a",  "a: ", " #",   "[",    "}",
    ",",   "*a",  "&a",   "!a",   "|",    ">",      "'",    "\"",  "\\",   "%a",   "@",
    "`",   "---", "...",  "",     "mug1", "A mug.", "\xc3", " ",   "=",    "a\\n", "\xc2\x85"};

std::string Utf8(int c) {
  const auto byte = [](int value) { return static_cast<char>(value); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xc0 | c >> 6), byte(0x80 | (c & 0x3f))};
  if (c < 0x10000) {
    return {byte(0xe0 | c >> 12), byte(0x80 | (c >> 6 & 0x3f)), byte(0x80 | (c & 0x3f))};
  }
  return {byte(0xf0 | c >> 18), byte(0x80 | (c >> 12 & 0x3f)), byte(0x80 | (c >> 6 & 0x3f)),
          byte(0x80 | (c & 0x3f))};
}

rc::Gen<std::string> AnyCharacter(int first) {
  const auto all = rc::gen::suchThat(rc::gen::inRange(first, 0x110000),
                                     [](int c) { return c < 0xd800 || c > 0xdfff; });
  return rc::gen::map(
      rc::gen::oneOf(rc::gen::inRange(first, 0x80), rc::gen::inRange(0xa0, 0x3000), all), Utf8);
}

rc::Gen<std::string> Trap() {
  return rc::gen::suchThat(rc::gen::elementOf(kTraps),
                           [](const std::string& trap) { return trap != "\xc3"; });
}

/// Traps, runs of any characters, and both behind each other.
rc::Gen<std::string> AnyText(int first_character = 0) {
  const auto part = rc::gen::oneOf(Trap(), AnyCharacter(first_character));
  const auto joined = rc::gen::map(rc::gen::container<std::vector<std::string>>(part),
                                   [](const std::vector<std::string>& parts) {
                                     std::string text;
                                     for (const std::string& each : parts) text += each;
                                     return text;
                                   });
  return rc::gen::oneOf(Trap(), joined);
}

rc::Gen<std::string> AnyName() {
  return rc::gen::suchThat(AnyText(0x20), [](const std::string& name) {
    return !name.empty() && name.size() <= 1000 && name.find('\x7f') == std::string::npos;
  });
}

double FromBits(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

rc::Gen<double> AnyReal() {
  const auto bits =
      rc::gen::map(rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()), FromBits);
  const auto plain =
      rc::gen::map(rc::gen::inRange(-100'000, 100'000), [](int i) { return i / 100.0; });
  return rc::gen::suchThat(rc::gen::oneOf(bits, plain),
                           [](double value) { return std::isfinite(value); });
}

Property AnyProperty() {
  const std::string type =
      *rc::gen::element<std::string>("Pose", "On", "xsd:float", "xsd:double", "xsd:int",
                                     "xsd:integer", "xsd:boolean", "xsd:string");
  Property property{*AnyName(), type, {}};
  if (!property.IsLink() && type != "xsd:string") {
    if (type == "xsd:boolean") property.filler = *rc::gen::arbitrary<bool>();
    if (type == "xsd:float" || type == "xsd:double") property.filler = *AnyReal();
    if (type == "xsd:int") property.filler = std::int64_t{*rc::gen::arbitrary<std::int32_t>()};
    if (type == "xsd:integer") property.filler = *rc::gen::arbitrary<std::int64_t>();
  } else {
    property.filler = property.IsLink() ? *AnyName() : *AnyText();
  }
  return property;
}

/// Bounds in order, 0 and infinities among them. @pre lower < infinity or upper > -infinity
Bounds AnyBounds(double never) {
  const auto moment = rc::gen::oneOf(AnyReal(), rc::gen::element(0.0, kForever, -kForever));
  double earliest = *moment, latest = *moment;
  if (earliest > latest) std::swap(earliest, latest);
  if (earliest == never) earliest = 0.0;
  if (latest == never) latest = 0.0;
  return {std::min(earliest, latest), std::max(earliest, latest)};
}

Fluent AnyFluent() {
  Fluent fluent;
  fluent.concept_name = *rc::gen::oneOf(rc::gen::element<std::string>("Mug", "On"), AnyName());
  fluent.instance = *AnyName();
  const int num_properties = *rc::gen::inRange(0, 6);
  for (int i = 0; i < num_properties; ++i) fluent.properties.push_back(AnyProperty());
  fluent.start = AnyBounds(kForever);
  fluent.finish = AnyBounds(-kForever);
  if (fluent.start.earliest > fluent.finish.latest) fluent.finish = {kForever, kForever};
  return fluent;
}

HIRES_PROPERTY(FluentYamlProperties, WhatIsWrittenIsReadBackToTheLastBit, ()) {
  std::vector<Fluent> fluents;
  const int count = *rc::gen::inRange(0, 4);
  for (int i = 0; i < count; ++i) fluents.push_back(AnyFluent());
  const std::string text = WriteFluents(fluents);
  const std::vector<Fluent> read = ReadKnowledge(text, "text").fluents;
  RC_ASSERT(read == fluents);
  RC_ASSERT(WriteFluents(read) == text);  // also tells -0.0 from 0.0
}

HIRES_PROPERTY(FluentYamlProperties, DamagedTextIsReadOrRefusedAndNothingElse, ()) {
  std::string text = WriteFluents({AnyFluent(), AnyFluent()});
  const int num_damages = *rc::gen::inRange(1, 5);
  for (int i = 0; i < num_damages; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto size = *rc::gen::inRange<std::size_t>(0, 8);
    text.replace(at, size, *rc::gen::elementOf(kTraps));
    text.resize(std::max<std::size_t>(text.size(), 1), ' ');
  }
  try {
    const std::vector<Fluent> read = ReadKnowledge(text, "damaged").fluents;
    const std::string canonical = WriteFluents(read);
    RC_ASSERT(ReadKnowledge(canonical, "canonical").fluents == read);
  } catch (const base::ConfigError& error) {
    RC_ASSERT(std::string(error.what()).find("damaged: ") == 0u);
  }
}

std::string PoseName(int i) { return "pose" + std::to_string(i); }

/// Attachments lead from lower to higher numbers, so that they go in no circle.
std::vector<PoseModification> AnyModifications(int num_poses) {
  std::vector<PoseModification> modifications;
  for (int i = 0; i < num_poses; ++i) {
    const int group = *rc::gen::inRange(0, 3);
    PoseModification modification{PoseName(i), "g" + std::to_string(group), group + 1, {}, {}};
    PoseModification::Delta delta{"hasX", {}};
    for (int c = 0; c <= group; ++c) delta.choices.push_back(*rc::gen::inRange(-50, 50) / 4.0);
    modification.modifications.push_back(delta);
    for (int j = i + 1; j < num_poses; ++j) {
      if (*rc::gen::inRange(0, 3) == 0) modification.attachments.push_back(PoseName(j));
    }
    modifications.push_back(modification);
  }
  return modifications;
}

bool LeadsTo(const std::vector<PoseModification>& modifications, int from, int to) {
  if (from == to) return true;
  for (const std::string& next : modifications[static_cast<std::size_t>(from)].attachments) {
    if (LeadsTo(modifications, std::stoi(next.substr(4)), to)) return true;
  }
  return false;
}

// The slow obvious way: for each pose, look whether any way leads to it from each modification.
// Deltas are quarters, so sums are exact in any order.
HIRES_PROPERTY(FluentYamlProperties, APoseMovesByAllThatLeadsToIt, ()) {
  const int num_poses = *rc::gen::inRange(1, 8);
  const std::vector<PoseModification> modifications = AnyModifications(num_poses);
  const base::Rng rng(*rc::gen::arbitrary<std::uint64_t>());
  std::vector<Fluent> scene;
  for (int i = 0; i < num_poses; ++i) {
    scene.push_back({"Pose", PoseName(i), {{"hasX", "xsd:float", 1.0 * i}}});
  }
  ApplyModifications(modifications, rng, &scene);

  std::map<std::string, int> choice;
  for (const PoseModification& each : modifications) {
    if (choice.count(each.group) == 0) {
      choice.emplace(each.group, rng.Fork(choice.size()).Index(each.choices));
    }
  }
  for (int i = 0; i < num_poses; ++i) {
    double expected = i;
    for (int from = 0; from <= i; ++from) {
      const PoseModification& each = modifications[static_cast<std::size_t>(from)];
      const auto drawn = static_cast<std::size_t>(choice.at(each.group));
      if (LeadsTo(modifications, from, i)) expected += each.modifications[0].choices[drawn];
    }
    RC_ASSERT(std::get<double>(scene[static_cast<std::size_t>(i)].properties[0].filler) ==
              expected);
  }
}

HIRES_PROPERTY(FluentYamlProperties, ModificationsComeBackAsTheyWere, ()) {
  KnowledgeFile file;
  file.modifications = AnyModifications(*rc::gen::inRange(0, 6));
  const std::string text = WriteKnowledge(file);
  RC_ASSERT(WriteKnowledge(ReadKnowledge(text, "text")) == text);
}

}  // namespace
}  // namespace hires::knowledge::fluent_yaml_properties_test
