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
  /// Mean concavity of a border above which two regions stay apart: 0 is flat or convex, 0.5 is a
  /// step of the normals that stands across `sharp`, 1 is the most.
  double max_concavity{0.3};
  double sharp{0.6};  ///< how far two normals lean towards each other, along the line between them
  int min_points{100};  ///< of a part
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
  double min_same_face{0.5};     ///< of all surfels of either part, on faces of the other
  double min_gap{0.015};         ///< [m] between parts that something divides; nearer ones touch
  double min_hidden{0.7};        ///< of the gap between two parts, behind something else
};

struct SegmentationParams {
  TableParams table{};
  SurfelParams surfels{};
  ConvexPartParams parts{};
  PartJoiningParams joining{};
  double surface_tolerance{
      3.0};                ///< [DepthNoise] above the plane from which on a point is a thing's
  double max_below{0.03};  ///< [m] below the plane down to which a point is the table's
  double max_above{0.6};   ///< [m] above the plane; what is higher is no thing on it
  double max_beside{0.1};  ///< [m] beside the table's outline, likewise
};

}  // namespace hires::perception
