#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/outputs.h"

namespace CLI {
class App;
}

/// What a verb writes beside what it prints: its answer for machines, and a page made from that.
namespace hires::cli {

/// Of the JSON that WriteReport() writes. It grows when a field goes or changes its meaning, not
/// when one is added; scripts/report refuses what is newer than itself.
constexpr int kReportFormat = 1;

struct ReportOptions {
  std::string json, html;      ///< files to write; empty: none
  std::string png;             ///< of `achieve`: what was done when, drawn
  std::string command;         ///< as it was typed, for a shell
  std::string package_folder;  ///< where scripts/report lies
};

/// Whether anything is to be written.
bool IsWanted(const ReportOptions& options);

/// Adds --json and --html to a verb.  @pre `options` outlives `verb`.
void AddReportOptions(CLI::App* verb, ReportOptions* options);

/// Before the work is done: an hour of it must not end at a folder or package that is missing, nor
/// at an answer that is written over what it rests on.
/// @param inputs        that the verb reads.
/// @param more_outputs  that it writes beside the report.
/// @throws base::ConfigError as CheckOutputs() of them all, or naming what is not there.
void CheckReport(const ReportOptions& options, const std::vector<VerbFile>& inputs = {},
                 std::vector<VerbFile> more_outputs = {});

/// A file that an answer will rest on, as it is before the work is done.
struct ReportInput {
  /// @param path  empty: there is none, it is left out.  @throws base::ConfigError: unreadable.
  ReportInput(std::string what, std::string path);
  std::string what;  ///< "world"
  std::string path;
  std::string hash;  ///< 16 digits
};

/// How an answer came about, for whoever wants it again.
struct ReportOrigin {
  std::string verb;     ///< "experiment hypothesis"
  bool is_local{true};  ///< by this program alone; else by running nodes, with files of their own
  std::vector<ReportInput> inputs;
  std::map<std::string, std::string> hashes;  ///< of what was read: "robot" -> 16 digits
};

/// Writes `answer`, with `report` before it (format, verb, version, command, origin), where the
/// options ask for it. The page is made from the very JSON.
/// @throws base::ConfigError if a file cannot be read or written, with what scripts/report says.
void WriteReport(const ReportOptions& options, const ReportOrigin& origin,
                 const nlohmann::ordered_json& answer);

/// "saved to FILE", a line for each, on standard output. What went to a device, standard output
/// say, needs no word.
/// @param paths  empty ones: nothing was wanted.
void SaySaved(const std::vector<std::string>& paths);

/// Runs scripts/report with these arguments.
/// @param input  for its standard input.
/// @throws base::ConfigError with what it said, unless it ended well.
void RunReportProgram(const std::string& package_folder, const std::vector<std::string>& arguments,
                      const std::string& input = "");

/// `hires report FILE.json`: makes page or picture from a stored answer.
struct StoredReportOptions {
  std::string file, html, png;
  CLI::App* verb{nullptr};
};
/// @pre `options` outlives `app`.
void AddReportVerb(CLI::App* app, StoredReportOptions* options);
/// @return 0.  @throws base::ConfigError for bad input.
int RunReportVerb(const StoredReportOptions& options, const std::string& package_folder);

/// A word of a command as a shell takes it.
std::string Quoted(const std::string& word);
/// A whole command.
std::string CommandText(const std::vector<std::string>& words);

}  // namespace hires::cli
