#pragma once

#include <string>
#include <vector>

#include "perception/support/random_tables.h"

namespace hires::test_support {

/// How what was recognised on tables agrees with what stood there. A thing is found if a detection
/// has more of its points than of anything else's; things of fewer than 400 pixels do not count.
class RecognitionScore {
 public:
  explicit RecognitionScore(const std::vector<perception::KnownModel>& catalogue);

  void Add(const RandomTable& table, const perception::Recognition& seen);
  double MedianError() const;  ///< [m] of the poses of things that are named rightly
  /// One line for people.
  std::string Text() const;

  int num_large{0}, found{0};
  int num_known{0}, named{0};  ///< of those found; rightly up to models of one geometry
  int num_unknown{0}, unknown_as_such{0};
  int num_detections{0}, surplus{0};  ///< of nothing, or of a thing that another one has more of
  std::vector<double> errors{};       ///< [m]
  std::vector<std::pair<std::string, std::string>> confusions{};  ///< kind, and what it was called

 private:
  std::string ShapeOf(const std::string& label) const;
  std::vector<std::vector<std::string>> alike_;  // labels of each shape
};

}  // namespace hires::test_support
