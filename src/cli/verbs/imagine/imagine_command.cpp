#include "cli/verbs/imagine/imagine_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/trimmed.h"
#include "cli/exit_code.h"
#include "cli/own_object.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "hires/imagination/client_config.h"
#include "hires/robot/load_robot.h"
#include "hires/skills/action_loader.h"
#include "reports/text/report_json.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

void AddOptions(CLI::App* app, ImagineOptions* o) {
  app->add_option("--action", o->action,
                  "what the robot would do: move_base_param, place_object, ...")
      ->required();
  app->add_option("--actions", o->action_libraries,
                  "library with more actions (.so), for --local; nodes have ~action_libraries")
      ->allow_extra_args(false);
  AddStartOptions(app, &o->start);
  app->add_option("--arg", o->arguments,
                  "alternatives of one argument, separated by commas; once per argument, in order")
      ->allow_extra_args(false);
  app->add_option("--rollouts", o->rollouts,
                  "maximum number per combination; default: as --config says, 400")
      ->check(NumberBetween(1, 100000));
  app->add_option("--seed", o->seed, "of all chance; equal seeds give equal answers")
      ->check(WholeNumber());
  app->add_option("--deadline", o->deadline, "[s] after which the best answer so far is taken")
      ->check(NumberBetween(0.0, 1e6));
  app->add_option("--ranking", o->ranking, "cost, risk or thesis; default: as --config says");
  app->add_option("--min-success", o->min_success,
                  "share of successes that the lower end of the interval must reach")
      ->check(NumberBetween(0.001, 0.999));
  app->add_option("--max-regret", o->max_regret,
                  "[s] expected regret of the recommendation at which rollouts stop, for "
                  "`--ranking cost`; default: 2")
      ->check(NumberBetween(0.0, 1e5));
  app->add_option("--uncertainty", o->uncertainty,
                  "YAML file over the scene's own (`only: true` in it: instead), or none");
  app->add_option("--sensing", o->sensing,
                  "with --local, by what rollouts see: fitted (a quick detector that errs as the "
                  "recogniser was found to), pictures (the recogniser itself; slow)")
      ->check(CLI::IsMember({"fitted", "pictures"}));
  app->add_flag("--no-early-stop", o->play_all, "play all rollouts even if the answer is decided");
  app->add_flag("--local", o->local, "in this process, without any ROS master");
  app->add_option("--threads", o->threads, "workers of --local; default: one per core")
      ->check(NumberBetween(1, 256));
  CLI::Option* world = app->add_option("--world", o->world, "another SDF world");
  app->add_option("--map", o->map, "a map_server map (its YAML) whose walls are the world")
      ->excludes(world);
  AddAreaOption(app, &o->areas);
  app->add_option("--robot", o->robot, "another robot: profile (.yaml), URDF or xacro file");
  app->add_option("--objects", o->objects, "another catalogue of objects (YAML)");
  app->add_option("--scene", o->scene, "another scene file instead of config/scene.yaml");
  app->add_option("--config", o->config, "another file instead of config/imagination_client.yaml");
  AddReportOptions(app, &o->report);
  AddSaveRolloutOptions(app, &o->save);
  app->add_flag("--quiet", o->quiet, "no progress bar");
}

std::vector<std::string> AlternativesOf(const std::string& list) {
  std::vector<std::string> alternatives = base::Split(list, ',');
  for (std::string& alternative : alternatives) alternative = base::Trimmed(alternative);
  if (std::count(alternatives.begin(), alternatives.end(), "") > 0) {
    throw base::ConfigError(fmt::format(
        "--arg '{}': an alternative is empty; wanted names with one comma between two", list));
  }
  return alternatives;
}

/// What was typed as a file is loaded, and called by its name.
void NameObjects(imagination::SetupConfig* setup, ImagineStart* start) {
  std::map<std::string, std::string> names;  // by what was typed: a file is loaded once
  const auto name_of = [&](const std::string& object) {
    const auto [entry, is_new] = names.emplace(object, "");
    if (is_new) entry->second = NameOf(object, setup);
    return entry->second;
  };
  for (std::string& object : start->on_tray) object = name_of(object);
  for (imagination::PutObject& put : start->put) put.object = name_of(put.object);
  for (base::Atom& atom : start->atoms) {
    if (atom.predicate == "On") atom.arguments[0] = name_of(atom.arguments[0]);
    if (atom.predicate == "Holding") atom.arguments[1] = name_of(atom.arguments[1]);
  }
}

void SetStart(const ImagineOptions& o, ImagineQuery* query) {
  query->setup.action_libraries = o.action_libraries;
  query->start =
      ReadStart(o.start, o.action, skills::LoadActionSet(o.action_libraries)->catalogue());
  NameObjects(&query->setup, &query->start);
}

void SetSensing(const ImagineOptions& o, imagination::SetupConfig* setup) {
  if (o.sensing.empty()) return;
  if (!o.local) {
    throw base::ConfigError(
        "--sensing is for --local; running nodes see as `recogniser` of their scene file says");
  }
  setup->recogniser =
      o.sensing == "pictures" ? o.report.package_folder + "/config/recogniser.yaml" : "none";
}

std::string ConfigPath(const ImagineOptions& o) {
  return o.config.empty() ? o.report.package_folder + "/config/imagination_client.yaml" : o.config;
}

ImagineQuery MakeQuery(const ImagineOptions& o) {
  if (!o.local && !o.action_libraries.empty()) {
    throw base::ConfigError(
        "--actions is for --local; running nodes load theirs by the parameter ~action_libraries "
        "(imagination.launch actions:=FILE)");
  }
  const imagination::ClientConfig config = imagination::ReadClientConfig(ConfigPath(o));
  ImagineQuery query;
  query.setup = imagination::ReadSetupConfig(o.scene.empty() ? config.scene : o.scene);
  imagination::OverridePaths(o.world, o.robot, o.objects, o.uncertainty, &query.setup);
  query.setup.map = o.map;
  SetSensing(o, &query.setup);
  query.setup.areas = ReadAreas(o.areas);
  SetStart(o, &query);
  query.own_scene = !(o.world + o.map + o.robot + o.objects + o.scene).empty() ||
                    !o.areas.empty() || !query.setup.extra_objects.empty();
  query.own_uncertainty = !o.uncertainty.empty();
  query.action.name = o.action;
  for (const std::string& list : o.arguments) {
    query.action.alternatives.push_back(AlternativesOf(list));
  }
  query.seed = o.seed;
  query.scheduler = config.scheduler;
  if (o.rollouts > 0) query.scheduler.rollouts = o.rollouts;
  if (o.deadline >= 0.0) query.scheduler.deadline = o.deadline;
  if (!o.ranking.empty()) query.scheduler.criteria.rule = imagination::ParseRankingRule(o.ranking);
  if (o.min_success > 0.0) query.scheduler.criteria.min_success = o.min_success;
  if (o.max_regret >= 0.0) query.scheduler.criteria.max_regret = o.max_regret;
  query.validated = config.validated;
  if (o.play_all) query.scheduler.early_stop = false;
  query.threads = o.threads > 0 ? o.threads : std::max(1u, std::thread::hardware_concurrency());
  return query;
}

/// A bar that is drawn over itself on a terminal, a line now and then in a log.
class ProgressDisplay {
 public:
  ProgressDisplay() : is_terminal_(isatty(STDERR_FILENO) != 0) {}

  void Show(const imagination::Interim& interim) {
    const auto now = std::chrono::steady_clock::now();
    if (is_terminal_) {
      std::cerr << '\r' << reports::ProgressLine(interim.progress) << "\033[K" << std::flush;
    } else if (now >= next_line_) {
      next_line_ = now + std::chrono::seconds(5);
      std::cerr << reports::ProgressLine(interim.progress) << std::endl;
    }
  }
  void Clear() const {
    if (is_terminal_) std::cerr << "\r\033[K";
  }

 private:
  bool is_terminal_;
  std::chrono::steady_clock::time_point next_line_{};
};

void PrintReport(const imagination::Report& report, imagination::RankingRule rule) {
  if (!report.ranking.empty()) {
    const bool with_cost = rule == imagination::RankingRule::kCost;
    const std::string prices = report.by_cost ? imagination::PriceSentence(*report.by_cost) : "";
    std::cout << reports::RankingTable(report.ranking, report.recommended, with_cost, prices)
              << '\n';
  }
  std::cout << fmt::format("{}: {}\n", reports::OutcomeName(report), report.why);
  std::cout << reports::FailureLines(report.ranking);
  for (const std::string& caveat : report.caveats) std::cout << "caveat: " << caveat << '\n';
  if (report.kept.rollouts > 0) {
    std::cout << fmt::format("{} rollouts, {:.0f} s, are those of an earlier request\n",
                             report.kept.rollouts, report.kept.simulated_seconds);
  }
  if (report.wall_seconds > 0.0 && report.played_seconds() > 0.0) {
    std::cout << fmt::format("{:.0f} s imagined in {:.1f} s, {:.0f} times as fast as real time\n",
                             report.played_seconds(), report.wall_seconds,
                             report.played_seconds() / report.wall_seconds);
  }
}

/// A name that nothing has, but whose kin the catalogue knows, is played as a model of that kind.
void PrintKin(const ImagineQuery& query, QueryScene* scene) {
  const imagination::ImaginationSetup& setup = scene->setup();
  for (const std::string& object : query.start.Objects()) {
    const std::string model = setup.ModelOf(object);
    const bool is_named = setup.object_models.count(base::ToLower(object)) > 0 ||
                          base::ToLower(model) == base::ToLower(object);
    if (is_named) continue;
    std::cout << fmt::format(
        "object '{}' is not in the catalogue; as its like there, it is a '{}'\n", object, model);
  }
}

/// What the answer rests on here.
std::vector<VerbFile> InputsOf(const ImagineOptions& options, const ImagineQuery& query) {
  const imagination::SetupConfig& files = query.setup;
  const bool has_uncertainty = files.uncertainty != "none";
  const std::string config = ConfigPath(options);
  std::vector<VerbFile> inputs{
      {"settings", config},
      {"scene",
       options.scene.empty() ? imagination::ReadClientConfig(config).scene : options.scene},
      {"world", files.map.empty() ? files.world : ""},
      {"map", files.map},
      {"robot", robot::FileOfRobot(files.robot)},
      {"objects", files.objects},
      {"uncertainty", has_uncertainty ? files.uncertainty : ""},
      {"uncertainty over it", files.uncertainty_over}};
  for (const std::string& object : files.extra_objects) inputs.push_back({"object", object});
  for (const std::string& file : AreaFilesOf(options.areas)) inputs.push_back({"areas", file});
  return inputs;
}

/// Nothing that is asked for is written over what is read, and all can be written.
void CheckImagineFiles(const ImagineOptions& options, const ImagineQuery& query) {
  std::vector<VerbFile> inputs = InputsOf(options, query);
  inputs.push_back(PictureFile(query.setup.map));
  for (const std::string& library : options.action_libraries)
    inputs.push_back({"actions", library});
  std::vector<VerbFile> outputs = FilesOf(options.save);
  for (const std::string& strip : StripFiles(options.report.html))
    outputs.push_back({"picture of --html", strip});
  CheckReport(options.report, inputs, outputs);
}

/// Running nodes have files of their own, which they and their workers compare among themselves.
ReportOrigin OriginOf(const ImagineOptions& options, const ImagineQuery& query, QueryScene* scene) {
  ReportOrigin origin;
  origin.verb = "imagine";
  origin.is_local = options.local;
  if (!options.local || !IsWanted(options.report)) return origin;
  for (const VerbFile& input : InputsOf(options, query))
    origin.inputs.emplace_back(input.what, input.path);
  const imagination::ImaginationSetup& setup = scene->setup();
  origin.hashes = {{"world", base::HexOf(setup.world_hash)},
                   {"robot", base::HexOf(setup.robot_hash)},
                   {"physics", base::HexOf(setup.physics_hash)},
                   {"actions", base::HexOf(setup.actions_hash)}};
  return origin;
}

/// The answer for machines; where a page is made of it, with pictures.
nlohmann::ordered_json AnswerOf(const ImagineOptions& options, const ImagineQuery& query,
                                QueryScene* scene, const imagination::Report& report,
                                const std::function<bool()>& cancelled) {
  nlohmann::ordered_json answer = reports::ToJson(report, query.scheduler.criteria);
  const std::string& html = options.report.html;
  if (html.empty() || report.ranking.empty()) return answer;
  const std::string& json = options.report.json;
  const auto shown = [&](const std::string& file) {  // from the JSON, or as it is
    return json.empty()
               ? file
               : std::filesystem::proximate(file, std::filesystem::absolute(json).parent_path())
                     .string();
  };
  try {
    for (const Strip& strip : WriteStrips(html, query.threads, scene, report, cancelled)) {
      answer["pictures"].push_back({{"caption", strip.caption}, {"file", shown(strip.file)}});
    }
  } catch (const base::ConfigError& error) {
    if (options.local) throw;
    // The answer is theirs who have other files; the page can do without pictures.
    std::cerr << "hires: no pictures on the page: " << error.what() << '\n';
  }
  return answer;
}

}  // namespace

void AddImagineVerb(CLI::App* app, ImagineOptions* options) {
  options->verb =
      app->add_subcommand("imagine", "play alternatives of an action many times and rank them");
  AddOptions(options->verb, options);
}

int ExitCodeOf(const imagination::Report& report) {
  switch (report.outcome) {
    case imagination::ImaginationOutcome::kRanked:
    case imagination::ImaginationOutcome::kClose:
      return kExitRecommended;
    case imagination::ImaginationOutcome::kAllFailed:
      return kExitAllFailed;
    case imagination::ImaginationOutcome::kUndecided:
      return kExitUndecided;
    case imagination::ImaginationOutcome::kNoWorker:
      return kExitNoWorker;
    case imagination::ImaginationOutcome::kNothingFinished:
      return kExitDeadline;
    case imagination::ImaginationOutcome::kCancelled:
      return kExitCancelled;
  }
  return kExitBadInput;
}

int RunImagineVerb(const ImagineOptions& options, const ImagineBackends& backends,
                   const std::function<bool()>& cancelled) {
  const ImagineQuery query = MakeQuery(options);
  CheckImagineFiles(options, query);
  CheckSaveRollout(options.save, query, backends.make_rollout_bag);
  ProgressDisplay display;
  imagination::OnInterim on_interim;
  if (!options.quiet) on_interim = [&](const auto& interim) { display.Show(interim); };
  if (!options.local && !backends.imagine_remotely) {
    throw base::ConfigError("this build has no ROS nodes to ask; add --local");
  }
  QueryScene scene(query);
  const ReportOrigin origin = OriginOf(options, query, &scene);
  if (options.local) {
    RequireNames(query, &scene);
    PrintKin(query, &scene);
  }
  const imagination::Report report =
      options.local ? ImagineInThisProcess(query, &scene, on_interim, cancelled)
                    : backends.imagine_remotely(query, on_interim, cancelled);
  if (!options.quiet) display.Clear();
  PrintReport(report, query.scheduler.criteria.rule);
  WriteReport(options.report, origin, AnswerOf(options, query, &scene, report, cancelled));
  const int code = ExitCodeOf(report);
  if (report.ranking.empty()) return code;  // nothing was played that could be saved
  SaveRollout(options.save, query.threads, &scene, report, backends.make_rollout_bag, cancelled);
  return code;
}

}  // namespace hires::cli
