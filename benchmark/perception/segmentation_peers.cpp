// Scores and processor times of our segmentation and of PCL's on a folder of labelled scenes, a
// line of JSON for each scene; benchmark/perception/compare_with_pcl makes tables of them.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "hires/base/resource_use.h"
#include "hires/base/rng.h"
#include "hires/perception/segmentation.h"
#include "perception/pcl_segmentation.h"
#include "perception/support/segmentation_score.h"
#include "perception/support/tabletop_scenes.h"

namespace hires::perception {
namespace {

struct Method {
  std::string name;
  std::function<Segmentation(const PointCloud&)> segment;
  bool finds_tables;
};

std::vector<Method> Methods(std::uint64_t seed) {
  const PclPatchParams fine;
  PclPatchParams coarse;
  coarse.voxel = 0.0075;
  coarse.seed = 0.03;
  const auto patches = [](const PclPatchParams& params) {
    return [params](const PointCloud& cloud) { return SegmentByPclPatches(cloud, params); };
  };
  return {{"ours",
           [seed](const PointCloud& cloud) {
             return SegmentTabletop(cloud, std::nullopt, {}, base::Rng(seed));
           },
           true},
          {"PCL Euclidean", [](const PointCloud& cloud) { return SegmentByPclClusters(cloud, {}); },
           true},
          {"PCL LCCP 0.005/0.02", patches(fine), false},
          {"PCL LCCP 0.0075/0.03", patches(coarse), false}};
}

struct SceneName {
  std::string name;
  int number;
};

std::vector<SceneName> ScenesIn(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(folder + ": is no folder; name that of the scenes' pictures");
  static const std::regex kDepth("([A-Za-z_]+)([0-9]{1,6})_depth\\.png");
  std::vector<SceneName> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::smatch match;
    const std::string file = entry.path().filename().string();
    if (std::regex_match(file, match, kDepth))
      scenes.push_back({match[1].str() + match[2].str(), std::stoi(match[2].str())});
  }
  if (scenes.empty()) {
    throw std::runtime_error(
        folder +
        ": has no picture called NAME<number>_depth.png; name a folder that is "
        "laid out as ../shared/data/tabletop/learn");
  }
  std::sort(scenes.begin(), scenes.end(), [](const SceneName& a, const SceneName& b) {
    return a.number != b.number ? a.number < b.number : a.name < b.name;
  });
  return scenes;
}

std::string KindOf(const SceneName& scene) {
  const auto is_called = [&](const char* name) { return scene.name.rfind(name, 0) == 0; };
  std::vector<test_support::TabletopKind> kinds;
  if (is_called("learn")) kinds = test_support::kTabletopKinds;
  if (is_called("test")) kinds = test_support::kTabletopTestKinds;
  for (const auto& kind : kinds)
    if (scene.number >= kind.first && scene.number <= kind.last) return kind.name;
  return "scenes";
}

nlohmann::json Try(const Method& method, const test_support::TabletopScene& scene) {
  const double begin = base::ThreadCpuSeconds();
  const Segmentation out = method.segment(scene.cloud);
  const double seconds = base::ThreadCpuSeconds() - begin;
  const auto score = test_support::ScoreOf(scene.truth, out.labels);
  nlohmann::json row{
      {"method", method.name},  {"points", score.num_points}, {"overlap", score.overlap},
      {"inside", score.inside}, {"outside", score.outside},   {"seconds", seconds},
      {"table_share", nullptr}, {"is_table_found", nullptr},  {"of_none", nullptr}};
  int of_things = 0, of_none = 0;
  for (std::size_t i = 0; i < out.labels.size(); ++i) {
    if (out.labels[i] < kLabelFirstThing || !IsMeasured(scene.cloud.points[i])) continue;
    ++(scene.truth[i] < 20 ? of_none : of_things);
  }
  if (method.finds_tables) {
    row["of_none"] = static_cast<double>(of_none) / std::max(1, of_none + of_things);
    const double share =
        out.table ? test_support::ShareOfTableNear(*out.table, test_support::kTableTolerance,
                                                   scene.cloud, scene.truth)
                  : 0.0;
    row["table_share"] = share;
    row["is_table_found"] = share >= test_support::kMinTableShare;
  }
  return row;
}

void CompareOn(const std::string& folder, std::uint64_t seed) {
  const std::vector<Method> methods = Methods(seed);
  const std::vector<SceneName> scenes = ScenesIn(folder);
  const auto read = [&](const SceneName& scene) {
    return test_support::ReadTabletopScene(folder + "/" + scene.name);
  };
  for (const Method& method : methods) Try(method, read(scenes.front()));  // warms up
  for (const SceneName& scene : scenes) {
    const auto pictures = read(scene);
    nlohmann::json row{{"scene", scene.name},
                       {"number", scene.number},
                       {"kind", KindOf(scene)},
                       {"num_scenes", scenes.size()},
                       {"methods", nlohmann::json::array()}};
    for (const Method& method : methods) row["methods"].push_back(Try(method, pictures));
    std::cout << row.dump() << std::endl;
  }
}

}  // namespace
}  // namespace hires::perception

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: " << argv[0] << " FOLDER [SEED]\n";
    return EXIT_FAILURE;
  }
  try {
    hires::perception::CompareOn(argv[1], argc > 2 ? std::stoull(argv[2]) : 1);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
