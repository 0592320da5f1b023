#pragma once

#include <hires/ImagineGoal.h>
#include <hires/ImagineResult.h>

#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hires/imagination/report.h"
#include "nodes/hires/imagine_recording.h"

namespace hires_ros {

/// Exit code of `hires replay` when an answer that should repeat itself did not.
constexpr int kExitDiffers = 2;

/// Whether an answer rests on more than software, world and seed: it ended at its deadline, was
/// cancelled, there was no worker, or rollouts took their workers down. Such an answer need not
/// repeat itself.
bool DependsOnMoment(const hires::ImagineGoal& goal, const hires::ImagineResult& result);

/// The goal as it is imagined again. Where the answer was complete then, the deadline played no
/// part in it, so it is left out: a busier machine must not change the verdict.
hires::ImagineGoal GoalToReplay(const RecordedRequest& recorded);

/// What was predicted then, against what is predicted now.
struct ReplayComparison {
  bool identical{false};                 ///< every bit but the wall time
  bool depended_on_moment{false};        ///< then; no difference is expected to mean anything
  std::vector<std::string> differences;  ///< for people, with all digits; empty if identical
};
ReplayComparison CompareAnswers(const hires::ImagineGoal& goal, const hires::ImagineResult& then,
                                const hires::ImagineResult& now);

/// One request imagined again.
struct ReplayedRequest {
  RecordedRequest recorded;
  hires::ImagineResult now;
  ReplayComparison comparison;
};

/// For people: then and now in one table, the verdict below.
std::string ReplayText(const ReplayedRequest& replayed);

/// For machines: request_id, action, goal_id, outcome_then, outcome_now, identical,
/// depended_on_moment, differences, then and now (as `hires imagine --json`).
nlohmann::ordered_json ReplayJson(const ReplayedRequest& replayed);

/// Imagines one goal, or throws hires::base::ConfigError if there is no client to ask.
using ImagineAgain = std::function<hires::ImagineResult(const hires::ImagineGoal&)>;

/// Imagines all requests again, and prints each comparison as soon as it is there.
/// @param cancelled  asked after each request; the request that was cut short is left out.
std::vector<ReplayedRequest> ReplayAll(const std::vector<RecordedRequest>& requests,
                                       const ImagineAgain& imagine_again,
                                       const std::function<bool()>& cancelled, std::ostream& out);

/// 0 if all answers that should repeat themselves did, else kExitDiffers.
int ReplayExitCode(const std::vector<ReplayedRequest>& replayed);

/// Imagines in this process with the package's own scene; loads it at the first call.
ImagineAgain MakeLocalImagination(const std::string& package_folder,
                                  const std::vector<std::string>& action_libraries, int num_threads,
                                  const hires::imagination::OnInterim& on_interim,
                                  const std::function<bool()>& cancelled);

/// The verb `hires replay BAG`, of an episode (see episode_replay.h) or of requests: `[--requests]
/// [--local] [--actions FILE] [--threads N] [--json FILE]
/// [--topic NAME]`.
/// @param arguments  without the program's and the verb's name.
/// @return The exit code: as ReplayExitCode, 1 for wrong arguments, 130 when interrupted.
/// @throws hires::base::ConfigError for a bad bag, and if there is no client to ask.
int RunReplay(const std::vector<std::string>& arguments, const std::string& package_folder);

}  // namespace hires_ros
