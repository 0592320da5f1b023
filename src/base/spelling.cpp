#include "hires/base/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "hires/base/text.h"

namespace hires::base {
namespace {

constexpr std::size_t kMostGuesses = 3;

/// Whether one was mistyped for the other: a third of it may differ, or two letters be swapped.
bool IsSlipOf(const std::string& a, const std::string& b) {
  constexpr std::size_t kLeast = 3;  // of shorter names nearly all are alike
  if (std::max(a.size(), b.size()) < kLeast) return false;
  const std::size_t distance = EditDistance(a, b);
  if (distance <= std::max<std::size_t>(1, std::max(a.size(), b.size()) / 3)) return true;
  return distance == 2 && a.size() == b.size() &&
         std::is_permutation(a.begin(), a.end(), b.begin());
}

/// Whether all letters of `part` come in `whole`, in that order.
bool HasInOrder(const std::string& whole, const std::string& part) {
  std::size_t found = 0;
  for (const char letter : whole) {
    if (found < part.size() && part[found] == letter) ++found;
  }
  return found == part.size();
}

/// Whether one stands in the other, or one is short for the other, as peper1 for peppermill1.
bool IsPart(const std::string& a, const std::string& b) {
  const auto& [part, whole] = std::minmax(
      a, b, [](const auto& one, const auto& other) { return one.size() < other.size(); });
  if (part.size() < 3) return false;
  if (whole.find(part) != std::string::npos) return true;
  return part.size() > 3 && 2 * part.size() >= whole.size() && part[0] == whole[0] &&
         HasInOrder(whole, part);
}

}  // namespace

// One row of the table at a time.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

bool AreSpeltAlike(const std::string& a, const std::string& b) {
  const std::size_t shorter = std::min(a.size(), b.size());
  if (shorter < 3) return false;
  const std::size_t distance = EditDistance(ToLower(a), ToLower(b));
  return distance > 0 && distance <= (shorter < 8 ? 1u : 2u);
}

std::vector<std::string> LikelyNames(const std::string& name,
                                     const std::vector<std::string>& known) {
  const std::string lower = ToLower(name.substr(0, kMostCompared));
  std::vector<std::string> mistyped, parts;
  std::size_t best = 0;
  for (const std::string& candidate : NearestNames(name, known, known.size())) {
    const std::string other = ToLower(candidate);
    const std::size_t distance = EditDistance(lower, other);
    if (mistyped.empty()) best = distance;
    // Beside a clear slip others are no guess.
    if (distance <= best + 1 && IsSlipOf(lower, other)) mistyped.push_back(candidate);
    if (IsPart(lower, other)) parts.push_back(candidate);
  }
  std::vector<std::string>& guesses = mistyped.empty() ? parts : mistyped;
  guesses.resize(std::min(guesses.size(), kMostGuesses));
  return guesses;
}

std::string Counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace hires::base
