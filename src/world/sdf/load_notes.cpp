#include "world/sdf/load_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::world {
namespace {

constexpr std::size_t kMostProblems = 50;  // that a message lists

}  // namespace

void LoadNotes::Add(const std::string& noun, const std::string& rest, const std::string& place,
                    int count) {
  const auto same = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& kind) {
    return kind.noun == noun && kind.rest == rest;
  });
  if (same == kinds_.end()) {
    kinds_.push_back({noun, rest, place, count});
  } else {
    same->count += count;
  }
}

void LoadNotes::AddProblem(const std::string& text) {
  const std::size_t colon = text.find(": ");
  const std::string place = colon == std::string::npos ? "" : text.substr(0, colon + 2);
  const std::string rest = text.substr(place.size());
  const auto same = std::find_if(problems_.begin(), problems_.end(),
                                 [&](const Problem& one) { return one.text == rest; });
  if (same == problems_.end()) {
    problems_.push_back({rest, {place}});
  } else if (std::find(same->places.begin(), same->places.end(), place) == same->places.end()) {
    same->places.push_back(place);
  }
}

std::vector<std::string> LoadNotes::ProblemLines() const {
  std::vector<std::string> lines;
  for (const Problem& problem : problems_) {
    const std::size_t count = problem.places.size();
    lines.push_back(problem.places.front() + problem.text +
                    (count > 1 ? fmt::format(" (named {} times)", count) : ""));
  }
  return lines;
}

std::vector<std::string> LoadNotes::Sentences() const {
  std::vector<std::string> sentences;
  for (const Kind& kind : kinds_) {
    sentences.push_back(fmt::format("{} {}; {}{}", base::Counted(kind.count, kind.noun), kind.rest,
                                    kind.count > 1 ? "first " : "", kind.first));
  }
  return sentences;
}

void LoadNotes::ThrowIfProblems(const std::string& path) const {
  if (problems_.empty()) return;
  const std::vector<std::string> sentences = Sentences();
  std::vector<std::string> listed = ProblemLines();
  if (listed.size() == 1 && sentences.empty()) throw base::ConfigError(listed.front());
  if (listed.size() > kMostProblems) {
    listed.resize(kMostProblems);
    listed.push_back(fmt::format("and {} more", problems_.size() - kMostProblems));
  }
  std::string text =
      fmt::format("{}: cannot be loaded; correct:\n  {}", path, base::Join(listed, "\n  "));
  if (!sentences.empty()) {
    text +=
        fmt::format("\n and know of what it holds besides:\n  {}", base::Join(sentences, "\n  "));
  }
  throw base::ConfigError(text);
}

}  // namespace hires::world
