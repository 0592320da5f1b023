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
  if (std::find(problems_.begin(), problems_.end(), text) == problems_.end())
    problems_.push_back(text);
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
  if (problems_.size() == 1 && sentences.empty()) throw base::ConfigError(problems_.front());
  std::vector<std::string> listed(
      problems_.begin(),
      problems_.begin() + static_cast<std::ptrdiff_t>(std::min(problems_.size(), kMostProblems)));
  if (listed.size() < problems_.size())
    listed.push_back(fmt::format("and {} more", problems_.size() - listed.size()));
  std::string text =
      fmt::format("{}: cannot be loaded; correct:\n  {}", path, base::Join(listed, "\n  "));
  if (!sentences.empty()) {
    text +=
        fmt::format("\n and know of what it holds besides:\n  {}", base::Join(sentences, "\n  "));
  }
  throw base::ConfigError(text);
}

}  // namespace hires::world
