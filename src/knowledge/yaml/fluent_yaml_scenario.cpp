#include <fmt/format.h>

#include "knowledge/yaml/fluent_yaml_documents.h"
#include "knowledge/yaml/fluent_yaml_modification.h"

namespace hires::knowledge {
namespace {

const std::vector<std::string> kTexts = {"Scenario", "Instruction", "Truth", "World"};

std::vector<std::string> TextsOf(const Field& field, const ScenarioSetting& setting) {
  if (setting.group.empty()) return {field.Text()};
  std::vector<std::string> texts;
  const std::string wanted =
      fmt::format("a list of {} texts, one for each choice", setting.choices);
  for (const Field& item : field.Items(wanted, static_cast<std::size_t>(setting.choices))) {
    texts.push_back(item.Text());
  }
  return texts;
}

}  // namespace

const std::vector<std::string> kScenarioKeys = {"Group", "Choices", "Scenario", "Instruction",
                                                "Truth", "World",   "ZOrigin"};

ScenarioSetting ReadScenarioSetting(const Fields& in) {
  ScenarioSetting setting;
  setting.where = in.At();
  if (const auto group = in.Find("Group")) {
    setting.group = group->Name();
    setting.choices = ReadChoices(in.Require("Choices", "say how many there are"));
  } else if (const auto choices = in.Find("Choices")) {
    choices->Fail("there is no Group that chooses; name one, or remove this line");
  }
  for (const std::string& key : kTexts) {
    if (const auto field = in.Find(key)) setting.values[key] = TextsOf(*field, setting);
  }
  if (const auto z = in.Find("ZOrigin")) setting.z_origin = z->Real();
  return setting;
}

}  // namespace hires::knowledge
