#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lab/src/series/scenario_variant.h"

namespace hires::lab {

/// The verb of `hires` that plays one run through the graph of nodes:
/// `hires scenario_run ORDER.json RESULT.json FIRST_PORT`.
constexpr char kScenarioRunVerb[] = "scenario_run";

/// How runs of a series are played.
struct ScenarioPlayer {
  std::string program;       ///< empty: `hires`, or this one for a graph
  bool is_graph{false};      ///< through the graph of nodes; else by `hires achieve --local`
  int threads{2};            ///< that play rollouts, where it is no graph
  int workers{1};            ///< simulators that imagine, of a graph
  double pace{1.0};          ///< of a graph: simulated seconds per second
  double hang_after{300.0};  ///< [s] without progress, after which a run hangs
  double time_limit{900.0};  ///< [s] simulated, of a graph
};

/// One run that is to be played, in a folder of its own.
struct ScenarioOrder {
  VariantFiles files;
  std::string task, truth, folder;
  std::uint64_t seed{1};
};

// What a run leaves in its folder.
std::string ResultOf(const ScenarioOrder& order);
std::string StoreOf(const ScenarioOrder& order);

/// What the process is told that plays a run through the graph of nodes.
struct GraphOrder {
  ScenarioOrder run;
  int workers{1};
  double pace{1.0};
  double time_limit{900.0};  ///< [s] simulated
};
std::string GraphOrderText(const GraphOrder& order);
/// @throws base::ConfigError naming `where` and the field.
GraphOrder ParseGraphOrder(const std::string& text, const std::string& where);

/// What of the program's words somebody types to play the run again by hand; nothing of a graph.
std::vector<std::string> AchieveWords(const ScenarioOrder& order, int threads);

/// How a process that plays a run ended.
struct TryEnd {
  bool is_cancelled{false};
  std::string broken;  ///< "signal 9 (Killed)", ...; empty: the result is there
};

/// Plays the run in a process of its own, which dies with this one, and takes all with it that it
/// started. A process without a result, or one whose outputs stand still for too long, is broken.
/// Call it from main().  @throws base::ConfigError if no process can be started.
TryEnd PlayTry(const ScenarioOrder& order, const ScenarioPlayer& player,
               const std::function<bool()>& cancelled);

}  // namespace hires::lab
