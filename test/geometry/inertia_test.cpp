#include "hires/geometry/inertia.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <vector>

#include "hires/base/rng.h"

namespace hires::geometry::inertia_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Eigen::Matrix3d Diagonal(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

/// Second moments of points spread evenly over the shape's bounds, those outside left out: the slow
/// and obvious road to the inertia about the centre.
template <typename Inside>
Eigen::Matrix3d SummedInertia(const Eigen::Vector3d& half, double mass, Inside inside) {
  constexpr int kSteps = 60;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  int count = 0;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Eigen::Array3d cell(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps);
    const Eigen::Vector3d p = half.array() * ((2.0 * cell + 1.0) / kSteps - 1.0);
    if (!inside(p)) continue;
    sum += p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose();
    ++count;
  }
  return mass / count * sum;
}

TEST(SolidInertiaTest, ThePepperMillOfTheThesis) {
  // m = 0.14 kg, r = 0.037 m, h = 0.274 m: I_z = 0.14 * 0.037^2 / 2 = 9.583e-5;
  // I_x = 0.14 * (3 * 0.001369 + 0.075076) / 12 = 9.238016667e-4.
  const Eigen::Matrix3d inertia = SolidInertia(Cylinder{0.037, 0.274}, 0.14);
  EXPECT_NEAR(inertia(0, 0), 9.238016667e-4, 1e-13);
  EXPECT_NEAR(inertia(1, 1), 9.238016667e-4, 1e-13);
  EXPECT_NEAR(inertia(2, 2), 9.583e-5, 1e-15);
  EXPECT_TRUE(inertia.isDiagonal(0.0));
}

TEST(SolidInertiaTest, BoxAndSphereWorkedByHand) {
  EXPECT_TRUE(SolidInertia(Box{{1.0, 2.0, 3.0}}, 12.0).isApprox(Diagonal(13.0, 10.0, 5.0), 1e-15));
  EXPECT_TRUE(SolidInertia(Sphere{0.5}, 10.0).isApprox(Diagonal(1.0, 1.0, 1.0), 1e-15));
}

TEST(SolidInertiaTest, AgreesWithSummedUpPoints) {
  const auto in_cylinder = [](const Eigen::Vector3d& p) { return p.head<2>().norm() <= 0.2; };
  EXPECT_TRUE(SolidInertia(Cylinder{0.2, 0.7}, 3.0)
                  .isApprox(SummedInertia({0.2, 0.2, 0.35}, 3.0, in_cylinder), 2e-3));
  const auto in_box = [](const Eigen::Vector3d&) { return true; };
  EXPECT_TRUE(SolidInertia(Box{{0.2, 0.4, 1.0}}, 3.0)
                  .isApprox(SummedInertia({0.1, 0.2, 0.5}, 3.0, in_box), 2e-3));
  const auto in_sphere = [](const Eigen::Vector3d& p) { return p.norm() <= 0.3; };
  EXPECT_TRUE(SolidInertia(Sphere{0.3}, 3.0)
                  .isApprox(SummedInertia({0.3, 0.3, 0.3}, 3.0, in_sphere), 2e-3));
}

TEST(WhyUnphysicalTest, TheDefaultIsPhysical) { EXPECT_EQ(WhyUnphysical({}), ""); }

TEST(WhyUnphysicalTest, EverySolidIsPhysicalInEveryOrientation) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(2).Fork(seed);
    const double mass = rng.Uniform(1e-3, 100.0);
    const Box box{{rng.Uniform(1e-3, 2.0), rng.Uniform(1e-3, 2.0), rng.Uniform(1e-3, 2.0)}};
    const Eigen::Matrix3d turn =
        RotationFromRpy(rng.Uniform(-3.0, 3.0), rng.Uniform(-1.5, 1.5), rng.Uniform(-3.0, 3.0))
            .toRotationMatrix();
    const MassProperties properties{mass, Eigen::Vector3d::Zero(),
                                    turn * SolidInertia(box, mass) * turn.transpose()};
    EXPECT_EQ(WhyUnphysical(properties), "") << "seed " << seed;
  }
}

TEST(WhyUnphysicalTest, MassMustBeFiniteAndPositive) {
  for (const double mass : {0.0, -1.0, double{NAN}, double{INFINITY}}) {
    MassProperties properties;
    properties.mass = mass;
    EXPECT_THAT(WhyUnphysical(properties),
                AllOf(HasSubstr("mass is "), HasSubstr("wanted a finite number above 0")));
  }
}

TEST(WhyUnphysicalTest, EverythingMustBeFinite) {
  MassProperties properties;
  properties.p_BBcm.x() = NAN;
  EXPECT_THAT(WhyUnphysical(properties), HasSubstr("not finite"));
  properties = {};
  properties.I_BBcm(0, 1) = INFINITY;
  EXPECT_THAT(WhyUnphysical(properties), HasSubstr("not finite"));
}

TEST(WhyUnphysicalTest, InertiaMustBeSymmetricAndPositive) {
  MassProperties properties;
  properties.I_BBcm(0, 1) = 0.01;
  EXPECT_THAT(WhyUnphysical(properties), HasSubstr("not symmetric"));
  properties.I_BBcm = Diagonal(1.0, 1.0, 0.0);
  EXPECT_THAT(WhyUnphysical(properties), HasSubstr("not positive definite"));
  properties.I_BBcm = Diagonal(1.0, 1.0, -0.1);
  EXPECT_THAT(WhyUnphysical(properties), HasSubstr("not positive definite"));
  properties.I_BBcm.setZero();
  EXPECT_THAT(WhyUnphysical(properties), HasSubstr("not positive definite"));
}

TEST(WhyUnphysicalTest, MomentsMustFormATriangle) {
  MassProperties properties;
  properties.I_BBcm = Diagonal(1.0, 2.0, 3.0);  // a flat plate: just possible
  EXPECT_EQ(WhyUnphysical(properties), "");
  properties.I_BBcm = Diagonal(1.0, 2.0, 3.001);
  EXPECT_THAT(WhyUnphysical(properties),
              AllOf(HasSubstr("1, 2, 3.001 kg m^2"), HasSubstr("triangle inequality")));
}

/// Two roads: put together at once, or in any order of pairs.
TEST(TogetherTest, DoesNotDependOnTheOrder) {
  base::Rng rng(3);
  for (int round = 0; round < 100; ++round) {
    std::vector<MassProperties> parts(3);
    for (auto& part : parts) {
      part.mass = rng.Uniform(0.1, 5.0);
      for (int k = 0; k < 3; ++k) part.p_BBcm[k] = rng.Uniform(-1.0, 1.0);
      part.I_BBcm = rng.Uniform(0.1, 1.0) * Eigen::Matrix3d::Identity();
    }
    const auto all = Together(parts);
    const auto pairs = Together({parts[2], Together({parts[0], parts[1]})});
    EXPECT_NEAR(all.mass, pairs.mass, 1e-12);
    EXPECT_TRUE(all.p_BBcm.isApprox(pairs.p_BBcm, 1e-12));
    EXPECT_TRUE(all.I_BBcm.isApprox(pairs.I_BBcm, 1e-12));
    EXPECT_EQ(WhyUnphysical(all), "");
  }
}

Collision At(const Shape& shape, const Eigen::Vector3d& p_BS) {
  Collision result;
  result.shape = shape;
  result.X_BS.translation = p_BS;
  return result;
}

/// Two roads: a box whole, and cut into two that lie side by side.
TEST(SolidOfTest, ABoxIsWhatItsHalvesAre) {
  const MassProperties whole = SolidOf({At(Box{{0.4, 0.2, 0.6}}, {1.0, 0.0, 0.3})}, 2.5);
  const Box half{{0.2, 0.2, 0.6}};
  const MassProperties halves =
      SolidOf({At(half, {0.9, 0.0, 0.3}), At(half, {1.1, 0.0, 0.3})}, 2.5);
  EXPECT_EQ(whole.mass, 2.5);
  EXPECT_TRUE(whole.p_BBcm.isApprox(halves.p_BBcm, 1e-12));
  EXPECT_TRUE(whole.I_BBcm.isApprox(halves.I_BBcm, 1e-12));
  EXPECT_TRUE(whole.I_BBcm.isApprox(SolidInertia(Box{{0.4, 0.2, 0.6}}, 2.5), 1e-12));
}

TEST(SolidOfTest, AMeshIsTheBoxRoundIt) {
  TriangleMesh mesh;
  mesh.vertices = {{0.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, {0.0, 0.2, 0.0}, {0.0, 0.0, 0.6}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const MassProperties solid =
      SolidOf({At(std::make_shared<const TriangleMesh>(mesh), {1.0, 0.0, 0.0})}, 3.0);
  EXPECT_TRUE(solid.p_BBcm.isApprox(Eigen::Vector3d(1.2, 0.1, 0.3), 1e-12));
  EXPECT_TRUE(solid.I_BBcm.isApprox(SolidInertia(Box{{0.4, 0.2, 0.6}}, 3.0), 1e-12));
}

/// Solids, hollow ones and heavy cores of every form and place are bodies; placeholders and other
/// units are not.
TEST(WhyImplausibleTest, TellsBodiesFromPlaceholdersAndOtherUnits) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    base::Rng rng = base::Rng(5).Fork(seed);
    const auto size = [&] { return rng.Uniform(0.02, 0.5); };
    const auto place = [&] { return rng.Uniform(-0.3, 0.3); };
    std::vector<Collision> shapes{At(Box{{size(), size(), size()}}, {place(), place(), place()}),
                                  At(Cylinder{size(), size()}, {place(), place(), place()}),
                                  At(Sphere{size()}, {place(), place(), place()})};
    shapes.resize(1 + seed % 3);
    for (Collision& shape : shapes)
      shape.X_BS.rotation = RotationFromRpy(rng.Uniform(-3.0, 3.0), place(), place());
    const MassProperties solid = SolidOf(shapes, rng.Uniform(0.05, 5.0));
    ASSERT_EQ(WhyUnphysical(solid), "");
    const auto scaled = [&](double factor) {
      MassProperties other = solid;
      other.I_BBcm *= factor;
      return WhyImplausible(other, shapes);
    };
    for (const double factor : {0.05, 0.5, 1.0}) EXPECT_EQ(scaled(factor), "") << "seed " << seed;
    for (const double factor : {1e-3, 1e3})  // g mm^2 and the like are farther off still
      EXPECT_THAT(scaled(factor), HasSubstr("wanted at least")) << "seed " << seed;
  }
}

TEST(WhyImplausibleTest, APointMassInTheFarthestCornerIsTheMost) {
  const std::vector<Collision> cube{At(Box{{0.2, 0.2, 0.2}}, {0.0, 0.0, 0.1})};
  MassProperties body{2.0, {0.0, 0.0, 0.1}, {}};
  const double most = 2.0 * 3.0 * 0.1 * 0.1;
  body.I_BBcm = 0.999 * most * Eigen::Matrix3d::Identity();
  EXPECT_EQ(WhyImplausible(body, cube), "");
  body.I_BBcm = 1.001 * most * Eigen::Matrix3d::Identity();
  EXPECT_THAT(WhyImplausible(body, cube), HasSubstr("at most 0.06 for 2 kg"));
  body.p_BBcm.z() = 0.0;  // farther from the upper corners
  EXPECT_EQ(WhyImplausible(body, cube), "");
}

}  // namespace
}  // namespace hires::geometry::inertia_test
