#include "hires/actions/catalogue.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::actions {

void Catalogue::Add(ActionSpec spec) {
  CheckSpec(spec);
  if (specs_.count(spec.name) > 0) {
    throw base::ConfigError(
        fmt::format("action '{}' exists already; give the new one another name", spec.name));
  }
  const std::string name = spec.name;
  specs_.emplace(name, std::move(spec));
}

const ActionSpec* Catalogue::Find(const std::string& name) const {
  const auto found = specs_.find(base::CanonicalName(name));
  return found == specs_.end() ? nullptr : &found->second;
}

const ActionSpec& Catalogue::Get(const std::string& name) const {
  if (const ActionSpec* spec = Find(name)) return *spec;
  std::vector<std::string> names;
  for (const auto& entry : specs_) names.push_back(entry.first);
  throw base::ConfigError(base::UnknownName("action", name, names));
}

bool MayUseHead(const Catalogue& catalogue, const std::string& name) {
  const ActionSpec* spec = catalogue.Find(name);
  return spec == nullptr || spec->groups.count(kHeadGroup) > 0;
}

}  // namespace hires::actions
