#pragma once

#include "hires/perception/table.h"

namespace hires::perception {

struct SurfelParams {
  double cell{0.005};           ///< [m] edge of the grid's cells ...
  int many{8000};               ///< ... which grow where there would be more surfels than that
  double max_cell{0.007};       ///< [m] at the most
  double normal_radius{0.010};  ///< [m] of the neighbourhood that a normal is fitted to
  double border_radius{0.012};  ///< [m] surfels that are nearer border on each other
};

struct ConvexPartParams {
  double voxel{0.005};         ///< [m] 1 m away; it grows with the distance, as does noise
  double seed{0.025};          ///< [m] between the middles of supervoxels, likewise
  double max_concavity{0.21};  ///< [rad] by which two supervoxels may lean towards each other
  double max_step{0.1};        ///< [voxels] between supervoxels that still hang together
  int min_supervoxels{3};      ///< of a patch; smaller ones become their neighbour's
  int min_points{100};         ///< of a part
};

/// Sines by which surfels at most `border_radius` apart turn towards each other.
struct SmoothBorderParams {
  double max_concavity{0.25};  ///< along a border; more is an edge
  double share{0.8};           ///< of a border's pairs of surfels that are so
  double min_bend{-0.01};      ///< mean within a part that is no more than flat, but for noise
  int min_pairs{30};           ///< of surfels; shorter borders join nothing
};

struct PartJoiningParams {
  double min_inward{0.1};        ///< mean of what a wall's normals turn to its own middle: -1 .. 1
  double rim_tolerance{0.02};    ///< [m] between the upper ends of a hollow thing's two sides
  double min_same_width{0.7};    ///< of the two sides, seen from the camera: both / either
  double max_rim_gap{0.6};       ///< between the two sides, of their width
  double min_inner_share{0.15};  ///< of a vessel's surfels, on walls that face its middle
  double min_floor{0.8};         ///< of a floor's surfels, seen through the opening
  double min_flatness{0.8};      ///< of a floor's mean normal, upwards
  double face_tolerance{0.004};  ///< [m] of surfels to their face
  double same_face{0.008};       ///< [m] of surfels to a face that they continue
  double min_same_face{0.5};     ///< of one part's surfels, on faces of the other
  double min_gap{0.015};         ///< [m] between parts that something divides; nearer ones touch
  double min_hidden{0.8};        ///< of a face's gap between two parts, behind something else
};

struct SegmentationParams {
  TableParams table{};
  SurfelParams surfels{};
  ConvexPartParams parts{};
  SmoothBorderParams smooth_borders{};
  PartJoiningParams joining{};
  double surface_tolerance{
      3.0};                ///< [DepthNoise] above the plane from which on a point is a thing's
  double max_below{0.03};  ///< [m] below the plane down to which a point is the table's
  double max_above{0.6};   ///< [m] above the plane; what is higher is no thing on it
  double max_beside{0.5};  ///< [m] beside the table's outline, likewise
};

}  // namespace hires::perception
