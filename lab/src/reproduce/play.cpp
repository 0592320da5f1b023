#include "lab/src/reproduce/play.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

constexpr double kLongestPlay = 86400.0;  // [s]

/// The names between braces of a word; other text between braces is no placeholder.
std::vector<std::string> PlaceholdersIn(const std::string& word) {
  std::vector<std::string> names;
  for (std::size_t begin = word.find('{'); begin != std::string::npos;
       begin = word.find('{', begin + 1)) {
    const std::size_t end = word.find('}', begin);
    if (end == std::string::npos) break;
    const std::string name = word.substr(begin + 1, end - begin - 1);
    const bool is_name =
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_/") == std::string::npos;
    if (is_name && !name.empty()) names.push_back(name);
  }
  return names;
}

/// The play of a placeholder such as {durations} or {durations/folder}.
std::string PlayIn(const std::string& placeholder) {
  return placeholder.substr(0, placeholder.find('/'));
}

bool IsOwn(const std::string& placeholder) {
  return placeholder == "package" || placeholder == "answer" || placeholder == "folder";
}

/// Appends a play after those whose answers it takes.
void Append(const std::vector<Play>& plays, const Play& play, std::vector<std::string> path,
            std::vector<Play>* order) {
  if (FindPlay(*order, play.name) != nullptr) return;
  if (std::count(path.begin(), path.end(), play.name) > 0) {
    throw base::ConfigError(fmt::format("plays need each other's answers in a circle: {} -> {}",
                                        base::Join(path, " -> "), play.name));
  }
  path.push_back(play.name);
  for (const std::string& name : NeededBy(play)) {
    RequirePlay("play " + play.name, plays, name);
    Append(plays, *FindPlay(plays, name), path, order);
  }
  order->push_back(play);
}

}  // namespace

std::vector<std::string> WordsIn(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Play ReadPlay(base::ParamReader in) {
  Play play;
  play.name = in.GetString("name");
  play.command = WordsIn(in.GetString("command"));
  play.inputs = in.GetStrings("inputs");
  play.seconds = in.Get("seconds", base::Between(0.0, kLongestPlay));
  play.done_codes = {0};
  if (in.Has("done_codes")) {
    play.done_codes.clear();
    for (const std::string& code : in.GetStrings("done_codes")) {
      if (code.empty() || code.size() > 3 ||
          code.find_first_not_of("0123456789") != std::string::npos) {
        in.Fail("done_codes", fmt::format("has '{}'; wanted exit codes, 0 .. 255", code));
      }
      play.done_codes.push_back(std::stoi(code));
    }
  }
  const bool writes = std::any_of(
      play.command.begin(), play.command.end(),
      [](const std::string& word) { return word.find("{answer}") != std::string::npos; });
  if (!writes) in.Fail("command", "which writes no answer; wanted --json {answer} in it");
  return play;
}

std::string ProgramNameOf(const Play& play) {
  static const std::set<std::string> kLabVerbs{"experiment", "experiences", "scenarios"};
  const bool is_of_lab = !play.command.empty() && kLabVerbs.count(play.command.front()) > 0;
  return is_of_lab ? "hires_lab" : "hires";
}

std::vector<std::string> NeededBy(const Play& play) {
  std::vector<std::string> needed;
  for (const std::string& word : play.command) {
    for (const std::string& name : PlaceholdersIn(word)) {
      if (!IsOwn(name)) needed.push_back(PlayIn(name));
    }
  }
  return needed;
}

const Play* FindPlay(const std::vector<Play>& plays, const std::string& name) {
  const auto found =
      std::find_if(plays.begin(), plays.end(), [&](const Play& play) { return play.name == name; });
  return found == plays.end() ? nullptr : &*found;
}

void RequirePlay(const std::string& where, const std::vector<Play>& plays,
                 const std::string& name) {
  if (FindPlay(plays, name) != nullptr) return;
  std::vector<std::string> known;
  for (const Play& play : plays) known.push_back(play.name);
  throw base::ConfigError(where + ": " + base::UnknownName("play", name, known));
}

std::vector<Play> InOrder(const std::vector<Play>& plays, const std::vector<std::string>& names) {
  std::vector<Play> order;
  for (const std::string& name : names) Append(plays, *FindPlay(plays, name), {}, &order);
  return order;
}

}  // namespace hires::lab
