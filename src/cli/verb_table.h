#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"
#include "cli/report_output.h"

namespace hires::cli {

/// What the answers of all verbs say of the program and its call.
struct ProgramCall {
  std::string command;         ///< as it was typed, for a shell
  std::string package_folder;  ///< where config/, worlds/, urdf/ lie
};

/// Where most options keep what says to which files the answer is written.
template <typename Options>
ReportOptions* ReportOf(Options* options) {
  return &options->report;
}

/// Verbs with their options, in the order in which help shows them. A type of options has a member
/// `verb`, which adding sets.
class VerbTable {
 public:
  /// @pre `app` outlives this.
  VerbTable(CLI::App* app, ProgramCall call) : app_(app), call_(std::move(call)) {}

  /// @param report  finds the ReportOptions among the options; null where there are none.
  template <typename Options>
  void Add(const std::function<void(CLI::App*, Options*)>& add,
           const std::function<ReportOptions*(Options*)>& report,
           const std::function<int(const Options&)>& run, OnSignal on_signal = OnSignal::kAsk) {
    const auto options = std::make_shared<Options>();
    if (report) SetCall(report(options.get()));
    add(app_, options.get());
    verbs_.push_back({options->verb, [options, run] { return run(*options); }, on_signal});
  }

  /// A verb that parses its arguments itself.
  /// @param is_shown  in the program's help; else only programs call it.
  void AddForeign(const std::string& name, const std::string& help,
                  const std::function<int(const std::vector<std::string>&)>& run,
                  bool is_shown = true);

  void SetCall(ReportOptions* report) const {
    report->command = call_.command;
    report->package_folder = call_.package_folder;
  }
  const std::string& package_folder() const { return call_.package_folder; }
  std::vector<ProgramVerb> Take() { return std::move(verbs_); }

 private:
  CLI::App* app_;
  ProgramCall call_;
  std::vector<ProgramVerb> verbs_;
};

/// What was typed, with the program's name alone before it, wherever it lies.
std::string CommandOf(const std::string& program, std::vector<std::string> arguments);

}  // namespace hires::cli
