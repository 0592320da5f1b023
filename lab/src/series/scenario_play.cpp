#include "lab/src/series/scenario_play.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "lab/src/product_program.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr useconds_t kTryPoll = 20000;    // [us]
constexpr double kTryGrace = 5.0;         // [s] for a process to end that is told to
constexpr double kGraphTryGrace = 60.0;   // [s] likewise, for a whole graph
constexpr std::size_t kMostOfLine = 200;  // characters of a message

template <typename Order, typename Visitor>
void VisitGraphOrder(Order* order, const Visitor& visit) {
  visit("scenario", &order->run.files.scenario);
  visit("world", &order->run.files.world);
  visit("knowledge", &order->run.files.knowledge);
  visit("task", &order->run.task);
  visit("truth", &order->run.truth);
  visit("seed", &order->run.seed);
  visit("folder", &order->run.folder);
  visit("workers", &order->workers);
  visit("pace", &order->pace);
  visit("time_limit", &order->time_limit);
}

std::string LogOf(const ScenarioOrder& order) { return order.folder + "/run.log"; }

/// Bytes that all processes of the run have said so far.
std::uintmax_t SaidBytes(const std::string& folder) {
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".log") bytes += entry.file_size(error);
  }
  return bytes;
}

/// Whether a process that goes on has said something lately.
class Watch {
 public:
  Watch(const ScenarioOrder& order, const ScenarioPlayer& player)
      : folder_(order.folder), limit_(player.hang_after), last_(base::SteadyNow()) {}

  bool Hangs() {
    const std::uintmax_t bytes = SaidBytes(folder_);
    const double now = base::SteadyNow();
    if (bytes != bytes_) last_ = now;
    bytes_ = bytes;
    return now - last_ > limit_;
  }

 private:
  const std::string& folder_;
  const double limit_;
  double last_;
  std::uintmax_t bytes_{0};
};

bool HasResult(const std::string& how_it_ended, const ScenarioOrder& order) {
  std::error_code error;
  return how_it_ended.rfind("exit code ", 0) == 0 && fs::exists(ResultOf(order), error);
}

std::string SaidText(const ScenarioOrder& order) {
  const std::string line = base::LastLineOf(LogOf(order));
  if (line.size() > kMostOfLine) return ": " + line.substr(0, kMostOfLine) + "...";
  return line.empty() ? "" : ": " + line;
}

TryEnd Await(base::ChildProcess* process, const ScenarioOrder& order, const ScenarioPlayer& player,
             const std::function<bool()>& cancelled) {
  Watch watch(order, player);
  while (!process->Ended()) {
    if (cancelled()) {
      process->Terminate(player.is_graph ? kGraphTryGrace : kTryGrace);
      return {true, ""};
    }
    if (watch.Hangs()) {
      if (player.is_graph) process->Terminate(kGraphTryGrace);
      return {false,
              fmt::format("hung: no progress for {:g} s{}", player.hang_after, SaidText(order))};
    }
    usleep(kTryPoll);
  }
  const std::string how = *process->Ended();
  return {false, HasResult(how, order) ? "" : how + SaidText(order)};
}

std::vector<std::string> CommandOf(const ScenarioOrder& order, const ScenarioPlayer& player,
                                   const std::optional<base::PortClaim>& ports) {
  const std::string own = fs::read_symlink("/proc/self/exe").string();
  const std::string program = player.is_graph ? own : ProductProgram();
  std::vector<std::string> command{player.program.empty() ? program : player.program};
  if (!ports) {
    const std::vector<std::string> words = AchieveWords(order, player.threads);
    command.insert(command.end(), words.begin(), words.end());
    return command;
  }
  const std::string file = order.folder + "/order.json";
  base::ReplaceTextFile(file,
                        GraphOrderText({order, player.workers, player.pace, player.time_limit}));
  command.insert(command.end(),
                 {kScenarioRunVerb, file, ResultOf(order), std::to_string(ports->first())});
  return command;
}

void RemoveOldTry(const ScenarioOrder& order) {
  std::error_code ignored;
  fs::remove(ResultOf(order), ignored);
  for (const char* ending : {"", "-wal", "-shm"}) fs::remove(StoreOf(order) + ending, ignored);
}

}  // namespace

std::string ResultOf(const ScenarioOrder& order) { return order.folder + "/result.json"; }
std::string StoreOf(const ScenarioOrder& order) { return order.folder + "/blackboard.db"; }

std::string GraphOrderText(const GraphOrder& order) {
  ordered_json json;
  VisitGraphOrder(&order, [&](const char* key, const auto* value) { json[key] = *value; });
  return json.dump(2) + '\n';
}

GraphOrder ParseGraphOrder(const std::string& text, const std::string& where) {
  const ordered_json json = ordered_json::parse(text, nullptr, false);
  GraphOrder order;
  VisitGraphOrder(&order, [&](const char* key, auto* value) {
    try {
      *value = json.at(key).get<std::decay_t<decltype(*value)>>();
    } catch (const ordered_json::exception& error) {
      throw base::ConfigError(fmt::format("{}: field '{}': {}", where, key, error.what()));
    }
  });
  return order;
}

std::vector<std::string> AchieveWords(const ScenarioOrder& order, int threads) {
  return {"achieve",    "--local",
          "--scenario", order.files.scenario,
          "--world",    order.files.world,
          "--truth",    order.truth,
          "--seed",     std::to_string(order.seed),
          "--threads",  std::to_string(threads),
          "--store",    StoreOf(order),
          "--json",     ResultOf(order)};
}

TryEnd PlayTry(const ScenarioOrder& order, const ScenarioPlayer& player,
               const std::function<bool()>& cancelled) {
  RemoveOldTry(order);
  base::AdoptOrphans();
  std::optional<base::PortClaim> ports;
  if (player.is_graph) ports.emplace(player.workers + 1);
  base::ProcessOptions options;
  options.command = CommandOf(order, player, ports);
  options.output = LogOf(order);
  TryEnd end;
  {
    base::ChildProcess process(options);
    end = Await(&process, order, player, cancelled);
  }
  base::KillDescendants();
  return end;
}

}  // namespace hires::lab
