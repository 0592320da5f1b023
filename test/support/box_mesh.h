#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>

#include "hires/geometry/shape.h"

namespace hires::test_support {

/// Adds the box between two corners, its triangles counter-clockwise seen from outside.
/// @param turned  the other way round
inline void AddBox(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, bool turned,
                   geometry::TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh->vertices.emplace_back((i & 1) != 0 ? upper.x() : lower.x(),
                                (i & 2) != 0 ? upper.y() : lower.y(),
                                (i & 4) != 0 ? upper.z() : lower.z());
  }
  const std::array<int, 3> triangles[] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                          {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                          {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (auto [a, b, c] : triangles) {
    if (turned) std::swap(b, c);
    mesh->triangles.push_back({first + a, first + b, first + c});
  }
}

/// The axis-aligned box round the origin.
inline std::shared_ptr<const geometry::TriangleMesh> BoxMesh(const Eigen::Vector3d& size) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  AddBox(-0.5 * size, 0.5 * size, false, mesh.get());
  return mesh;
}

/// 0.4 x 0.3 m, its floor up to 0.01 m, its walls 0.02 m thick and up to 0.15 m.
inline std::shared_ptr<const geometry::TriangleMesh> Basket(bool turned = false) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  AddBox({-0.2, -0.15, 0.0}, {0.2, 0.15, 0.01}, turned, mesh.get());
  AddBox({-0.2, -0.15, 0.0}, {-0.18, 0.15, 0.15}, turned, mesh.get());
  AddBox({0.18, -0.15, 0.0}, {0.2, 0.15, 0.15}, turned, mesh.get());
  AddBox({-0.2, -0.15, 0.0}, {0.2, -0.13, 0.15}, turned, mesh.get());
  AddBox({-0.2, 0.13, 0.0}, {0.2, 0.15, 0.15}, turned, mesh.get());
  return mesh;
}

/// As Basket without its overlaps: one closed surface, its floor at 0.01 m.
inline std::shared_ptr<const geometry::TriangleMesh> Tub() {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  const auto ring = [&](double x, double y, double z) {
    for (const auto& [sx, sy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      mesh->vertices.emplace_back(sx * x, sy * y, z);
  };
  ring(0.2, 0.15, 0.0);    // 0: underside
  ring(0.2, 0.15, 0.15);   // 4: rim, outside
  ring(0.18, 0.13, 0.15);  // 8: rim, inside
  ring(0.18, 0.13, 0.01);  // 12: floor
  const auto quad = [&](int a, int b, int c, int d) {
    mesh->triangles.push_back({a, b, c});
    mesh->triangles.push_back({a, c, d});
  };
  quad(3, 2, 1, 0);
  quad(12, 13, 14, 15);
  for (int i = 0; i < 4; ++i) {
    const int k = (i + 1) % 4;
    quad(i, k, 4 + k, 4 + i);
    quad(4 + i, 4 + k, 8 + k, 8 + i);
    quad(8 + i, 8 + k, 12 + k, 12 + i);
  }
  return mesh;
}

}  // namespace hires::test_support
