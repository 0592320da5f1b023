#include "cli/verbs/doctor/robot_doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/exit_code.h"
#include "cli/verbs/doctor/robot_doctor_hosts.h"
#include "cli/verbs/doctor/robot_doctor_judge.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;

bool HasFailed(const RobotFindings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const RobotFinding& finding) {
    return finding.level == FindingLevel::kFailed;
  });
}

std::vector<std::string> RowOf(const std::string& topic, const std::string& node,
                               const SeenMessages& seen) {
  const auto age = seen.age();
  return {topic, node, std::to_string(seen.count),
          seen.rate() > 0.0 ? fmt::format("{:.1f}", seen.rate()) : "",
          age ? fmt::format("{:.3f}", *age) : ""};
}

std::string MessageTable(const RobotNeeds& needs, const RobotView& view) {
  std::vector<std::vector<std::string>> rows{{"topic", "from", "messages", "Hz", "age [s]"}};
  for (const WantedTopic& wanted : needs.all_topics()) {
    const SeenTopic* topic = view.FindTopic(wanted.name);
    if (topic == nullptr) continue;
    for (const auto& [node, seen] : topic->messages) {
      rows.push_back(RowOf(wanted.name, node, seen));
    }
  }
  return rows.size() > 1 ? reports::FormatTable(rows) + '\n' : "";
}

std::string ClockTable(const RobotView& view) {
  std::vector<std::vector<std::string>> rows{{"clock of", "ahead [s]", "sure to [s]", "answers"}};
  for (const auto& [host, bounds] : view.clocks) {
    rows.push_back({host, fmt::format("{:.3f}", 0.5 * (bounds.lower + bounds.upper)),
                    fmt::format("{:.3f}", 0.5 * bounds.width()),
                    std::to_string(bounds.num_answers)});
  }
  return rows.size() > 1 ? reports::FormatTable(rows) + '\n' : "";
}

std::string LastLine(const RobotFindings& findings) {
  if (HasFailed(findings)) return "something needs attention, see FAILED above\n";
  return findings.empty() ? "all is well\n" : "nothing failed\n";
}

ordered_json ToJson(const RobotFinding& finding) {
  return {{"level", ToString(finding.level)},
          {"code", finding.code},
          {"subject", finding.subject},
          {"text", finding.text},
          {"remedy", finding.remedy}};
}

ordered_json ToJson(const SeenMessages& seen) {
  ordered_json json{{"type", seen.type}, {"md5", seen.md5}, {"messages", seen.count}};
  json["rate"] = seen.rate();
  if (const auto age = seen.age()) json["age"] = *age;
  return json;
}

ordered_json ClocksJson(const RobotView& view) {
  ordered_json clocks = ordered_json::object();
  for (const auto& [host, bounds] : view.clocks) {
    clocks[host] = {{"ahead_at_least", bounds.lower},
                    {"ahead_at_most", bounds.upper},
                    {"answers", bounds.num_answers}};
  }
  return clocks;
}

bool HasCode(const RobotFindings& findings, const std::string& code) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const RobotFinding& finding) { return finding.code == code; });
}

/// All findings, what fails first.
RobotFindings Sorted(const std::vector<RobotFindings>& parts) {
  RobotFindings findings;
  for (const RobotFindings& part : parts) {
    findings.insert(findings.end(), part.begin(), part.end());
  }
  std::stable_sort(findings.begin(), findings.end(),
                   [](const RobotFinding& a, const RobotFinding& b) { return a.level > b.level; });
  return findings;
}

}  // namespace

RobotFindings JudgeRobot(const RobotDoctorOptions& options, const RobotNeeds& needs,
                         const hires::robot::RobotProfile& profile, const RobotView& view) {
  std::vector<RobotFindings> parts{JudgeHosts(view), JudgeClocks(view),
                                   JudgeListeners(needs, view)};
  if (HasCode(parts.front(), "own_loopback")) return Sorted(parts);  // nothing came, of course
  parts.insert(parts.end(), {JudgeTopics(needs, view), JudgeFrames(needs, profile, view),
                             JudgeJoints(profile, view), JudgeReadiness(needs.names, view)});
  if (options.navigation != "own") {
    parts.push_back(JudgeMoveBase(needs.names, view, options.navigation == "move_base"));
  }
  return Sorted(parts);
}

std::string RobotReport(const RobotNeeds& needs, const RobotView& view,
                        const RobotFindings& findings) {
  std::string text =
      fmt::format("robot at {}: {} nodes, {} topics, listened for {:.1f} s\n\n", view.master_uri,
                  view.nodes.size(), view.topics.size(), view.seconds);
  text += MessageTable(needs, view) + ClockTable(view);
  for (const RobotFinding& finding : findings) {
    text += FindingText(
        {finding.level, fmt::format("{} {}\n{}", finding.subject, finding.text, finding.remedy)});
  }
  return text + (findings.empty() ? "" : "\n") + LastLine(findings);
}

ordered_json RobotJson(const RobotNeeds& needs, const RobotView& view,
                       const RobotFindings& findings) {
  ordered_json json{{"ok", !HasFailed(findings)},
                    {"master", view.master_uri},
                    {"seconds", view.seconds},
                    {"findings", ordered_json::array()},
                    {"topics", ordered_json::object()}};
  for (const RobotFinding& finding : findings) json["findings"].push_back(ToJson(finding));
  for (const WantedTopic& wanted : needs.all_topics()) {
    const SeenTopic* topic = view.FindTopic(wanted.name);
    ordered_json publishers = ordered_json::object();
    if (topic != nullptr) {
      for (const auto& [node, seen] : topic->messages) publishers[node] = ToJson(seen);
    }
    json["topics"][wanted.name] = publishers;
  }
  json["clocks"] = ClocksJson(view);
  return json;
}

int RunRobotDoctor(const RobotDoctorOptions& options, const std::string& package_folder,
                   const RobotMessageTypes& types, const LookAtRobot& look) {
  const auto or_default = [&](const std::string& path, const char* name) {
    return path.empty() ? package_folder + "/config/robots/" + name : path;
  };
  const std::string names = or_default(options.names, "pr2_names.yaml");
  const std::string profile = or_default(options.profile, "pr2.yaml");
  CheckReport(options.report, {{"names", names}, {"profile", profile}});
  const RobotNeeds needs =
      NeedsOf(control::ReadRobotNames(names), types,
              navigation::ReadBaseGuardParams(package_folder + "/config/base_guard.yaml"));
  const auto robot = robot::LoadRobot(profile);
  const RobotView view = look(options.seconds, needs);
  const RobotFindings findings = JudgeRobot(options, needs, robot.profile, view);
  std::cout << RobotReport(needs, view, findings) << std::flush;
  ReportOrigin origin;
  origin.verb = "doctor";
  origin.is_local = false;
  WriteReport(options.report, origin, RobotJson(needs, view, findings));
  return HasFailed(findings) ? kExitBadInput : kExitRecommended;
}

}  // namespace hires::cli
