// Shapes and floors of worlds as people have them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/world/occupancy_grid.h"
#include "hires/world/world.h"
#include "support/glb.h"
#include "world/sdf_texts.h"
#include "world/wild_world.h"

namespace hires::world::wild_shapes_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class WildShapesTest : public WildWorld {};

/// Whether something stands at a place, between 0.1 and 0.2 m.
bool StandsAt(const World& world, double x, double y) {
  const OccupancyGrid grid = SliceWorld(world, 0.1, 0.2, 0.02);
  const Eigen::Vector2d cell = (Eigen::Vector2d(x, y) - grid.origin) / grid.resolution;
  return grid.at(static_cast<int>(cell.x()), static_cast<int>(cell.y())) == Cell::kOccupied;
}

TEST_F(WildShapesTest, EveryShapeHasItsOwnOutline) {
  const auto bounds = [&](const std::string& shape) {
    const World world = Load(StaticModel("a", LinkWithShape(shape)), "1.11");
    geometry::Aabb box;
    for (const auto& part : world.statics.at(0).collisions)
      box.Include(geometry::BoundsOf(part.shape, part.X_BS));
    return box;
  };
  const auto expect = [](const geometry::Aabb& box, const Eigen::Vector3d& half, double slack) {
    EXPECT_TRUE((box.upper - half).cwiseAbs().maxCoeff() < slack) << box.upper.transpose();
    EXPECT_TRUE((box.lower + half).cwiseAbs().maxCoeff() < slack) << box.lower.transpose();
  };
  expect(bounds("<capsule><radius>0.1</radius><length>0.6</length></capsule>"), {0.1, 0.1, 0.4},
         1e-12);
  expect(bounds("<ellipsoid><radii>0.4 0.3 0.2</radii></ellipsoid>"), {0.4, 0.3, 0.2}, 0.004);
  expect(bounds("<ellipsoid><radii>0.3 0.3 0.3</radii></ellipsoid>"), {0.3, 0.3, 0.3}, 1e-12);
  expect(bounds("<cone><radius>0.2</radius><length>0.5</length></cone>"), {0.2, 0.2, 0.25}, 0.002);
}

TEST_F(WildShapesTest, LooseCapsulesConesAndPolylinesArePlayedAndEllipsoidsStandStill) {
  const auto load = [&](const std::string& shape) {
    return Load(Model("a", Link("l", "0 0 0 0 0 0", Inertial(1, 1), shape)), "1.11");
  };
  for (const std::string shape :
       {"<capsule><radius>0.1</radius><length>0.6</length></capsule>",
        "<cone><radius>0.2</radius><length>0.5</length></cone>",
        "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>0.5</height>"
        "</polyline>"}) {
    EXPECT_EQ(load(shape).initial.objects.size(), 1u) << shape;
  }
  const World world = load("<ellipsoid><radii>0.4 0.3 0.2</radii></ellipsoid>");
  EXPECT_EQ(world.statics.size(), 1u);
  EXPECT_THAT(world.notes, testing::Contains(HasSubstr("<ellipsoid>")));
}

TEST_F(WildShapesTest, APolylineKeepsItsBaysAndHoles) {
  const std::string bay =
      "<polyline><point>0 0</point><point>1 0</point><point>1 0.3</point><point>0.3 0.3</point>"
      "<point>0.3 1</point><point>0 1</point><height>0.8</height></polyline>";
  const World angle =
      Load(StaticModel("plinth", "<pose>2 1.5 0 0 0 0</pose>" + LinkWithShape(bay)));
  EXPECT_TRUE(StandsAt(angle, 2.8, 1.65));
  EXPECT_TRUE(StandsAt(angle, 2.15, 2.3));
  EXPECT_FALSE(StandsAt(angle, 2.7, 2.2)) << "in the bay";
  const World frame = Load(StaticModel(
      "frame", LinkWithShape(
                   "<polyline><point>0 0</point><point>0 2</point><point>2 2</point>"
                   "<point>2 0</point><height>1</height></polyline><polyline><point>0.5 0.5</point>"
                   "<point>1.5 0.5</point><point>1.5 1.5</point><point>0.5 1.5</point>"
                   "<height>1</height></polyline>")));
  EXPECT_TRUE(StandsAt(frame, 0.25, 1.0));
  EXPECT_TRUE(StandsAt(frame, 1.75, 1.0));
  EXPECT_FALSE(StandsAt(frame, 1.0, 1.0)) << "in the hole";
  for (const std::string bad :
       {"<polyline><point>0 0</point><point>1 1</point><point>1 0</point><point>0 1</point>"
        "<height>1</height></polyline>",
        "<polyline><point>0 0</point><point>1 1</point><height>1</height></polyline>",
        "<polyline><point>0 0</point><point>1 0</point><point>1 1</point></polyline>",
        "<polyline><point>0 0</point><point>1 x</point><point>1 1</point><height>1</height>"
        "</polyline>"}) {
    EXPECT_THAT(ErrorOf(StaticModel("a", LinkWithShape(bad))),
                AllOf(HasSubstr("test.world:3: collision 'c'"), HasSubstr("<polyline>")))
        << bad;
  }
}

TEST_F(WildShapesTest, ASubmeshIsReadAlone) {
  folder_.Write("two.obj", kTwoCubes);
  const auto bounds = [&](const std::string& submesh) {
    const World world = Load(StaticModel(
        "a", LinkWithShape("<mesh><uri>two.obj</uri><scale>2 1 1</scale>" + submesh + "</mesh>")));
    const auto& part = world.statics.at(0).collisions.at(0);
    return geometry::BoundsOf(part.shape, part.X_BS);
  };
  EXPECT_NEAR(bounds("").upper.x(), 12.0, 1e-6);
  EXPECT_NEAR(bounds("<submesh><name>left</name></submesh>").upper.x(), 2.0, 1e-6);
  EXPECT_NEAR(bounds("<submesh><name>right</name></submesh>").lower.x(), 10.0, 1e-6);
  EXPECT_NEAR(bounds("<submesh><name>right</name><center>true</center></submesh>").lower.x(), -1.0,
              1e-6);
  EXPECT_THAT(ErrorOf(StaticModel("a", LinkWithShape("<mesh><uri>two.obj</uri><submesh><name>rigth"
                                                     "</name></submesh></mesh>"))),
              AllOf(HasSubstr("submesh 'rigth' is unknown"), HasSubstr("'right'")));
}

/// One triangle for each geometry, in the node of that name, `x` [cm] along x.
std::string Collada(const std::vector<std::pair<std::string, int>>& nodes) {
  std::string geometries, scene;
  for (const auto& [name, x] : nodes) {
    geometries += fmt::format(
        "<geometry id='g{0}' name='form_{0}'><mesh><source id='p{0}'><float_array id='a{0}' "
        "count='9'>{1} 0 0 {2} 0 0 {1} 100 0</float_array><technique_common><accessor "
        "source='#a{0}' count='3' stride='3'><param name='X' type='float'/><param name='Y' "
        "type='float'/><param name='Z' type='float'/></accessor></technique_common></source>"
        "<vertices id='v{0}'><input semantic='POSITION' source='#p{0}'/></vertices><triangles "
        "count='1'><input semantic='VERTEX' source='#v{0}' offset='0'/><p>0 1 2</p></triangles>"
        "</mesh></geometry>",
        name, x, x + 100);
    scene += fmt::format(
        "<node id='n{0}' name='{0}'><translate>0 200 0</translate><instance_geometry "
        "url='#g{0}'/></node>",
        name);
  }
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit meter='0.01'/><up_axis>Z_UP</up_axis></asset>"
         "<library_geometries>" +
         geometries + "</library_geometries><library_visual_scenes><visual_scene id='s'>" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

TEST_F(WildShapesTest, ASubmeshOfColladaIsNamedByItsNodeAndPlacedByIt) {
  folder_.Write("two.dae", Collada({{"left", 0}, {"right", 300}}));
  for (const std::string name : {"right", "form_right"}) {
    const World world =
        Load(StaticModel("a", LinkWithShape("<mesh><uri>two.dae</uri><submesh><name>" + name +
                                            "</name></submesh></mesh>")));
    const auto& part = world.statics.at(0).collisions.at(0);
    const geometry::Aabb box = geometry::BoundsOf(part.shape, part.X_BS);
    EXPECT_TRUE(box.lower.isApprox(Eigen::Vector3d(3, 2, 0), 1e-5)) << box.lower.transpose();
    EXPECT_TRUE(box.upper.isApprox(Eigen::Vector3d(4, 3, 0), 1e-5)) << box.upper.transpose();
  }
}

TEST_F(WildShapesTest, ASubmeshOfGltfIsNamedByItsNodeAndPlacedByIt) {
  folder_.Write("part.glb", test_support::GlbOf(test_support::TetrahedronGltf()));
  for (const std::string submesh : {"", "<submesh><name>part</name></submesh>"}) {
    const World world =
        Load(StaticModel("a", LinkWithShape("<mesh><uri>part.glb</uri>" + submesh + "</mesh>")));
    const auto& part = world.statics.at(0).collisions.at(0);
    const geometry::Aabb box = geometry::BoundsOf(part.shape, part.X_BS);
    EXPECT_TRUE(box.lower.isApprox(Eigen::Vector3d(0, 0, 10), 1e-6)) << box.lower.transpose();
    EXPECT_TRUE(box.upper.isApprox(Eigen::Vector3d(1, 2, 13), 1e-6)) << box.upper.transpose();
  }
}

TEST_F(WildShapesTest, ShapesOfSizeZeroAreLeftOutAndTheOthersStay) {
  for (const std::string nothing :
       {"<box><size>0 0 0</size></box>", "<box><size>2 0 0</size></box>",
        "<cylinder><radius>0</radius><length>1</length></cylinder>",
        "<sphere><radius>0</radius></sphere>",
        "<capsule><radius>0</radius><length>1</length></capsule>",
        "<ellipsoid><radii>1 0 0</radii></ellipsoid>"}) {
    const World world =
        Load(StaticModel("a", "<link name='l'><collision name='c'><geometry>" + nothing +
                                  "</geometry></collision><collision name='d'><geometry>" +
                                  kUnitBox + "</geometry></collision></link>"));
    EXPECT_THAT(world.notes, ElementsAre(AllOf(HasSubstr("1 collision with a shape of size 0"),
                                               HasSubstr("test.world:3 'c'"))))
        << nothing;
    ASSERT_EQ(world.statics.size(), 1u) << nothing;
    EXPECT_EQ(world.statics[0].collisions.size(), 1u) << nothing;
  }
}

/// It stops what drives there, or carries what stands on it.
TEST_F(WildShapesTest, APlateWithoutThicknessIsNotLeftOut) {
  for (const std::string plate : {"<box><size>2 0 1</size></box>", "<box><size>2 1 0</size></box>",
                                  "<cylinder><radius>1</radius><length>0.0</length></cylinder>"}) {
    EXPECT_THROW(Load(StaticModel("a", "<link name='l'><collision name='c'><geometry>" + plate +
                                           "</geometry></collision></link>")),
                 base::ConfigError)
        << plate;
  }
}

TEST_F(WildShapesTest, AllShapesOfACollisionAreTakenWhateverTheirNames) {
  base::Rng rng(13);
  for (int i = 0; i < 30; ++i) {
    std::string link;
    int num_shapes = 0, num_several = 0;
    for (int j = 1 + rng.Index(3); j > 0; --j) {
      std::string geometries;
      const int count = 1 + rng.Index(3);
      for (int k = 0; k < count; ++k) {
        const bool is_capsule = rng.Bernoulli(0.3);
        const std::string shape =
            is_capsule ? "<ellipsoid><radii>1 2 3</radii></ellipsoid>" : kUnitBox;
        geometries += k > 0 && rng.Bernoulli(0.5) ? shape : "</geometry><geometry>" + shape;
      }
      geometries = "<geometry>" + geometries + "</geometry>";
      const std::string empty = "<geometry></geometry>";
      if (geometries.rfind(empty, 0) == 0) geometries.erase(0, empty.size());
      link += fmt::format("<collision name='c'><pose>{} 0 0 0 0 0</pose>{}</collision>", num_shapes,
                          geometries);
      num_shapes += count;
      num_several += count > 1 ? 1 : 0;
    }
    const World world = Load(StaticModel("a", "<link name='l'>" + link + "</link>"));
    ASSERT_EQ(world.statics.size(), 1u) << link;
    EXPECT_EQ(world.statics[0].collisions.size(), static_cast<std::size_t>(num_shapes)) << link;
    EXPECT_EQ(world.notes.size(), num_several > 0 ? 1u : 0u) << link;
    std::set<std::string> names;
    for (const auto& shape : world.statics[0].collisions) names.insert(shape.name);
    EXPECT_EQ(names.size(), static_cast<std::size_t>(num_shapes)) << link;
  }
}

std::string Plane(const std::string& name, double z, double friction) {
  return StaticModel(
      name, fmt::format("<pose>0 0 {} 0 0 0</pose>", z) +
                LinkWithShape("<plane><normal>0 0 1</normal></plane>",
                              fmt::format("<surface><friction><ode><mu>{}</mu></ode></friction>"
                                          "</surface>",
                                          friction)));
}

TEST_F(WildShapesTest, TheHighestPlaneIsTheFloor) {
  const World same = Load(Plane("a", 0, 1) + Plane("b", 0, 1));
  EXPECT_THAT(same.notes, ElementsAre(HasSubstr("test.world:4")));
  const World rough = Load(Plane("a", 0, 0.5) + Plane("b", 0, 0.7));
  EXPECT_EQ(rough.floor_friction, 0.7);
  EXPECT_THAT(rough.notes, ElementsAre(AllOf(HasSubstr("0.7"), HasSubstr("0.5"))));
  for (const bool is_first : {true, false}) {
    const std::string upper = Plane("a", 0, 0.5), lower = Plane("b", -0.3, 0.7);
    const World world = Load(is_first ? upper + lower : lower + upper);
    EXPECT_EQ(world.floor_friction, 0.5);
    EXPECT_EQ(world.lowered_by, 0.0);
    EXPECT_THAT(world.notes, ElementsAre(HasSubstr(is_first ? "test.world:4" : "test.world:3")));
  }
  const World raised = Load(Plane("a", 1.5, 1) + StaticModel("box", "<pose>0 0 2 0 0 0</pose>" +
                                                                        LinkWithShape(kUnitBox)));
  EXPECT_EQ(raised.lowered_by, 1.5);
  EXPECT_NEAR(raised.statics.at(0).X_MB.translation.z(), 0.5, 1e-12);
  EXPECT_THAT(log_, HasSubstr("floor=1.500 m"));
}

}  // namespace
}  // namespace hires::world::wild_shapes_test
