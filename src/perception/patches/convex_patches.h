#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::perception {

struct PatchParams {
  double voxel;          ///< [m] 1 m away; it grows with the distance, as does noise
  double seed;           ///< [m] between the middles of supervoxels, likewise
  double max_concavity;  ///< [rad] by which two supervoxels may lean towards each other
  double max_step;       ///< [voxels] between supervoxels that still hang together
  int min_supervoxels;   ///< of a patch; smaller ones become their neighbour's
};

/// Patches of a surface that no concave edge divides: PCL's supervoxels
/// [pcl::SupervoxelClustering] and locally convex connected patches of them
/// [pcl::LCCPSegmentation; Stein, Schoeler, Papon, Woergoetter 2014, "Object Partitioning Using
/// Local Convexity", CVPR], without colours, which our clouds do not have. Where two things touch,
/// their surfaces meet in a concave edge. Supervoxels across such an edge are no patch between
/// them. The same points give the same patches: nothing is drawn,
/// and one thread does it.
/// @param points   [m] in the camera's frame, ahead of it, `height` rows of `width`; one row: not
/// organised.
/// @param indices  of the points that count; all of them measured.
/// @return patch of each point, 1, 2, ...; 0: it is in none.
/// @throws base::ConfigError in programs that are built without PCL.
std::vector<int> FindConvexPatches(const std::vector<Eigen::Vector3f>& points, int width,
                                   int height, const std::vector<int>& indices,
                                   const PatchParams& params);

}  // namespace hires::perception
