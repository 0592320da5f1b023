#include "cli/verbs/recognise/recognise_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/averages.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/report_output.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/perception/pcd_file.h"
#include "hires/perception/recogniser_config.h"
#include "reports/text/report_json.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;
using perception::Detection;
using perception::Recognition;

constexpr std::uint64_t kSeed = 1;  // of the planes that are tried

ordered_json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// [m] of the smallest rectangle along the axes of the plane.
Eigen::Array2d ExtentOf(const geometry::Polygon& outline) {
  Eigen::Array2d lower = outline.front(), upper = lower;
  for (const Eigen::Vector2d& corner : outline) {
    lower = lower.min(corner.array());
    upper = upper.max(corner.array());
  }
  return upper - lower;
}

ordered_json TableToJson(const perception::Table& table, long num_points, int num_left_out) {
  ordered_json outline = ordered_json::array();
  for (const Eigen::Vector2d& corner : table.outline) outline.push_back(ToJson(table.Lift(corner)));
  return {{"normal", ToJson(table.normal)},
          {"distance", table.offset},
          {"points", num_points},
          {"left_out", num_left_out},
          {"outline", outline}};
}

ordered_json ThingToJson(const Detection& thing, int label, bool is_segmenting) {
  const Eigen::Quaterniond& q = thing.X_CO.rotation;
  ordered_json json{{"label", label},
                    {"points", thing.num_points},
                    {"position", ToJson(thing.X_CO.translation)},
                    {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                    {"size", ToJson(thing.size)},
                    {"may_be_beside", thing.may_be_beside}};
  if (is_segmenting) return json;
  ordered_json alternatives = ordered_json::array();
  for (const auto& other : thing.alternatives)
    alternatives.push_back({{"kind", other.label}, {"confidence", other.confidence}});
  json["kind"] = thing.label;
  json["category"] = thing.category;
  const bool is_unknown = thing.label == perception::kUnknownLabel;
  json["confidence"] = is_unknown ? ordered_json() : ordered_json(thing.confidence);
  json["visible_share"] = is_unknown ? ordered_json() : ordered_json(thing.visible_share);
  json["alternatives"] = alternatives;
  if (!thing.nearest_label.empty()) {
    json["nearest"] = {{"kind", thing.nearest_label}, {"quality", thing.nearest_quality}};
  }
  json["too_far"] = thing.is_too_far;
  return json;
}

ordered_json ToJson(const Recognition& seen, const RecogniseOptions& options) {
  const auto& labels = seen.segmentation.labels;
  ordered_json things = ordered_json::array();
  for (std::size_t i = 0; i < seen.detections.size(); ++i) {
    things.push_back(ThingToJson(seen.detections[i],
                                 perception::kLabelFirstThing + static_cast<int>(i),
                                 options.is_segmenting));
  }
  ordered_json table = nullptr;
  if (seen.segmentation.table) {
    table = TableToJson(*seen.segmentation.table,
                        std::count(labels.begin(), labels.end(), perception::kLabelTable),
                        seen.segmentation.num_left_out);
  }
  return {{"schema", "hires/recognition"}, {"version", 2},   {"cloud", options.cloud},
          {"points", labels.size()},       {"table", table}, {"things", things}};
}

std::string KindText(const Detection& thing) {
  if (!thing.nearest_label.empty()) {
    return fmt::format("{} (nearest: {}, quality {:.2f})", thing.label, thing.nearest_label,
                       thing.nearest_quality);
  }
  if (thing.is_too_far) return thing.label + " (too far away to be named)";
  if (thing.label == perception::kUnknownLabel) return thing.label;
  std::string text = fmt::format("{} {:.2f}", thing.label, thing.confidence);
  constexpr std::size_t kMost = 2;
  for (std::size_t i = 0; i < std::min(kMost, thing.alternatives.size()); ++i)
    text +=
        fmt::format(", {} {:.2f}", thing.alternatives[i].label, thing.alternatives[i].confidence);
  return text;
}

/// What is not sure, and what was left out.
std::string DoubtText(const Recognition& seen) {
  std::vector<std::string> unsure;
  for (std::size_t i = 0; i < seen.detections.size(); ++i)
    if (seen.detections[i].may_be_beside)
      unsure.push_back(std::to_string(perception::kLabelFirstThing + i));
  std::string text;
  constexpr double kStraightOn = 0.955;  // cosine
  if (seen.segmentation.table && -seen.segmentation.table->normal.z() > kStraightOn)
    text += "it is seen from straight above: a wall before the camera would look the same\n";
  if (seen.segmentation.table && seen.segmentation.table->noise > 1.0) {
    text += fmt::format(
        "its points scatter {:.1f} times as much as a Kinect's: things may be in pieces or "
        "missing\n",
        seen.segmentation.table->noise);
  }
  if (!unsure.empty()) {
    text += fmt::format("may be beside the table, which is hidden about them: {}\n",
                        base::Join(unsure, ", "));
  }
  if (seen.segmentation.num_left_out > 0) {
    text += fmt::format("{} points above the table or just beside it are of no thing\n",
                        seen.segmentation.num_left_out);
  }
  return text;
}

/// Whether over the table there is as much as a thing has, and none is told.
bool IsUntold(const Recognition& seen, int min_points) {
  return seen.segmentation.num_over >= min_points;
}

std::string UntoldText(const Recognition& seen) {
  return fmt::format(
      "{} points over it tell no thing: they are too few for their distance, or scatter too much; "
      "take a cloud from nearer, or one with more points\n",
      seen.segmentation.num_over);
}

std::string TableText(const Recognition& seen, const RecogniseOptions& options, bool is_untold) {
  if (!seen.segmentation.table) return "no table is seen\n";
  const perception::Table& table = *seen.segmentation.table;
  const Eigen::Array2d extent = ExtentOf(table.outline);
  std::string text =
      fmt::format("table {:.2f} m below the camera, {:.2f} m x {:.2f} m of it seen; {} on it\n",
                  table.offset, extent.maxCoeff(), extent.minCoeff(),
                  is_untold                     ? std::string("it cannot be told what is")
                  : seen.detections.empty()     ? std::string("nothing")
                  : seen.detections.size() == 1 ? std::string("one thing")
                                                : fmt::format("{} things", seen.detections.size()));
  if (is_untold) text += UntoldText(seen);
  text += DoubtText(seen);
  if (seen.detections.empty()) return text;
  std::vector<std::vector<std::string>> rows{
      {"label", "kind", "x [m]", "y [m]", "z [m]", "size [m]", "points"}};
  for (std::size_t i = 0; i < seen.detections.size(); ++i) {
    const Detection& thing = seen.detections[i];
    const Eigen::Vector3d& p = thing.X_CO.translation;
    rows.push_back(
        {std::to_string(perception::kLabelFirstThing + i), KindText(thing),
         fmt::format("{:.3f}", p.x()), fmt::format("{:.3f}", p.y()), fmt::format("{:.3f}", p.z()),
         fmt::format("{:.3f} x {:.3f} x {:.3f}", thing.size.x(), thing.size.y(), thing.size.z()),
         std::to_string(thing.num_points)});
  }
  if (options.is_segmenting)
    for (auto& row : rows) row.erase(row.begin() + 1);
  return text + reports::FormatTable(rows);
}

/// Other than one in which nothing was measured: there was nothing to look at.
void CheckHasPoints(const perception::PointCloud& cloud, const std::string& path) {
  if (!cloud.points.empty()) return;
  throw base::ConfigError(fmt::format(
      "{}: is an empty cloud, of no points; wanted one with points: record it again while the "
      "camera sends clouds",
      path));
}

/// No depth camera measures as far; a cloud in millimetres says so by that.
void CheckUnit(const perception::PointCloud& cloud, const std::string& path) {
  constexpr float kFarthest = 20.0F;      // [m] in the median; tables stand nearer
  constexpr float kCentimetres = 300.0F;  // up to 3 m, else 0.3 m and more in millimetres
  std::vector<float> depths;
  for (const Eigen::Vector3f& p_C : cloud.points) {
    if (perception::IsMeasured(p_C)) depths.push_back(p_C.z());
  }
  if (depths.empty()) return;
  const float middle = base::Median(depths);
  if (middle <= kFarthest) return;
  const bool is_centimetres = middle < kCentimetres;
  throw base::ConfigError(fmt::format(
      "{}: half of its points are farther than {:.0f} away; wanted metres: are these {}? Divide "
      "them by {}",
      path, middle, is_centimetres ? "centimetres" : "millimetres", is_centimetres ? 100 : 1000));
}

}  // namespace

void AddRecogniseVerb(CLI::App* app, RecogniseOptions* o) {
  CLI::App* verb = app->add_subcommand(
      "recognise", "what stands on the table in a depth camera's cloud (.pcd, optical frame)");
  verb->add_option("cloud", o->cloud, "point cloud, format .pcd, organised or not")->required();
  verb->add_option("--json", o->json,
                   "write table and things to this file; - : print them instead");
  verb->add_option(
      "--labels", o->labels,
      "write the cloud with a field `label` to this file (.pcd): 0 nothing measured or "
      "nothing on the table, 1 the table, 2, 3, ... things");
  verb->add_flag("--segment-only", o->is_segmenting, "tell things apart, but do not name them");
  verb->add_option("--objects", o->objects, "another catalogue of objects (YAML)");
  verb->add_option("--config", o->config, "another file instead of config/recogniser.yaml");
  o->verb = verb;
}

int RunRecogniseVerb(const RecogniseOptions& options, const std::string& package_folder) {
  const std::string config_path =
      options.config.empty() ? package_folder + "/config/recogniser.yaml" : options.config;
  CheckOutputs(
      {{"--json", options.json, true}, {"--labels", options.labels}},
      {{"cloud", options.cloud}, {"objects", options.objects}, {"configuration", config_path}});
  perception::RecogniserConfig config =
      perception::ReadRecogniserConfig(config_path, options.objects);
  if (options.is_segmenting) config.catalogue.clear();
  perception::PointCloud cloud = perception::ReadPcd(options.cloud);
  CheckHasPoints(cloud, options.cloud);
  const std::string why = perception::TakeOnlyAhead(&cloud);
  if (!why.empty()) {
    throw base::ConfigError(fmt::format(
        "{}: {}: transform its points; from the camera's place, with x forward, y left and z up, "
        "they are (-y, -z, x). A VIEWPOINT in the file is not applied",
        options.cloud, why));
  }
  CheckUnit(cloud, options.cloud);
  const perception::Recogniser recogniser(config.catalogue, config.params);
  const Recognition seen = recogniser.Recognise(cloud, std::nullopt, base::Rng(kSeed));
  const bool is_untold = IsUntold(seen, config.params.segmentation.parts.min_points);
  const bool is_measured =
      std::any_of(cloud.points.begin(), cloud.points.end(), perception::IsMeasured);
  if (options.json == "-") {
    std::cout << ToJson(seen, options).dump(2) << '\n';
  } else {
    std::cout << (is_measured ? "" : "no point of the cloud was measured: ")
              << TableText(seen, options, is_untold);
  }
  if (!options.json.empty() && options.json != "-")
    reports::WriteJson(ToJson(seen, options), options.json);
  if (!options.labels.empty())
    perception::WriteLabelledPcd(cloud, seen.segmentation.labels, options.labels);
  if (options.json != "-") SaySaved({options.json, options.labels});  // else it would be no JSON
  return seen.segmentation.table && !is_untold ? kExitRecommended : kExitUndecided;
}

}  // namespace hires::cli
