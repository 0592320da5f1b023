#pragma once

#include <string>
#include <vector>

#include "lab/src/reproduce/play_runner.h"
#include "lab/src/reproduce/play_store.h"

/// What verbs that play a catalogue share.
namespace hires::lab {

/// Where answers of plays are kept: hires/results among the user's caches, as XDG has it.
/// @param given  by the user; empty: nothing.
/// @throws base::ConfigError naming the verb, if there is no place.
std::string PlaysFolder(const std::string& verb, const std::string& given);

/// A bar that is drawn over itself on a terminal, a line for each play in a log.
class PlaysDisplay {
 public:
  PlaysDisplay();
  void Show(const PlaysProgress& progress);
  void Clear() const;

 private:
  bool is_terminal_;
  std::string told_;
};

/// A table on standard output of what is played, which answers are there, and the time it takes.
void PrintPlays(const std::vector<Play>& plays, PlayStore* store);

/// A line on standard output, if answers are of other builds of this version.
void SayOtherBuilds(const PlaysDone& done, const std::string& build);

}  // namespace hires::lab
