#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "hires/base/check.h"
#include "hires/base/overloaded.h"
#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"
#include "knowledge/yaml/fluent_yaml_scalar.h"

namespace hires::knowledge {
namespace {

std::string Write(const Filler& filler) {
  return std::visit(
      base::Overloaded{[](const std::string& text) { return WriteText(text); },
                       [](double value) {
                         HIRES_CHECK(std::isfinite(value), "a filler is not finite");
                         return WriteReal(value);
                       },
                       [](std::int64_t value) { return fmt::format("{}", value); },
                       [](bool value) { return std::string(value ? "true" : "false"); }},
      filler);
}

/// [0, 0] for `unbounded`, -infinity or infinity; hence the moment 0 is [-0.0, -0.0].
std::string Write(const temporal::Bounds& bounds, double unbounded) {
  if (bounds == temporal::Bounds{unbounded, unbounded}) return "[0, 0]";
  if (bounds == temporal::Bounds{0.0, 0.0}) return "[-0.0, -0.0]";
  return fmt::format("[{}, {}]", WriteReal(bounds.earliest + 0.0), WriteReal(bounds.latest + 0.0));
}

std::string Write(const Property& property) {
  return fmt::format("  - [{}, {}, {}]\n", WriteText(property.role), WriteText(property.type),
                     Write(property.filler));
}

std::string Write(const Fluent& fluent) {
  std::string text = fmt::format(
      "!Fluent\nClass_Instance: [{}, {}]\nStartTime: {}\nFinishTime: {}\n",
      WriteText(fluent.concept_name), WriteText(fluent.instance),
      Write(fluent.start, -temporal::kForever), Write(fluent.finish, temporal::kForever));
  text += fluent.properties.empty() ? "Properties: []\n" : "Properties:\n";
  for (const Property& property : fluent.properties) text += Write(property);
  return text;
}

std::string WriteList(const std::vector<std::string>& items) {
  std::vector<std::string> written;
  written.reserve(items.size());
  for (const std::string& item : items) written.push_back(WriteText(item));
  return "[" + base::Join(written, ", ") + "]";
}

std::string Write(const PoseModification::Delta& delta) {
  std::vector<std::string> choices;
  for (const double choice : delta.choices) choices.push_back(WriteReal(choice));
  return fmt::format("  - [{}, [{}]]\n", WriteText(delta.property), base::Join(choices, ", "));
}

std::string Write(const PoseModification& modification) {
  std::string text = fmt::format("!FluentPoseModification\nInstance: {}\nGroup: {}\nChoices: {}\n",
                                 WriteText(modification.instance), WriteText(modification.group),
                                 modification.choices);
  text += modification.modifications.empty() ? "Modifications: []\n" : "Modifications:\n";
  for (const PoseModification::Delta& delta : modification.modifications) text += Write(delta);
  return text + "Attachments: " + WriteList(modification.attachments) + "\n";
}

std::string Write(const DemandTopic& topic) {
  return fmt::format(
      "!DemandTopic\nName: {}\nClassFilter: {}\nSubclassFilter: {}\nSuperclassFilter: {}\n"
      "PropertyFilterMode: {}\nPropertyFilter: {}\nQueryFilter: {}\n",
      WriteText(topic.name), WriteList(topic.exact), WriteList(topic.below), WriteList(topic.above),
      topic.all_properties ? "intersection" : "union", WriteList(topic.properties),
      WriteList(topic.queries));
}

template <typename Document>
void Append(const std::vector<Document>& documents, std::string* text) {
  for (const Document& document : documents) {
    if (!text->empty()) *text += "---\n";
    *text += Write(document);
  }
}

}  // namespace

std::string WriteFluents(const std::vector<Fluent>& fluents) {
  std::string text;
  Append(fluents, &text);
  return text;
}

std::string WriteKnowledge(const KnowledgeFile& file) {
  std::string text;
  Append(file.fluents, &text);
  Append(file.modifications, &text);
  Append(file.topics, &text);
  return text;
}

}  // namespace hires::knowledge
