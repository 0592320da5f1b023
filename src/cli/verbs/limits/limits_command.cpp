#include "cli/verbs/limits/limits_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "cli/crew_display.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/own_object.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/imagination/client_config.h"
#include "hires/robot/load_robot.h"
#include "reports/limits/motion_limits.h"
#include "reports/text/report_json.h"

namespace hires::cli {
namespace {

/// What is on the tray, and what was named as well and cannot be.
struct Payloads {
  std::vector<std::string> names, errors;

  void RequireSome() const {
    if (names.empty()) throw base::ConfigError(base::Join(errors, "\n"));
  }

  /// Keeps those that the tray carries one by one.
  void RefuseBad(const imagination::ImaginationSetup& setup) {
    std::vector<std::string> carried;
    std::set<std::string> seen;
    for (const std::string& name : names) {
      try {
        if (!seen.insert(base::ToLower(name)).second) {
          throw base::ConfigError(fmt::format(
              "object '{}' is named twice; expected different objects; use two instances of the "
              "catalogue, or a copy of its file with another name",
              name));
        }
        reports::SupportsOnTray(setup, {name});
        carried.push_back(name);
      } catch (const base::ConfigError& error) {
        errors.push_back(error.what());
      }
    }
    names = std::move(carried);
    RequireSome();
  }
};

imagination::SetupConfig SetupOf(const LimitsOptions& o, const std::string& package_folder,
                                 Payloads* payloads) {
  const std::string scene =
      o.scene.empty()
          ? imagination::ReadClientConfig(package_folder + "/config/imagination_client.yaml").scene
          : o.scene;
  imagination::SetupConfig setup = imagination::ReadSetupConfig(scene);
  imagination::OverridePaths({}, o.robot, o.objects, o.uncertainty, &setup);
  for (const std::string& typed : o.payloads) {
    imagination::SetupConfig with = setup;
    try {
      payloads->names.push_back(NameOf(typed, &with));
      setup = std::move(with);
    } catch (const base::ConfigError& error) {
      payloads->errors.push_back(error.what());
    }
  }
  payloads->RequireSome();
  return setup;
}

void CheckLimitsFiles(const LimitsOptions& o, const imagination::SetupConfig& setup) {
  std::vector<VerbFile> inputs = SceneFiles(setup.world, "", setup.robot, {});
  for (const VerbFile& input : {VerbFile{"scene", o.scene}, VerbFile{"objects", setup.objects},
                                VerbFile{"uncertainty", setup.uncertainty},
                                VerbFile{"uncertainty over it", setup.uncertainty_over},
                                VerbFile{"given limits", o.given}}) {
    inputs.push_back(input);
  }
  for (const std::string& object : setup.extra_objects) inputs.push_back({"object", object});
  CheckOutputs({{"--yaml", o.yaml}, {"--json", o.json}, {"--csv", o.csv}}, inputs);
}

/// What was derived of the robot, a line each; "" where its files say all.
std::string AssumedText(const robot::Robot& robot) {
  std::string text;
  for (const std::string& assumed : robot.assumed)
    text += "assumed of the robot, " + assumed + '\n';
  return text.empty() ? "" : text + '\n';
}

/// Limits are found in several parts, each of which would say what is left of itself.
base::Crew CrewOf(const LimitsOptions& o, const std::function<bool()>& cancelled) {
  base::Crew crew = MakeCrew(o.threads, o.quiet, cancelled);
  if (crew.on_progress) {
    crew.on_progress = [show = crew.on_progress, begin = base::SteadyNow()](
                           double fraction, double) { show(fraction, base::SteadyNow() - begin); };
  }
  return crew;
}

/// @return false when cancelled.
bool Find(const LimitsOptions& options, const reports::LimitsRequest& request,
          const imagination::ImaginationSetup& setup, const base::Crew& crew) {
  const double begin = base::SteadyNow();
  auto report = reports::FindLimits(request, setup, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return false;
  report->wall_seconds = base::SteadyNow() - begin;
  const std::string yaml = reports::LimitsYaml(*report);
  std::cout << reports::LimitsText(*report) << '\n' << yaml;
  if (!options.yaml.empty()) base::ReplaceTextFile(options.yaml, yaml);
  if (!options.json.empty()) reports::WriteJson(reports::ToJson(*report), options.json);
  return true;
}

/// @return false when cancelled.
bool CheckGiven(const LimitsOptions& options, const reports::LimitsRequest& request,
                const imagination::ImaginationSetup& setup, const base::Crew& crew) {
  const bool is_omnidirectional =
      setup.scene->robot.profile.base_controller.drive == robot::Drive::kOmnidirectional;
  const reports::GivenLimits given = reports::ReadGivenLimits(options.given, is_omnidirectional);
  const auto report = reports::CheckGivenLimits(request, setup, given, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return false;
  std::cout << reports::GivenText(*report, given);
  if (!options.csv.empty()) base::ReplaceTextFile(options.csv, reports::GivenCsv(*report));
  return true;
}

}  // namespace

void AddLimitsVerb(CLI::App* app, LimitsOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "limits", "how fast and how suddenly a robot may drive with an object on its tray");
  options->verb = verb;
  verb->add_option("--object", options->payloads,
                   "payload: object of the catalogue, or a file (.sdf, .urdf, .yaml); up to three "
                   "times, together on the tray")
      ->required()
      ->allow_extra_args(false);
  verb->add_option("--robot", options->robot, "another robot: profile (.yaml), URDF or xacro file");
  verb->add_option("--max-fall", options->max_fall,
                   "share of drives that may lose the object; default: 0.01")
      ->check(NumberBetween(0.001, 0.5));
  verb->add_option("--max-slide", options->max_slide,
                   "slide on the tray that counts as a failure [m]; default: standing.slide of the "
                   "scene (0.10)")
      ->check(NumberBetween(0.001, 2.0));
  verb->add_option("--objects", options->objects, "another catalogue of objects (YAML)");
  verb->add_option("--uncertainty", options->uncertainty,
                   "YAML file over the scene's own (`only: true` in it: instead), or none");
  verb->add_option("--scene", options->scene, "another scene file instead of config/scene.yaml");
  verb->add_option("--seed", options->seed, "of all chance; equal seeds give equal answers")
      ->check(WholeNumber());
  verb->add_option("--threads", options->threads, "default: one per core; changes no number")
      ->check(NumberBetween(1, 256));
  verb->add_option("--check", options->check_truths,
                   "play so many new truths at each limit, and 10 % above it")
      ->check(NumberBetween(1, 100000));
  CLI::Option* yaml = verb->add_option("--yaml", options->yaml,
                                       "write move_base's parameters to this file as well");
  CLI::Option* json = verb->add_option("--json", options->json, "write all numbers to this file");
  CLI::Option* given = verb->add_option("--given", options->given,
                                        "check these limits instead: parameters of DWAPlannerROS, "
                                        "TebLocalPlannerROS or Nav2 (YAML)")
                           ->excludes(yaml)
                           ->excludes(json)
                           ->excludes(verb->get_option("--check"));
  verb->add_option("--csv", options->csv, "write which given limits each object survives to a file")
      ->needs(given);
  verb->add_flag("--quiet", options->quiet, "no progress bar");
}

int RunLimitsVerb(const LimitsOptions& options, const std::string& package_folder,
                  const std::function<bool()>& cancelled) {
  Payloads payloads;
  const imagination::SetupConfig config = SetupOf(options, package_folder, &payloads);
  CheckLimitsFiles(options, config);
  imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(config);
  if (options.max_slide) setup.standing.slide = *options.max_slide;
  payloads.RefuseBad(setup);
  for (const std::string& error : payloads.errors) std::cerr << "hires limits: " << error << '\n';
  reports::LimitsRequest request;
  request.objects = payloads.names;
  request.is_controller_assumed = robot::IsMotionAssumed(config.robot);
  request.max_fall = options.max_fall;
  request.seed = options.seed;
  request.check_truths = options.check_truths;
  // Whoever asks reads these while the rest is played.
  reports::ClosedForms forms = reports::ClosedFormLimits(request.objects, setup);
  const reports::HazardLimits hazards = reports::FindHazardLimits(request.objects, setup);
  forms.weakest.insert(forms.weakest.end(), hazards.bounds.begin(), hazards.bounds.end());
  std::cout << AssumedText(setup.scene->robot)
            << reports::ClosedFormText(forms, request.is_controller_assumed) << '\n'
            << std::flush;
  const base::Crew crew = CrewOf(options, cancelled);
  const bool is_done = options.given.empty() ? Find(options, request, setup, crew)
                                             : CheckGiven(options, request, setup, crew);
  if (!is_done) {
    std::cerr << "hires limits: cancelled; nothing is written\n";
    return kExitCancelled;
  }
  return payloads.errors.empty() ? kExitRecommended : kExitBadInput;
}

}  // namespace hires::cli
