#pragma once

#include <memory>

#include "hires/geometry/shape.h"

namespace hires::test_support {

/// The axis-aligned box as twelve triangles.
inline std::shared_ptr<const geometry::TriangleMesh> BoxMesh(const Eigen::Vector3d& size) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5);
    mesh->vertices.push_back(corner.cwiseProduct(size));
  }
  mesh->triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

}  // namespace hires::test_support
