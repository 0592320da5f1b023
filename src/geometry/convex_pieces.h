#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// What a mesh is made of, for contacts that want convex solids.
struct ConvexPieces {
  /// Parts that are solid (IsSolid); of all others each flat face that is convex and not small, as
  /// a plate of 1 mm below it.
  std::vector<std::shared_ptr<const TriangleMesh>> solids;
  std::shared_ptr<const TriangleMesh> rest;  ///< the other triangles; null where there are none
};

/// A mesh of more pieces than are worth while is `rest` as a whole.
ConvexPieces ConvexPiecesOf(const TriangleMesh& mesh);

}  // namespace hires::geometry
