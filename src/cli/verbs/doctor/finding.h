#pragma once

#include <string>
#include <vector>

/// What `hires doctor` says, and how.
namespace hires::cli {

enum class FindingLevel {
  kOk,
  kNote,     ///< worth knowing, nothing to do
  kWarning,  ///< works, but a person should look at it
  kFailed    ///< does not work before it is mended
};

struct Finding {
  FindingLevel level{FindingLevel::kOk};
  std::string text;  ///< what is, and what to do; further lines are indented when printed
};

std::string ToString(FindingLevel level);  ///< "ok", "note", "warning", "failed"

/// "ok      ...", "note    ...", "warn    ...", "FAILED  ...".
std::string FindingText(const Finding& finding);

struct RobotFinding {
  FindingLevel level{FindingLevel::kFailed};
  std::string code;     ///< one word for programs: "topic_missing"
  std::string subject;  ///< "topic /base_scan"
  std::string text;     ///< what is
  std::string remedy;   ///< what to do
};
using RobotFindings = std::vector<RobotFinding>;

void Append(const RobotFindings& more, RobotFindings* findings);

}  // namespace hires::cli
