#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/reproduce/play.h"

namespace hires::lab {

/// A table of a page is read; a longer one is not.
constexpr std::size_t kMostRows = 20;
/// [s] on two cores that all plays may take together.
constexpr double kLongestPublishing = 3600.0;

/// A number, and how it came about.
struct PublishedNumber {
  std::string name;                         ///< "onset_error", for the rows
  std::string what;                         ///< in words
  std::string unit;                         ///< "%", "m"; empty: it has none
  int digits{0};                            ///< behind the point, where people read it
  std::optional<double> value;              ///< none: it was not played
  std::optional<double> low, high;          ///< of its interval
  std::optional<double> at_least, at_most;  ///< what it should be; none: nothing was promised
  std::optional<int> n;                     ///< what it rests on
  std::string truth;                        ///< one of Truths()
  std::string command;
  std::optional<int> seed;
  std::string date;               ///< the day it was obtained: "2026-11-28"; empty: it was not
  std::string version;            ///< that it was obtained with
  std::optional<double> seconds;  ///< [s] wall time of the command, as far as it is known
  bool is_kept{false};            ///< measured before, and not played for this publication
};

/// What a number may be held against: "same", "foreign", "harsh", "simulated", "closed form",
/// "published", "measured", "none".
const std::vector<std::string>& Truths();

/// A number to be found in a play's answer. Pointers are those of AnswerField.
struct PlayedNumber {
  PublishedNumber number;       ///< all that is known before it is played
  std::vector<std::string> at;  ///< of several the largest counts
  std::string over;             ///< it is divided by this one; empty: by none
  std::string low, high;        ///< empty: those that stand at `at`, if there are any
  std::string n_at;             ///< empty: `number` has it
  double times{1.0};            ///< 100 makes per cent of a share
};

struct PlayedSeries {
  Play play;
  std::vector<PlayedNumber> numbers;
};

/// A line of the page's table. {name} stands for a number, {name:interval} for the ends of its
/// interval, {name:n} for what it rests on, {name:goal} for its goal and whether it is met.
struct PageRow {
  std::string what, ours, against;
  std::string rests_on;  ///< what else is to be known of it, for the page of details; may be empty
  std::string notes;     ///< path below the package, of where it is told at length
};

/// What a version publishes, and how it is said.
struct PublishCatalogue {
  std::vector<PlayedSeries> played;
  std::vector<PublishedNumber> kept;
  std::string intro;  ///< {version} and {date} stand for those of the results
  std::string remarks;
  std::vector<PageRow> rows;
};

/// @throws base::ConfigError with a line for each thing that is wrong, naming file, entry and
/// field: numbers and plays that are named twice, rows that name no number, too many rows, plays
/// that take too long together or need each other in a circle.
PublishCatalogue ReadPublishCatalogue(const std::string& path);

/// Each after those whose answers it takes.
std::vector<Play> PlaysOf(const PublishCatalogue& catalogue);

}  // namespace hires::lab
