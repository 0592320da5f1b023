#include "perception/tabletop/hidden_face.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "hires/base/rng.h"
#include "support/rounds.h"

namespace hires::perception::hidden_face_test {
namespace {

using Eigen::Vector3d;

enum Part { kLeft, kRight, kOther, kNone };

struct Hit {
  double z{0.0};  // [m] before the camera
  Part part{kNone};
};
using Ray = std::optional<Hit>;  // nothing: nothing is measured there
/// What a camera meets in the direction of x / z, y / z; y points downwards.
using Scene = std::function<Ray(double, double)>;

constexpr double kFace = 1.0;               // [m] before the camera
constexpr double kTop = 0.4, kFoot = 0.55;  // [m] of the face below the camera; its foot on a table
constexpr double kGap = 0.06;               // [m] of its middle to either side, which is not seen
constexpr double kSide = 0.2;               // [m] likewise, where it ends

/// The two sides of the face that are seen.
Ray Sides(double x, double y) {
  const double beside = std::abs(x) * kFace;
  if (y * kFace < kTop || y * kFace > kFoot || beside < kGap || beside > kSide) return std::nullopt;
  return Hit{kFace, x < 0.0 ? kLeft : kRight};
}

/// Something before the gap, and somewhat wider.
bool IsBeforeGap(double x) { return std::abs(x) < 1.1 * kGap; }

/// How much of the face between both sides is hidden, as HiddenFaces sees it.
double ShareHidden(const Scene& scene) {
  PointCloud cloud;
  std::vector<int> measured;
  std::vector<Part> part_of;
  for (double y = 0.25; y < 0.7; y += 0.002) {
    for (double x = -0.3; x < 0.3; x += 0.002) {
      const Ray ray = scene(x, y);
      if (!ray) continue;
      measured.push_back(static_cast<int>(cloud.points.size()));
      cloud.points.push_back((ray->z * Vector3d(x, y, 1.0)).cast<float>());
      part_of.push_back(ray->part);
    }
  }
  const SurfelCloud surfels = MakeSurfels(cloud, measured, {});
  std::vector<int> part(surfels.surfels.size(), -1), left, right;
  for (const int i : measured)
    if (part_of[i] != kNone) part[surfels.of_point[i]] = part_of[i];
  for (int i = 0; i < static_cast<int>(part.size()); ++i) {
    if (part[i] == kLeft) left.push_back(i);
    if (part[i] == kRight) right.push_back(i);
  }
  Table table;  // by default -y is upwards
  table.offset = kFoot;
  const SeenDepth seen(cloud);
  return HiddenFaces(cloud, table, surfels, seen, part)
      .ShareHidden({-Vector3d::UnitZ(), kFace}, left, right, 0.008);
}

// A post hides it from above down to somewhere; below that one looks between both sides.
TEST(HiddenFacesTest, TheShareIsWhatSomethingInFrontHides) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    const double z = rng.Uniform(0.5, 0.9), lowest = rng.Uniform(kTop, kFoot);
    const double share = ShareHidden([&](double x, double y) {
      if (IsBeforeGap(x) && y < lowest) return Ray(Hit{z, kOther});
      const Ray side = Sides(x, y);
      return side ? side : Ray(Hit{1.5, kNone});
    });
    EXPECT_NEAR(share, (lowest - kTop) / (kFoot - kTop), 0.1) << seed;
  }
}

TEST(HiddenFacesTest, WhereNothingIsMeasuredNothingIsSaid) {
  EXPECT_EQ(ShareHidden(Sides), -1.0);
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    const double highest = rng.Uniform(kTop, 0.5);  // above it a shadow of the projector
    const double share = ShareHidden([&](double x, double y) {
      return IsBeforeGap(x) && y > highest ? Ray(Hit{0.7, kOther}) : Sides(x, y);
    });
    EXPECT_GT(share, 0.9) << seed;
  }
}

// A box reaches as far back as the face: its front hides what is below its top, and it is there.
TEST(HiddenFacesTest, WhatIsFilledIsNotHidden) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    const double front = rng.Uniform(0.85, 0.9), back = rng.Uniform(1.02, 1.1);
    const double top = rng.Uniform(0.3, 0.33);  // [m] below the camera
    const auto box = [&](double depth) {
      return ShareHidden([&, depth](double x, double y) {
        if (!IsBeforeGap(x) || y > kFoot / front) return Sides(x, y);
        if (y >= top / front) return Ray(Hit{front, kOther});
        return y >= top / depth ? Ray(Hit{top / y, kOther}) : Ray();
      });
    };
    EXPECT_LT(box(back), 0.2) << seed;
    EXPECT_GT(box(front + 0.05), 0.9) << seed << ": it ends before the face";
  }
}

TEST(HiddenFacesTest, TooLittleOnTheFaceSaysNothing) {
  const PointCloud cloud;
  const SurfelCloud surfels;
  const SeenDepth seen(cloud);
  const Table table;
  const HiddenFaces faces(cloud, table, surfels, seen, {});
  EXPECT_EQ(faces.ShareHidden({-Vector3d::UnitZ(), kFace}, {}, {}, 0.008), -1.0);
}

}  // namespace
}  // namespace hires::perception::hidden_face_test
