#include "geometry/convex_pieces.h"

#include <gtest/gtest.h>

#include "geometry/mesh_pieces.h"
#include "support/box_mesh.h"

namespace hires::geometry::convex_pieces_test {
namespace {

using hires::test_support::Basket;
using hires::test_support::Tub;

TEST(ConvexPiecesTest, ClosedBoxesOfOneMeshAreSolidsEach) {
  const ConvexPieces pieces = ConvexPiecesOf(*Basket());
  ASSERT_EQ(pieces.solids.size(), 5u);
  EXPECT_EQ(pieces.rest, nullptr);
  EXPECT_TRUE(IsSolid(*pieces.solids[0]));
}

TEST(ConvexPiecesTest, OfATubThatIsOneSurfaceTheFlatFacesArePlatesAndItsRimIsLeft) {
  const ConvexPieces pieces = ConvexPiecesOf(*Tub());
  // Underside, floor, four walls from inside and four from outside; the rim has a hole.
  ASSERT_EQ(pieces.solids.size(), 10u);
  for (const auto& solid : pieces.solids) EXPECT_TRUE(IsSolid(*solid));
  ASSERT_NE(pieces.rest, nullptr);
  EXPECT_EQ(pieces.rest->triangles.size(), 8u);
}

TEST(ConvexPiecesTest, WhatIsRoundOrOfManyPiecesStaysAMesh) {
  TriangleMesh crumbs;
  for (int i = 0; i < 200; ++i)
    hires::test_support::AddBox({0.1 * i, 0, 0}, {0.1 * i + 0.05, 0.05, 0.05}, false, &crumbs);
  const ConvexPieces pieces = ConvexPiecesOf(crumbs);
  EXPECT_TRUE(pieces.solids.empty());
  ASSERT_NE(pieces.rest, nullptr);
  EXPECT_EQ(pieces.rest->triangles.size(), crumbs.triangles.size());
}

}  // namespace
}  // namespace hires::geometry::convex_pieces_test
