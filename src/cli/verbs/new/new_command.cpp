#include "cli/verbs/new/new_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"

namespace hires::cli {
namespace {

namespace fs = std::filesystem;

/// "bot.yaml" for dir/bot.urdf.xacro and dir/bot.urdf: where the program runs.
std::string ProfileNameFor(const std::string& robot) {
  std::string name = fs::path(robot).filename().string();
  for (const char* ending : {".xacro", ".urdf"}) {
    const std::string lower = base::ToLower(fs::path(name).extension().string());
    if (lower == ending) name = fs::path(name).stem().string();
  }
  return name + ".yaml";
}

}  // namespace

void AddNewVerb(CLI::App* app, NewOptions* options) {
  CLI::App* verb =
      app->add_subcommand("new", "begin a file of your own: a robot's profile from its URDF");
  options->verb = verb;
  verb->require_subcommand(1);
  CLI::App* robot = verb->add_subcommand(
      "robot", "write what is derived and assumed of a URDF as a profile, to be corrected");
  robot
      ->add_option("robot", options->robot,
                   "URDF or xacro file; then arguments of xacro, NAME:=VALUE")
      ->required();
  robot->add_option("--output", options->output,
                    "file to write; default: the robot's file name with .yaml, in this folder");
  robot->add_flag("--force", options->is_forced, "write over a file that is there");
}

int RunNewVerb(const NewOptions& options) {
  const std::string robot = base::Join(options.robot, " ");
  const std::string output =
      options.output.empty() ? ProfileNameFor(options.robot.front()) : options.output;
  CheckOutputs({{"--output", output}}, {{"robot", options.robot.front()}});
  std::error_code error;
  if (!options.is_forced && fs::is_regular_file(output, error)) {
    throw base::ConfigError(fmt::format(
        "{}: is there already; write to another file by --output, or over it by --force", output));
  }
  base::ReplaceTextFile(output,
                        robot::WriteProfile(robot, fs::path(output).parent_path().string()));
  std::cout << fmt::format(
      "{}: the profile of {}; correct what is wrong there, then give it with --robot {}\n", output,
      robot, output);
  return kExitRecommended;
}

}  // namespace hires::cli
