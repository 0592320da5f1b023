#include "planning/language/faults.h"

#include <fmt/format.h>

#include "hires/base/text.h"

namespace hires::planning {
namespace {

constexpr std::size_t kMostFaults = 10;

}  // namespace

void Faults::Require() const {
  if (texts_.empty()) return;
  std::vector<std::string> told = texts_;
  if (told.size() > kMostFaults) {
    told.resize(kMostFaults);
    told.push_back(fmt::format("and {} more", texts_.size() - kMostFaults));
  }
  throw base::ConfigError(base::Join(told, "\n"));
}

}  // namespace hires::planning
