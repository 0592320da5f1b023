#include "lab/src/experiment/hypothesis_play.h"

#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "reports/task/timeline.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using base::ConfigError;
using nlohmann::ordered_json;

constexpr double kStopGrace = 60.0;   // [s] for a run to end its system
constexpr double kExtraTime = 180.0;  // [s] beyond its limit, after which a run hangs
constexpr useconds_t kPoll = 50000;   // [us]

/// How long the process may live: the run watches its own limit, and stops the robot first.
double DeadlineOf(const HypothesisOrder& order) {
  return base::SteadyNow() + order.goal.wall_limit + kExtraTime;
}

enum class Ending { kDone, kCancelled, kHung };

Ending Await(base::ChildProcess* process, double deadline, const std::function<bool()>& cancelled) {
  while (!process->Ended()) {
    const bool is_cancelled = cancelled();
    if (is_cancelled || base::SteadyNow() > deadline) {
      process->Terminate(kStopGrace);
      return is_cancelled ? Ending::kCancelled : Ending::kHung;
    }
    usleep(kPoll);
  }
  return Ending::kDone;
}

HypothesisRun Broken(const std::string& outcome, const std::string& reason) {
  HypothesisRun run;
  run.outcome = outcome;
  run.reason = reason;
  return run;
}

HypothesisRun ReadRecord(const std::string& path, const std::string& how_it_ended,
                                     const std::string& log) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return Broken("run_died", fmt::format("{}: {}", how_it_ended, base::LastLineOf(log)));
  }
  const ordered_json json = ordered_json::parse(base::ReadTextFile(path), nullptr, false);
  return ParseHypothesisRun(json, path);
}

template <typename T>
void TakeField(const ordered_json& json, const char* key, const std::string& where, T* value) {
  try {
    *value = json.at(key).get<T>();
  } catch (const ordered_json::exception& error) {
    throw ConfigError(fmt::format("{}: field '{}': {}", where, key, error.what()));
  }
}

template <typename Order, typename Visitor>
void VisitOrder(Order* order, const Visitor& visit) {
  visit("scenario", &order->scenario);
  visit("run", &order->run);
  visit("imagination", &order->imagines);
  visit("seed", &order->seed);
  visit("pace", &order->pace);
  visit("workers", &order->workers);
  visit("objects", &order->goal.objects);
  visit("areas", &order->goal.areas);
  visit("time_limit", &order->goal.time_limit);
  visit("start_limit", &order->goal.start_limit);
  visit("wall_limit", &order->goal.wall_limit);
  visit("folder", &order->folder);
}

}  // namespace

std::string HypothesisOrderText(const HypothesisOrder& order) {
  ordered_json json;
  VisitOrder(&order, [&](const char* key, const auto* value) { json[key] = *value; });
  return json.dump(2) + '\n';
}

HypothesisOrder ParseHypothesisOrder(const std::string& text,
                                                 const std::string& where) {
  const ordered_json json = ordered_json::parse(text, nullptr, false);
  HypothesisOrder order;
  VisitOrder(&order, [&](const char* key, auto* value) { TakeField(json, key, where, value); });
  return order;
}

std::optional<HypothesisRun> PlayHypothesisRun(
    const HypothesisOrder& wanted, const std::function<bool()>& cancelled) {
  base::AdoptOrphans();
  const base::RunFolder folder(wanted.folder);
  const base::PortClaim ports(wanted.workers + 1);
  HypothesisOrder order = wanted;
  order.folder = folder.path();
  const std::string order_path = order.folder + "/order.json";
  const std::string record_path = order.folder + "/record.json";
  const std::string log_path = order.folder + "/run.log";
  base::ReplaceTextFile(order_path, HypothesisOrderText(order));
  fs::remove(record_path);
  base::ProcessOptions options;
  options.command = {fs::read_symlink("/proc/self/exe").string(), kHypothesisRunVerb, order_path,
                     record_path, std::to_string(ports.first())};
  options.output = log_path;
  Ending ending = Ending::kDone;
  std::string how_it_ended;
  {
    base::ChildProcess process(options);
    ending = Await(&process, DeadlineOf(order), cancelled);
    how_it_ended = process.Ended().value_or("killed");
  }
  base::KillDescendants();
  if (ending == Ending::kCancelled) return std::nullopt;
  if (ending == Ending::kHung) return Broken("hung", "it did not end at its limit: killed");
  return ReadRecord(record_path, how_it_ended, log_path);
}

}  // namespace hires::lab
