#include "cli/report_output.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "reports/text/report_json.h"

extern char** environ;

namespace hires::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Debian's own: that is where its packages are.
constexpr char kPython[] = "/usr/bin/python3";
constexpr char kProgram[] = "/scripts/report";

/// An open file without a name, gone with this object.
class UnnamedFile {
 public:
  explicit UnnamedFile(const std::string& text = "") : file_(std::tmpfile()) {
    const bool is_written = file_ != nullptr &&
                            std::fwrite(text.data(), 1, text.size(), file_) == text.size() &&
                            std::fflush(file_) == 0;
    if (is_written) {
      std::rewind(file_);
      return;
    }
    const int why = errno;
    if (file_ != nullptr) std::fclose(file_);
    throw base::ConfigError(
        fmt::format("cannot make a temporary file: {}; make room in /tmp", strerror(why)));
  }
  ~UnnamedFile() { std::fclose(file_); }
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;

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
int RunProgram(std::vector<std::string> words, const UnnamedFile& input,
               const UnnamedFile& output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.descriptor(), STDIN_FILENO);
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

/// Files of the package by their place in it, so that equal answers look the same on any computer.
std::string ShownPath(const std::string& path, const std::string& package_folder) {
  const fs::path whole = fs::weakly_canonical(path);
  const fs::path below = whole.lexically_relative(fs::weakly_canonical(package_folder));
  const bool is_below = !below.empty() && *below.begin() != "..";
  return is_below ? below.string() : path;
}

ordered_json InputsJson(const std::vector<ReportInput>& inputs, const std::string& package_folder) {
  ordered_json list = ordered_json::array();
  for (const ReportInput& input : inputs) {
    if (input.path.empty()) continue;
    list.push_back({{"what", input.what},
                    {"path", ShownPath(input.path, package_folder)},
                    {"hash", input.hash}});
  }
  return list;
}

ordered_json HeadJson(const ReportOptions& options, const ReportOrigin& origin) {
  return {{"format", kReportFormat},  {"verb", origin.verb},
          {"version", HIRES_VERSION}, {"command", options.command},
          {"local", origin.is_local}, {"inputs", InputsJson(origin.inputs, options.package_folder)},
          {"hashes", origin.hashes}};
}

/// What is wanted of the JSON file, of standard input where it is "-".
void MakePictures(const std::string& file, const std::string& html, const std::string& png,
                  const std::string& package_folder, const std::string& input = "") {
  std::vector<std::string> arguments{file};
  if (!html.empty()) arguments.insert(arguments.end(), {"--html", html});
  if (!png.empty()) arguments.insert(arguments.end(), {"--png", png});
  if (arguments.size() > 1) RunReportProgram(package_folder, arguments, input);
}

}  // namespace

ReportInput::ReportInput(std::string what, std::string path)
    : what(std::move(what)), path(std::move(path)) {
  if (this->path.empty()) return;
  base::Hasher hasher;
  hasher.Add(base::ReadTextFile(this->path));
  hash = base::HexOf(hasher.value());
}

bool IsWanted(const ReportOptions& options) {
  return !(options.json + options.html + options.png).empty();
}

void AddReportOptions(CLI::App* verb, ReportOptions* options) {
  verb->add_option("--json", options->json, "write everything to this file, for machines");
  verb->add_option("--html", options->html,
                   "write one page to this file that shows everything and needs no network");
}

void CheckReport(const ReportOptions& options, const std::vector<VerbFile>& inputs,
                 std::vector<VerbFile> more_outputs) {
  more_outputs.push_back({"--json", options.json});
  more_outputs.push_back({"--html", options.html});
  more_outputs.push_back({"--png", options.png});
  CheckOutputs(more_outputs, inputs);
  if (!(options.html + options.png).empty()) {
    RunReportProgram(options.package_folder, {"--check"});
  }
}

void WriteReport(const ReportOptions& options, const ReportOrigin& origin,
                 const ordered_json& answer) {
  if (!IsWanted(options)) return;
  ordered_json report{{"report", HeadJson(options, origin)}};
  report.update(answer);
  if (!options.json.empty()) reports::WriteJson(report, options.json);
  // What the answer names beside it, pictures say, is found from its own file.
  const bool is_stored = !options.json.empty() && fs::is_regular_file(options.json);
  const std::string text =
      is_stored ? "" : report.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  MakePictures(is_stored ? options.json : "-", options.html, options.png, options.package_folder,
               text);
  SaySaved({options.json, options.html, options.png});
}

void SaySaved(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (fs::is_regular_file(path)) std::cout << "saved to " << path << '\n';
  }
}

void RunReportProgram(const std::string& package_folder, const std::vector<std::string>& arguments,
                      const std::string& input) {
  std::vector<std::string> words{kPython, "-B", package_folder + kProgram};
  words.insert(words.end(), arguments.begin(), arguments.end());
  UnnamedFile output;
  const int code = RunProgram(words, UnnamedFile(input), output);
  if (code == 0) return;
  const std::string said = output.Read();
  throw base::ConfigError(
      !said.empty()
          ? said
          : fmt::format("{} cannot be run; install python3, or leave out --html and --png",
                        kPython));
}

void AddReportVerb(CLI::App* app, StoredReportOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "report",
      "make a page or a picture from what imagine, achieve, plan, experiment FILE, experiment "
      "hypothesis, reproduce or doctor wrote with --json");
  verb->add_option("file", options->file, "that JSON file")->required();
  verb->add_option("--html", options->html,
                   "write one page to this file that shows everything and needs no network");
  verb->add_option("--png", options->png, "of `achieve`: draw what was done when to this file");
  options->verb = verb;
}

int RunReportVerb(const StoredReportOptions& options, const std::string& package_folder) {
  if ((options.html + options.png).empty()) {
    throw base::ConfigError("report: nothing to make; add --html FILE or --png FILE");
  }
  CheckOutputs({{"--html", options.html}, {"--png", options.png}}, {{"answer", options.file}});
  MakePictures(options.file, options.html, options.png, package_folder);
  SaySaved({options.html, options.png});
  return 0;
}

std::string Quoted(const std::string& word) {
  if (!word.empty() && word.find_first_of(" '\"$\\*?[]&;|<>()`#~!") == std::string::npos) {
    return word;
  }
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string CommandText(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back(Quoted(word));
  return base::Join(quoted, " ");
}

}  // namespace hires::cli
