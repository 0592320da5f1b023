#include "perception/pcl_segmentation.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace hires::perception {
namespace {

// PCL has all that is used here compiled for it; the colours stay black.
using PclPoint = pcl::PointXYZRGBA;
using PclCloud = pcl::PointCloud<PclPoint>;

PclCloud::Ptr ToPcl(const PointCloud& cloud) {
  auto out = std::make_shared<PclCloud>(cloud.width, cloud.height);
  out->is_dense = false;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    out->points[i].getVector3fMap() = cloud.points[i];
  return out;
}

// With the camera, at the origin, above it.
std::optional<Table> FindPlane(const PclCloud::Ptr& cloud, const PclClusterParams& params) {
  pcl::SACSegmentation<PclPoint> plane;
  plane.setOptimizeCoefficients(true);
  plane.setModelType(pcl::SACMODEL_PLANE);
  plane.setMethodType(pcl::SAC_RANSAC);
  plane.setDistanceThreshold(params.plane_tolerance);
  plane.setMaxIterations(params.max_iterations);
  plane.setInputCloud(cloud);
  pcl::PointIndices on_it;
  pcl::ModelCoefficients found;
  plane.segment(on_it, found);
  if (on_it.indices.empty()) return std::nullopt;
  const Eigen::Vector4d coefficients =
      Eigen::Map<const Eigen::Vector4f>(found.values.data()).cast<double>() *
      (found.values[3] < 0.0F ? -1.0 : 1.0);
  Table table;
  table.normal = coefficients.head<3>();
  table.offset = coefficients[3];
  return table;
}

// Labels what is the table's.
pcl::Indices AboveTable(const PointCloud& cloud, double tolerance, Segmentation* out) {
  pcl::Indices above;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!IsMeasured(cloud.points[i])) continue;
    const double height = out->table->HeightOf(cloud.points[i].cast<double>());
    if (std::abs(height) <= tolerance) out->labels[i] = kLabelTable;
    if (height > tolerance) above.push_back(static_cast<int>(i));
  }
  return above;
}

std::vector<pcl::PointIndices> ClustersOf(const PclCloud::Ptr& cloud, const pcl::Indices& above,
                                          const PclClusterParams& params) {
  const auto indices = std::make_shared<pcl::Indices>(above);
  pcl::EuclideanClusterExtraction<PclPoint> extraction;
  extraction.setClusterTolerance(params.max_gap);
  extraction.setMinClusterSize(params.min_points);
  extraction.setSearchMethod(std::make_shared<pcl::search::KdTree<PclPoint>>());
  extraction.setInputCloud(cloud);
  extraction.setIndices(indices);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  return clusters;
}

// Their labels begin with 1; 0 is no patch.
pcl::PointCloud<pcl::PointXYZL>::Ptr PatchesOf(const PclCloud::Ptr& cloud,
                                               const PclPatchParams& params) {
  const auto voxel = static_cast<float>(params.voxel), seed = static_cast<float>(params.seed);
  pcl::SupervoxelClustering<PclPoint> clustering(voxel, seed);
  clustering.setInputCloud(cloud);
  clustering.setColorImportance(0.0F);
  clustering.setSpatialImportance(1.0F);  // this and the next as in PCL's example of LCCP
  clustering.setNormalImportance(4.0F);
  std::map<std::uint32_t, pcl::Supervoxel<PclPoint>::Ptr> supervoxels;
  clustering.extract(supervoxels);
  std::multimap<std::uint32_t, std::uint32_t> neighbours;
  clustering.getSupervoxelAdjacency(neighbours);
  pcl::LCCPSegmentation<PclPoint> patches;
  patches.setConcavityToleranceThreshold(static_cast<float>(params.max_concavity));
  patches.setSanityCheck(true);
  patches.setSmoothnessCheck(true, voxel, seed, static_cast<float>(params.max_step));
  patches.setMinSegmentSize(static_cast<std::uint32_t>(params.min_supervoxels));
  patches.setInputSupervoxels(supervoxels, neighbours);
  patches.segment();
  auto labelled = clustering.getLabeledCloud();
  patches.relabelCloud(*labelled);
  return labelled;
}

bool HasPoints(const PointCloud& cloud) {
  for (const Eigen::Vector3f& point : cloud.points)
    if (IsMeasured(point)) return true;
  return false;
}

}  // namespace

Segmentation SegmentByPclClusters(const PointCloud& cloud, const PclClusterParams& params) {
  Segmentation out;
  out.labels.assign(cloud.points.size(), kLabelNone);
  if (!HasPoints(cloud)) return out;
  const PclCloud::Ptr points = ToPcl(cloud);
  out.table = FindPlane(points, params);
  if (!out.table) return out;
  const pcl::Indices above = AboveTable(cloud, params.plane_tolerance, &out);
  if (above.empty()) return out;
  for (const pcl::PointIndices& cluster : ClustersOf(points, above, params)) {
    for (const int i : cluster.indices) out.labels[i] = kLabelFirstThing + out.num_things;
    ++out.num_things;
  }
  return out;
}

Segmentation SegmentByPclPatches(const PointCloud& cloud, const PclPatchParams& params) {
  Segmentation out;
  out.labels.assign(cloud.points.size(), kLabelNone);
  if (!HasPoints(cloud)) return out;
  const auto patches = PatchesOf(ToPcl(cloud), params);
  std::map<std::uint32_t, int> things;
  for (std::size_t i = 0; i < patches->size(); ++i) {
    const std::uint32_t patch = patches->points[i].label;
    if (patch == 0) continue;
    const int next = kLabelFirstThing + static_cast<int>(things.size());
    out.labels[i] = things.emplace(patch, next).first->second;
  }
  out.num_things = static_cast<int>(things.size());
  return out;
}

}  // namespace hires::perception
