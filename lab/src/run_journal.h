#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hires::lab {

/// Finished runs in a file of JSON lines, so that hours of work outlive whatever ends the program.
/// The first line says what the runs have in common. A last line that was cut off is dropped.
class RunJournal {
 public:
  /// Told of a run that is in the file.  @param where  "runs.journal: line 3".
  using OnRun = std::function<void(const nlohmann::ordered_json& run, const std::string& where)>;

  /// Begins the file, or goes on with one of the same head. One program at a time; runs of another
  /// build of it are kept, with a warning.
  /// @param head    what the runs have in common; its field `journal` names the kind of journal.
  /// @param on_run  called for each run that is there, before this returns.
  /// @throws base::ConfigError naming file and line: it cannot be written, is in use, is no
  /// journal of this kind, is broken elsewhere than at its end, or has another head (field named).
  RunJournal(const std::string& path, const nlohmann::ordered_json& head, const OnRun& on_run);
  ~RunJournal();
  RunJournal(const RunJournal&) = delete;
  RunJournal& operator=(const RunJournal&) = delete;

  /// On the disk when this returns.  @throws base::ConfigError if it cannot be written.
  void Append(const nlohmann::ordered_json& run);

 private:
  void Load(const nlohmann::ordered_json& head, const OnRun& on_run);
  void AppendText(const std::string& line);

  std::string path_;
  int fd_{-1};
};

}  // namespace hires::lab
