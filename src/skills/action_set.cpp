#include "hires/skills/action_set.h"

#include <fmt/format.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"

namespace hires::skills {

std::string ToString(const std::vector<LibraryOfActions>& libraries) {
  if (libraries.empty()) return "no library";
  std::vector<std::string> names;
  for (const LibraryOfActions& library : libraries) {
    names.push_back(fmt::format("{} {}", std::filesystem::path(library.path).filename().string(),
                                base::HexOf(library.hash)));
  }
  return base::Join(names, ", ");
}

void ActionSet::Add(Action action) {
  if (!action.make) {
    throw base::ConfigError(fmt::format(
        "action '{}' has no maker; give the function that makes its skill", action.spec.name));
  }
  const std::string name = action.spec.name;
  catalogue_.Add(std::move(action.spec));
  ways_[name] = {std::move(action.make), action.goes_by};
}

const Way& ActionSet::WayOf(const std::string& name) const {
  return ways_.at(catalogue_.Get(name).name);
}

std::uint64_t ActionSet::hash() const {
  base::Hasher hasher;
  for (const auto& [name, spec] : catalogue_.specs()) hasher.Add(actions::Canonical(spec));
  for (const LibraryOfActions& library : libraries_) hasher.Add(library.hash);
  return hasher.value();
}

}  // namespace hires::skills
