#include "cli/verbs/doctor/finding.h"

#include <fmt/format.h>

#include <array>

#include "hires/base/text.h"

namespace hires::cli {

std::string ToString(FindingLevel level) {
  static constexpr std::array<const char*, 4> kNames{"ok", "note", "warning", "failed"};
  return kNames[static_cast<std::size_t>(level)];
}

std::string FindingText(const Finding& finding) {
  static constexpr std::array<const char*, 4> kHeads{"ok", "note", "warn", "FAILED"};
  const std::vector<std::string> lines = hires::base::Split(finding.text, '\n');
  return fmt::format("{:<8}{}\n", kHeads[static_cast<std::size_t>(finding.level)],
                     hires::base::Join(lines, "\n          "));
}

void Append(const RobotFindings& more, RobotFindings* findings) {
  findings->insert(findings->end(), more.begin(), more.end());
}

}  // namespace hires::cli
