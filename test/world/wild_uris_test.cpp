// Where what worlds as people have them include is looked for.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/world/world.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"
#include "world/wild_world.h"

namespace hires::world::wild_uris_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class WildUrisTest : public WildWorld {};

/// Sets a variable as long as this is.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* before = std::getenv(name);
    had_ = before != nullptr;
    if (had_) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  bool had_{false};
  std::string before_;
};

TEST_F(WildUrisTest, ModelsBesideWorldsAreFound) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)), "package/models");
  const std::string text = WorldText("<include><uri>model://crate</uri></include>");
  for (const std::string place :
       {"package/worlds/a.world", "package/worlds/indoor/a.world", "package/a.world"}) {
    EXPECT_EQ(LoadWorld(folder_.Write(place, text)).statics.size(), 1u) << place;
  }
  folder_.Write("package/inner/package.xml", "<package/>");
  const std::string other = folder_.Write("package/inner/worlds/a.world", text);
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadWorld(other); }),
              AllOf(HasSubstr("'model://crate' is not there"), HasSubstr("GZ_SIM_RESOURCE_PATH"),
                    HasSubstr("GAZEBO_MODEL_PATH")))
      << "models of another package";
}

TEST_F(WildUrisTest, AddressesThatBeginWithTheModelFolderAreFound) {
  folder_.Write("package/models/crate/meshes/two.obj", kTwoCubes);
  folder_.Write("package/secret/two.obj", kTwoCubes);
  for (const std::string place : {"package/worlds/a.world", "package/worlds/indoor/a.world"}) {
    const auto load = [&](const std::string& uri) {
      WriteModel("crate",
                 StaticModel("crate", LinkWithShape("<mesh><uri>\n" + uri + "\n</uri></mesh>")),
                 "package/models");
      return LoadWorld(
          folder_.Write(place, WorldText("<include><uri>model://crate</uri></include>")));
    };
    const std::uint64_t hash = load("model://crate/meshes/two.obj").hash;
    for (const char* uri : {"file://models/crate/meshes/two.obj", "models/crate/meshes/two.obj",
                            "file://crate/meshes/two.obj"}) {
      EXPECT_EQ(load(uri).hash, hash) << uri;
    }
    EXPECT_THAT(MessageOf<base::ConfigError>([&] { load("file://models/crate/meshes/tow.obj"); }),
                AllOf(HasSubstr("'file://models/crate/meshes/tow.obj' is not there"),
                      HasSubstr("two.obj'?")));
    for (const char* uri : {"file://secret/two.obj", "file://models/../secret/two.obj"})
      EXPECT_THROW(load(uri), base::ConfigError) << uri;
  }
}

TEST_F(WildUrisTest, EscapesInAddressesAreRead) {
  WriteModel("my crate (1)", StaticModel("crate", LinkWithShape(kUnitBox)));
  for (const char* uri : {"model://my crate (1)", "model://my%20crate%20%281%29",
                          "models/my%20crate (1)/model.sdf"}) {
    EXPECT_EQ(Load(fmt::format("<include><uri>{}</uri></include>", uri)).statics.size(), 1u);
  }
  const std::string file = "file://" + folder_.path("models/my crate (1)/model.sdf");
  EXPECT_EQ(Load("<include><uri>" + base::Join(base::Split(file, ' '), "%20") + "</uri></include>")
                .statics.size(),
            1u);
  EXPECT_THAT(ErrorOf("<include><uri>model://none%20</uri></include>"),
              HasSubstr("'model://none%20' is not there"));
  EXPECT_THAT(ErrorOf("<include><uri>model://%2e%2e/%2e%2e/x</uri></include>"),
              HasSubstr("is not there"));
}

TEST_F(WildUrisTest, GazebosVariablesAndCachesAreLookedThrough) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)), "elsewhere");
  WriteModel("2", StaticModel("seat", LinkWithShape(kUnitBox)),
             "home/.gz/fuel/fuel.gazebosim.org/openrobotics/models/office chair");
  WriteModel("10", StaticModel("seat", LinkWithShape("<sphere><radius>1</radius></sphere>")),
             "home/.gz/fuel/fuel.gazebosim.org/openrobotics/models/office chair");
  const std::string include = "<include><uri>model://crate</uri></include>";
  for (const char* variable : {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH",
                               "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH"}) {
    const Variable set(variable, "/no/such:" + folder_.path("elsewhere"));
    EXPECT_EQ(Load(include).statics.size(), 1u) << variable;
  }
  const Variable home("HOME", folder_.path("home"));
  for (const std::string uri :
       {"https://fuel.gazebosim.org/1.0/OpenRobotics/models/Office%20Chair",
        "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Office_Chair/10",
        " https://fuel.ignitionrobotics.org/1.0/x/models/OFFICE CHAIR/tip/ "}) {
    const World world = Load("<include><name>seat</name><uri>" + uri + "</uri></include>");
    ASSERT_EQ(world.statics.size(), 1u) << uri;
    EXPECT_TRUE(std::holds_alternative<geometry::Sphere>(world.statics[0].collisions[0].shape))
        << "the newest version";
  }
}

TEST_F(WildUrisTest, AllThatIsMissingIsSaidAtOnceWithWhatComesNear) {
  WriteModel("crate", StaticModel("crate", LinkWithShape(kUnitBox)));
  folder_.Write("meshes/table.stl", "x");
  const std::string error = ErrorOf(
      "<include><uri>model://crates</uri></include>\n"
      "<include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/OfficeChairGrey</uri>"
      "</include>\n" +
      StaticModel("t", LinkWithShape("<mesh><uri>meshes/tabel.stl</uri></mesh>")) +
      "<actor name='x'/>");
  EXPECT_THAT(error, AllOf(HasSubstr("test.world:3: 'model://crates' is not there"),
                           HasSubstr("did you mean 'crate'?"), HasSubstr("test.world:4: 'https://"),
                           HasSubstr("nothing is fetched"), HasSubstr("OfficeChairGrey"),
                           HasSubstr("test.world:5")));
  EXPECT_THAT(error, AllOf(HasSubstr("table.stl'?"), HasSubstr("1 actor")));
}

}  // namespace
}  // namespace hires::world::wild_uris_test
