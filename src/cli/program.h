#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
}

// What programs with verbs share: `hires VERB ...`, and others in its manner.
namespace hires::cli {

/// What SIGINT, SIGTERM and SIGHUP do while a verb runs.
enum class OnSignal {
  kAsk,  ///< the verb asks IsInterrupted() and finishes what it must; one that has not asked within
         ///< a second (it reads a large file) ends at once, with kExitCancelled
  kEnd   ///< it has nothing to finish and ends as any program does
};

struct ProgramVerb {
  CLI::App* verb{nullptr};   ///< tells whether it was typed
  std::function<int()> run;  ///< @return exit code.  @throws std::exception for bad input
  OnSignal on_signal{OnSignal::kAsk};
};

struct Program {
  std::string name;         ///< as it is typed
  std::string description;  ///< one line
  /// Adds all verbs; their options must live as long as what is returned.
  std::function<std::vector<ProgramVerb>(CLI::App*)> add_verbs;
  /// Verbs of earlier versions -> how each is called now.
  std::map<std::string, std::string> moved{};
};

/// Whether a signal came that a verb heeds.
bool IsInterrupted();

/// Parses, runs one verb, prints what is wrong. Never throws.
/// @param arguments  the program's name first, as in argv.
/// @return the verb's exit code; kExitBadInput where no verb could be run.
int RunProgram(const Program& program, const std::vector<std::string>& arguments);

}  // namespace hires::cli
