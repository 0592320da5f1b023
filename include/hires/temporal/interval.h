#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace hires::temporal {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// What is known about a moment [s]: it lies in [earliest, latest].
struct Bounds {
  double earliest{-kForever};
  double latest{kForever};
  bool operator==(const Bounds& other) const {
    return earliest == other.earliest && latest == other.latest;
  }
};

/// A stretch of time [s] that begins at `start` and has ended at `finish`: [start, finish).
struct Interval {
  double start{-kForever};
  double finish{kForever};
  bool operator==(const Interval& other) const {
    return start == other.start && finish == other.finish;
  }
};

/// The thirteen relations of two intervals [Allen 1983, Comm. ACM 26:832-843].
enum class Allen {
  kBefore,
  kMeets,
  kOverlaps,
  kStarts,
  kDuring,
  kFinishes,
  kEquals,
  kFinishedBy,
  kContains,
  kStartedBy,
  kOverlappedBy,
  kMetBy,
  kAfter
};
constexpr int kNumAllen = 13;

/// The one relation that holds from `a` to `b`. @pre both have start < finish.
Allen Relation(const Interval& a, const Interval& b);
Allen Inverse(Allen relation);
/// The relations that an interval of which only bounds are known may have to `b`, in the order of
/// `Allen`; none if the bounds leave it no time at all.  @pre b.start < b.finish.
std::vector<Allen> PossibleRelations(const Bounds& start, const Bounds& finish, const Interval& b);
std::string_view ToString(Allen relation);  ///< "before", "met_by", ...
/// @throws ConfigError naming the thirteen words.
Allen ReadAllen(std::string_view word);

}  // namespace hires::temporal
