#include "hires/physics/physics_world.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <thread>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "physics/scenes.h"

namespace hires::physics::physics_world_test {
namespace {

using Eigen::Vector3d;
using test_support::AddStandingCylinder;
using test_support::At;
using test_support::BoxMesh;
using test_support::kTrayTop;
using test_support::MakeCollision;
using test_support::TrayScene;
using ::testing::HasSubstr;

void StepTimes(PhysicsWorld* world, int num_steps) {
  for (int i = 0; i < num_steps; ++i) world->Step();
}

std::vector<double> Numbers(const PhysicsState& state) {
  std::vector<double> numbers;
  for (const BodyState& body : state.bodies) {
    for (const Vector3d& v : {body.X_WB.translation, body.V_WB.linear, body.V_WB.angular}) {
      numbers.insert(numbers.end(), v.data(), v.data() + 3);
    }
    const double* q = body.X_WB.rotation.coeffs().data();
    numbers.insert(numbers.end(), q, q + 4);
  }
  return numbers;
}

bool SameBits(const PhysicsState& a, const PhysicsState& b) {
  const std::vector<double> x = Numbers(a), y = Numbers(b);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
}

geometry::MassProperties BoxMass(const Vector3d& size, double mass) {
  return {mass, Vector3d::Zero(), geometry::SolidInertia(geometry::Box{size}, mass)};
}

/// A shaken tray with everything on it that can be on it; some of it falls down.
class ShakenTray {
 public:
  ShakenTray() : scene_(6) {
    PhysicsWorld& world = scene_.world;
    const Vector3d size(0.04, 0.05, 0.06);
    world.AddLoose(BoxMass(size, 0.1), {MakeCollision(geometry::Box{size}, Vector3d::Zero())},
                   At(0.15, 0.2, kTrayTop + 0.05));
    world.AddLoose(BoxMass(size, 0.1), {MakeCollision(BoxMesh(size), Vector3d::Zero())},
                   At(0.25, 0.2, kTrayTop + 0.1));
    world.AddLoose(BoxMass(size, 0.1),
                   {MakeCollision(geometry::Sphere{0.02}, {0.0, 0.0, 0.03}),
                    MakeCollision(geometry::Cylinder{0.02, 0.05}, Vector3d::Zero())},
                   At(0.2, 0.28, kTrayTop + 0.2));
  }

  void Run(int first_step, int num_steps) {
    for (int step = first_step; step < first_step + num_steps; ++step) {
      BodyState motion = scene_.world.GetState(scene_.base);
      const double time = 0.001 * step;
      motion.V_WB.linear = {0.5 * std::sin(5.0 * time), 0.3 * std::cos(7.0 * time), 0.0};
      motion.V_WB.angular = {0.0, 0.0, std::sin(2.0 * time)};
      scene_.world.SetMotion(scene_.base, motion);
      scene_.world.Step();
    }
  }

  PhysicsWorld& world() { return scene_.world; }

 private:
  TrayScene scene_;
};

PhysicsState PlayOnFrom(const PhysicsState& start, int first_step, int num_steps) {
  ShakenTray tray;
  tray.world().Restore(start);
  tray.Run(first_step, num_steps);
  return tray.world().Save();
}

TEST(PhysicsWorldTest, RestoredWorldsGoOnBitByBitLikeTheSavedOne) {
  ShakenTray tray;
  tray.Run(0, 700);
  const PhysicsState saved = tray.world().Save();
  tray.Run(700, 4000);
  const PhysicsState end = tray.world().Save();
  EXPECT_TRUE(SameBits(PlayOnFrom(saved, 700, 4000), end));
  EXPECT_FALSE(SameBits(saved, end));
  PhysicsState in_thread;
  std::thread([&] { in_thread = PlayOnFrom(saved, 700, 4000); }).join();
  EXPECT_TRUE(SameBits(in_thread, end));
}

TEST(PhysicsWorldTest, TwoThreadsAtOnceGiveTheSameBits) {
  ShakenTray tray;
  tray.Run(0, 300);
  const PhysicsState saved = tray.world().Save();
  std::array<PhysicsState, 2> ends;
  std::array<std::thread, 2> threads;
  for (std::size_t i = 0; i < 2; ++i) {
    threads[i] = std::thread([&, i] { ends[i] = PlayOnFrom(saved, 300, 3000); });
  }
  for (std::thread& thread : threads) thread.join();
  tray.Run(300, 3000);
  EXPECT_TRUE(SameBits(ends[0], ends[1]));
  EXPECT_TRUE(SameBits(ends[0], tray.world().Save()));
}

TEST(PhysicsWorldTest, ForkingAtEverySaveChangesNothing) {
  ShakenTray steady;
  PhysicsState forked = ShakenTray().world().Save();
  for (int part = 0; part < 20; ++part) {
    forked = PlayOnFrom(forked, 100 * part, 100);
    steady.Run(100 * part, 100);
    ASSERT_TRUE(SameBits(forked, steady.world().Save())) << "part " << part;
  }
}

TEST(PhysicsWorldTest, SavingTwiceGivesTheSameAndGoesOnTheSame) {
  ShakenTray once, twice;
  once.Run(0, 500);
  twice.Run(0, 500);
  const PhysicsState saved = once.world().Save();
  twice.world().Save();
  EXPECT_TRUE(SameBits(twice.world().Save(), saved));
  once.Run(500, 500);
  twice.Run(500, 500);
  EXPECT_TRUE(SameBits(once.world().Save(), twice.world().Save()));
}

TEST(PhysicsWorldTest, UsedWorldRestoredIsAsGoodAsAFreshOne) {
  ShakenTray used;
  const PhysicsState start = used.world().Save();
  used.Run(0, 2500);
  used.world().Restore(start);
  used.Run(0, 1500);
  EXPECT_TRUE(SameBits(used.world().Save(), PlayOnFrom(start, 0, 1500)));
}

TEST(PhysicsWorldTest, SavedRotationsHaveUnitLength) {
  ShakenTray tray;
  tray.Run(0, 1000);
  for (const BodyState& body : tray.world().Save().bodies) {
    EXPECT_NEAR(body.X_WB.rotation.norm(), 1.0, 1e-15);
  }
}

TEST(PhysicsWorldTest, EveryShapeComesToRestOnEverySupport) {
  const Vector3d size(0.1, 0.1, 0.1);
  const std::vector<geometry::Shape> shapes = {geometry::Box{size}, geometry::Cylinder{0.05, 0.1},
                                               geometry::Sphere{0.05}, BoxMesh(size)};
  const std::vector<geometry::Shape> supports = {
      geometry::Box{{0.4, 0.4, 0.2}}, geometry::Cylinder{0.2, 0.2}, BoxMesh({0.4, 0.4, 0.2})};
  for (const geometry::Shape& shape : shapes) {
    for (const geometry::Shape& support : supports) {
      PhysicsWorld world({});
      world.AddStatic({MakeCollision(support, {0.0, 0.0, 0.1})}, geometry::Pose3());
      const BodyId body = world.AddLoose(
          BoxMass(size, 0.3), {MakeCollision(shape, Vector3d::Zero())}, At(0.03, 0.05, 0.26));
      StepTimes(&world, 1500);
      const BodyState state = world.GetState(body);
      EXPECT_NEAR(state.X_WB.translation.z(), 0.25, 0.0015)
          << shape.index() << " on " << support.index();
      EXPECT_LT(state.V_WB.linear.norm(), 0.01) << shape.index() << " on " << support.index();
    }
  }
}

TEST(PhysicsWorldTest, LooseBodiesStackOnEachOther) {
  PhysicsWorld world({});
  world.AddFloor(0.8);
  const geometry::Cylinder bowl{0.098, 0.04}, cup{0.04, 0.1};
  AddStandingCylinder(&world, bowl, 0.3, Vector3d::Zero());
  AddStandingCylinder(&world, cup, 0.3, {0.03, 0.0, 0.04});
  const BodyId top = AddStandingCylinder(&world, bowl, 0.3, {0.03, 0.0, 0.14});
  StepTimes(&world, 5000);
  EXPECT_NEAR(world.GetState(top).X_WB.translation.z(), 0.14, 0.003);
  EXPECT_LT(geometry::TiltOf(world.GetState(top).X_WB.rotation), 0.01);
}

TEST(PhysicsWorldTest, TallBodyPushedOverComesToLie) {
  PhysicsWorld world({});
  world.AddFloor(0.8);
  const BodyId mill = AddStandingCylinder(&world, {0.037, 0.274}, 0.14, Vector3d::Zero());
  BodyState state = world.GetState(mill);
  state.V_WB.angular = {3.0, 0.0, 0.0};
  world.SetState(mill, state);
  StepTimes(&world, 4000);
  EXPECT_NEAR(geometry::TiltOf(world.GetState(mill).X_WB.rotation), 1.5708, 0.03);
  const Vector3d foot = world.GetState(mill).X_WB.translation;
  EXPECT_NEAR(foot.z(), 0.037, 0.002);
}

TEST(PhysicsWorldTest, MillOverhangingTheTrayByLessThanHalfStaysAndByMoreFalls) {
  for (const double beyond : {-0.01, 0.01}) {
    PhysicsWorld world({});
    world.AddStatic({MakeCollision(geometry::Box{{0.25, 0.6, 0.005}}, {0.0, 0.0, -0.0025})},
                    geometry::Lift({}, 1.0));
    const BodyId mill =
        AddStandingCylinder(&world, {0.037, 0.274}, 0.14, {0.125 + beyond, 0.0, 1.0});
    StepTimes(&world, 2000);
    EXPECT_EQ(world.GetState(mill).X_WB.translation.z() > 0.99, beyond < 0.0) << beyond;
  }
}

TEST(PhysicsWorldTest, BodyOnATurningTrayStaysInItsPlace) {
  TrayScene scene(1);
  BodyState motion;
  motion.V_WB.angular.z() = 1.0;
  scene.world.SetMotion(scene.base, motion);
  const auto p_BM = [&scene] {
    return scene.world.GetState(scene.base).X_WB.Inverse() *
           scene.world.GetState(scene.mills[0]).X_WB.translation;
  };
  StepTimes(&scene.world, 3000);  // it slips and wobbles until it turns, too
  const Vector3d start = p_BM();
  StepTimes(&scene.world, 10000);
  EXPECT_LT((p_BM() - start).norm(), 1e-6);
  EXPECT_NEAR(geometry::YawOf(scene.world.GetState(scene.base).X_WB.rotation),
              geometry::WrapToPi(13.0), 1e-9);
}

TEST(PhysicsWorldTest, DrivenBodyMovesExactlyAsToldWhateverItHits) {
  PhysicsWorld world({});
  world.AddFloor(1.0);
  const BodyId ram = world.AddDriven(
      {MakeCollision(geometry::Box{{0.2, 0.2, 0.2}}, {0.0, 0.0, 0.11})}, geometry::Pose3());
  const Vector3d size(0.2, 0.2, 0.2);
  const BodyId box =
      world.AddLoose(BoxMass(size, 50.0), {MakeCollision(geometry::Box{size}, Vector3d::Zero())},
                     At(0.25, 0, 0.1));
  BodyState motion;
  motion.V_WB.linear.x() = 0.25;
  world.SetMotion(ram, motion);
  StepTimes(&world, 1000);
  EXPECT_NEAR(world.GetState(ram).X_WB.translation.x(), 0.25, 1e-12);
  EXPECT_NEAR(world.GetState(box).X_WB.translation.x(), 0.45, 0.003);
  EXPECT_NEAR(world.GetState(box).V_WB.linear.x(), 0.25, 0.01);
}

TEST(PhysicsWorldTest, RisingTrayCarriesItsLoad) {
  TrayScene scene(1);
  BodyState motion = scene.world.GetState(scene.base);
  motion.V_WB.linear.z() = 0.1;
  scene.world.SetMotion(scene.base, motion);
  StepTimes(&scene.world, 2000);
  EXPECT_NEAR(scene.world.GetState(scene.mills[0]).X_WB.translation.z(), kTrayTop + 0.2, 0.0012);
}

TEST(PhysicsWorldTest, FastBodiesDoNotPassThroughThinWalls) {
  for (const double speed : {5.0, 20.0, 50.0, 90.0}) {
    for (int mesh = 0; mesh < 2; ++mesh) {
      PhysicsWorld world({});
      const Vector3d size(0.005, 1.0, 1.0);
      world.AddStatic({mesh == 1 ? MakeCollision(BoxMesh(size), Vector3d::Zero())
                                 : MakeCollision(geometry::Box{size}, Vector3d::Zero())},
                      geometry::Pose3());
      const double mass = 0.1;
      BodyState state = At(-0.513, 0.0, 0.1);
      state.V_WB.linear.x() = speed;
      const BodyId ball = world.AddLoose(
          {mass, Vector3d::Zero(), geometry::SolidInertia(geometry::Sphere{0.01}, mass)},
          {MakeCollision(geometry::Sphere{0.01}, Vector3d::Zero())}, state);
      for (int i = 0; i < 150; ++i) {
        world.Step();
        ASSERT_LT(world.GetState(ball).X_WB.translation.x(), 0.0) << speed << " mesh " << mesh;
      }
    }
  }
}

TEST(PhysicsWorldTest, FastElasticBallComesBackAsFast) {
  PhysicsParams params;
  params.gravity = 0.0;
  PhysicsWorld world(params);
  geometry::Collision wall = MakeCollision(geometry::Box{{0.005, 1.0, 1.0}}, Vector3d::Zero());
  wall.restitution = 1.0;
  world.AddStatic({wall}, geometry::Pose3());
  BodyState state = At(-0.513, 0.0, 0.0);
  state.V_WB.linear.x() = 40.0;
  const BodyId ball =
      world.AddLoose({0.1, Vector3d::Zero(), geometry::SolidInertia(geometry::Sphere{0.01}, 0.1)},
                     {MakeCollision(geometry::Sphere{0.01}, Vector3d::Zero())}, state);
  StepTimes(&world, 40);
  EXPECT_NEAR(world.GetState(ball).V_WB.linear.x(), -40.0, 0.01);
}

TEST(PhysicsWorldTest, ExtraAccelerationActsOnLooseBodies) {
  PhysicsParams params;
  params.gravity = 0.0;
  PhysicsWorld world(params);
  const Vector3d size(0.1, 0.1, 0.1);
  const BodyId box = world.AddLoose(
      BoxMass(size, 2.0), {MakeCollision(geometry::Box{size}, Vector3d::Zero())}, At(0, 0, 0));
  world.SetExtraAcceleration({1.0, 0.0, -2.0});
  StepTimes(&world, 1000);
  const Vector3d v = world.GetState(box).V_WB.linear;
  EXPECT_NEAR((v - Vector3d(1.0, 0.0, -2.0)).norm(), 0.0, 1e-9);
}

TEST(PhysicsWorldTest, OriginAwayFromTheCentreOfMassMovesOnAnArc) {
  PhysicsParams params;
  params.gravity = 0.0;
  PhysicsWorld world(params);
  geometry::MassProperties mass = BoxMass({0.1, 0.1, 0.1}, 1.0);
  mass.p_BBcm = {0.5, 0.0, 0.0};
  BodyState state;
  state.V_WB.angular.z() = 1.0;
  state.V_WB.linear.y() = -0.5;  // then the centre of mass rests
  const BodyId body = world.AddLoose(mass, {}, state);
  StepTimes(&world, 1000);
  const BodyState end = world.GetState(body);
  EXPECT_NEAR((end.X_WB * mass.p_BBcm - mass.p_BBcm).norm(), 0.0, 1e-9);
  EXPECT_NEAR(geometry::YawOf(end.X_WB.rotation), 1.0, 1e-6);
  EXPECT_NEAR(end.V_WB.linear.norm(), 0.5, 1e-9);
}

TEST(PhysicsWorldTest, FrictionIsTheSmallerOfTheTwo) {
  for (const bool is_floor_smooth : {true, false}) {
    PhysicsWorld world({});
    world.AddFloor(is_floor_smooth ? 0.1 : 0.9);
    const Vector3d size(0.3, 0.3, 0.05);
    BodyState state = At(0.0, 0.0, 0.025);
    state.V_WB.linear.x() = 1.0;
    const BodyId box = world.AddLoose(
        BoxMass(size, 1.0),
        {MakeCollision(geometry::Box{size}, Vector3d::Zero(), is_floor_smooth ? 0.9 : 0.1)}, state);
    StepTimes(&world, 500);
    EXPECT_NEAR(world.GetState(box).V_WB.linear.x(), 1.0 - 0.5 * 0.1 * 9.81, 0.005);
  }
}

TEST(PhysicsWorldTest, StepsAndContactsAreCounted) {
  TrayScene scene(2);
  StepTimes(&scene.world, 300);
  EXPECT_EQ(scene.world.num_steps(), 300u);
  EXPECT_EQ(scene.world.num_contacts(), 8);
}

TEST(PhysicsWorldTest, SolverHasNothingToComplainAboutOnAShakenTray) {
  PhysicsWorld::TakeSolverMessages();
  ShakenTray tray;
  tray.Run(0, 4000);
  EXPECT_THAT(PhysicsWorld::TakeSolverMessages(), ::testing::IsEmpty());
}

TEST(PhysicsWorldTest, RefusesParametersOutsideTheirRange) {
  const auto refused = [](PhysicsParams params) -> std::string {
    try {
      PhysicsWorld world(params);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  PhysicsParams params;
  params.time_step = 0.05;
  EXPECT_THAT(refused(params), HasSubstr("time_step [s] is 0.05, wanted 1e-05 to 0.005"));
  params = {};
  params.erp = 1.5;
  EXPECT_THAT(refused(params), HasSubstr("erp is 1.5"));
  params = {};
  params.cfm = 0.0;
  EXPECT_THAT(refused(params), HasSubstr("cfm is 0"));
  params = {};
  params.gravity = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refused(params), HasSubstr("gravity [m/s^2] is nan"));
  params = {};
  params.surface_layer = -1.0;
  EXPECT_THAT(refused(params), HasSubstr("surface_layer [m] is -1"));
}

TEST(PhysicsWorldTest, RefusesUnphysicalMass) {
  PhysicsWorld world({});
  geometry::MassProperties mass = BoxMass({0.1, 0.1, 0.1}, 1.0);
  mass.mass = -1.0;
  try {
    world.AddLoose(mass, {MakeCollision(geometry::Sphere{0.1}, Vector3d::Zero())}, {});
    FAIL() << "accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("loose body with 'shape'"));
  }
}

TEST(PhysicsWorldTest, WrongBodiesAndStatesBreakPreconditions) {
  TrayScene scene(1);
  PhysicsWorld& world = scene.world;
  EXPECT_THROW(world.SetMotion(scene.mills[0], {}), std::logic_error);
  EXPECT_THROW(world.SetState(scene.base, {}), std::logic_error);
  EXPECT_THROW(world.GetState(-1), std::logic_error);
  EXPECT_THROW(world.GetState(1000), std::logic_error);
  BodyState state;
  state.V_WB.linear.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(world.SetState(scene.mills[0], state), std::logic_error);
  state = {};
  state.X_WB.rotation.coeffs() *= 2.0;
  EXPECT_THROW(world.SetMotion(scene.base, state), std::logic_error);
  PhysicsState short_state = world.Save();
  short_state.bodies.pop_back();
  EXPECT_THROW(world.Restore(short_state), std::logic_error);
}

}  // namespace
}  // namespace hires::physics::physics_world_test
