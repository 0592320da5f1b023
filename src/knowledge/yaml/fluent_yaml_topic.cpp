#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "knowledge/yaml/fluent_yaml_documents.h"
#include "knowledge/yaml/fluent_yaml_text.h"

namespace hires::knowledge {
namespace {

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

}  // namespace

const std::vector<std::string> kTopicKeys = {
    "Name",           "ClassFilter",        "SubclassFilter", "SuperclassFilter",
    "PropertyFilter", "PropertyFilterMode", "QueryFilter"};

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

}  // namespace hires::knowledge
