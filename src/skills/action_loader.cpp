#include "hires/skills/action_loader.h"

#include <fmt/format.h>

#include <class_loader/class_loader.hpp>
#include <filesystem>
#include <map>
#include <mutex>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "hires/skills/action_library.h"

namespace hires::skills {
namespace {

constexpr std::size_t kMostBytes = 512u << 20;

using class_loader::ClassLoader;

/// What a file brought along when it was loaded; if it changes afterwards, that changes nothing.
struct LoadedLibrary {
  std::uint64_t hash{0};
  std::vector<Action> actions;
};

std::vector<Action> ActionsOf(const ActionLibrary& library) {
  struct HostLibrary : ActionLibrary {
    std::vector<Action> Actions() const override { return {}; }
  };
  if (library.Layout() != HostLibrary().Layout()) {
    throw base::ConfigError(
        "it was built with other headers than this program; rebuild it against the installed ones");
  }
  library.SetLog([](base::LogLevel level, const std::string& text) { base::Log(level, text); });
  return library.Actions();
}

std::vector<Action> ActionsIn(ClassLoader* loader) {
  const std::vector<std::string> classes = loader->getAvailableClasses<ActionLibrary>();
  if (classes.empty()) {
    throw base::ConfigError(
        "it has no class of actions; derive one from hires::skills::ActionLibrary and name it in "
        "HIRES_REGISTER_ACTIONS");
  }
  std::vector<Action> actions;
  for (const std::string& name : classes) {
    for (Action& action : ActionsOf(*loader->createUniqueInstance<ActionLibrary>(name))) {
      actions.push_back(std::move(action));
    }
  }
  return actions;
}

/// Never unloads: skills and exceptions that a library's code made may be anywhere.
ClassLoader* LoaderOf(const std::string& path) {
  static auto* loaders = new std::vector<std::unique_ptr<ClassLoader>>;
  try {
    loaders->push_back(std::make_unique<ClassLoader>(path));
  } catch (const class_loader::LibraryLoadException& error) {
    throw base::ConfigError(fmt::format("it cannot be loaded: {}", error.what()));
  }
  return loaders->back().get();
}

LoadedLibrary Load(const std::string& path) {
  LoadedLibrary library;
  base::Hasher hasher;
  hasher.Add(base::ReadTextFile(path, kMostBytes));
  library.hash = hasher.value();
  library.actions = ActionsIn(LoaderOf(path));
  return library;
}

/// Loads a file once.
const LoadedLibrary& LibraryAt(const std::string& path) {
  static std::mutex mutex;
  static auto* libraries = new std::map<std::string, LoadedLibrary>;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto known = libraries->find(path);
  if (known != libraries->end()) return known->second;
  return libraries->emplace(path, Load(path)).first->second;
}

void AddLibrary(const std::string& path, ActionSet* set) {
  const LoadedLibrary& library = LibraryAt(std::filesystem::absolute(path).string());
  for (const Action& action : library.actions) set->Add(action);
  set->Note({path, library.hash});
}

}  // namespace

std::shared_ptr<const ActionSet> LoadActionSet(const std::vector<std::string>& libraries) {
  if (libraries.empty()) return OwnActionSet();
  auto set = std::make_shared<ActionSet>(*OwnActionSet());
  for (const std::string& path : libraries) {
    try {
      AddLibrary(path, set.get());
    } catch (const std::exception& error) {  // a library may throw anything
      throw base::ConfigError(fmt::format("library of actions '{}': {}", path, error.what()));
    }
  }
  return set;
}

std::string WhyActionsDiffer(std::uint64_t wanted, const ActionSet& own) {
  if (wanted == own.hash()) return "";
  return fmt::format(
      "actions differ: the client has {}, this worker {} with {}; start both with the same "
      "~action_libraries",
      base::HexOf(wanted), base::HexOf(own.hash()), ToString(own.libraries()));
}

}  // namespace hires::skills
