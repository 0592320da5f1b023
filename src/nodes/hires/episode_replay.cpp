#include "nodes/hires/episode_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/exit_code.h"
#include "hires/base/error.h"
#include "hires/base/progress.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/imagination/local_setup.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/world/world_messages.h"
#include "nodes/hires/bag_file.h"
#include "nodes/hires/episode_recording.h"
#include "nodes/hires/imagine_recording.h"
#include "nodes/hires/remote_imagination.h"
#include "reports/text/report_json.h"

namespace hires_ros {
namespace {

namespace cli = hires::cli;
namespace reports = hires::reports;
namespace imagination = hires::imagination;
using hires::base::ConfigError;
using imagination::ImaginationSetup;
using nlohmann::ordered_json;
using reports::ComparedStep;
using reports::Episode;
using reports::EpisodeConfig;
using reports::EpisodeStep;
using reports::ImaginedAction;

/// Nothing when it was cancelled.
using Imagine =
    std::function<std::optional<ImaginedAction>(const EpisodeStep& step, std::uint64_t place)>;

EpisodeConfig ConfigOf(const EpisodeReplay& replay) {
  EpisodeConfig config = reports::ReadEpisodeConfig(replay.config, replay.names);
  config.names.map_to_world =
      hires::geometry::ParseMapToWorld(replay.map_to_world, "--map-to-world");
  return config;
}

// ---------------------------------------------------------------- imagining

hires::ImagineGoal GoalOf(const EpisodeStep& step, const ImaginationSetup& setup,
                          const reports::ReplayParams& params, std::uint64_t place) {
  hires::base::ActionTemplate action{step.action.name, {}};
  for (const std::string& argument : step.action.arguments) {
    action.alternatives.push_back({argument});
  }
  hires::ImagineGoal goal;
  goal.steps.push_back(ToMsg(action));
  goal.world_state = ToMsg(step.start.world);
  goal.world_state.header.frame_id = "map";
  goal.world_state.world_hash = setup.world_hash;
  goal.robot_state = ToMsg(step.start.robot);
  goal.rollouts = static_cast<std::uint32_t>(params.rollouts);
  goal.seed = params.seed + place;
  goal.play_all = true;
  goal.request_id = fmt::format("replay_step_{}", place);
  return goal;
}

std::optional<ImaginedAction> AskFor(const EpisodeStep& step, const hires::ImagineGoal& goal,
                                     const imagination::OnInterim& on_interim,
                                     const std::function<bool()>& cancelled) {
  ImaginedAction imagined;
  if (step.goal) {
    imagined.refusal =
        "it ended at no area that the world has, so that an imagination client cannot be asked; "
        "--local can";
    return imagined;
  }
  const hires::ImagineResult result = AskImaginationClient(goal, on_interim, cancelled);
  if (result.outcome == hires::ImagineResult::CANCELLED) return std::nullopt;
  if (result.predictions.empty()) {
    imagined.refusal = result.why;
    return imagined;
  }
  imagined.evidence = FromMsg(result.predictions.front()).evidence;
  return imagined;
}

/// @param done  steps, with the share of the one that is imagined.
void ReportSteps(double done, std::size_t all) {
  hires::base::ReportProgress(fmt::format("imagining {} again", hires::base::Counted(all, "step")),
                              done / std::max<double>(1.0, static_cast<double>(all)));
}

Imagine WayOf(const EpisodeReplay& replay, const ImaginationSetup& setup,
              const std::vector<EpisodeStep>& steps, const std::function<bool()>& cancelled) {
  if (replay.is_local) {
    return [=, all = steps.size(), with_goals = reports::WithGoals(setup, steps)](
               const EpisodeStep& step, std::uint64_t place) {
      const hires::base::Crew crew{replay.threads, cancelled, [&](double share, double) {
                                     ReportSteps(static_cast<double>(place) + share, all);
                                   }};
      return reports::ImagineStep(with_goals, step, replay.params, place, crew);
    };
  }
  return [=, all = steps.size()](const EpisodeStep& step, std::uint64_t place) {
    const auto on_interim = [&](const imagination::Interim& interim) {
      const double rollouts = std::max(1.0, static_cast<double>(interim.progress.total));
      ReportSteps(static_cast<double>(place) + interim.progress.done / rollouts, all);
    };
    return AskFor(step, GoalOf(step, setup, replay.params, place), on_interim, cancelled);
  };
}

/// Nothing when it was cancelled.
std::optional<std::vector<ComparedStep>> CompareAll(const std::vector<EpisodeStep>& steps,
                                                    const Imagine& imagine, double surprise) {
  std::vector<ComparedStep> compared;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ReportSteps(static_cast<double>(i), steps.size());
    std::optional<ImaginedAction> imagined = ImaginedAction();
    if (steps[i].why_not.empty()) imagined = imagine(steps[i], i);
    if (!imagined) return std::nullopt;
    compared.push_back(reports::CompareStep(steps[i], *imagined, surprise));
  }
  ReportSteps(static_cast<double>(steps.size()), steps.size());
  return compared;
}

// ---------------------------------------------------------------- what the bag says

void PrintNotes(const EpisodeRecording& recording) {
  const std::string advice = recording.topics.Advice();
  if (!advice.empty()) std::cout << advice;
  for (const auto& [what, count] : recording.dropped) {
    std::cout << fmt::format("left out {}: {}\n", hires::base::Counted(count, "time"), what);
  }
}

void PrintUntoldJoints(const std::vector<std::string>& joints) {
  if (joints.empty()) return;
  std::cout << fmt::format(
      "joint states never told of {} of arms and torso ({}): imagined as in the driving posture; "
      "if the robot told of them elsewhere, say by --names on which topic\n",
      hires::base::Counted(joints.size(), "joint"), hires::base::Join(joints, ", "));
}

bool HasSamples(const EpisodeRecording& recording) {
  for (const Episode& episode : recording.episodes) {
    if (!episode.samples.empty()) return true;
  }
  return false;
}

std::string ListOfDropped(const EpisodeRecording& recording) {
  std::string text;
  for (const auto& [what, count] : recording.dropped) {
    text += fmt::format("\n  {} times: {}", count, what);
  }
  return text.empty() ? "" : "; left out was" + text;
}

void RequireState(const EpisodeReplay& replay, const EpisodeRecording& recording) {
  if (HasSamples(recording)) return;
  throw ConfigError(fmt::format(
      "{}: where the robot was is never known: {} did not come{}; record it too, or say by --names "
      "what this robot calls its topics and frames",
      replay.bag, recording.missing.empty() ? "a moment with all of it" : recording.missing,
      ListOfDropped(recording)));
}

[[noreturn]] void FailWithoutSteps(const EpisodeReplay& replay) {
  throw ConfigError(fmt::format(
      "{}: nobody asked for an action in it, and the robot moved by nothing that could be "
      "one; record while it works",
      replay.bag));
}

ordered_json ReplayedJson(const EpisodeReplay& replay, const EpisodeRecording& recording) {
  ordered_json json{{"bag", replay.bag},
                    {"imagined_by", replay.is_local ? "this process" : "imagination client"},
                    {"rollouts", replay.params.rollouts},
                    {"seed", replay.params.seed},
                    {"dropped", recording.dropped},
                    {"untold_joints", recording.untold_joints},
                    {"episodes", ordered_json::array()}};
  return json;
}

}  // namespace

std::optional<EpisodeConfig> ConfigOfEpisode(const EpisodeReplay& replay) {
  EpisodeConfig config = ConfigOf(replay);
  const std::vector<BagTopic> topics = TopicsOfBagFile(replay.bag);
  const reports::TopicCheck check = CheckTopics(config, {topics.begin(), topics.end()});
  if (check.is_usable()) return config;
  if (HasImagineGoals(topics)) return std::nullopt;
  throw ConfigError(
      fmt::format("{}: is no robot episode, and holds no goals of an `imagine` action: "
                  "{}{}",
                  replay.bag, check.Advice(), ListOfTopics(topics)));
}

int ReplayEpisode(const EpisodeReplay& replay, const EpisodeConfig& config,
                  const std::string& package_folder, const std::function<bool()>& cancelled) {
  const ImaginationSetup setup =
      imagination::LoadLocalSetup(package_folder + "/config/imagination_client.yaml",
                                  replay.action_libraries)
          .setup;
  const EpisodeRecording recording = ReadEpisodeRecording(replay.bag, config, setup);
  RequireState(replay, recording);
  PrintNotes(recording);
  PrintUntoldJoints(recording.untold_joints);
  ordered_json json = ReplayedJson(replay, recording);
  for (const Episode& episode : recording.episodes) {
    const std::vector<EpisodeStep> steps = reports::StepsOf(episode, setup, config);
    if (steps.empty()) continue;
    const auto compared =
        CompareAll(steps, WayOf(replay, setup, steps, cancelled), config.surprise);
    if (!compared) return cli::kExitCancelled;
    std::cout << reports::EpisodeTable(*compared) << '\n'
              << reports::EpisodeSummary(*compared) << std::flush;
    json["episodes"].push_back(reports::EpisodeJson(*compared));
  }
  if (json["episodes"].empty()) FailWithoutSteps(replay);
  if (!replay.json.empty()) reports::WriteJson(json, replay.json);
  return cli::kExitRecommended;
}

}  // namespace hires_ros
