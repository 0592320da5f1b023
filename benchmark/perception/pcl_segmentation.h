#pragma once

#include "hires/perception/point_cloud.h"
#include "hires/perception/segmentation.h"

namespace hires::perception {

/// PCL's plane, by RANSAC over all points [pcl::SACSegmentation], refined by least squares, and its
/// Euclidean clusters [pcl::EuclideanClusterExtraction] of what is above it.
struct PclClusterParams {
  double plane_tolerance{0.01};  ///< [m] to either side, within which a point is the plane's
  int max_iterations{10000};     ///< of RANSAC, which stops before when 0.99 sure of the plane
  double max_gap{0.02};          ///< [m] between neighbours within a cluster
  int min_points{100};           ///< of a cluster
};

/// PCL's locally convex connected patches [pcl::LCCPSegmentation; Stein, Schoeler, Papon,
/// Woergoetter 2014, "Object Partitioning using Local Convexity", CVPR] of the whole cloud, which
/// needs no plane: a table is a patch as well. Without colours, which our clouds do not have.
struct PclPatchParams {
  double voxel{0.005};  ///< [m] 1 m away; as PCL takes organised clouds, it grows with the distance
  double seed{0.02};    ///< [m] between the middles of supervoxels, likewise
  double max_concavity{10.0};  ///< [deg], as PCL takes it
  double max_step{0.1};        ///< [voxels] between supervoxels that still hang together
  int min_supervoxels{3};      ///< of a patch; smaller ones become their neighbour's
};

/// @return labels as SegmentTabletop gives them; the table without its outline, and nothing where
/// no plane is found.
Segmentation SegmentByPclClusters(const PointCloud& cloud, const PclClusterParams& params);

/// @return labels as SegmentTabletop gives them, without a table.
Segmentation SegmentByPclPatches(const PointCloud& cloud, const PclPatchParams& params);

}  // namespace hires::perception
