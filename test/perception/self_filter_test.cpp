#include "hires/perception/self_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hires/geometry/angles.h"
#include "hires/perception/camera_view.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "support/rays.h"
#include "support/rounds.h"
#include "support/sight_scenes.h"

namespace hires::perception::self_filter_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using geometry::Collision;
using test_support::AnyPose;
using test_support::AnyUnitVector;
using test_support::At;

const Vector3f kNothing = Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
constexpr double kSampleStep = 0.02;  // [m] of lines of sight

Collision Part(geometry::Shape shape, const geometry::Pose3& X_SP) {
  Collision part;
  part.name = "part";
  part.shape = std::move(shape);
  part.X_BS = X_SP;
  return part;
}

PointCloud Row(std::vector<Vector3f> points) {
  const int width = static_cast<int>(points.size());
  return {width, 1, std::move(points)};
}

bool IsCut(const Vector3f& p) { return !IsMeasured(p); }

// ---- The slow second road: distances by projecting onto the convex set, in doubles, and lines of
// sight by many samples.

double SlowDistance(const Collision& part, const Vector3d& p_S) {
  const Vector3d p = part.X_BS.Inverse() * p_S;
  Vector3d nearest = p;
  if (const auto* box = std::get_if<geometry::Box>(&part.shape)) {
    nearest = p.cwiseMin(box->size / 2).cwiseMax(-box->size / 2);
  } else if (const auto* sphere = std::get_if<geometry::Sphere>(&part.shape)) {
    if (p.norm() > sphere->radius) nearest = p * sphere->radius / p.norm();
  } else {
    const auto& cylinder = std::get<geometry::Cylinder>(part.shape);
    const double around = std::hypot(p.x(), p.y());
    if (around > cylinder.radius) nearest.head<2>() *= cylinder.radius / around;
    nearest.z() = std::clamp(p.z(), -cylinder.length / 2, cylinder.length / 2);
  }
  return (p - nearest).norm();
}

double SlowDistance(const std::vector<Collision>& parts, const Vector3d& p_S) {
  double distance = 1e9;
  for (const Collision& part : parts) distance = std::min(distance, SlowDistance(part, p_S));
  return distance;
}

/// The least distance of the way from the sensor to the point, of shapes without the sensor in
/// them.
double SlowClearance(const std::vector<Collision>& parts, double padding, const Vector3d& p_S) {
  double clearance = 1e9;
  for (const Collision& part : parts) {
    if (SlowDistance(part, Vector3d::Zero()) <= padding) continue;
    for (double t = 0.4; t <= 4.5; t += kSampleStep) {
      clearance = std::min(clearance, SlowDistance(part, t * p_S.normalized()));
    }
  }
  return clearance;
}

/// Boxes, cylinders and spheres 0.5 to 4.4 m before the sensor.
std::vector<Collision> AnyParts(base::Rng* rng) {
  std::vector<Collision> parts;
  for (int i = 0; i < 12; ++i) {
    const auto length = [&] { return rng->Uniform(0.02, 0.5); };
    const geometry::Pose3 X_SP = AnyPose(rng, {0.0, 0.0, 2.0});
    if (i % 3 == 0) parts.push_back(Part(geometry::Box{{length(), length(), length()}}, X_SP));
    if (i % 3 == 1) parts.push_back(Part(geometry::Cylinder{length() / 2, length()}, X_SP));
    if (i % 3 == 2) parts.push_back(Part(geometry::Sphere{length() / 2}, X_SP));
  }
  return parts;
}

TEST(SelfFilterTest, CutsAllPointsWithinThePaddingAndNoneBeyondIt) {
  constexpr double kSinglePrecision = 1e-5;
  for (int seed = 0; seed < test_support::Rounds(100); ++seed) {
    base::Rng rng(seed);
    const auto parts = AnyParts(&rng);
    const SelfFilterParams params{rng.Uniform(0.0, 0.1), 0.05};
    std::vector<Vector3f> points;
    for (int i = 0; i < 300; ++i) {
      const Collision& part = parts[rng.Index(static_cast<int>(parts.size()))];
      const Vector3d p_S = part.X_BS.translation + rng.Uniform(0.0, 0.6) * AnyUnitVector(&rng);
      points.push_back(p_S.cast<float>());
      points.push_back(kNothing);  // each is alone, so that it is behind no edge
    }
    PointCloud cloud = Row(points);
    const int num_cut = SelfFilter(params).Cut(parts, &cloud);
    int num_near = 0;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      const double distance = SlowDistance(parts, points[i].cast<double>());
      if (std::abs(distance - params.padding) < kSinglePrecision) continue;
      ASSERT_EQ(IsCut(cloud.points[i]), distance < params.padding) << "seed " << seed << ", " << i;
      if (distance < params.padding) ++num_near;
    }
    ASSERT_NEAR(num_cut, num_near, 1);
    ASSERT_GT(num_near, 5);
    ASSERT_LT(num_near, 295);
  }
}

TEST(SelfFilterTest, CutsWhatVeilsAnEdgeAndNothingElseBehindTheRobot) {
  int num_veils = 0, num_steady = 0;
  for (int seed = 0; seed < 25; ++seed) {
    base::Rng rng(1000 + seed);
    const auto parts = AnyParts(&rng);
    const SelfFilterParams params{0.03, 0.05};
    std::vector<Vector3f> points;
    for (int i = 0; i < 25; ++i) {  // beyond all parts, and beside each one a farther or nearer one
      Vector3d behind(rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0), 1.8);
      behind *= 5.0 / behind.norm();
      const Vector3d beside = behind * (1.0 - rng.Uniform(-0.04, 0.04));
      for (const Vector3d& p : {behind, beside}) points.push_back(p.cast<float>());
      points.push_back(kNothing);
    }
    PointCloud cloud = Row(points);
    SelfFilter(params).Cut(parts, &cloud);
    for (std::size_t i = 0; i < points.size(); i += 3) {
      const double step = points[i].norm() - points[i + 1].norm();
      if (std::abs(step - params.jump) < 1e-4) continue;
      const bool is_edge = step > params.jump;
      const double clearance = SlowClearance(parts, params.padding, points[i].cast<double>());
      if (is_edge && clearance < params.padding - 0.002) {  // by more than a graze
        ASSERT_TRUE(IsCut(cloud.points[i])) << "seed " << seed << ", " << clearance;
        ++num_veils;
      } else if (!is_edge || clearance > params.padding + kSampleStep) {
        ASSERT_FALSE(IsCut(cloud.points[i])) << "seed " << seed << ", " << clearance;
        ++num_steady;
      }
    }
  }
  EXPECT_GT(num_veils, 40);
  EXPECT_GT(num_steady, 300);
}

TEST(SelfFilterTest, ASteadyWallBehindAnArmStaysWhereItIsSeen) {
  const std::vector<Collision> arm{Part(geometry::Box{{0.1, 1.0, 0.1}}, At(0.0, 0.0, 1.0))};
  SelfFilter filter({0.03, 0.05});
  // Columns across the arm: wall, veil, arm, arm, veil, wall; 0.07 m away from it is beyond its
  // padded outline.
  PointCloud cloud = Row({{-0.40f, 0.0f, 2.0f},
                          {-0.14f, 0.0f, 2.0f},
                          {-0.04f, 0.0f, 0.95f},
                          {0.04f, 0.0f, 0.95f},
                          {0.07f, 0.0f, 1.3f},
                          {0.40f, 0.0f, 2.0f}});
  EXPECT_EQ(filter.Cut(arm, &cloud), 4);
  EXPECT_FALSE(IsCut(cloud.points[0]));
  EXPECT_FALSE(IsCut(cloud.points[5]));
  PointCloud wall = Row({{-0.14f, 0.0f, 2.0f}, {-0.13f, 0.0f, 2.0f}});
  EXPECT_EQ(filter.Cut(arm, &wall), 0);
}

TEST(SelfFilterTest, NeighboursAreThoseOfRowAndColumn) {
  const std::vector<Collision> arm{Part(geometry::Sphere{0.1}, At(0.0, 0.0, 1.0))};
  SelfFilter filter({0.03, 0.05});
  const Vector3f hit(0.0f, 0.0f, 0.9f), wall(0.0f, 0.0f, 2.0f);
  PointCloud beside{2, 2, {hit, kNothing, wall, kNothing}};
  EXPECT_EQ(filter.Cut(arm, &beside), 2);
  PointCloud across{2, 2, {hit, kNothing, kNothing, wall}};
  EXPECT_EQ(filter.Cut(arm, &across), 1);
  PointCloud next_row{2, 2, {kNothing, hit, wall, kNothing}};  // the end of a row is not its next's
  EXPECT_EQ(filter.Cut(arm, &next_row), 1);
}

TEST(SelfFilterTest, TheHousingOfTheSensorHidesNothing) {
  const std::vector<Collision> head{Part(geometry::Box{{0.3, 0.3, 0.3}}, At(0.0, 0.0, 0.0))};
  SelfFilter filter({0.03, 0.05});
  PointCloud cloud = Row({{0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, 0.17f}});
  EXPECT_EQ(filter.Cut(head, &cloud), 1);  // the last one, which is within its padding
  EXPECT_TRUE(IsCut(cloud.points[2]));
}

TEST(SelfFilterTest, AMeshIsCutLikeTheShapeThatItRepeats) {
  const geometry::Box box{{0.3, 0.2, 0.5}};
  const auto mesh = test_support::MeshOf(box);
  SelfFilter filter({0.04, 0.05});
  int num_cut = 0;
  for (int i = 0; i < 3000; ++i) {
    base::Rng rng(i);
    const geometry::Pose3 X_SP = AnyPose(&rng, {0.0, 0.0, 2.0});
    const Vector3d p = X_SP.translation + rng.Uniform(0.0, 0.5) * AnyUnitVector(&rng);
    if (std::abs(SlowDistance(Part(box, X_SP), p) - 0.04) < 1e-5) continue;
    PointCloud by_box = Row({(3.0 * p / p.norm()).cast<float>(), p.cast<float>()});
    PointCloud by_mesh = by_box;
    filter.Cut({Part(box, X_SP)}, &by_box);
    filter.Cut({Part(mesh, X_SP)}, &by_mesh);
    ASSERT_EQ(IsCut(by_mesh.points[1]), IsCut(by_box.points[1])) << i;
    if (IsCut(by_box.points[1])) {  // then the first one veils it, by more than a graze
      ASSERT_EQ(IsCut(by_mesh.points[0]), IsCut(by_box.points[0])) << i;
      ++num_cut;
    }
  }
  EXPECT_GT(num_cut, 500);
}

TEST(SelfFilterTest, NothingIsLeftOfThePr2InItsOwnHeadCameraAndNothingElseGoes) {
  const robot::Robot pr2 = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
  robot::JointPositions posture = pr2.profile.joints;
  posture[pr2.profile.upper_body->head_tilt_joint] = 1.1;
  const geometry::Pose2 X_MB{1.0, 2.0, 0.7};
  const auto shapes_M = ShapesOf(pr2, X_MB, posture);
  const LineOfSight sight(test_support::EmptyRoom(), {}, shapes_M);
  const PinholeCamera camera{ViewOf(pr2, X_MB, posture).X_MC, 160, 120, 100.0};
  const RangePicture truth = sight.Look(camera, 5.0);
  base::Rng rng(5);
  DepthSensorParams everything;
  everything.min_range = 0.1;
  PointCloud cloud = Measure(truth, camera, everything, &rng);
  const PointCloud before = cloud;
  const geometry::Pose3 X_SM = (camera.X_MC * OpticalFrame()).Inverse();
  std::vector<Collision> shapes_S = shapes_M;
  for (Collision& shape : shapes_S) shape.X_BS = X_SM * shape.X_BS;
  SelfFilter filter({});
  EXPECT_GT(filter.Cut(shapes_S, &cloud), 500);
  int num_floor = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!IsMeasured(before.points[i])) continue;
    const Vector3d p_M = X_SM.Inverse() * before.points[i].cast<double>();
    const bool is_own = SlowDistance(shapes_M, p_M) < 0.029;
    ASSERT_TRUE(!is_own || IsCut(cloud.points[i])) << i;
    if (std::abs(p_M.z()) < 0.02) num_floor += IsCut(cloud.points[i]) ? 0 : 1;
  }
  EXPECT_GT(num_floor, 1000);
}

TEST(SelfFilterTest, ARobotWithoutShapesLosesNothing) {
  SelfFilter filter({});
  PointCloud cloud = Row({{0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 2.0f}});
  EXPECT_EQ(filter.Cut({}, &cloud), 0);
  PointCloud empty;
  EXPECT_EQ(filter.Cut({}, &empty), 0);
}

}  // namespace
}  // namespace hires::perception::self_filter_test
