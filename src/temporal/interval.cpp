#include "hires/temporal/interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"

namespace hires::temporal {
namespace {

constexpr std::array<std::string_view, kNumAllen> kWords = {
    "before",      "meets",    "overlaps",   "starts",        "during", "finishes", "equals",
    "finished_by", "contains", "started_by", "overlapped_by", "met_by", "after"};

Allen RelationOfSameStart(double finish_a, double finish_b) {
  if (finish_a == finish_b) return Allen::kEquals;
  return finish_a < finish_b ? Allen::kStarts : Allen::kStartedBy;
}

/// @pre a begins before b does.
Allen RelationOfEarlier(const Interval& a, const Interval& b) {
  if (a.finish < b.start) return Allen::kBefore;
  if (a.finish == b.start) return Allen::kMeets;
  if (a.finish < b.finish) return Allen::kOverlaps;
  return a.finish == b.finish ? Allen::kFinishedBy : Allen::kContains;
}

/// Moments within `bounds` of which at least one stands to the landmarks as any moment there does:
/// the ends, the landmarks, and one between each two neighbours.
std::vector<double> Samples(const Bounds& bounds, std::vector<double> landmarks) {
  landmarks.insert(landmarks.end(), {bounds.earliest, bounds.latest});
  std::sort(landmarks.begin(), landmarks.end());
  std::vector<double> samples;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    samples.push_back(landmarks[i]);
    // Three steps, so that a start and a finish fit between the same neighbours.
    for (int step = 0; step < 3 && i + 1 < landmarks.size(); ++step) {
      samples.push_back(std::nextafter(samples.back(), landmarks[i + 1]));
    }
  }
  const auto outside = [&](double moment) {
    return !(bounds.earliest <= moment && moment <= bounds.latest);
  };
  samples.erase(std::remove_if(samples.begin(), samples.end(), outside), samples.end());
  return samples;
}

}  // namespace

Allen Relation(const Interval& a, const Interval& b) {
  HIRES_CHECK(a.start < a.finish && b.start < b.finish, "an interval must begin before it ends");
  if (a.start == b.start) return RelationOfSameStart(a.finish, b.finish);
  return a.start < b.start ? RelationOfEarlier(a, b) : Inverse(RelationOfEarlier(b, a));
}

Allen Inverse(Allen relation) {
  // The words stand mirrored around "equals".
  return static_cast<Allen>(kNumAllen - 1 - static_cast<int>(relation));
}

std::vector<Allen> PossibleRelations(const Bounds& start, const Bounds& finish, const Interval& b) {
  HIRES_CHECK(b.start < b.finish, "an interval must begin before it ends");
  const std::vector<double> landmarks = {b.start,      b.finish,        start.earliest,
                                         start.latest, finish.earliest, finish.latest};
  std::array<bool, kNumAllen> possible{};
  for (const double begin : Samples(start, landmarks)) {
    for (const double end : Samples(finish, landmarks)) {
      if (begin < end) possible[static_cast<std::size_t>(Relation({begin, end}, b))] = true;
    }
  }
  std::vector<Allen> relations;
  for (int i = 0; i < kNumAllen; ++i) {
    if (possible[static_cast<std::size_t>(i)]) relations.push_back(static_cast<Allen>(i));
  }
  return relations;
}

std::string_view ToString(Allen relation) { return kWords[static_cast<std::size_t>(relation)]; }

Allen ReadAllen(std::string_view word) {
  const auto found = std::find(kWords.begin(), kWords.end(), word);
  if (found == kWords.end()) {
    throw base::ConfigError(fmt::format("'{}' is no relation of two intervals; wanted one of {}",
                                        word, fmt::join(kWords, ", ")));
  }
  return static_cast<Allen>(found - kWords.begin());
}

}  // namespace hires::temporal
