// Worlds with one to three random oddities: each is loaded with notes that name all of them, or
// refused with a message that names all of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/world/world.h"
#include "support/rounds.h"
#include "world/sdf_texts.h"
#include "world/temp_folder.h"

namespace hires::world::odd_worlds_test {
namespace {

/// Something that a world may have, by the name of the thing.
struct Oddity {
  const char* kind;
  bool is_refused;
  std::function<std::string(const std::string& name)> text;
  /// What is said of it, with %s for the name; "" if it needs no word.
  const char* said;
};

std::string Loose(const std::string& name, const std::string& content) {
  return fmt::format("<model name='{}'><pose>3 3 0 0 0 0</pose>{}</model>\n", name, content);
}

std::string Body(const std::string& name, const std::string& inertial, const std::string& shape) {
  return fmt::format(
      "<link name='{}'>{}<collision name='c'><geometry>{}</geometry></collision></link>", name,
      inertial, shape);
}

const char kGood[] =
    "<inertial><mass>1</mass><inertia><ixx>.2</ixx><iyy>.2</iyy><izz>.2</izz></inertia></inertial>";
const char kPlaceholder[] =
    "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";
const char kBad[] =
    "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>9</izz></inertia></inertial>";

std::string Jointed(const std::string& name, const std::string& type, const std::string& inertial) {
  return Loose(name, Body("a", inertial, kUnitBox) + Body("b", inertial, kUnitBox) +
                         fmt::format("<joint name='j' type='{}'><parent>a</parent><child>b</child>"
                                     "</joint>",
                                     type));
}

std::string StaticShape(const std::string& name, const std::string& shape) {
  return StaticModel(name, LinkWithShape(shape));
}

/// Things of the classes that public worlds are made of.
std::vector<Oddity> Oddities() {
  using Name = const std::string&;
  return {
      {"inertial of what is static", false,
       [](Name n) { return StaticModel(n, Body("l", kBad, kUnitBox)); }, ""},
      {"wrapper", false,
       [](Name n) {
         return fmt::format(
             "<model name='{}'><include><uri> model://crate </uri></include></model>", n);
       },
       ""},
      {"glued links", false, [](Name n) { return Jointed(n, "fixed", kGood); }, ""},
      {"inertia of a larger body", false,
       [](Name n) { return Loose(n, Body("l", kPlaceholder, kUnitBox)); }, "%s"},
      {"hinge", false, [](Name n) { return Jointed(n, "revolute", kBad); }, "%s"},
      {"joint to nothing", false,
       [](Name n) {
         return Loose("m_" + n, Body("a", kGood, kUnitBox) +
                                    "<joint name='j' type='fixed'><parent>a</parent><child>gone_" +
                                    n + "</child></joint>");
       },
       "'gone_%s' is not there"},
      {"no mass", false, [](Name n) { return Loose(n, Body("l", "", kUnitBox)); }, "%s"},
      {"parts", false,
       [](Name n) { return Loose(n, Body("a", kGood, kUnitBox) + Body("b", kGood, kUnitBox)); },
       "%s"},
      {"no shape", false, [](Name n) { return Loose(n, "<link name='l'/>"); }, "%s"},
      {"capsule", false,
       [](Name n) {
         return StaticShape(n, "<capsule><radius>1</radius><length>1</length></capsule>");
       },
       ""},
      {"actor", false, [](Name n) { return fmt::format("<actor name='{}'/>", n); }, "%s"},
      {"population", false,
       [](Name n) {
         return fmt::format("<population name='{}'><model_count>7</model_count></population>", n);
       },
       "%s"},
      {"plane below", false,
       [](Name n) {
         return StaticModel(n, "<pose>0 0 -1 0 0 0</pose>" +
                                   LinkWithShape("<plane><normal>0 0 1</normal></plane>"));
       },
       "below another one"},
      {"unknown element", false, [](Name n) { return fmt::format("<modell name='{}'/>", n); },
       "%s"},
      {"light and plugin", false,
       [](Name n) { return fmt::format("<light name='{}'/><plugin name='p'/>", n); }, ""},
      {"collision without a shape", false,
       [](Name n) {
         return StaticModel(n, "<link name='l'><collision name='" + n + "_c'/></link>");
       },
       "%s_c"},
      {"comment", false, [](Name n) { return "<!-- <model " + n + " -->"; }, ""},
      {"bad mass of what can move", true,
       [](Name n) { return Loose(n, Body(n + "_link", kBad, kUnitBox)); }, "%s_link"},
      {"missing model", true,
       [](Name n) { return "<include><uri>model://" + n + "</uri></include>"; }, "model://%s"},
      {"missing model of Fuel", true,
       [](Name n) { return "<include><uri>https://x.org/1.0/y/models/" + n + "</uri></include>"; },
       "models/%s"},
      {"missing mesh", true,
       [](Name n) { return StaticShape(n, "<mesh><uri>" + n + ".stl</uri></mesh>"); }, "%s.stl"},
      {"heightmap", true,
       [](Name n) { return StaticShape(n, "<heightmap><uri>x</uri></heightmap>"); }, "<heightmap>"},
      {"tilted plane", true,
       [](Name n) { return StaticShape(n, "<plane><normal>0 1 1</normal></plane>"); },
       "level ones that face up"},
      {"far away", false,
       [](Name n) {
         return StaticModel("near_" + n, LinkWithShape(kUnitBox)) +
                StaticModel(n, "<pose>5000 0 0 0 0 0</pose>" + LinkWithShape(kUnitBox));
       },
       "'%s'"},
      {"farther than anything is written", true,
       [](Name n) {
         return StaticModel(n, "<pose>5e6 0 0 0 0 0</pose>" + LinkWithShape(kUnitBox));
       },
       "'%s'"},
      {"nothing collides", false,
       [](Name n) {
         return StaticModel(n, LinkWithShape(kUnitBox,
                                             "<surface><contact><collide_bitmask>0x0"
                                             "</collide_bitmask></contact></surface>"));
       },
       "<collide_bitmask> of 0"},
      {"two shapes", false,
       [](Name n) {
         return StaticShape(n, std::string(kUnitBox) + "<sphere><radius>1</radius></sphere>");
       },
       "of several shapes"},
      {"size of nothing", false,
       [](Name n) {
         return StaticModel(n, "<link name='l'><collision name='" + n +
                                   "'><geometry><box><size>2 0 0</size></box></geometry>"
                                   "</collision></link>");
       },
       "with a shape of size 0 left out, as nothing touches it"},
      {"second pose", false,
       [](Name n) {
         return StaticModel(
             n, "<pose>0 0 0 0 0 0</pose>" + LinkWithShape(kUnitBox) + "<pose>9 0 0 0 0 0</pose>");
       },
       "<pose> more in a <model>"},
      {"origin", false,
       [](Name n) { return StaticModel(n, "<link name='l'><origin xyz='1 0 0'/></link>") + ""; },
       "<origin> in <link> left out, as SDF knows none there (was <pose> meant?)"},
      {"no number", true,
       [](Name n) { return StaticShape(n, "<sphere><radius>r_" + n + "</radius></sphere>"); },
       "<radius> in <sphere> is 'r_%s', wanted 1 number"},
      {"too few numbers", true,
       [](Name n) { return StaticShape(n, "<box><size>1 1</size></box>"); },
       "<size> in <box> is '1 1', wanted 3 numbers"},
      {"static in other words", true,
       [](Name n) {
         return "<model name='" + n + "'><static>yes_" + n + "</static>" + LinkWithShape(kUnitBox) +
                "</model>";
       },
       "<static> is 'yes_%s', wanted true or false"},
      {"static in capitals", false,
       [](Name n) {
         return "<model name='" + n + "'><static> TRUE </static>" + LinkWithShape(kUnitBox) +
                "</model>";
       },
       ""},
      {"commas", false,
       [](Name n) {
         return StaticModel(n, "<pose>1, 2, 0.5, 0, 0, 0</pose>" +
                                   LinkWithShape("<box><size>1,1, 1</size></box>"));
       },
       ""},
      {"two links of one name", true,
       [](Name n) {
         return StaticModel(n, "<link name='l_" + n + "'/><link name='l_" + n + "'/>");
       },
       "link 'l_%s' has the name of another"},
      {"area on what moves", true,
       [](Name n) {
         return LooseCube("cube_" + n) +
                fmt::format("<frame name='{0}' attached_to='cube_{0}'/>", n);
       },
       "frame '%s'"},
      {"pose of nothing", true,
       [](Name n) {
         return fmt::format("<frame name='{}'><pose relative_to='gone_{}'/></frame>", n, n);
       },
       "gone_%s"},
      {"endless friction", false,
       [](Name n) {
         return StaticModel(n, LinkWithShape(kUnitBox,
                                             "<surface><friction><ode><mu>inf</mu></ode>"
                                             "</friction></surface>"));
       },
       "infinite or negative: 1000 is taken"},
      {"friction", true,
       [](Name n) {
         return StaticModel(n, LinkWithShape(kUnitBox, "<surface><friction><ode><mu2>m_" + n +
                                                           "</mu2></ode></friction></surface>"));
       },
       "<mu2> in <ode> is 'm_%s', wanted 1 number"},
  };
}

std::string Said(const Oddity& oddity, const std::string& name) {
  std::string said = oddity.said;
  const std::size_t at = said.find("%s");
  return at == std::string::npos ? said : said.replace(at, 2, name);
}

class OddWorldsTest : public testing::Test {
 protected:
  OddWorldsTest() {
    folder_.Write("models/crate/model.sdf",
                  ModelFile(StaticModel("crate", LinkWithShape(kUnitBox))));
    folder_.Write("models/crate/model.config", ModelConfig("crate"));
    base::SetLogSink([](base::LogLevel, const std::string&) {});
  }
  ~OddWorldsTest() override { base::SetLogSink({}); }

  /// What is said of a world; `is_refused` tells how.
  std::string SaidOf(const std::string& content, const std::string& version, bool* is_refused) {
    std::string text = WorldText(content);
    text.replace(text.find("1.7"), 3, version);
    *is_refused = false;
    try {
      return base::Join(LoadWorld(folder_.Write("odd.world", text)).notes, "\n");
    } catch (const base::ConfigError& error) {
      *is_refused = true;
      return error.what();
    }
  }

  TempFolder folder_;
};

TEST_F(OddWorldsTest, EachAloneIsLoadedOrRefusedAndSaid) {
  for (const Oddity& oddity : Oddities()) {
    bool is_refused = false;
    const std::string said =
        SaidOf(StaticShape("floor", "<plane><normal>0 0 1</normal></plane>") + oddity.text("thing"),
               "1.7", &is_refused);
    EXPECT_EQ(is_refused, oddity.is_refused) << oddity.kind << ": " << said;
    EXPECT_NE(said.find(Said(oddity, "thing")), std::string::npos) << oddity.kind << ": " << said;
    if (*oddity.said == '\0') {
      EXPECT_EQ(said, "") << oddity.kind;
    }
  }
}

TEST_F(OddWorldsTest, OfSeveralEachIsSaid) {
  const std::vector<Oddity> oddities = Oddities();
  const char* versions[] = {"1.6", "1.7", "1.9", "1.10", "1.12"};
  for (int round = 0; round < test_support::Rounds(400); ++round) {
    base::Rng rng(static_cast<std::uint64_t>(round) + 1);
    std::vector<const Oddity*> drawn;
    const int number = 1 + rng.Index(3);
    while (static_cast<int>(drawn.size()) < number) {
      const Oddity* oddity = &oddities[rng.Index(static_cast<int>(oddities.size()))];
      if (std::find(drawn.begin(), drawn.end(), oddity) == drawn.end()) drawn.push_back(oddity);
    }
    std::string content = StaticShape("floor", "<plane><normal>0 0 1</normal></plane>");
    bool is_any_refused = false;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      content += drawn[i]->text(fmt::format("thing{}", i)) + "\n";
      is_any_refused = is_any_refused || drawn[i]->is_refused;
      if (rng.Bernoulli(0.5)) content += StaticShape(fmt::format("wall{}", i), kUnitBox);
    }
    const std::string version = versions[rng.Index(5)];
    bool is_refused = false;
    const std::string said = SaidOf(content, version, &is_refused);
    EXPECT_EQ(is_refused, is_any_refused) << content << said;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      EXPECT_NE(said.find(Said(*drawn[i], fmt::format("thing{}", i))), std::string::npos)
          << drawn[i]->kind << " in\n"
          << content << "said:\n"
          << said;
    }
    if (version == "1.10" || version == "1.12") {
      EXPECT_NE(said.find("read as 1.9"), std::string::npos) << said;
    }
  }
}

}  // namespace
}  // namespace hires::world::odd_worlds_test
