#include "cli/verbs/doctor/doctor.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "cli/exit_code.h"
#include "cli/verbs/imagine/imagine_start.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/imagination/client_config.h"
#include "hires/physics/physics_checks.h"
#include "hires/robot/load_robot.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;

/// What was found, in the order in which it was printed.
struct Findings {
  bool passed{true};
  ordered_json list = ordered_json::array();     ///< of findings
  ordered_json physics = ordered_json::array();  ///< of bodies with their comparisons

  void Add(const Finding& finding) {
    passed = passed && finding.level != FindingLevel::kFailed;
    std::cout << FindingText(finding) << std::flush;
    list.push_back({{"level", ToString(finding.level)}, {"text", finding.text}});
  }
};

Finding CheckFiles(const DoctorBackends& backends) {
  try {
    const auto client =
        imagination::ReadClientConfig(backends.package_folder + "/config/imagination_client.yaml");
    const auto setup =
        imagination::LoadImaginationSetup(imagination::ReadSetupConfig(client.scene));
    return {FindingLevel::kOk,
            fmt::format("world '{}' with {} bodies and {} areas, robot '{}' with {} links",
                        setup.scene->world.name, setup.scene->world.statics.size(),
                        setup.scene->world.frames.size(), setup.scene->robot.model.name,
                        setup.scene->robot.model.links.size())};
  } catch (const std::exception& error) {
    return {FindingLevel::kFailed, error.what()};
  }
}

Finding CheckMachine() {
  const unsigned cores = std::thread::hardware_concurrency();
  return {cores > 0 ? FindingLevel::kOk : FindingLevel::kFailed,
          fmt::format("{} cores: start at most so many workers here", cores)};
}

std::vector<std::string> RowOf(const physics::PhysicsCheck& check) {
  return {
      check.passed() ? "ok" : "FAILED",       check.name,  fmt::format("{:.5g}", check.expected),
      fmt::format("{:.5g}", check.measured),  check.unit,  fmt::format("{:.2g}", check.error),
      fmt::format("{:.2g}", check.tolerance), check.remark};
}

ordered_json ToJson(const physics::PhysicsCheck& check) {
  return {{"check", check.name},      {"closed_form", check.expected}, {"measured", check.measured},
          {"unit", check.unit},       {"error", check.error},          {"allowed", check.tolerance},
          {"passed", check.passed()}, {"remark", check.remark}};
}

void ShowChecks(const std::string& body, const std::vector<physics::PhysicsCheck>& checks,
                Findings* findings) {
  std::vector<std::vector<std::string>> rows{
      {"", "check", "closed form", "measured", "unit", "error", "allowed", "remark"}};
  ordered_json list = ordered_json::array();
  for (const physics::PhysicsCheck& check : checks) {
    findings->passed = findings->passed && check.passed();
    rows.push_back(RowOf(check));
    list.push_back(ToJson(check));
  }
  std::cout << '\n' << reports::FormatTable(rows) << std::flush;
  findings->physics.push_back({{"body", body}, {"checks", list}});
}

void CheckPhysics(Findings* findings) {
  const struct {
    const char* name;
    physics::UprightCylinder body;
  } mills[] = {{"pepper mill, thesis text", {0.037, 0.274, 0.140}},
               {"pepper mill, appendix", {0.035, 0.300, 0.500}},
               {"pepper mill, repository", {0.037, 0.274, 0.350}}};
  for (const auto& mill : mills) {
    ShowChecks(mill.name, physics::RunPhysicsChecks(mill.body, mill.name), findings);
  }
  ShowChecks("friction", physics::RunFrictionChecks(), findings);
  ShowChecks("every shape", physics::RunShapeChecks(), findings);
}

int CheckAll(const DoctorBackends& backends, bool with_physics, const ReportOptions& report) {
  CheckReport(report);
  Findings findings;
  findings.Add(CheckMachine());
  findings.Add(CheckFiles(backends));
  for (const Check& check : backends.more_checks) {
    for (const Finding& finding : check()) findings.Add(finding);
  }
  if (with_physics) CheckPhysics(&findings);
  std::cout << (findings.passed ? "\nall is well\n"
                                : "\nsomething needs attention, see FAILED above\n");
  ReportOrigin origin;
  origin.verb = "doctor";
  WriteReport(
      report, origin,
      {{"ok", findings.passed}, {"findings", findings.list}, {"physics", findings.physics}});
  return findings.passed ? kExitRecommended : kExitBadInput;
}

int CheckTheFiles(const DoctorOptions& options, const DoctorBackends& backends) {
  const ReportOptions& report = options.robot.report;
  const FileDoctorOptions& files = options.files;
  CheckReport(report, SceneFiles(files.world, files.map, files.robot, files.areas),
              {{"--png", files.png}});
  Findings findings;
  ExamineFiles(files, backends.package_folder,
               [&](const Finding& finding) { findings.Add(finding); });
  ReportOrigin origin;
  origin.verb = "doctor";
  if (findings.passed) {  // else one of them may not be there
    origin.inputs = {
        {"world", files.world}, {"map", files.map}, {"robot", robot::FileOfRobot(files.robot)}};
  }
  WriteReport(report, origin, {{"ok", findings.passed}, {"findings", findings.list}});
  return findings.passed ? kExitRecommended : kExitBadInput;
}

}  // namespace

void AddDoctorVerb(CLI::App* app, DoctorOptions* o) {
  o->verb = app->add_subcommand(
      "doctor",
      "check this machine and compare the physics with closed forms, or --robot: a running robot");
  CLI::Option* robot =
      o->verb
          ->add_option(
              "--robot", o->files.robot,
              "look at the robot of ROS_MASTER_URI instead; with --world or --map: profile "
              "(.yaml), URDF or xacro file")
          ->expected(0, 1);
  o->verb->add_option(
      "--world", o->files.world,
      "read this world, with --robot FILE, and say all that is assumed, left out or "
      "suspected");
  o->verb->add_option("--map", o->files.map, "likewise of a map_server map");
  AddAreaOption(o->verb, &o->files.areas);
  o->verb->add_option("--png", o->files.png, "with --world or --map: picture from above");
  o->verb
      ->add_flag("--no-physics", o->is_without_physics,
                 "look at this machine alone: the comparison takes 11 s of a processor")
      ->excludes(robot);
  o->verb->add_option("--names", o->robot.names, "what the robot calls its things (YAML)")
      ->needs(robot);
  o->verb->add_option("--profile", o->robot.profile, "the robot's profile (YAML)")->needs(robot);
  o->verb
      ->add_option("--navigation", o->robot.navigation,
                   "move_base or own: who will drive; what move_base lacks is then a failure, or "
                   "of no interest")
      ->check(CLI::IsMember({"move_base", "own"}))
      ->needs(robot);
  o->verb->add_option("--seconds", o->robot.seconds, "[s] to listen")
      ->check(NumberBetween(0.2, 600.0))
      ->needs(robot);
  AddReportOptions(o->verb, &o->robot.report);
}

int RunDoctorVerb(const DoctorOptions& options, const DoctorBackends& backends) {
  if (options.files.is_asked()) return CheckTheFiles(options, backends);
  for (const auto& [option, value] :
       {std::pair("--robot " + options.files.robot, !options.files.robot.empty()),
        std::pair(std::string("--area"), !options.files.areas.empty()),
        std::pair(std::string("--png"), !options.files.png.empty())}) {
    if (value)
      throw base::ConfigError(option + ": is looked at in a world; add --world FILE or --map FILE");
  }
  const bool is_robot = options.verb != nullptr && options.verb->count("--robot") > 0;
  if (!is_robot) {
    return CheckAll(backends, !options.is_without_physics, options.robot.report);
  }
  if (!backends.examine_robot) {
    throw base::ConfigError("this build has no ROS, so it cannot ask a robot; leave out --robot");
  }
  return backends.examine_robot(options.robot);
}

}  // namespace hires::cli
