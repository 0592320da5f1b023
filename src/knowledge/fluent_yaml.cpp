#include "hires/knowledge/fluent_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "fluent_yaml_field.h"
#include "fluent_yaml_modification.h"
#include "fluent_yaml_text.h"
#include "fluent_yaml_tree.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

constexpr int kMaxChoices = 1'000'000;

// ------------------------------------------------------------------------------------- !Fluent

const std::vector<std::string> kFluentKeys = {"Class_Instance", "StartTime", "FinishTime",
                                              "Properties"};

Filler RealFiller(const Field& field) { return field.Real(); }
Filler IntegerFiller(const Field& field) { return field.Integer(); }
Filler TruthFiller(const Field& field) { return field.Truth(); }
Filler TextFiller(const Field& field) { return field.Text(); }

Filler IntFiller(const Field& field) {
  using Int = std::numeric_limits<std::int32_t>;
  const std::int64_t value = field.Integer();
  if (value < Int::min() || value > Int::max()) {
    field.Fail(fmt::format("is {}, an xsd:int has 32 bits; make it an xsd:integer", value));
  }
  return value;
}

struct ValueType {
  std::string_view name;
  Filler (*read)(const Field&);
};
constexpr std::array<ValueType, 6> kValueTypes = {{{"xsd:float", RealFiller},
                                                   {"xsd:double", RealFiller},
                                                   {"xsd:int", IntFiller},
                                                   {"xsd:integer", IntegerFiller},
                                                   {"xsd:boolean", TruthFiller},
                                                   {"xsd:string", TextFiller}}};

const ValueType& FindValueType(const std::string& type, const Field& field) {
  for (const ValueType& known : kValueTypes) {
    if (known.name == type) return known;
  }
  std::vector<std::string> names;
  for (const ValueType& known : kValueTypes) names.emplace_back(known.name);
  field.Fail(fmt::format("type '{}' is unknown; wanted one of {}, or a concept", Shown(type),
                         base::Join(names, ", ")));
}

Property ReadProperty(const Field& field) {
  const std::vector<Field> parts = field.Items("[property, filler type, filler]", 3);
  Property property{parts[0].Name(), parts[1].Name(), {}};
  property.filler = property.IsLink() ? Filler(parts[2].Name())
                                      : FindValueType(property.type, parts[1]).read(parts[2]);
  return property;
}

/// [0, 0] stands for `unbounded`, since ever or for ever. The moment 0 itself, which the original
/// had no need of, is [-0.0, -0.0].
temporal::Bounds ReadBounds(const Field& field, double unbounded) {
  const std::vector<Field> ends = field.Items("[earliest, latest]", 2);
  const temporal::Bounds bounds{ends[0].Moment(), ends[1].Moment()};
  const bool all_zero = bounds.earliest == 0.0 && bounds.latest == 0.0;
  if (all_zero && !std::signbit(bounds.earliest) && !std::signbit(bounds.latest)) {
    return {unbounded, unbounded};
  }
  if (bounds.earliest > bounds.latest) {
    field.Fail(
        fmt::format("is [{}, {}]; wanted the earlier time first", bounds.earliest, bounds.latest));
  }
  return {bounds.earliest + 0.0, bounds.latest + 0.0};  // -0.0 becomes 0.0
}

void CheckTimes(const Fluent& fluent, const Field& start, const Field& finish) {
  if (fluent.start.earliest == temporal::kForever)
    start.Fail("is never; wanted a time before .inf");
  if (fluent.finish.latest == -temporal::kForever) {
    finish.Fail("is before all time; wanted a time after -.inf");
  }
  if (fluent.start.earliest > fluent.finish.latest) {
    finish.Fail(
        fmt::format("is at {} at the latest, before the fluent starts at {} at the "
                    "earliest; correct the times",
                    fluent.finish.latest, fluent.start.earliest));
  }
}

Fluent ReadFluent(const Fields& in) {
  Fluent fluent;
  const std::vector<Field> head =
      in.Require("Class_Instance", "write [concept, instance]").Items("[concept, instance]", 2);
  fluent.concept_name = head[0].Name();
  fluent.instance = head[1].Name();
  const Field start = in.Require("StartTime", "write [0, 0] for since ever");
  const Field finish = in.Require("FinishTime", "write [0, 0] for for ever");
  fluent.start = ReadBounds(start, -temporal::kForever);
  fluent.finish = ReadBounds(finish, temporal::kForever);
  CheckTimes(fluent, start, finish);
  const Field properties = in.Require("Properties", "write [] for none");
  for (const Field& item : properties.Items("a list of [property, filler type, filler]")) {
    fluent.properties.push_back(ReadProperty(item));
  }
  return fluent;
}

// --------------------------------------------------------------------- !FluentPoseModification

const std::vector<std::string> kModificationKeys = {"Instance", "Group", "Choices", "Modifications",
                                                    "Attachments"};

PoseModification::Delta ReadDelta(const Field& field, const PoseModification& modification) {
  const std::vector<Field> parts = field.Items("[property, [delta of each choice]]", 2);
  PoseModification::Delta delta{parts[0].Name(), {}};
  for (const Field& choice : parts[1].Items("a list of deltas")) {
    delta.choices.push_back(choice.Real());
  }
  // Also checked for all together, but only here the line is known.
  if (delta.choices.size() != static_cast<std::size_t>(modification.choices)) {
    field.Fail(
        fmt::format("'{}', {}: has {} deltas, Choices says {}; give one delta for each "
                    "choice",
                    Shown(modification.instance), Shown(delta.property), delta.choices.size(),
                    modification.choices));
  }
  return delta;
}

int ReadChoices(const Field& field) {
  const std::int64_t choices = field.Integer();
  if (choices < 1 || choices > kMaxChoices) {
    field.Fail(fmt::format("is {}, wanted a whole number between 1 and {}", choices, kMaxChoices));
  }
  return static_cast<int>(choices);
}

PoseModification ReadModification(const Fields& in) {
  PoseModification modification;
  modification.instance = in.Require("Instance", "name the pose to change").Name();
  modification.group = in.Require("Group", "name what takes the same choice").Name();
  modification.choices = ReadChoices(in.Require("Choices", "say how many there are"));
  const Field deltas = in.Require("Modifications", "write [] for none");
  for (const Field& item : deltas.Items("a list of [property, [delta of each choice]]")) {
    modification.modifications.push_back(ReadDelta(item, modification));
  }
  if (const auto attachments = in.Find("Attachments")) {
    modification.attachments = attachments->Names();
  }
  return modification;
}

// --------------------------------------------------------------------------------- !DemandTopic

const std::vector<std::string> kTopicKeys = {
    "Name",           "ClassFilter",        "SubclassFilter", "SuperclassFilter",
    "PropertyFilter", "PropertyFilterMode", "QueryFilter"};

bool IsTopicName(const std::string& name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/';
  };
  const bool begins_well = !(name[0] >= '0' && name[0] <= '9') && name[0] != '_' && name[0] != '/';
  return begins_well && name.back() != '/' && name.find("//") == std::string::npos &&
         std::all_of(name.begin(), name.end(), fits);
}

std::string ReadTopicName(const Field& field) {
  std::string name = field.Name();
  if (!IsTopicName(name)) {
    field.Fail(
        fmt::format("is '{}', no topic name; wanted letters, digits, _ and / that begin "
                    "with a letter",
                    Shown(name)));
  }
  return name;
}

bool ReadMode(const Field& field) {
  const std::string mode = field.Text();
  if (mode == "intersection") return true;
  if (mode == "union") return false;
  field.Fail(fmt::format("is '{}', wanted union or intersection", Shown(mode)));
}

std::vector<std::string> NamesOf(const Fields& in, const std::string& key) {
  const std::optional<Field> field = in.Find(key);
  return field ? field->Names() : std::vector<std::string>();
}

DemandTopic ReadTopic(const Fields& in) {
  DemandTopic topic;
  topic.name = ReadTopicName(in.Require("Name", "name the topic"));
  topic.exact = NamesOf(in, "ClassFilter");
  topic.below = NamesOf(in, "SubclassFilter");
  topic.above = NamesOf(in, "SuperclassFilter");
  topic.properties = NamesOf(in, "PropertyFilter");
  if (const auto mode = in.Find("PropertyFilterMode")) topic.all_properties = ReadMode(*mode);
  if (const auto queries = in.Find("QueryFilter")) {
    for (const Field& item : queries->Items("a list of queries")) {
      topic.queries.push_back(item.Text());
    }
  }
  return topic;
}

// ---------------------------------------------------------------------------------- the stream

const std::vector<std::string> kTags = {"!Fluent", "!FluentPoseModification", "!DemandTopic"};

/// Puts documents into a KnowledgeFile, and remembers where what stood.
class FileReader {
 public:
  explicit FileReader(const std::string& source) : source_(source) {}

  void Read(int document, const YamlNode& root) {
    const std::string where = fmt::format("{}: document {}", source_, document);
    if (root.tag == kTags[0]) {
      file_.fluents.push_back(ReadFluent(Fields(root, where, kFluentKeys)));
    } else if (root.tag == kTags[1]) {
      const Fields fields(root, where, kModificationKeys);
      file_.modifications.push_back(ReadModification(fields));
      modified_at_.push_back(fields.At());
    } else if (root.tag == kTags[2]) {
      AddTopic(Fields(root, where, kTopicKeys));
    } else {
      FailTag(where, root);
    }
  }

  KnowledgeFile Finish() {
    CheckModifications(file_.modifications, [&](std::size_t i) { return modified_at_[i]; });
    return std::move(file_);
  }

 private:
  void AddTopic(const Fields& fields) {
    DemandTopic topic = ReadTopic(fields);
    const auto [first, is_new] = topic_at_.emplace(topic.name, fields.At());
    if (!is_new) {
      throw base::ConfigError(
          fmt::format("{}: topic '{}' is demanded twice (already: {}); rename "
                      "one",
                      fields.At(), topic.name, first->second));
    }
    file_.topics.push_back(std::move(topic));
  }

  [[noreturn]] static void FailTag(const std::string& where, const YamlNode& root) {
    const std::string at = fmt::format("{}, line {}: ", where, root.line);
    if (root.tag.empty()) {
      throw base::ConfigError(at + "the document has no tag; begin it with one of " +
                              base::Join(kTags, ", "));
    }
    throw base::ConfigError(at + base::UnknownName("tag", Shown(root.tag), kTags));
  }

  const std::string& source_;
  KnowledgeFile file_;
  std::vector<std::string> modified_at_;         // by index of the modification
  std::map<std::string, std::string> topic_at_;  // by name
};

}  // namespace

KnowledgeFile ReadKnowledge(std::string_view text, const std::string& source) {
  FileReader reader(source);
  VisitDocuments(text, source,
                 [&](int document, const YamlNode& root) { reader.Read(document, root); });
  return reader.Finish();
}

KnowledgeFile LoadKnowledge(const std::string& path) {
  return ReadKnowledge(base::ReadTextFile(path), path);
}

}  // namespace hires::knowledge
