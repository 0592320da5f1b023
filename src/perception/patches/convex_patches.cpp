#include "perception/patches/convex_patches.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace hires::perception {
namespace {

// PCL has all that is used here compiled for it; the colours stay black.
using PclPoint = pcl::PointXYZRGBA;
using PclCloud = pcl::PointCloud<PclPoint>;

constexpr double kDegrees = 57.29577951308232;  // of a radian
constexpr double kInFold = 0.8;                 // of a patch's supervoxels; then it is no surface

PclCloud::Ptr ToPcl(const std::vector<Eigen::Vector3f>& points, int width, int height,
                    const std::vector<int>& indices) {
  auto out = std::make_shared<PclCloud>(width, height);
  out->is_dense = false;
  for (PclPoint& point : out->points)
    point.getVector3fMap().setConstant(std::numeric_limits<float>::quiet_NaN());
  for (const int i : indices) out->points[i].getVector3fMap() = points[i];
  return out;
}

using Supervoxels = std::map<std::uint32_t, pcl::Supervoxel<PclPoint>::Ptr>;
using Neighbours = std::multimap<std::uint32_t, std::uint32_t>;  // of supervoxels
using Patches = std::map<std::uint32_t, std::uint32_t>;          // of each supervoxel

// PCL numbers patches, and gives small ones to their neighbours, in the order in which they lie in
// memory. Here a patch is called as its first supervoxel is.
Patches NumberedBySupervoxels(const Patches& patches) {
  std::map<std::uint32_t, std::uint32_t> first;
  Patches out;
  for (const auto& [supervoxel, patch] : patches)
    out[supervoxel] = first.emplace(patch, supervoxel).first->second;
  return out;
}

std::map<std::uint32_t, std::vector<std::uint32_t>> MembersOf(const Patches& patches) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> members;
  for (const auto& [supervoxel, patch] : patches) members[patch].push_back(supervoxel);
  return members;
}

Eigen::Vector3f NormalOf(const pcl::Supervoxel<PclPoint>& one) {
  return one.normal_.getNormalVector3fMap();
}

bool IsConcave(const pcl::Supervoxel<PclPoint>& a, const pcl::Supervoxel<PclPoint>& b) {
  const Eigen::Vector3f way = a.centroid_.getVector3fMap() - b.centroid_.getVector3fMap();
  return way.dot(NormalOf(a) - NormalOf(b)) < 0.0F;
}

// A supervoxel across a concave edge has points of both sides, and a normal between theirs.
// Returns the patch of the side that it is more alike, larger than its own; its own: it lies in
// none.
std::uint32_t SideOfFold(std::uint32_t one, const Patches& patches, const Supervoxels& supervoxels,
                         const Neighbours& neighbours,
                         const std::map<std::uint32_t, std::vector<std::uint32_t>>& members) {
  const pcl::Supervoxel<PclPoint>& own = *supervoxels.at(one);
  const std::size_t size = members.at(patches.at(one)).size();
  std::vector<std::pair<float, std::uint32_t>> sides;  // likeness of a neighbour, itself
  const auto range = neighbours.equal_range(one);
  for (auto it = range.first; it != range.second; ++it) {
    const pcl::Supervoxel<PclPoint>& other = *supervoxels.at(it->second);
    const float likeness = NormalOf(own).dot(NormalOf(other));
    const bool is_larger = members.at(patches.at(it->second)).size() > size;
    if (is_larger && IsConcave(own, other) && std::isfinite(likeness))
      sides.emplace_back(-likeness, it->second);
  }
  std::sort(sides.begin(), sides.end());
  for (const auto& [unlikeness, a] : sides) {
    for (const auto& [unlikeness_b, b] : sides) {
      const float between = NormalOf(*supervoxels.at(a)).dot(NormalOf(*supervoxels.at(b)));
      if (patches.at(a) != patches.at(b) && between < -std::max(unlikeness, unlikeness_b))
        return patches.at(a);
    }
  }
  return patches.at(one);
}

// Strings of such supervoxels are given to the two sides, the smallest first.
Patches WithoutFolds(Patches patches, const Supervoxels& supervoxels,
                     const Neighbours& neighbours) {
  auto members = MembersOf(patches);
  std::vector<std::uint32_t> order;
  for (const auto& [patch, unused] : members) order.push_back(patch);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return members.at(a).size() < members.at(b).size();
  });
  for (const std::uint32_t patch : order) {
    std::map<std::uint32_t, std::uint32_t> sides;
    for (const std::uint32_t one : members.at(patch)) {
      const std::uint32_t side = SideOfFold(one, patches, supervoxels, neighbours, members);
      if (side != patch) sides[one] = side;
    }
    if (static_cast<double>(sides.size()) < kInFold * members.at(patch).size()) continue;
    for (const std::uint32_t one : members.at(patch)) {
      const auto side = sides.find(one);
      const std::uint32_t into = side == sides.end() ? sides.begin()->second : side->second;
      patches[one] = into;
      members.at(into).push_back(one);
    }
    members.erase(patch);
  }
  return patches;
}

// The largest patch beside one; itself where it is alone. Of equal ones the lowest.
std::uint32_t LargestBeside(std::uint32_t patch, const std::vector<std::uint32_t>& members,
                            const Patches& patches, const Neighbours& neighbours,
                            const std::map<std::uint32_t, std::vector<std::uint32_t>>& all) {
  std::set<std::uint32_t> beside;
  for (const std::uint32_t one : members) {
    const auto range = neighbours.equal_range(one);
    for (auto it = range.first; it != range.second; ++it) beside.insert(patches.at(it->second));
  }
  beside.erase(patch);
  const auto largest = std::max_element(beside.begin(), beside.end(), [&](auto a, auto b) {
    return all.at(a).size() < all.at(b).size();
  });
  return largest == beside.end() ? patch : *largest;
}

// Smaller patches become their largest neighbour's.
Patches WithoutSmall(Patches patches, const Neighbours& neighbours, std::size_t least) {
  auto all = MembersOf(patches);
  for (auto it = all.begin(); it != all.end();) {
    const std::uint32_t into = it->second.size() < least
                                   ? LargestBeside(it->first, it->second, patches, neighbours, all)
                                   : it->first;
    if (into == it->first) {
      ++it;
      continue;
    }
    for (const std::uint32_t one : it->second) patches[one] = into;
    all[into].insert(all[into].end(), it->second.begin(), it->second.end());
    it = all.erase(it);
  }
  return patches;
}

}  // namespace

std::vector<int> FindConvexPatches(const std::vector<Eigen::Vector3f>& points, int width,
                                   int height, const std::vector<int>& indices,
                                   const PatchParams& params) {
  std::vector<int> patch(points.size(), 0);
  if (indices.empty()) return patch;
  const auto voxel = static_cast<float>(params.voxel), seed = static_cast<float>(params.seed);
  pcl::SupervoxelClustering<PclPoint> clustering(voxel, seed);
  clustering.setUseSingleCameraTransform(true);  // PCL's default for organised clouds alone
  clustering.setInputCloud(ToPcl(points, width, height, indices));
  clustering.setColorImportance(0.0F);
  clustering.setSpatialImportance(1.0F);  // this and the next as in PCL's example of LCCP
  clustering.setNormalImportance(4.0F);
  Supervoxels supervoxels;
  clustering.extract(supervoxels);
  Neighbours neighbours;
  clustering.getSupervoxelAdjacency(neighbours);
  pcl::LCCPSegmentation<PclPoint> lccp;
  lccp.setConcavityToleranceThreshold(static_cast<float>(params.max_concavity * kDegrees));
  lccp.setSanityCheck(true);
  lccp.setSmoothnessCheck(true, voxel, seed, static_cast<float>(params.max_step));
  lccp.setInputSupervoxels(supervoxels, neighbours);
  lccp.segment();
  Patches patches;
  lccp.getSupervoxelToSegmentMap(patches);
  patches = WithoutFolds(NumberedBySupervoxels(patches), supervoxels, neighbours);
  patches = WithoutSmall(patches, neighbours, static_cast<std::size_t>(params.min_supervoxels));
  const auto labelled = clustering.getLabeledCloud();
  for (const int i : indices) {
    const auto found = patches.find(labelled->points[i].label);
    patch[i] = found == patches.end() ? 0 : static_cast<int>(found->second);
  }
  return patch;
}

}  // namespace hires::perception
