#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"
#include "knowledge/yaml/fluent_yaml_field.h"

namespace hires::knowledge {

/// Do the modifications make sense together: one per instance, as many deltas as choices on every
/// axis, the same choices throughout a group, attachments that go in no circle?
/// @param where  How messages begin, for each modification by index.
/// @throws ConfigError naming instance, axis, group or circle.
void CheckModifications(const std::vector<PoseModification>& modifications,
                        const std::function<std::string(std::size_t)>& where);

/// How many choices a group has.  @throws ConfigError for none, or more than a million.
int ReadChoices(const Field& field);

}  // namespace hires::knowledge
