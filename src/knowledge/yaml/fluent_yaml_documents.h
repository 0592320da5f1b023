#pragma once

#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"
#include "knowledge/yaml/fluent_yaml_field.h"

namespace hires::knowledge {

// The keys that a document of each kind may have, and what it says. All throw ConfigError with
// place, what came and what was wanted.
extern const std::vector<std::string> kFluentKeys;
Fluent ReadFluent(const Fields& in);

extern const std::vector<std::string> kModificationKeys;
PoseModification ReadModification(const Fields& in);

extern const std::vector<std::string> kTopicKeys;
DemandTopic ReadTopic(const Fields& in);

extern const std::vector<std::string> kScenarioKeys;
ScenarioSetting ReadScenarioSetting(const Fields& in);

}  // namespace hires::knowledge
