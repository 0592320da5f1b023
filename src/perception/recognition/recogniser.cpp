#include "hires/perception/recogniser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/averages.h"
#include "hires/base/error.h"
#include "hires/perception/depth_sensor.h"
#include "perception/recognition/model_fit.h"
#include "perception/recognition/model_view.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;
using geometry::Pose3;

constexpr std::size_t kFitPoints = 200;  // of a thing that a model is fitted to
constexpr std::size_t kMostViewed = 6;   // shapes whose fit is best are looked at
constexpr double kBelowTop = 0.98;       // of a thing's points, below its top
constexpr double kMinSize = 0.005;       // [m] of an unknown thing's box
// [m] sd of depth, that of 3.5 m, where the camera's range ends and nine of ten names are right:
// with more any model of about the size lies within the noise, and the best of them is a guess.
constexpr double kMostNoise = 0.02;

/// Table T in the cloud's frame C: z upwards from its plane.
Pose3 FrameOf(const Table& table) {
  Eigen::Matrix3d rotation;
  rotation << table.along_x, table.along_y, table.normal;
  return {-table.offset * table.normal, Eigen::Quaterniond(rotation)};
}

struct Thing {
  int label{0};
  std::vector<Vector3d> p_T{};  ///< of all its points
  ThingPoints sample{};
  PixelWindow window{};
};

/// A shape of the catalogue where it fits the thing best.
struct Candidate {
  const ModelShape* shape{nullptr};
  ModelPose pose{};
  ModelView view{};
};

std::vector<Thing> ThingsOf(const LabelledPicture& seen, int num_things, const Pose3& X_CT) {
  std::vector<Thing> things(num_things);
  const Pose3 X_TC = X_CT.Inverse();
  const Eigen::Matrix3d R_TC = X_TC.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < seen.labels.size(); ++i) {
    if (seen.labels[i] < kLabelFirstThing) continue;
    Thing& thing = things[seen.labels[i] - kLabelFirstThing];
    thing.label = seen.labels[i];
    const Vector3d p_C = seen.cloud.points[i].cast<double>();
    thing.p_T.push_back(R_TC * p_C + X_TC.translation);
    thing.sample.sd.push_back(DepthNoise(p_C.z()));
    thing.window.Include(seen.picture.Project(p_C));
  }
  for (Thing& thing : things) {  // every n-th
    const std::size_t step = thing.p_T.size() / kFitPoints + 1;
    for (std::size_t i = 0; i < thing.p_T.size(); i += step) {
      thing.sample.p_T.push_back(thing.p_T[i]);
      thing.sample.sd[i / step] = thing.sample.sd[i];
    }
    thing.sample.sd.resize(thing.sample.p_T.size());
  }
  return things;
}

Pose3 PoseOf(const Candidate& candidate, const Pose3& X_CT) {
  return X_CT * geometry::Lift(candidate.pose.X_TO, candidate.shape->foot);
}

/// That of all its models; none where they differ: nothing that is seen tells them apart.
std::string CategoryOf(const ModelShape& shape) {
  const std::string& first = shape.models.front().category;
  const bool is_one = std::all_of(shape.models.begin(), shape.models.end(),
                                  [&](const KnownModel& one) { return one.category == first; });
  return is_one ? first : "";
}

Detection Unknown(const Thing& thing, const Pose3& X_CT) {
  const Footprint print = FootprintOf(thing.p_T);
  std::vector<double> heights;
  for (const Vector3d& p : thing.p_T) heights.push_back(p.z());
  const auto top = heights.begin() + static_cast<long>(kBelowTop * (heights.size() - 1));
  std::nth_element(heights.begin(), top, heights.end());
  Detection detection;
  detection.label = kUnknownLabel;
  detection.X_CO = X_CT * geometry::Lift(print.X_TF);
  detection.size = Vector3d(print.length, print.width, *top).cwiseMax(kMinSize);
  return detection;
}

}  // namespace

struct Recogniser::Impl {
  std::vector<Candidate> Compare(const LabelledPicture& seen, const Thing& thing,
                                 const Pose3& X_CT) const;
  Detection Detect(const LabelledPicture& seen, const Thing& thing, const Pose3& X_CT) const;
  void Name(const std::vector<Candidate>& candidates, Detection* detection) const;
  Recognition Named(const PointCloud& cloud, Segmentation segmentation) const;

  RecogniserParams params;
  std::vector<ModelShape> shapes;
};

/// @return the shapes that fit, best view first.
std::vector<Candidate> Recogniser::Impl::Compare(const LabelledPicture& seen, const Thing& thing,
                                                 const Pose3& X_CT) const {
  const Footprint footprint = FootprintOf(thing.sample.p_T);
  std::vector<Candidate> candidates;
  for (const ModelShape& shape : shapes)
    candidates.push_back({&shape, FitModel(shape, thing.sample, footprint), {}});
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.pose.misfit < b.pose.misfit; });
  candidates.resize(std::min(candidates.size(), kMostViewed));
  for (Candidate& one : candidates)
    one.view = CompareView(seen, thing.label, thing.window, *one.shape->field, PoseOf(one, X_CT));
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.view.quality > b.view.quality; });
  return candidates;
}

/// Each shape weighs exp(sharpness * quality), as does the unknown one of the least quality that
/// counts; models of one shape share its confidence.
void Recogniser::Impl::Name(const std::vector<Candidate>& candidates, Detection* detection) const {
  const auto weight = [&](double quality) {
    return std::exp(params.sharpness * (quality - params.min_quality));
  };
  double sum = weight(params.min_quality);
  for (const Candidate& one : candidates) sum += weight(one.view.quality);
  std::vector<LabelConfidence> names;
  for (const Candidate& one : candidates) {
    const auto& models = one.shape->models;
    for (const KnownModel& known : models)
      names.push_back({known.label, weight(one.view.quality) / sum / models.size()});
  }
  detection->confidence = names.front().confidence;
  names.erase(names.begin());
  names.push_back({kUnknownLabel, weight(params.min_quality) / sum});
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return a.confidence > b.confidence; });
  constexpr double kWorthSaying = 0.01;
  for (const LabelConfidence& name : names)
    if (name.confidence >= kWorthSaying) detection->alternatives.push_back(name);
}

Detection Recogniser::Impl::Detect(const LabelledPicture& seen, const Thing& thing,
                                   const Pose3& X_CT) const {
  const bool is_too_far = base::Mean(thing.sample.sd) > kMostNoise;
  std::vector<Candidate> candidates;
  if (!is_too_far) candidates = Compare(seen, thing, X_CT);
  Detection detection;
  if (candidates.empty() || candidates.front().view.quality < params.min_quality) {
    detection = Unknown(thing, X_CT);
    if (!candidates.empty() && candidates.front().view.quality > 0.0) {
      detection.nearest_label = candidates.front().shape->models.front().label;
      detection.nearest_quality = candidates.front().view.quality;
    }
  } else {
    const Candidate& best = candidates.front();
    detection.label = best.shape->models.front().label;
    detection.category = CategoryOf(*best.shape);
    detection.X_CO = PoseOf(best, X_CT);
    detection.visible_share = best.view.visible_share;
    detection.size = best.shape->field->bounds().upper - best.shape->field->bounds().lower;
    Name(candidates, &detection);
  }
  detection.num_points = static_cast<int>(thing.p_T.size());
  detection.is_too_far = is_too_far;
  return detection;
}

Recognition Recogniser::Impl::Named(const PointCloud& cloud, Segmentation segmentation) const {
  Recognition out;
  out.segmentation = std::move(segmentation);
  const auto picture = PictureOf(cloud);
  if (!out.segmentation.table || !picture) return out;
  const LabelledPicture seen{cloud, *picture, out.segmentation.labels};
  const Pose3 X_CT = FrameOf(*out.segmentation.table);
  for (const Thing& thing : ThingsOf(seen, out.segmentation.num_things, X_CT)) {
    out.detections.push_back(Detect(seen, thing, X_CT));
    out.detections.back().may_be_beside =
        out.segmentation.may_be_beside.at(thing.label - kLabelFirstThing);
  }
  return out;
}

std::vector<KnownModel> NoLargerThan(double max_extent, const std::vector<KnownModel>& catalogue) {
  std::vector<KnownModel> usable;
  for (const KnownModel& known : catalogue) {
    geometry::Aabb bounds;
    for (const geometry::Collision& one : known.model->collisions)
      bounds.Include(geometry::BoundsOf(one.shape, one.X_BS));
    if ((bounds.upper - bounds.lower).maxCoeff() <= max_extent) usable.push_back(known);
  }
  return usable;
}

Recogniser::Recogniser(const std::vector<KnownModel>& catalogue, const RecogniserParams& params) {
  std::set<std::string> labels;
  for (const KnownModel& known : catalogue) {
    if (!labels.insert(known.label).second) {
      throw base::ConfigError(
          fmt::format("the catalogue has two models that are called '{}'; give one of them another "
                      "label",
                      known.label));
    }
  }
  impl_ = std::make_unique<Impl>(
      Impl{params, ShapesOfCatalogue(NoLargerThan(params.max_extent, catalogue))});
}
Recogniser::~Recogniser() = default;
Recogniser::Recogniser(Recogniser&&) noexcept = default;
Recogniser& Recogniser::operator=(Recogniser&&) noexcept = default;

Recognition Recogniser::Recognise(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                                  const base::Rng& rng) const {
  return impl_->Named(cloud, SegmentTabletop(cloud, stand, impl_->params.segmentation, rng));
}

Recognition Recogniser::RecogniseOn(const Table& plate, const PointCloud& cloud,
                                    const base::Rng& rng) const {
  const SegmentationParams& params = impl_->params.segmentation;
  return impl_->Named(cloud, SegmentOn(PlateIn(cloud, plate, params.table), cloud, params, rng));
}

bool Recogniser::AreAlike(const std::string& label, const std::string& other) const {
  const auto is_in = [](const ModelShape& shape, const std::string& wanted) {
    return std::any_of(shape.models.begin(), shape.models.end(),
                       [&](const KnownModel& one) { return one.label == wanted; });
  };
  return label == other ||
         std::any_of(impl_->shapes.begin(), impl_->shapes.end(), [&](const ModelShape& shape) {
           return is_in(shape, label) && is_in(shape, other);
         });
}

}  // namespace hires::perception
