#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/evaluation/report_json.h"
#include "hires/evaluation/timeline.h"

extern char** environ;

namespace hires::evaluation {
namespace {

using nlohmann::ordered_json;

/// What is not there is null, and so is what JSON does not know: infinity, "not a number".
ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : nullptr;
}
ordered_json NumberOrNull(const std::optional<double>& value) {
  return value ? NumberOrNull(*value) : ordered_json(nullptr);
}

ordered_json StepToJson(const execution::StepStatus& step) {
  return {{"plan", step.plan},
          {"index", step.index},
          {"action", step.action.name},
          {"arguments", step.action.arguments},
          {"phase", ToString(step.phase)},
          {"started", NumberOrNull(step.started)},
          {"finished", NumberOrNull(step.finished)},
          {"earliest_start", NumberOrNull(step.start.earliest)},
          {"latest_start", NumberOrNull(step.start.latest)},
          {"earliest_finish", NumberOrNull(step.finish.earliest)},
          {"latest_finish", NumberOrNull(step.finish.latest)},
          {"expected_start", NumberOrNull(step.expected_start)},
          {"expected_finish", NumberOrNull(step.expected_finish)},
          {"note", step.note},
          {"failure", ToJson(step.failure)}};
}

ordered_json PredictionToJson(const imagination::Prediction& prediction) {
  const imagination::Evidence& evidence = prediction.evidence;
  return {{"action", prediction.action.name},
          {"arguments", prediction.action.arguments},
          {"rollouts", evidence.num_rollouts},
          {"success", evidence.success.share},
          {"success_lower", evidence.success.lower},
          {"success_upper", evidence.success.upper},
          {"confidence_mean", evidence.confidence_mean},
          {"confidence_pooled", evidence.confidence_pooled},
          {"falls", evidence.falls},
          {"duration_mean", evidence.duration.mean},
          {"duration_sd", evidence.duration.sd},
          {"failures", FailuresToJson(evidence.failures)}};
}

ordered_json ImaginedToJson(const ImaginedStep& step) {
  ordered_json predictions = ordered_json::array();
  for (const auto& prediction : step.predictions) {
    predictions.push_back(PredictionToJson(prediction));
  }
  return {{"plan", step.plan},
          {"step", step.step},
          {"action", step.action.name},
          {"alternatives", step.action.alternatives},
          {"requested", step.requested},
          {"answered", NumberOrNull(step.answered)},
          {"dispatch", NumberOrNull(step.dispatch)},
          {"deadline", NumberOrNull(step.deadline)},
          {"wall_seconds", step.wall_seconds},
          {"simulated_seconds", step.simulated_seconds},
          {"outcome", ToString(step.outcome)},
          {"recommended", step.recommended},
          {"predictions", predictions},
          {"why", step.why}};
}

/// An open file for the output of a program, gone with this object.
class Output {
 public:
  Output() : file_(std::tmpfile()) {
    if (file_ == nullptr) {
      throw base::ConfigError(fmt::format("cannot make a temporary file: {}", strerror(errno)));
    }
  }
  ~Output() { std::fclose(file_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  int descriptor() const { return fileno(file_); }
  std::string Read() {
    std::string text(4096, '\0');
    std::rewind(file_);
    text.resize(std::fread(text.data(), 1, text.size(), file_));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }

 private:
  std::FILE* file_;
};

/// Exit code; -1 where it could not be started or was killed.
int RunProgram(std::vector<std::string> words, const Output& output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDERR_FILENO);
  pid_t pid = 0;
  const int failed = posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return -1;
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

ordered_json ToJson(const AchieveReport& report) {
  ordered_json steps = ordered_json::array(), imaginations = ordered_json::array();
  for (const auto& step : report.status.steps) steps.push_back(StepToJson(step));
  for (const auto& step : report.status.imaginations) imaginations.push_back(ImaginedToJson(step));
  return {{"task", report.task},
          {"outcome", ToString(report.outcome)},
          {"reason", report.reason},
          {"failure", ToJson(report.failure)},
          {"episode", report.episode},
          {"replans", report.status.replans},
          {"duration", MakeTimeline(report).duration},
          {"begin", BeginOf(report.status)},
          {"steps", steps},
          {"imaginations", imaginations},
          {"warnings", report.status.warnings}};
}

void WriteText(const std::string& text, const std::string& path) {
  const std::string unfinished = path + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(unfinished, path, error);
  if (file && !error) return;
  std::filesystem::remove(unfinished, error);
  throw base::ConfigError(
      fmt::format("{}: cannot be written; check folder, rights and space", path));
}

void DrawTimeline(const std::string& script, const std::string& csv, const std::string& png) {
  Output output;
  // Debian's own Python: that is where its matplotlib is.
  const int code = RunProgram({"/usr/bin/python3", script, csv, png}, output);
  if (code == 0) return;
  throw base::ConfigError(fmt::format("{}: not drawn from {}: {}", png, csv,
                                      code < 0 ? "/usr/bin/python3 cannot be run" : output.Read()));
}

}  // namespace hires::evaluation
