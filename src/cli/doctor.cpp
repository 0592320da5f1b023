#include "hires/cli/doctor.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <thread>
#include <vector>

#include "hires/base/error.h"
#include "hires/cli/command_line.h"
#include "hires/evaluation/report_table.h"
#include "hires/imagination/client_config.h"
#include "hires/physics/physics_checks.h"

namespace hires::cli {
namespace {

bool CheckFiles(const Backends& backends) {
  try {
    const auto client =
        imagination::ReadClientConfig(backends.package_folder + "/config/imagination_client.yaml");
    const auto setup =
        imagination::LoadImaginationSetup(imagination::ReadSetupConfig(client.scene));
    std::cout << fmt::format(
        "ok      world '{}' with {} bodies and {} areas, robot '{}' with {} links\n",
        setup.scene->world.name, setup.scene->world.statics.size(),
        setup.scene->world.frames.size(), setup.scene->robot.model.name,
        setup.scene->robot.model.links.size());
    return true;
  } catch (const std::exception& error) {
    std::cout << "FAILED  " << error.what() << '\n';
    return false;
  }
}

bool CheckMachine() {
  const unsigned cores = std::thread::hardware_concurrency();
  std::cout << fmt::format("ok      {} cores: start at most so many workers here\n", cores);
  return cores > 0;
}

bool CheckPhysics() {
  const struct {
    const char* name;
    physics::UprightCylinder body;
  } mills[] = {{"pepper mill, thesis text", {0.037, 0.274, 0.140}},
               {"pepper mill, appendix", {0.035, 0.300, 0.500}},
               {"pepper mill, repository", {0.037, 0.274, 0.350}}};
  bool passed = true;
  for (const auto& mill : mills) {
    std::vector<std::vector<std::string>> rows{
        {"", "check", "closed form", "measured", "unit", "error", "allowed", "remark"}};
    for (const physics::PhysicsCheck& check : physics::RunPhysicsChecks(mill.body, mill.name)) {
      passed = passed && check.passed();
      rows.push_back({check.passed() ? "ok" : "FAILED", check.name,
                      fmt::format("{:.5g}", check.expected), fmt::format("{:.5g}", check.measured),
                      check.unit, fmt::format("{:.2g}", check.error),
                      fmt::format("{:.2g}", check.tolerance), check.remark});
    }
    std::cout << '\n' << evaluation::FormatTable(rows) << std::flush;
  }
  return passed;
}

int CheckAll(const Backends& backends, bool with_physics) {
  bool passed = CheckMachine();
  passed = CheckFiles(backends) && passed;
  for (const Check& check : backends.more_checks) passed = check() && passed;
  if (with_physics) passed = CheckPhysics() && passed;
  std::cout << (passed ? "\nall is well\n" : "\nsomething needs attention, see FAILED above\n");
  return passed ? kExitRecommended : kExitBadInput;
}

}  // namespace

void AddDoctorVerb(CLI::App* app, DoctorOptions* o) {
  o->verb = app->add_subcommand(
      "doctor",
      "check this machine and compare the physics with closed forms, or --robot: a running robot");
  CLI::Option* robot =
      o->verb->add_flag("--robot", o->is_robot, "look at the robot of ROS_MASTER_URI instead");
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
      ->check(CLI::Range(0.2, 600.0))
      ->needs(robot);
  o->verb->add_option("--json", o->robot.json, "write what was found to this file as well")
      ->needs(robot);
}

int RunDoctorVerb(const DoctorOptions& options, const Backends& backends) {
  if (!options.is_robot) return CheckAll(backends, !options.is_without_physics);
  if (!backends.examine_robot) {
    throw base::ConfigError("this build has no ROS, so it cannot ask a robot; leave out --robot");
  }
  return backends.examine_robot(options.robot);
}

}  // namespace hires::cli
