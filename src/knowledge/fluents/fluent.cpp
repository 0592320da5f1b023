#include "hires/knowledge/fluent.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "hires/base/error.h"

namespace hires::knowledge {
namespace {

constexpr std::array<std::string_view, 4> kSources = {"knowledge", "observation", "person",
                                                      "monitor"};

}  // namespace

bool operator==(const Property& a, const Property& b) {
  return std::tie(a.role, a.type, a.filler) == std::tie(b.role, b.type, b.filler);
}

bool operator==(const Fluent& a, const Fluent& b) {
  return std::tie(a.concept_name, a.instance, a.properties, a.start, a.finish) ==
         std::tie(b.concept_name, b.instance, b.properties, b.start, b.finish);
}

std::string_view ToString(Source source) { return kSources[static_cast<std::size_t>(source)]; }

Source ReadSource(std::string_view word) {
  const auto found = std::find(kSources.begin(), kSources.end(), word);
  if (found == kSources.end()) {
    throw base::ConfigError(
        fmt::format("source '{}' is unknown; wanted one of {}", word, fmt::join(kSources, ", ")));
  }
  return static_cast<Source>(found - kSources.begin());
}

}  // namespace hires::knowledge
