#include "hires/perception/picture_scene.h"

#include <gtest/gtest.h>

#include <future>

namespace hires::perception::picture_scene_test {
namespace {

using Eigen::Vector3d;

constexpr double kRightAngle = 1.5707963267948966;
constexpr Colour kRed{200, 40, 20}, kBlue{20, 40, 200};

PaintedBody Body(const geometry::Shape& shape, const Vector3d& p_M, const Colour& colour,
                 bool is_glass = false) {
  PaintedBody body;
  body.shapes_B.emplace_back();
  body.shapes_B.back().shape = shape;
  body.X_MB.translation = p_M;
  body.colour = colour;
  body.is_glass = is_glass;
  return body;
}

PaintedBody Cube(double edge, const Vector3d& p_M, const Colour& colour, bool is_glass = false) {
  return Body(geometry::Box{Vector3d::Constant(edge)}, p_M, colour, is_glass);
}

/// Colours as they are, without light and shadow.
Lighting Flat() {
  Lighting lighting;
  lighting.sun = lighting.sky = 0.0;
  lighting.ambient = 1.0;
  return lighting;
}

/// From (0, 0, 10) along x, so that the floor is far below: focal length 100 pixels.
PinholeCamera Ahead() { return LookAt({0, 0, 10}, {1, 0, 10}, 200, 100, kRightAngle); }

int Brightness(const Colour& colour) { return colour[0] + colour[1] + colour[2]; }

TEST(PictureSceneTest, ACubeFillsThePixelsThatItsFrontFaceProjectsTo) {
  // Its front face, 2 m away, spans 0.1 m both ways: 5 pixels.
  const PictureScene scene({Cube(0.2, {2.1, 0, 10}, kRed)});
  const Picture picture = scene.Draw(Ahead(), {}, Flat());
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      const bool is_within = column >= 95 && column < 105 && row >= 45 && row < 55;
      EXPECT_EQ(picture.At(column, row) == kRed, is_within) << column << ' ' << row;
    }
  }
}

TEST(PictureSceneTest, TheNearestSurfaceIsSeenInWhateverOrderBodiesCome) {
  const PaintedBody near = Cube(0.2, {2.1, 0, 10}, kRed), far = Cube(1.0, {4.5, 0, 10}, kBlue);
  for (const auto& bodies : {std::vector{near, far}, std::vector{far, near}}) {
    const Picture picture = PictureScene(bodies).Draw(Ahead(), {}, Flat());
    EXPECT_EQ(picture.At(100, 50), kRed);
    EXPECT_EQ(picture.At(108, 50), kBlue);  // 0.5 m at 4 m: 12.5 pixels
  }
}

TEST(PictureSceneTest, WhatMovesIsWhereItIsNow) {
  const PictureScene scene({});
  EXPECT_EQ(scene.Draw(Ahead(), {Cube(0.2, {2.1, 0, 10}, kRed)}, Flat()).At(100, 50), kRed);
  // 0.4 m to the left at 2 m: 20 pixels.
  const Picture later = scene.Draw(Ahead(), {Cube(0.2, {2.1, 0.4, 10}, kRed)}, Flat());
  EXPECT_NE(later.At(100, 50), kRed);
  EXPECT_EQ(later.At(80, 50), kRed);
}

TEST(PictureSceneTest, OneLooksThroughGlass) {
  const PaintedBody behind = Cube(0.2, {2.1, 0, 10}, kRed),
                    pane = Cube(0.5, {1.0, 0, 10}, kBlue, true);
  const Colour seen = PictureScene({behind, pane}).Draw(Ahead(), {}, Flat()).At(100, 50);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], 0.22 * kBlue[i] + 0.78 * kRed[i], 0.51) << i;
}

TEST(PictureSceneTest, ABodyCastsItsShadowAndGlassNone) {
  Lighting noon;
  noon.to_sun = Vector3d::UnitZ();
  const PinholeCamera camera = LookAt({-3, 0, 2}, {0, 0, 0}, 101, 101, 0.4);
  const auto lit = [&](const std::vector<PaintedBody>& bodies) {
    return Brightness(PictureScene(bodies).Draw(camera, {}, noon).At(50, 50));
  };
  const PaintedBody plate = Body(geometry::Box{{0.3, 0.3, 0.01}}, {0, 0, 1.5}, kRed);
  PaintedBody glass = plate;
  glass.is_glass = true;
  EXPECT_LT(lit({plate}), 0.7 * lit({}));
  EXPECT_EQ(lit({glass}), lit({}));
}

TEST(PictureSceneTest, AFaceTowardsTheLightIsBrighterThanOneAwayFromIt) {
  Lighting from_camera, from_behind;
  from_camera.to_sun = -Vector3d::UnitX();
  from_behind.to_sun = Vector3d::UnitX();
  const PictureScene scene({Cube(0.2, {2.1, 0, 10}, kRed)});
  EXPECT_GT(Brightness(scene.Draw(Ahead(), {}, from_camera).At(100, 50)),
            Brightness(scene.Draw(Ahead(), {}, from_behind).At(100, 50)));
}

TEST(PictureSceneTest, AMeshLooksAsTheBoxThatItIs) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (int k = 0; k < 8; ++k) {
    mesh->vertices.emplace_back(0.2 * ((k & 1) - 0.5), 0.2 * ((k >> 1 & 1) - 0.5),
                                0.2 * ((k >> 2 & 1) - 0.5));
  }
  mesh->triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  const geometry::Shape shape = std::shared_ptr<const geometry::TriangleMesh>(mesh);
  const PinholeCamera camera = LookAt({1.03, 0.71, 10.57}, {2.1, 0, 10}, 120, 90, 0.5);
  const PictureScene scene({});
  const Picture box = scene.Draw(camera, {Cube(0.2, {2.1, 0, 10}, kRed)}),
                same = scene.Draw(camera, {Body(shape, {2.1, 0, 10}, kRed)});
  int differing = 0;
  for (std::size_t i = 0; i < box.pixels.size(); ++i) differing += box.pixels[i] != same.pixels[i];
  EXPECT_LE(differing, 8);  // a ray along an edge may go either way
}

TEST(PictureSceneTest, TheSameCallsGiveTheSameBitsInAnyThread) {
  const PictureScene scene({Cube(1.0, {0, 0, 0.5}, kRed)});
  const PinholeCamera camera = LookAt({2, 1, 2}, {0, 0, 0.5}, 160, 120, 0.9);
  const std::vector<PaintedBody> moving{Body(geometry::Cylinder{0.2, 0.5}, {0, 0, 1.3}, kBlue)};
  const Picture first = scene.Draw(camera, moving);
  std::vector<std::future<Picture>> others;
  for (int k = 0; k < 3; ++k) {
    others.push_back(std::async(std::launch::async, [&] { return scene.Draw(camera, moving); }));
  }
  for (auto& other : others) EXPECT_EQ(other.get().pixels, first.pixels);
}

TEST(PictureSceneTest, APictureWithoutPixelsIsRefused) {
  PinholeCamera camera;
  camera.width = 0;
  EXPECT_THROW(PictureScene({}).Draw(camera, {}), std::logic_error);
}

}  // namespace
}  // namespace hires::perception::picture_scene_test
