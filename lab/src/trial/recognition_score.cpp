#include "lab/src/trial/recognition_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hires/geometry/angles.h"
#include "perception/recognition/model_fit.h"

namespace hires::perception {
namespace {

/// For each detection, how many of its points each thing has; -1: something else.
using Votes = std::vector<std::map<int, int>>;

Votes VotesOf(const RandomTable& table, const TabletopView& seen) {
  Votes votes(seen.sighting.detections.size());
  for (std::size_t i = 0; i < table.owner.size(); ++i)
    if (seen.thing_of[i] >= 0) ++votes[seen.thing_of[i]][table.owner[i]];
  return votes;
}

/// Whether at least half of the points measured of a thing are those of one detection.
bool IsTaken(const Votes& votes, int thing, int num_measured) {
  return std::any_of(votes.begin(), votes.end(), [&](const std::map<int, int>& one) {
    const auto found = one.find(thing);
    return found != one.end() && 2 * found->second >= num_measured;
  });
}

/// Of each thing, points that the camera measured.
std::vector<int> PointsMeasured(const RandomTable& table) {
  std::vector<int> points(table.things.size(), 0);
  for (std::size_t i = 0; i < table.owner.size(); ++i)
    if (table.owner[i] >= 0 && IsMeasured(table.cloud.points[i])) ++points[table.owner[i]];
  return points;
}

/// Whose points a detection mostly has, and how many; -1: nothing's.
struct Owner {
  int thing{-1};
  int num_points{0};
};

Owner OwnerOf(const std::map<int, int>& votes, double least_share) {
  Owner owner;
  int all = 0;
  for (const auto& [thing, num] : votes) {
    all += num;
    if (num > owner.num_points || (owner.thing < 0 && num == owner.num_points))
      owner = {thing, num};
  }
  return owner.num_points >= least_share * all ? owner : Owner{};
}

/// For each thing the detection by which it is found, of two the one with more of it; -1: none.
/// @param measured  PointsMeasured.
std::vector<int> DetectionOfThing(const std::vector<int>& measured, const Votes& votes,
                                  const FoundBy& found_by) {
  std::vector<int> of_thing(measured.size(), -1), most(measured.size(), 0);
  for (std::size_t d = 0; d < votes.size(); ++d) {
    const Owner owner = OwnerOf(votes[d], found_by.of_detection);
    if (owner.thing < 0) continue;
    if (owner.num_points < found_by.of_thing * measured[owner.thing]) continue;
    if (owner.num_points <= most[owner.thing]) continue;
    most[owner.thing] = owner.num_points;
    of_thing[owner.thing] = static_cast<int>(d);
  }
  return of_thing;
}

BoxError BoxErrorOf(const TableThing& thing, const Detection& seen) {
  const Eigen::Vector3d to_middle(0.0, 0.0, 0.5 * seen.size.z());
  const Eigen::Vector2d sides = thing.size.head<2>();
  BoxError error;
  error.middle = (seen.X_CO * to_middle - thing.X_CO * thing.middle).norm();
  error.longer = seen.size.head<2>().maxCoeff() - sides.maxCoeff();
  error.shorter = seen.size.head<2>().minCoeff() - sides.minCoeff();
  error.height = seen.size.z() - thing.size.z();
  return error;
}

/// Not a number of no values.
double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<long>(share * (values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

BoxSums BoxSumsOf(const std::vector<ThingVerdict>& things) {
  BoxSums sums;
  const auto quantiles = [&](double BoxError::*part) {
    std::vector<double> errors;
    for (const ThingVerdict& thing : things)
      if (thing.box) errors.push_back(std::abs((*thing.box).*part));
    sums.num_boxes = static_cast<int>(errors.size());
    return ErrorQuantiles{Quantile(errors, 0.5), Quantile(errors, 0.95)};
  };
  sums.middle = quantiles(&BoxError::middle);
  sums.longer = quantiles(&BoxError::longer);
  sums.shorter = quantiles(&BoxError::shorter);
  sums.height = quantiles(&BoxError::height);
  return sums;
}

}  // namespace

RecognitionScore::RecognitionScore(const std::vector<KnownModel>& catalogue, int min_points,
                                   const FoundBy& found_by)
    : min_points_(min_points), found_by_(found_by) {
  for (const ModelShape& shape : ShapesOfCatalogue(catalogue)) {
    kinds_.push_back({{}, geometry::TurnSymmetry(shape.models.front().model->collisions)});
    for (const KnownModel& known : shape.models) kinds_.back().labels.push_back(known.label);
  }
}

const RecognitionScore::Kind* RecognitionScore::FindKind(const std::string& label) const {
  for (const Kind& kind : kinds_)
    if (std::find(kind.labels.begin(), kind.labels.end(), label) != kind.labels.end()) return &kind;
  return nullptr;
}

std::string RecognitionScore::KindOf(const std::string& label) const {
  const Kind* kind = FindKind(label);
  return kind != nullptr ? kind->labels.front() : label;
}

std::vector<std::string> RecognitionScore::LabelsLike(const std::string& label) const {
  const Kind* kind = FindKind(label);
  return kind != nullptr ? kind->labels : std::vector<std::string>{label};
}

void RecognitionScore::JudgeName(const Detection& seen, ThingVerdict* verdict) const {
  verdict->called = KindOf(seen.label);
  verdict->label = seen.label;
  verdict->confidence = seen.confidence;
  if (verdict->is_right()) return;
  for (const LabelConfidence& other : seen.alternatives)
    if (KindOf(other.label) == verdict->kind)
      verdict->doubt = std::max(verdict->doubt, other.confidence);
}

void RecognitionScore::JudgePose(const RandomTable& table, const TableThing& thing,
                                 const Detection& seen, ThingVerdict* verdict) const {
  const Eigen::Vector3d error = seen.X_CO.translation - thing.X_CO.translation;
  verdict->error = error.norm();
  verdict->error_B =
      (table.X_BCknown * seen.X_CO.translation - table.X_BC * thing.X_CO.translation).norm();
  const Eigen::Vector3d up_C = table.X_BC.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  verdict->offset = SightFrame(thing.X_CO.translation, up_C).transpose() * error;
  const int symmetry = FindKind(thing.model)->symmetry;
  if (symmetry == geometry::kRound) return;
  const double turn = geometry::YawOf(thing.X_CO.rotation.conjugate() * seen.X_CO.rotation);
  const double step = 2.0 * geometry::kPi / symmetry;
  verdict->turned_by = std::abs(turn - step * std::round(turn / step));
}

void RecognitionScore::Add(const RandomTable& table, const TabletopView& seen) {
  num_detections_ += static_cast<int>(seen.sighting.detections.size());
  const Votes votes = VotesOf(table, seen);
  const std::vector<int> measured = PointsMeasured(table);
  const std::vector<int> of_thing = DetectionOfThing(measured, votes, found_by_);
  num_surplus_ += static_cast<int>(votes.size()) -
                  static_cast<int>(std::count_if(of_thing.begin(), of_thing.end(),
                                                 [](int detection) { return detection >= 0; }));
  for (std::size_t k = 0; k < table.things.size(); ++k) {
    const TableThing& thing = table.things[k];
    if (thing.num_points < min_points_) continue;
    ThingVerdict verdict;
    verdict.table = num_tables_;
    verdict.model = thing.model;
    verdict.kind = thing.is_known ? KindOf(thing.model) : kUnknownLabel;
    verdict.distance = thing.X_CO.translation.norm();
    verdict.torso = table.torso;
    verdict.view = thing.view;
    verdict.num_points = thing.num_points;
    if (of_thing[k] >= 0) {
      const Detection& detection = seen.sighting.detections[of_thing[k]];
      JudgeName(detection, &verdict);
      if (verdict.is_right() && thing.is_known) JudgePose(table, thing, detection, &verdict);
      if (verdict.is_right() && !thing.is_known) verdict.box = BoxErrorOf(thing, detection);
    } else {
      verdict.is_merged = IsTaken(votes, static_cast<int>(k), measured[k]);
    }
    things_.push_back(verdict);
  }
  ++num_tables_;
}

void RecognitionScore::Append(const RecognitionScore& other) {
  for (ThingVerdict verdict : other.things_) {
    verdict.table += num_tables_;
    things_.push_back(verdict);
  }
  num_tables_ += other.num_tables_;
  num_detections_ += other.num_detections_;
  num_surplus_ += other.num_surplus_;
}

RecognitionSums SumsOf(const std::vector<ThingVerdict>& things) {
  RecognitionSums sums;
  std::vector<double> errors, errors_B, turns;
  for (const ThingVerdict& thing : things) {
    ++sums.num_things;
    ++(thing.is_known() ? sums.num_known : sums.num_unknown);
    if (!thing.is_found()) continue;
    ++sums.num_found;
    ++(thing.is_known() ? sums.num_known_found : sums.num_unknown_found);
    if (!thing.is_right()) continue;
    ++(thing.is_known() ? sums.num_named : sums.num_unknown_so_called);
    if (thing.is_known()) {
      sums.num_own_label += thing.label == thing.model ? 1 : 0;
      errors.push_back(thing.error);
      errors_B.push_back(thing.error_B);
    }
    if (thing.turned_by) turns.push_back(*thing.turned_by);
  }
  sums.median_error = Quantile(errors, 0.5);
  sums.error_95 = Quantile(errors, 0.95);
  sums.median_error_B = Quantile(errors_B, 0.5);
  sums.error_B_95 = Quantile(errors_B, 0.95);
  sums.median_turn = Quantile(turns, 0.5);
  sums.boxes = BoxSumsOf(things);
  return sums;
}

std::string Text(const RecognitionScore& score) {
  const RecognitionSums sums = SumsOf(score.things());
  std::string text = fmt::format(
      "found {} of {}, named {} of {}, unknown as such {} of {}, surplus {} of {}, median error "
      "{:.1f} mm",
      sums.num_found, sums.num_things, sums.num_named, sums.num_known, sums.num_unknown_so_called,
      sums.num_unknown, score.num_surplus(), score.num_detections(), 1e3 * sums.median_error);
  for (const ThingVerdict& thing : score.things()) {
    if (thing.is_found() && !thing.is_right())
      text += fmt::format("; {} called {}", thing.kind, thing.called);
  }
  return text;
}

}  // namespace hires::perception
