#include "nodes/hires/replay.h"

#include <fmt/format.h>
#include <ros/serialization.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/program.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/progress.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/imagination/local_imagination.h"
#include "hires/imagination/local_setup.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/imagination/imagine_request.h"
#include "hires/ros/values/action_messages.h"
#include "nodes/hires/episode_replay.h"
#include "nodes/hires/remote_imagination.h"
#include "reports/text/report_json.h"
#include "reports/text/report_table.h"

namespace hires_ros {
namespace {

namespace cli = hires::cli;
namespace reports = hires::reports;
namespace imagination = hires::imagination;
using hires::ImagineGoal;
using hires::ImagineResult;
using nlohmann::ordered_json;

/// The bytes that would travel: equal for equal bits, whatever the type.
template <typename T>
std::vector<std::uint8_t> BytesOf(const T& value) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(value));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, value);
  return bytes;
}

template <typename T>
bool SameBits(const T& a, const T& b) {
  return BytesOf(a) == BytesOf(b);
}

bool SameBitsButWallTime(ImagineResult a, ImagineResult b) {
  a.wall_seconds = b.wall_seconds = 0.0;
  // What the client remembered then says nothing of the answer.
  a.rollouts_kept = b.rollouts_kept = 0;
  a.simulated_seconds_kept = b.simulated_seconds_kept = 0.0;
  return SameBits(a, b);
}

std::string OutcomeText(std::uint8_t outcome) {
  static constexpr std::array<const char*, 9> kNames{
      "ranked",  "ranked_at_deadline", "all_failed", "no_worker", "nothing_finished",
      "invalid", "cancelled",          "undecided",  "close"};
  return outcome < kNames.size() ? kNames[outcome] : fmt::format("outcome {}", outcome);
}

std::string TextOf(double value) { return fmt::format("{:.17g}", value); }
std::string TextOf(std::int32_t value) { return fmt::format("{}", value); }
std::string TextOf(std::uint32_t value) { return fmt::format("{}", value); }
std::string TextOf(std::uint64_t value) { return fmt::format("{}", value); }
std::string TextOf(const std::string& value) { return "'" + value + "'"; }
std::string TextOf(const hires::ActionCall& call) { return hires::base::ToString(FromMsg(call)); }

/// Collects what differs, with both values where a line can hold them.
class Differences {
 public:
  template <typename T>
  void Compare(const std::string& name, const T& then, const T& now) {
    if (SameBits(then, now)) return;
    lines_.push_back(fmt::format("{}: {} then, {} now", name, TextOf(then), TextOf(now)));
  }
  template <typename T>
  void CompareWhole(const std::string& name, const T& then, const T& now) {
    if (!SameBits(then, now)) lines_.push_back(name + " differs");
  }
  void Add(std::string line) { lines_.push_back(std::move(line)); }
  std::vector<std::string> Take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

void CompareNumbers(const std::string& place, const hires::Prediction& then,
                    const hires::Prediction& now, Differences* out) {
  static constexpr std::pair<const char*, double hires::Prediction::*> kNumbers[] = {
      {"confidence_pooled", &hires::Prediction::confidence_pooled},
      {"confidence_mean", &hires::Prediction::confidence_mean},
      {"success_share", &hires::Prediction::success_share},
      {"success_lower", &hires::Prediction::success_lower},
      {"success_upper", &hires::Prediction::success_upper},
      {"expected_cost", &hires::Prediction::expected_cost},
      {"cost_lower", &hires::Prediction::cost_lower},
      {"cost_upper", &hires::Prediction::cost_upper},
      {"fall_share", &hires::Prediction::fall_share},
      {"action_failed_share", &hires::Prediction::action_failed_share},
      {"duration_mean", &hires::Prediction::duration_mean},
      {"duration_sd", &hires::Prediction::duration_sd},
      {"duration_p50", &hires::Prediction::duration_p50},
      {"duration_p95", &hires::Prediction::duration_p95},
      {"max_tilt_p50", &hires::Prediction::max_tilt_p50},
      {"max_tilt_p95", &hires::Prediction::max_tilt_p95}};
  for (const auto& [name, number] : kNumbers) {
    out->Compare(place + name, then.*number, now.*number);
  }
}

void ComparePredictions(const std::string& place, const hires::Prediction& then,
                        const hires::Prediction& now, Differences* out) {
  out->Compare(place + "action", then.action, now.action);
  CompareNumbers(place, then, now, out);
  out->Compare(place + "falls", then.falls, now.falls);
  out->Compare(place + "rollouts", then.rollouts, now.rollouts);
  out->CompareWhole(place + "counts", then.counts, now.counts);
  out->CompareWhole(place + "durations", then.durations, now.durations);
  out->CompareWhole(place + "max_tilts", then.max_tilts, now.max_tilts);
  out->CompareWhole(place + "kind of interval", then.interval_kind, now.interval_kind);
  out->CompareWhole(place + "first_causes", then.first_causes, now.first_causes);
  out->CompareWhole(place + "worst rollout", then.worst, now.worst);
  out->CompareWhole(place + "median rollout", then.median, now.median);
  out->CompareWhole(place + "first failed rollout", then.first_failed, now.first_failed);
  out->CompareWhole(place + "failures", then.failures, now.failures);
  out->CompareWhole(place + "final_world", then.final_world, now.final_world);
  out->CompareWhole(place + "final_robot", then.final_robot, now.final_robot);
}

std::vector<std::string> DifferencesOf(const ImagineResult& then, const ImagineResult& now) {
  Differences out;
  if (then.outcome != now.outcome) {
    out.Add(fmt::format("outcome: {} then, {} now", OutcomeText(then.outcome),
                        OutcomeText(now.outcome)));
  }
  out.Compare("number of predictions", static_cast<std::uint32_t>(then.predictions.size()),
              static_cast<std::uint32_t>(now.predictions.size()));
  const std::size_t both = std::min(then.predictions.size(), now.predictions.size());
  for (std::size_t i = 0; i < both; ++i) {
    ComparePredictions(fmt::format("place {}, ", i + 1), then.predictions[i], now.predictions[i],
                       &out);
  }
  out.Compare("recommended", then.recommended, now.recommended);
  out.Compare("why", then.why, now.why);
  out.CompareWhole("by_cost", then.by_cost, now.by_cost);
  out.CompareWhole("caveats", then.caveats, now.caveats);
  out.CompareWhole("depends_on", then.depends_on, now.depends_on);
  out.Compare("seed", then.seed, now.seed);
  out.Compare("simulated_seconds", then.simulated_seconds, now.simulated_seconds);
  out.Compare("probability_best", then.probability_best, now.probability_best);
  out.Compare("expected_regret", then.expected_regret, now.expected_regret);
  out.Compare("rollouts_to_settle", then.rollouts_to_settle, now.rollouts_to_settle);
  return out.Take();
}

std::string ActionNameOf(const hires::ImagineGoal& goal) {
  return goal.steps.empty() ? "no step" : goal.steps.front().name;
}

bool HasUnplayable(const ImagineResult& result) {
  for (const hires::Prediction& prediction : result.predictions) {
    for (const hires::FailureCount& failure : prediction.failures) {
      if (failure.failure.code == hires::Failure::UNPLAYABLE) return true;
    }
  }
  return false;
}

// ---------------------------------------------------------------- text and JSON

std::vector<std::string> TableRow(const char* when, const ImagineResult& result, std::size_t i) {
  const bool is_recommended = result.recommended == static_cast<std::int32_t>(i);
  std::vector<std::string> row{when, is_recommended ? ">" : "", fmt::format("{}", i + 1)};
  if (i >= result.predictions.size()) {
    row.push_back("(no such place)");
    return row;
  }
  const hires::Prediction& p = result.predictions[i];
  row.insert(row.end(),
             {TextOf(p.action), fmt::format("{:.1f} %", 100.0 * p.success_share),
              fmt::format("{:.3f}", p.confidence_mean), fmt::format("{:.2f} s", p.duration_mean),
              fmt::format("{}", p.falls), fmt::format("{}", p.rollouts)});
  return row;
}

std::string RankingsText(const ImagineResult& then, const ImagineResult& now) {
  const std::size_t places = std::max(then.predictions.size(), now.predictions.size());
  if (places == 0) return "";
  std::vector<std::vector<std::string>> rows{
      {"", "", "place", "action", "success", "confidence", "duration", "falls", "n"}};
  for (std::size_t i = 0; i < places; ++i) {
    rows.push_back(TableRow("then", then, i));
    rows.push_back(TableRow("now", now, i));
  }
  return reports::FormatTable(rows);
}

std::string VerdictText(const ReplayedRequest& replayed) {
  const ReplayComparison& comparison = replayed.comparison;
  const std::string walls =
      fmt::format("{:.2f} s then, {:.2f} s now", replayed.recorded.result.wall_seconds,
                  replayed.now.wall_seconds);
  if (comparison.identical) {
    return fmt::format("identical, bit by bit, but for the wall time ({})\n", walls);
  }
  std::string text =
      comparison.depended_on_moment
          ? fmt::format(
                "not identical, and not expected to be: the answer then was {}, which "
                "depends on the moment and not on the seed alone ({})\n",
                replayed.recorded.result.outcome == ImagineResult::ALL_FAILED
                    ? "all_failed before all rollouts were played"
                    : OutcomeText(replayed.recorded.result.outcome),
                walls)
          : fmt::format(
                "DIFFERS ({}): software, world, robot, configuration or the bag are not "
                "what they were\n",
                walls);
  for (const std::string& line : comparison.differences) text += "  " + line + '\n';
  return text;
}

ordered_json AnswerJson(const ImagineResult& result) {
  if (result.outcome == ImagineResult::INVALID) {
    return {{"outcome", "invalid"},
            {"recommended", nullptr},
            {"why", result.why},
            {"ranking", ordered_json::array()},
            {"seed", result.seed}};
  }
  return reports::ToJson(FromMsg(result));
}

// ---------------------------------------------------------------- the verb

struct ReplayOptions {
  std::string bag, json, action;
  std::vector<std::string> action_libraries;
  bool local{false}, requests{false};
  int threads{0};
  EpisodeReplay episode;
};

void AddOptions(CLI::App* app, ReplayOptions* o) {
  app->add_option("BAG", o->bag,
                  "of a robot episode (config/episode.yaml says which topics), or of requests: "
                  "`rosbag record /imagine/goal /imagine/result`")
      ->required();
  CLI::Option* local =
      app->add_flag("--local", o->local, "in this process, with the package's own scene");
  app->add_option("--threads", o->threads, "workers of --local; default: one per core")
      ->check(cli::NumberBetween(1, 256))
      ->needs(local);
  app->add_option("--actions", o->action_libraries,
                  "library with more actions (.so), for --local; nodes have ~action_libraries")
      ->allow_extra_args(false)
      ->needs(local);
  app->add_option("--json", o->json, "write the comparisons to this file as well");
  app->add_option("--topic", o->action,
                  "requests of this recorded action, e.g. /imagine; default: all");
  app->add_flag("--requests", o->requests,
                "the requests of imagination in the bag, though it is an episode's");
  app->add_option("--episode", o->episode.config,
                  "of an episode: what its topics are; default: config/episode.yaml");
  app->add_option("--names", o->episode.names,
                  "of an episode: what its robot calls topics and frames; default: a PR2's");
  app->add_option("--map-to-world", o->episode.map_to_world,
                  "of an episode: 'x y yaw scale' of its map in the world; default: they are one");
  app->add_option("--rollouts", o->episode.params.rollouts,
                  "of an episode: for each step; default: 64")
      ->check(cli::NumberBetween(1, 100000));
  app->add_option("--seed", o->episode.params.seed, "of an episode: of all chance; default: 1")
      ->check(hires::cli::WholeNumber());
}

int ThreadsOf(const ReplayOptions& options) {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return options.threads > 0 ? options.threads : cores;
}

/// A bar that is drawn over itself on a terminal; elsewhere a line now and then.
void ShowProgress(const imagination::Interim& interim) {
  if (isatty(STDERR_FILENO) == 0) {
    return hires::base::ReportProgress(
        "imagining again", static_cast<double>(interim.progress.done) /
                               std::max<double>(1.0, static_cast<double>(interim.progress.total)));
  }
  const bool is_done = interim.progress.done >= interim.progress.total;
  std::cerr << '\r' << (is_done ? "" : reports::ProgressLine(interim.progress)) << "\033[K"
            << std::flush;
}

ImagineAgain ChooseImagination(const ReplayOptions& options, const std::string& package_folder,
                               const std::function<bool()>& cancelled) {
  if (!options.local) {
    return [cancelled](ImagineGoal goal) {
      goal.play_afresh = true;  // what the client remembers proves nothing
      return AskImaginationClient(goal, ShowProgress, cancelled);
    };
  }
  return MakeLocalImagination(package_folder, options.action_libraries, ThreadsOf(options),
                              ShowProgress, cancelled);
}

std::string SummaryText(const std::vector<ReplayedRequest>& replayed) {
  const auto count = [&](auto holds) {
    return std::count_if(replayed.begin(), replayed.end(),
                         [&](const ReplayedRequest& r) { return holds(r.comparison); });
  };
  return fmt::format("{} requests: {} identical, {} differ, {} not comparable bit by bit\n",
                     replayed.size(), count([](const auto& c) { return c.identical; }),
                     count([](const auto& c) { return !c.identical && !c.depended_on_moment; }),
                     count([](const auto& c) { return !c.identical && c.depended_on_moment; }));
}

int ReplayRequests(const ReplayOptions& options, const std::string& package_folder) {
  const ImagineRecording recording = ReadImagineRecording(options.bag, options.action);
  if (recording.results_without_goal > 0) {
    std::cout << fmt::format(
        "{} results without a goal are left out: their goals were sent before "
        "the recording began\n\n",
        recording.results_without_goal);
  }
  for (const std::string& left_out : recording.left_out)
    std::cout << "left out: " << left_out << "\n\n";
  std::cout << std::flush;
  const std::function<bool()> cancelled = cli::IsInterrupted;
  const auto replayed =
      ReplayAll(recording.requests, ChooseImagination(options, package_folder, cancelled),
                cancelled, std::cout);
  std::cout << SummaryText(replayed);
  if (!options.json.empty()) {
    ordered_json json = ordered_json::array();
    for (const ReplayedRequest& request : replayed) json.push_back(ReplayJson(request));
    reports::WriteJson(json, options.json);
  }
  return cli::IsInterrupted() ? cli::kExitCancelled : ReplayExitCode(replayed);
}

int Replay(const ReplayOptions& options, const std::string& package_folder) {
  cli::CheckOutputs({{"--json", options.json}}, {{"bag", options.bag},
                                                 {"episode", options.episode.config},
                                                 {"names", options.episode.names}});
  EpisodeReplay episode = options.episode;
  episode.bag = options.bag;
  episode.json = options.json;
  episode.action_libraries = options.action_libraries;
  episode.is_local = options.local;
  episode.threads = ThreadsOf(options);
  if (episode.config.empty()) episode.config = package_folder + "/config/episode.yaml";
  const bool wants_requests = options.requests || !options.action.empty();
  const auto config = wants_requests ? std::nullopt : ConfigOfEpisode(episode);
  if (!config) return ReplayRequests(options, package_folder);
  return ReplayEpisode(episode, *config, package_folder, cli::IsInterrupted);
}

}  // namespace

bool DependsOnMoment(const ImagineGoal& goal, const ImagineResult& result) {
  switch (result.outcome) {
    case ImagineResult::CLOSE:
      return HasUnplayable(result) || !result.complete;
    case ImagineResult::RANKED:
    case ImagineResult::INVALID:
      return HasUnplayable(result);
    case ImagineResult::UNDECIDED:
      return HasUnplayable(result) ||
             (!result.predictions.empty() && result.predictions[0].rollouts < goal.rollouts);
    case ImagineResult::ALL_FAILED:
      // The outcome alone does not say whether it was the deadline or an early stop.
      return HasUnplayable(result) || (!goal.deadline.isZero() && !result.predictions.empty() &&
                                       result.predictions[0].rollouts < goal.rollouts);
    default:
      return true;
  }
}

ImagineGoal GoalToReplay(const RecordedRequest& recorded) {
  ImagineGoal goal = recorded.goal;
  const bool was_complete = recorded.result.outcome != ImagineResult::INVALID &&
                            !DependsOnMoment(recorded.goal, recorded.result);
  if (was_complete) goal.deadline = ros::Duration(0.0);
  return goal;
}

ReplayComparison CompareAnswers(const ImagineGoal& goal, const ImagineResult& then,
                                const ImagineResult& now) {
  ReplayComparison comparison;
  comparison.identical = SameBitsButWallTime(then, now);
  comparison.depended_on_moment = DependsOnMoment(goal, then);
  if (!comparison.identical) comparison.differences = DifferencesOf(then, now);
  return comparison;
}

std::string ReplayText(const ReplayedRequest& replayed) {
  const RecordedRequest& recorded = replayed.recorded;
  return fmt::format(
             "request '{}' ({}, goal id {}): {} of at most {} rollouts each, seed {}\n"
             "outcome: {} then, {} now\n",
             hires::base::Shortened(recorded.goal.request_id), recorded.action, recorded.goal_id,
             ActionNameOf(recorded.goal), recorded.goal.rollouts, recorded.goal.seed,
             OutcomeText(recorded.result.outcome), OutcomeText(replayed.now.outcome)) +
         RankingsText(recorded.result, replayed.now) + VerdictText(replayed);
}

ordered_json ReplayJson(const ReplayedRequest& replayed) {
  const RecordedRequest& recorded = replayed.recorded;
  return {{"request_id", recorded.goal.request_id},
          {"action", recorded.action},
          {"goal_id", recorded.goal_id},
          {"outcome_then", OutcomeText(recorded.result.outcome)},
          {"outcome_now", OutcomeText(replayed.now.outcome)},
          {"identical", replayed.comparison.identical},
          {"depended_on_moment", replayed.comparison.depended_on_moment},
          {"differences", replayed.comparison.differences},
          {"then", AnswerJson(recorded.result)},
          {"now", AnswerJson(replayed.now)}};
}

std::vector<ReplayedRequest> ReplayAll(const std::vector<RecordedRequest>& requests,
                                       const ImagineAgain& imagine_again,
                                       const std::function<bool()>& cancelled, std::ostream& out) {
  std::vector<ReplayedRequest> replayed;
  for (const RecordedRequest& recorded : requests) {
    ReplayedRequest request{recorded, imagine_again(GoalToReplay(recorded)), {}};
    if (cancelled()) break;
    request.comparison = CompareAnswers(recorded.goal, recorded.result, request.now);
    out << ReplayText(request) << '\n' << std::flush;
    replayed.push_back(std::move(request));
  }
  return replayed;
}

int ReplayExitCode(const std::vector<ReplayedRequest>& replayed) {
  const bool differs =
      std::any_of(replayed.begin(), replayed.end(), [](const ReplayedRequest& request) {
        return !request.comparison.identical && !request.comparison.depended_on_moment;
      });
  return differs ? kExitDiffers : cli::kExitRecommended;
}

ImagineAgain MakeLocalImagination(const std::string& package_folder,
                                  const std::vector<std::string>& action_libraries, int num_threads,
                                  const imagination::OnInterim& on_interim,
                                  const std::function<bool()>& cancelled) {
  return [=, loaded = std::shared_ptr<const imagination::LocalSetup>()](
             const ImagineGoal& goal) mutable {
    if (!loaded) {
      loaded = std::make_shared<const imagination::LocalSetup>(imagination::LoadLocalSetup(
          package_folder + "/config/imagination_client.yaml", action_libraries));
    }
    std::optional<ImagineRequest> request;
    try {
      request = RequestOf(goal, loaded->setup, loaded->config.scheduler);
    } catch (const hires::base::ConfigError& error) {
      return RefusalOf(goal, error.what());
    }
    imagination::Report report = imagination::ImagineLocally(
        request->setup, request->actions, request->params, num_threads, on_interim, cancelled);
    imagination::AddCaveats(request->setup, request->actions, loaded->config.validated, &report);
    return AnswerTo(goal, *request, loaded->setup, report);
  };
}

int RunReplay(const std::vector<std::string>& arguments, const std::string& package_folder) {
  CLI::App app(
      "imagine the steps of a recorded robot episode, or recorded requests again, and compare",
      "hires replay");
  ReplayOptions options;
  AddOptions(&app, &options);
  app.footer(
      "exit codes: 0 an episode was compared, or all requests are answered identically, 2 an "
      "answer differs, 1 bad input; answers that ended at a deadline are compared, but may differ");
  try {
    // CLI11 takes its arguments from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : cli::kExitBadInput;
  }
  return Replay(options, package_folder);
}

}  // namespace hires_ros
