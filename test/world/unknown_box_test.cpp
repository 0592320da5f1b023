#include "hires/world/unknown_box.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/base/error.h"

namespace hires::world::unknown_box_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string WhyNot(const std::string& model) {
  try {
    World().RequireModel(model);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(UnknownBox, ItsNameSaysItsSize) {
  const std::string model = UnknownBoxModel({0.12, 0.0804, 0.2});
  EXPECT_EQ(model, "unknown_0.120x0.080x0.200");
  EXPECT_EQ(SizeOfUnknownBox(model), Eigen::Vector3d(0.12, 0.08, 0.2));
  EXPECT_EQ(UnknownBoxModel(SizeOfUnknownBox("unknown_0.001x10.000x3.217")),
            "unknown_0.001x10.000x3.217");
}

TEST(UnknownBox, AWorldKnowsItAsASolidThatStandsOnItsOrigin) {
  const auto box = World().RequireModel("unknown_0.120x0.080x0.200");
  EXPECT_EQ(box->name, "unknown_0.120x0.080x0.200");
  const double mass = kUnknownDensity * 0.12 * 0.08 * 0.2;
  EXPECT_NEAR(box->mass_properties.mass, mass, 1e-12);
  EXPECT_NEAR(box->mass_properties.p_BBcm.z(), 0.1, 1e-12);
  EXPECT_NEAR(box->mass_properties.I_BBcm(0, 0), mass * (0.08 * 0.08 + 0.2 * 0.2) / 12, 1e-12);
  ASSERT_EQ(box->collisions.size(), 1u);
  const geometry::Aabb bounds =
      geometry::BoundsOf(box->collisions[0].shape, box->collisions[0].X_BS);
  EXPECT_TRUE(bounds.lower.isApprox(Eigen::Vector3d(-0.06, -0.04, 0.0)));
  EXPECT_TRUE(bounds.upper.isApprox(Eigen::Vector3d(0.06, 0.04, 0.2)));
}

TEST(UnknownBox, ABadNameIsToldWithWhatWasWanted) {
  for (const char* bad :
       {"unknown_0.000x0.080x0.200", "unknown_-0.12x0.080x0.200", "unknown_10.001x0.080x0.200",
        "unknown_nanxnanxnan", "unknown_infx0.080x0.200", "unknown_thing", "unknown_",
        "unknown_0.12x0.08x0.2", "unknown_0.120x0.080", "unknown_0.120x0.080x0.200x0.100",
        "unknown_0.120x0.080x0.200 ", "unknown_1e1x0.080x0.200"}) {
    EXPECT_TRUE(SaysUnknownBox(bad));
    EXPECT_EQ(World().FindModel(bad), nullptr) << bad;
    EXPECT_THAT(WhyNot(bad),
                AllOf(HasSubstr(std::string("'") + bad + "'"), HasSubstr("0.001 to 10 m")));
  }
  EXPECT_THAT(WhyNot("unknown"), Not(HasSubstr("box"))) << "no model at all";
}

TEST(UnknownBox, AThingOfNoSizeHasNoModel) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -0.1, 0.0004, 10.1, nan, infinite}) {
    EXPECT_THROW(UnknownBoxModel({0.1, bad, 0.1}), base::ConfigError) << bad;
  }
}

TEST(UnknownBox, AWorldsOwnModelOfThatNameComesFirst) {
  World world;
  ObjectModel own;
  own.name = "unknown_0.120x0.080x0.200";
  own.mass_properties.mass = 7.0;
  world = WithModel(world, own);
  EXPECT_EQ(world.RequireModel(own.name)->mass_properties.mass, 7.0);
}

TEST(UnknownBox, AnObjectOfABadModelIsNamed) {
  try {
    World().ModelOf({"thing1", "unknown_0x0x0", {}, {}, ""});
    FAIL();
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("object 'thing1'"));
  }
}

}  // namespace
}  // namespace hires::world::unknown_box_test
