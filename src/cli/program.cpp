#include "cli/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <set>

#include "cli/exit_code.h"
#include "cli/reading_display.h"
#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::cli {
namespace {

constexpr unsigned kPatience = 1;  // [s] after a signal, for a verb to ask
constexpr double kMuch = 0.3;      // [s] of work; less: the computer has no time for us
constexpr int kMostPatience = 10;  // times

std::atomic<bool> interrupted{false}, heeded{false};
std::atomic<double> worked_before{0.0};  // [s] when the signal came
std::atomic<int> times_waited{0};

double WorkedUntilNow() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Both call only what a handler of signals may.
void OnInterrupt(int) {
  worked_before = WorkedUntilNow();
  interrupted = true;
  alarm(kPatience);
}

/// A verb that worked on and did not ask is still reading what it was given: it has nothing to
/// finish.
void OnUnheeded(int) {
  if (heeded) return;
  if (WorkedUntilNow() - worked_before < kMuch && ++times_waited < kMostPatience) {
    alarm(kPatience);
    return;
  }
  constexpr char kText[] = "hires: interrupted; nothing is written\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof(kText) - 1);
  _exit(kExitCancelled);
}

/// The first argument from `place` on that is neither an option of the verb nor an option's value;
/// the number of arguments where there is none.
std::size_t NextWord(const CLI::App& verb, const std::vector<std::string>& arguments,
                     std::size_t place) {
  for (; place < arguments.size() && arguments[place] != "--"; ++place) {
    const std::string& word = arguments[place];
    if (word.empty() || word.front() != '-') return place;
    const CLI::Option* option = verb.get_option_no_throw(word);
    if (option != nullptr && option->get_items_expected_min() > 0) ++place;
  }
  return arguments.size();
}

/// CLI11 itself would only say that a verb is missing, or take a misspelt one for a file.
/// @param begin  of the arguments behind the verb `app`.
void RefuseUnknownVerb(const CLI::App& app, const std::vector<std::string>& arguments,
                       std::size_t begin = 1) {
  const std::vector<const CLI::App*> inner = app.get_subcommands({});
  const std::size_t place = NextWord(app, arguments, begin);
  if (inner.empty() || place >= arguments.size() || arguments[place].empty()) return;
  const std::string& word = arguments[place];
  std::vector<std::string> shown;
  bool is_misspelt = false;
  for (const CLI::App* verb : inner) {
    if (verb->get_name() == word) return RefuseUnknownVerb(*verb, arguments, place + 1);
    if (verb->get_group().empty()) continue;  // programs call it
    shown.push_back(verb->get_name());
    is_misspelt = is_misspelt || base::AreSpeltAlike(word, verb->get_name());
  }
  const bool may_be_a_file = app.get_require_subcommand_min() == 0;  // as that of `experiment`
  if (may_be_a_file && (!is_misspelt || std::filesystem::exists(word))) return;
  throw base::ConfigError(base::UnknownName("verb", word, shown));
}

/// CLI11 itself would say first what else is missing, and never what comes near.
void RefuseUnknownOption(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::vector<const CLI::App*> path{&app};  // options of a verb may stand behind its inner verbs
  for (std::size_t i = 1; i < arguments.size() && arguments[i] != "--"; ++i) {
    if (path.back()->get_prefix_command()) return;  // its own parser looks at what follows
    const std::string name = arguments[i].substr(0, arguments[i].find('='));
    if (name.compare(0, 2, "--") != 0) {
      const auto inner = path.back()->get_subcommands(
          [&](const CLI::App* verb) { return verb->get_name() == name; });
      path.insert(path.end(), inner.begin(), inner.end());
      continue;
    }
    std::set<std::string> known;
    bool is_known = false;
    for (const CLI::App* verb : path) {
      is_known = is_known || verb->get_option_no_throw(name) != nullptr;
      for (const CLI::Option* option : verb->get_options()) known.insert(option->get_name());
    }
    if (is_known) continue;
    throw base::ConfigError(base::UnknownName("option", name, {known.begin(), known.end()}));
  }
}

/// For somebody who typed the program's name alone.
int ShowVerbs(const CLI::App& app) {
  std::cerr << app.help();
  return kExitBadInput;
}

/// Help where it was asked for, else what is wrong with the options. @return exit code.
int Explain(const CLI::ParseError& error, const CLI::App& app) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::string verb;
  for (const CLI::App* parsed : app.get_subcommands()) verb += parsed->get_name() + ' ';
  std::cerr << fmt::format("{0}: {1}; '{0} {2}--help' says what is wanted\n", app.get_name(),
                           error.what(), verb);
  return kExitBadInput;
}

/// Says how a verb of an earlier version is called now.
void RefuseMovedVerb(const Program& program, const std::vector<std::string>& arguments) {
  const auto moved = program.moved.find(arguments[1]);
  if (moved == program.moved.end()) return;
  throw base::ConfigError(
      fmt::format("'{} {}' is '{}' now", program.name, moved->first, moved->second));
}

/// An option or word that was given is not empty: as a rule a variable of the shell is not set, and
/// what holds without the option would be done instead.
void RefuseEmptyValues(const CLI::App& app) {
  std::vector<std::string> empty;
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string>& values = option->results();
    const bool is_empty = std::any_of(values.begin(), values.end(), [](const std::string& value) {
      return value.find_first_not_of(" \t\n\r") == std::string::npos;
    });
    const bool may_be_bare = option->get_items_expected_min() == 0;  // CLI11 then takes ""
    if (is_empty && !may_be_bare) empty.push_back(option->get_name());
  }
  if (!empty.empty()) {
    throw base::ConfigError(fmt::format(
        "{}: an empty text came, wanted a value; is a variable of the shell not set? Give one, or "
        "leave it out",
        base::Join(empty, ", ")));
  }
  for (const CLI::App* verb : app.get_subcommands()) RefuseEmptyValues(*verb);
}

int RunVerb(const std::vector<ProgramVerb>& verbs) {
  for (const ProgramVerb& each : verbs) {
    if (!*each.verb) continue;
    if (each.on_signal == OnSignal::kAsk) {
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, OnInterrupt);
      std::signal(SIGALRM, OnUnheeded);
    }
    return each.run();
  }
  return kExitBadInput;
}

bool IsQuiet(const CLI::App& app) {
  const CLI::Option* quiet = app.get_option_no_throw("--quiet");
  const std::vector<const CLI::App*> verbs = app.get_subcommands({});
  return (quiet != nullptr && quiet->count() > 0) ||
         std::any_of(verbs.begin(), verbs.end(), [](const auto* verb) { return IsQuiet(*verb); });
}

}  // namespace

bool IsInterrupted() {
  if (interrupted) heeded = true;
  return interrupted;
}

int RunProgram(const Program& program, const std::vector<std::string>& arguments) {
  HIRES_CHECK(!arguments.empty(), "the program's name is missing");
  CLI::App app(program.description, program.name);
  app.require_subcommand(1);
  app.set_version_flag("--version", program.name + " " HIRES_VERSION, "print the version and end");
  const std::vector<ProgramVerb> verbs = program.add_verbs(&app);
  try {
    if (arguments.size() == 1) return ShowVerbs(app);
    RefuseMovedVerb(program, arguments);
    RefuseUnknownVerb(app, arguments);
    RefuseUnknownOption(app, arguments);
    // CLI11 takes its arguments from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend() - 1));
    RefuseEmptyValues(app);
    const ReadingDisplay display(IsQuiet(app));
    return RunVerb(verbs);
  } catch (const CLI::ParseError& error) {
    return Explain(error, app);
  } catch (const std::exception& error) {
    std::cerr << program.name << ": " << error.what() << '\n';
    return kExitBadInput;
  }
}

}  // namespace hires::cli
