#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/detector.h"
#include "hires/perception/point_cloud.h"
#include "hires/perception/segmentation.h"
#include "hires/world/world.h"

namespace hires::perception {

/// A kind of thing that a recogniser knows.
struct KnownModel {
  std::string label;
  std::string category;  ///< concept of the ontology; empty: none is known
  std::shared_ptr<const world::ObjectModel> model;
};

struct RecogniserParams {
  SegmentationParams segmentation{};
  double min_quality{0.8};  ///< of what is recognised: 1 the picture is just what it would be
  double sharpness{60.0};   ///< by what power a better quality speaks for a kind
  double max_extent{0.6};   ///< [m] larger models are no things on tables
};

/// Those whose box has no edge longer than that [m]: what a recogniser compares things with.
std::vector<KnownModel> NoLargerThan(double max_extent, const std::vector<KnownModel>& catalogue);

struct Recognition {
  Segmentation segmentation{};
  std::vector<Detection> detections{};  ///< in the cloud's frame; of the labels 2, 3, ...
};

/// Tells what stands on a table in a cloud of a depth camera: things are told apart
/// (SegmentTabletop), and each is compared with all models of a catalogue, standing upright. A
/// model is moved to where its surface is nearest to the thing's points; then the picture that the
/// camera would have of it there is compared with the cloud: points that lie elsewhere, and places
/// at which the camera looks through the model, speak against it; what something else hides speaks
/// for nothing. Models of one geometry share their confidence. What no model explains is `unknown`,
/// with its box; so is what is farther away than 3.5 m, where depths err by more than 0.02 m
/// (DepthNoise).
class Recogniser {
 public:
  /// @throws base::ConfigError for a catalogue with two models of one label.
  explicit Recogniser(const std::vector<KnownModel>& catalogue,
                      const RecogniserParams& params = {});
  ~Recogniser();
  Recogniser(Recogniser&&) noexcept;
  Recogniser& operator=(Recogniser&&) noexcept;

  /// @param stand  as FindTable takes it.
  Recognition Recognise(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                        const base::Rng& rng) const;
  /// The same on a plate whose place is known about, as PlateIn takes it.
  Recognition RecogniseOn(const Table& plate, const PointCloud& cloud, const base::Rng& rng) const;

  /// Whether nothing that measures distances tells the two kinds apart; each is alike itself.
  bool AreAlike(const std::string& label, const std::string& other) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace hires::perception
