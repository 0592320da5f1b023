#pragma once

#include <string>
#include <vector>

#include "hires/base/param_reader.h"

namespace hires::lab {

/// One call of `hires` or `hires_lab` whose answer holds results.
struct Play {
  std::string name;
  /// Behind the program. {package}: folder of config/, worlds/, urdf/; {answer}: the JSON file to
  /// write; {folder}: one of its own, for journals; {other} and {other/folder}: answer and folder
  /// of the play of that name, which then is played before.
  std::vector<std::string> command;
  std::vector<std::string> inputs;  ///< files and folders below {package} that it depends on
  double seconds{0.0};              ///< [s] wall time on two cores, to foretell how long it takes
  std::vector<int> done_codes;      ///< exit codes at which the answer is whole
};

/// Reads name, command, inputs, seconds and done_codes.  @throws base::ConfigError naming the key.
Play ReadPlay(base::ParamReader in);

/// "hires_lab" for the verbs of the lab, else "hires".
std::string ProgramNameOf(const Play& play);

/// Names of the plays whose answers a play's command takes.
std::vector<std::string> NeededBy(const Play& play);

/// The play of that name, or null.
const Play* FindPlay(const std::vector<Play>& plays, const std::string& name);

/// @param where  for the message: file, and who needs it.
/// @throws base::ConfigError if there is no play of that name, with what is called alike.
void RequirePlay(const std::string& where, const std::vector<Play>& plays, const std::string& name);

/// Those of these names, each after the plays whose answers it takes.
/// @throws base::ConfigError for plays that are unknown or need each other in a circle.
std::vector<Play> InOrder(const std::vector<Play>& plays, const std::vector<std::string>& names);

/// What stands between white space.
std::vector<std::string> WordsIn(const std::string& text);

}  // namespace hires::lab
