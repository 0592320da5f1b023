#include "perception/support/recognition_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "perception/recognition/model_fit.h"

namespace hires::test_support {
namespace {

constexpr int kLarge = 400;  // points

/// For each detection the thing that most of its points are of, for each thing the detection with
/// the most of its points; -1: none.
std::vector<int> DetectionOfThing(const RandomTable& table, const perception::Recognition& seen,
                                  int* surplus) {
  std::vector<std::map<int, int>> votes(seen.detections.size());
  for (std::size_t i = 0; i < table.owner.size(); ++i) {
    const int label = seen.segmentation.labels[i];
    if (label >= perception::kLabelFirstThing)
      ++votes[label - perception::kLabelFirstThing][table.owner[i]];
  }
  std::vector<int> of_thing(table.things.size(), -1);
  for (std::size_t d = 0; d < votes.size(); ++d) {
    const auto most = std::max_element(votes[d].begin(), votes[d].end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    if (most->first < 0) {
      ++*surplus;
      continue;
    }
    int& known = of_thing[most->first];
    if (known >= 0) ++*surplus;
    if (known < 0 || votes[known][most->first] < most->second) known = static_cast<int>(d);
  }
  return of_thing;
}

}  // namespace

RecognitionScore::RecognitionScore(const std::vector<perception::KnownModel>& catalogue) {
  for (const perception::ModelShape& shape : perception::ShapesOfCatalogue(catalogue)) {
    alike_.emplace_back();
    for (const perception::KnownModel& known : shape.models) alike_.back().push_back(known.label);
  }
}

std::string RecognitionScore::ShapeOf(const std::string& label) const {
  for (const auto& labels : alike_)
    if (std::find(labels.begin(), labels.end(), label) != labels.end()) return labels.front();
  return label;
}

void RecognitionScore::Add(const RandomTable& table, const perception::Recognition& seen) {
  num_detections += static_cast<int>(seen.detections.size());
  const std::vector<int> of_thing = DetectionOfThing(table, seen, &surplus);
  for (std::size_t k = 0; k < table.things.size(); ++k) {
    const TableThing& thing = table.things[k];
    if (thing.num_points < kLarge) continue;
    ++num_large;
    if (of_thing[k] < 0) continue;
    ++found;
    const perception::Detection& detection = seen.detections[of_thing[k]];
    const std::string wanted = thing.is_known ? ShapeOf(thing.model) : perception::kUnknownLabel;
    ++(thing.is_known ? num_known : num_unknown);
    if (ShapeOf(detection.label) != wanted) {
      confusions.emplace_back(wanted, detection.label);
      continue;
    }
    ++(thing.is_known ? named : unknown_as_such);
    if (thing.is_known)
      errors.push_back((detection.X_CO.translation - thing.X_CO.translation).norm());
  }
}

double RecognitionScore::MedianError() const {
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
}

std::string RecognitionScore::Text() const {
  std::string text = fmt::format(
      "found {} of {}, named {} of {}, unknown as such {} of {}, surplus {} of {}, median error "
      "{:.1f} mm",
      found, num_large, named, num_known, unknown_as_such, num_unknown, surplus, num_detections,
      1e3 * MedianError());
  for (const auto& [kind, called] : confusions) text += fmt::format("; {} called {}", kind, called);
  return text;
}

}  // namespace hires::test_support
