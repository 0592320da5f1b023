#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/short_text.h"

namespace hires::world {

/// What there is to say of a file that is loaded: each kind of thing that is played otherwise than
/// it is written, or left out, once, with count and first place; and all that keeps it from being
/// loaded, each once.
class LoadNotes {
 public:
  /// Reads as "3 models with joints that move: ...; first hall.world:5 'door'".
  /// @param noun  of one: "model"
  /// @param rest  what is so about it and what is made of it: the kind, with `noun`
  /// @param place  "hall.world:5 'door'"
  void Add(const std::string& noun, const std::string& rest, const std::string& place,
           int count = 1);
  /// A whole message: place, what came, what was wanted, what to do. What is wrong alike at other
  /// places is told once, with their number.
  void AddProblem(const std::string& text);

  bool HasProblems() const { return !problems_.empty(); }
  /// More would not be listed: nothing is to be read for them.
  bool IsFull() const { return problems_.size() > base::kMostListed; }
  /// In the order of their first places, as base::FirstLines has them.
  std::vector<std::string> Sentences() const;
  /// @throws base::ConfigError with all problems, and after them what else there is to say, if
  /// there are any.
  void ThrowIfProblems(const std::string& path) const;

 private:
  struct Kind {
    std::string noun, rest, first;
    int count;
  };
  struct Problem {
    std::string text;   ///< what stands behind the place
    std::string first;  ///< place
    std::size_t count;  ///< of places
  };
  std::vector<std::string> ProblemLines() const;

  std::vector<Kind> kinds_;
  std::map<std::pair<std::string, std::string>, std::size_t> kind_indices_;  // by noun and rest
  std::vector<Problem> problems_;
  std::map<std::string, std::size_t> problem_indices_;            // by text
  std::set<std::pair<std::size_t, std::string>> problem_places_;  // index and place
};

}  // namespace hires::world
