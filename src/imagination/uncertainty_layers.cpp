#include "imagination/uncertainty_layers.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "hires/base/text.h"

namespace hires::imagination {
namespace {

constexpr char kCorrelationKey[] = "start_correlation";
constexpr char kOnlyKey[] = "only";

bool IsOfStartPose(const std::string& quantity) {
  return quantity.rfind("start_", 0) == 0 || quantity.rfind("docked_", 0) == 0;
}

bool IsSpread(const Distribution& distribution) {
  switch (distribution.kind) {
    case Distribution::Kind::kFixed:
      return false;
    case Distribution::Kind::kUniform:
      return distribution.first != distribution.second;
    default:
      return distribution.second != 0.0;
  }
}

}  // namespace

Uncertainty LaidOver(const Uncertainty& base, const Uncertainty& over) {
  if (over.is_only) return over;
  const auto is_named = [&](const std::string& name) { return over.quantities.count(name) > 0; };
  const std::vector<std::string> all = QuantityNames();
  if (std::all_of(all.begin(), all.end(), is_named)) return over;
  YAML::Node yaml = base.yaml == "none" ? YAML::Node(YAML::NodeType::Map) : YAML::Load(base.yaml);
  const bool spreads_starts =
      std::any_of(over.quantities.begin(), over.quantities.end(),
                  [](const auto& entry) { return IsOfStartPose(entry.first); });
  if (spreads_starts) yaml.remove(kCorrelationKey);
  for (const auto& entry : YAML::Load(over.yaml)) yaml[entry.first.Scalar()] = entry.second;
  yaml.remove(kOnlyKey);
  if (yaml.size() == 0) return NoUncertainty();
  return ParseUncertainty(YAML::Dump(yaml), "uncertainty laid over another one");
}

std::vector<std::string> CertainQuantities(const Uncertainty& uncertainty) {
  std::vector<std::string> certain;
  for (const std::string& name : QuantityNames()) {
    if (uncertainty.quantities.count(name) == 0) certain.push_back(name);
  }
  return certain;
}

std::string CertainText(const Uncertainty& uncertainty) {
  const std::vector<std::string> certain = CertainQuantities(uncertainty);
  const std::size_t num_named = uncertainty.quantities.size();
  const bool is_anything_spread =
      std::any_of(uncertainty.quantities.begin(), uncertainty.quantities.end(),
                  [](const auto& entry) { return IsSpread(entry.second); });
  if (!is_anything_spread && num_named > 0)
    return "nothing is uncertain: each quantity has one value, so that rollouts differ by noise at "
           "most, and spreads and shares say little of a real robot";
  if (!is_anything_spread)
    return "nothing is uncertain: all rollouts are of one and the same truth, so that spreads and "
           "shares say little of a real robot";
  if (certain.empty()) return {};
  if (certain.size() <= num_named) {
    return fmt::format("taken as certain, as the uncertainty does not name it: {}",
                       base::Join(certain, ", "));
  }
  std::vector<std::string> named;
  for (const auto& [name, distribution] : uncertainty.quantities) named.push_back(name);
  return fmt::format("taken as certain are {} of {} quantities, all but {}", certain.size(),
                     certain.size() + num_named, base::Join(named, ", "));
}

}  // namespace hires::imagination
