#include "world/sdf/load_notes.h"

#include <fmt/format.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::world {

void LoadNotes::Add(const std::string& noun, const std::string& rest, const std::string& place,
                    int count) {
  const auto [known, is_new] = kind_indices_.emplace(std::make_pair(noun, rest), kinds_.size());
  if (is_new) {
    kinds_.push_back({noun, rest, place, count});
  } else {
    kinds_[known->second].count += count;
  }
}

void LoadNotes::AddProblem(const std::string& whole) {
  const std::string text = base::Shortened(whole);  // a name may be a file long
  const std::size_t colon = text.find(": ");
  const std::string place = colon == std::string::npos ? "" : text.substr(0, colon + 2);
  const std::string rest = text.substr(place.size());
  const auto [known, is_new] = problem_indices_.emplace(rest, problems_.size());
  if (is_new) problems_.push_back({rest, place, 0});
  if (problem_places_.emplace(known->second, place).second) ++problems_[known->second].count;
}

std::vector<std::string> LoadNotes::ProblemLines() const {
  std::vector<std::string> lines;
  for (const Problem& problem : problems_) {
    lines.push_back(problem.first + problem.text +
                    (problem.count > 1 ? fmt::format(" (named {} times)", problem.count) : ""));
  }
  return base::FirstLines(std::move(lines));
}

std::vector<std::string> LoadNotes::Sentences() const {
  std::vector<std::string> sentences;
  for (const Kind& kind : kinds_) {
    sentences.push_back(fmt::format("{} {}; {}{}", base::Counted(kind.count, kind.noun), kind.rest,
                                    kind.count > 1 ? "first " : "", kind.first));
  }
  return base::FirstLines(std::move(sentences));
}

void LoadNotes::ThrowIfProblems(const std::string& path) const {
  if (problems_.empty()) return;
  const std::vector<std::string> sentences = Sentences(), listed = ProblemLines();
  if (listed.size() == 1 && sentences.empty()) throw base::ConfigError(listed.front());
  std::string text =
      fmt::format("{}: cannot be loaded; correct:\n  {}", path, base::Join(listed, "\n  "));
  if (!sentences.empty()) {
    text +=
        fmt::format("\n and know of what it holds besides:\n  {}", base::Join(sentences, "\n  "));
  }
  throw base::ConfigError(text);
}

}  // namespace hires::world
