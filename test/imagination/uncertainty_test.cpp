#include "hires/imagination/uncertainty.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "support/messages.h"

namespace hires::imagination::uncertainty_test {
namespace {

using hires::test_support::ConfigErrorOf;
using simulation::Variation;
using ::testing::AllOf;
using ::testing::HasSubstr;

Uncertainty Parse(const std::string& yaml) { return ParseUncertainty(yaml, "u.yaml"); }

std::string WhyRefused(const std::string& yaml) {
  return ConfigErrorOf([&] { Parse(yaml); });
}

TEST(UncertaintyTest, ReadsEachKindOfDistribution) {
  const Uncertainty read = Parse(R"(
object_mass: {distribution: uniform, lower: 0.8, upper: 1.2, unit: factor, source: a}
command_delay: {distribution: fixed, value: 0.03, unit: s, source: b}
start_yaw: {distribution: normal, mean: 0.1, sd: 0.05, unit: rad, source: c}
)");
  ASSERT_EQ(read.quantities.size(), 3u);
  EXPECT_EQ(read.quantities.at("object_mass").kind, Distribution::Kind::kUniform);
  EXPECT_EQ(read.quantities.at("object_mass").first, 0.8);
  EXPECT_EQ(read.quantities.at("object_mass").second, 1.2);
  EXPECT_EQ(read.quantities.at("command_delay").kind, Distribution::Kind::kFixed);
  EXPECT_EQ(read.quantities.at("command_delay").first, 0.03);
  EXPECT_EQ(read.quantities.at("start_yaw").kind, Distribution::Kind::kNormal);
  EXPECT_EQ(read.quantities.at("start_yaw").first, 0.1);
  EXPECT_EQ(read.quantities.at("start_yaw").second, 0.05);
}

TEST(UncertaintyTest, RefusesUnknownQuantities) {
  EXPECT_THAT(WhyRefused("object_mas: {distribution: fixed, value: 1, unit: factor, source: a}"),
              AllOf(HasSubstr("u.yaml"), HasSubstr("quantity 'object_mas' is unknown"),
                    HasSubstr("did you mean 'object_mass'"), HasSubstr("line 1")));
}

TEST(UncertaintyTest, RefusesAnotherUnit) {
  EXPECT_THAT(
      WhyRefused("start_yaw: {distribution: fixed, value: 1, unit: deg, source: a}"),
      AllOf(HasSubstr("u.yaml: start_yaw.unit is 'deg'"), HasSubstr("'rad'"), HasSubstr("line 1")));
}

TEST(UncertaintyTest, RefusesUnknownDistributions) {
  EXPECT_THAT(WhyRefused("start_x: {distribution: gauss, mean: 0, sd: 1, unit: m, source: a}"),
              AllOf(HasSubstr("start_x.distribution is 'gauss'"), HasSubstr("'uniform'"),
                    HasSubstr("'normal'")));
}

TEST(UncertaintyTest, RefusesALowerEndAboveTheUpper) {
  EXPECT_THAT(
      WhyRefused("start_x: {distribution: uniform, lower: 0.2, upper: 0.1, unit: m, source: a}"),
      AllOf(HasSubstr("start_x.upper is '0.1'"), HasSubstr("at least the lower end")));
}

TEST(UncertaintyTest, RefusesWhatMakesNoSense) {
  EXPECT_THAT(WhyRefused("object_mass: {distribution: fixed, value: -1, unit: factor, source: a}"),
              AllOf(HasSubstr("object_mass.value is '-1'"), HasSubstr("between 0.1 and 10")));
  EXPECT_THAT(
      WhyRefused("wheel_slip: {distribution: uniform, lower: 0, upper: 3, unit: share, source: a}"),
      HasSubstr("wheel_slip.upper is '3'"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: normal, mean: 0, sd: -0.1, unit: m, source: a}"),
              HasSubstr("start_x.sd is '-0.1'"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed, value: .nan, unit: m, source: a}"),
              HasSubstr("start_x.value is '.nan'"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed, value: .inf, unit: m, source: a}"),
              HasSubstr("start_x.value is '.inf'"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed, value: much, unit: m, source: a}"),
              AllOf(HasSubstr("start_x.value is 'much'"), HasSubstr("a number")));
}

TEST(UncertaintyTest, RefusesMissingKeysAndKeysOfOtherDistributions) {
  EXPECT_THAT(WhyRefused("start_x: {distribution: normal, mean: 0, unit: m, source: a}"),
              HasSubstr("start_x.sd is missing"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed, value: 0, source: a}"),
              HasSubstr("start_x.unit is missing"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed, value: 0, unit: m}"),
              HasSubstr("start_x.source is missing"));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed, value: 0, sd: 1, unit: m, source: a}"),
              HasSubstr("start_x.sd"));
}

TEST(UncertaintyTest, SaysAllKeysAtOnceThatAreMissing) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> numbers{
      {"fixed", {"value"}},
      {"uniform", {"lower", "upper"}},
      {"normal", {"mean", "sd"}},
      {"lognormal", {"median", "log_sd"}},
      {"laplace", {"mean", "distance"}}};
  for (const auto& [kind, keys] : numbers) {
    const std::string why = WhyRefused("start_x: {distribution: " + kind + "}");
    for (const std::string& key : keys) EXPECT_THAT(why, HasSubstr("start_x." + key)) << kind;
    EXPECT_THAT(why, AllOf(HasSubstr("start_x.unit"), HasSubstr("start_x.source are missing")));
  }
}

TEST(UncertaintyTest, RefusesWhatIsNoMapOfMaps) {
  EXPECT_THAT(WhyRefused("start_x: 0.3"), AllOf(HasSubstr("start_x"), HasSubstr("a map")));
  EXPECT_THAT(WhyRefused("[a, b]"), AllOf(HasSubstr("u.yaml"), HasSubstr("a map")));
  EXPECT_THAT(WhyRefused("start_x: {distribution: fixed"), HasSubstr("no valid YAML"));
}

TEST(UncertaintyTest, RefusesAQuantityThatStandsTwice) {
  const std::string line = "start_x: {distribution: fixed, value: 0, unit: m, source: a}\n";
  EXPECT_THAT(WhyRefused(line + line),
              AllOf(HasSubstr("start_x stands twice"), HasSubstr("line 2")));
}

TEST(UncertaintyTest, AMissingFileIsNamed) {
  EXPECT_THAT(ConfigErrorOf([] { LoadUncertainty("/nowhere/u.yaml"); }),
              HasSubstr("/nowhere/u.yaml: no such file"));
}

TEST(UncertaintyTest, TextMayBeNoneOrYaml) {
  EXPECT_TRUE(UncertaintyFromText("none", "request").quantities.empty());
  EXPECT_EQ(UncertaintyFromText("none", "request").hash, NoUncertainty().hash);
  const std::string yaml = "start_x: {distribution: fixed, value: 0.1, unit: m, source: a}";
  EXPECT_EQ(UncertaintyFromText(yaml, "request").quantities.size(), 1u);
  EXPECT_EQ(UncertaintyFromText(yaml, "request").yaml, yaml);
}

TEST(UncertaintyTest, TheHashTellsNumbersNotComments) {
  const auto hash = [](const std::string& yaml) { return Parse(yaml).hash; };
  const std::uint64_t one = hash("start_x: {distribution: fixed, value: 0.1, unit: m, source: a}");
  EXPECT_EQ(hash("# why\nstart_x:\n  unit: m\n  distribution: fixed\n  value: 0.10\n  source: b"),
            one);
  EXPECT_NE(hash("start_x: {distribution: fixed, value: 0.2, unit: m, source: a}"), one);
  EXPECT_NE(hash("start_y: {distribution: fixed, value: 0.1, unit: m, source: a}"), one);
  EXPECT_NE(hash("start_x: {distribution: uniform, lower: 0.1, upper: 0.1, unit: m, source: a}"),
            one);
}

// ----------------------------------------------------------------------------------- sampling

struct Statistics {
  double mean, sd, lowest, highest;
};

Statistics Sample(const std::string& yaml, const std::function<double(const Variation&)>& value) {
  const Uncertainty uncertainty = Parse(yaml);
  const int count = 10000;
  double sum = 0.0, squares = 0.0;
  Statistics s{0.0, 0.0, 1e9, -1e9};
  for (int i = 0; i < count; ++i) {
    const double x = value(SampleVariation(uncertainty, base::Rng(5).Fork(i)));
    sum += x;
    squares += x * x;
    s.lowest = std::min(s.lowest, x);
    s.highest = std::max(s.highest, x);
  }
  s.mean = sum / count;
  s.sd = std::sqrt(squares / count - s.mean * s.mean);
  return s;
}

TEST(UncertaintyTest, UniformDrawsSpreadEvenly) {
  const Statistics s = Sample(
      "object_mass: {distribution: uniform, lower: 0.8, upper: 1.2, unit: factor, source: a}",
      [](const Variation& v) { return v.mass_factor; });
  EXPECT_NEAR(s.mean, 1.0, 0.005);
  EXPECT_NEAR(s.sd, 0.4 / std::sqrt(12.0), 0.003);
  EXPECT_GE(s.lowest, 0.8);
  EXPECT_LT(s.highest, 1.2);
}

TEST(UncertaintyTest, NormalDrawsSpreadAsTheirDeviationWithin3OfThem) {
  const Statistics s =
      Sample("start_y: {distribution: normal, mean: 0.1, sd: 0.05, unit: m, source: a}",
             [](const Variation& v) { return v.start_offset.y; });
  EXPECT_NEAR(s.mean, 0.1, 0.002);
  // Cut at 3 deviations: sd * sqrt(1 - 6 phi(3) / (2 Phi(3) - 1)).
  EXPECT_NEAR(s.sd, 0.05 * 0.98658, 0.0015);
  EXPECT_GE(s.lowest, 0.1 - 0.15);
  EXPECT_LE(s.highest, 0.1 + 0.15);
  EXPECT_GT(s.highest, 0.1 + 0.125);
}

TEST(UncertaintyTest, DrawsStayWithinSense) {
  const Statistics s =
      Sample("localisation_noise: {distribution: normal, mean: 0.0, sd: 0.1, unit: m, source: a}",
             [](const Variation& v) { return v.localisation_noise; });
  EXPECT_EQ(s.lowest, 0.0);
  EXPECT_NEAR(s.highest, 0.3, 0.02);
}

TEST(UncertaintyTest, FixedAndEmptySpreadsGiveTheirValue) {
  const Variation v = SampleVariation(Parse(R"(
command_delay: {distribution: fixed, value: 0.03, unit: s, source: a}
start_x: {distribution: uniform, lower: 0.2, upper: 0.2, unit: m, source: a}
start_yaw: {distribution: normal, mean: 0.1, sd: 0.0, unit: rad, source: a}
)"),
                                      base::Rng(3));
  EXPECT_EQ(v.command_delay, 0.03);
  EXPECT_EQ(v.start_offset.x, 0.2);
  EXPECT_EQ(v.start_offset.yaw, 0.1);
}

/// A quantity that is fixed at a value of its own.
struct Slot {
  std::string name, unit;
  double value;
  double (*get)(const Variation&);
};

TEST(UncertaintyTest, EveryQuantityMovesItsNumberAlone) {
  const Slot slots[] = {
      {"object_mass", "factor", 1.3, [](const Variation& v) { return v.mass_factor; }},
      {"object_radius", "factor", 0.9, [](const Variation& v) { return v.radius_factor; }},
      {"object_com_height", "factor", 1.1, [](const Variation& v) { return v.com_height_factor; }},
      {"object_com_x", "m", 0.01, [](const Variation& v) { return v.com_offset.x(); }},
      {"object_com_y", "m", 0.02, [](const Variation& v) { return v.com_offset.y(); }},
      {"object_friction", "factor", 0.5, [](const Variation& v) { return v.friction_factor; }},
      {"object_x", "m", 0.03, [](const Variation& v) { return v.object_offset.x(); }},
      {"object_y", "m", 0.04, [](const Variation& v) { return v.object_offset.y(); }},
      {"start_x", "m", 0.05, [](const Variation& v) { return v.start_offset.x; }},
      {"start_y", "m", 0.06, [](const Variation& v) { return v.start_offset.y; }},
      {"start_yaw", "rad", 0.07, [](const Variation& v) { return v.start_offset.yaw; }},
      {"localisation_x", "m", 0.08, [](const Variation& v) { return v.localisation_bias.x; }},
      {"localisation_y", "m", 0.09, [](const Variation& v) { return v.localisation_bias.y; }},
      {"localisation_yaw", "rad", 0.1, [](const Variation& v) { return v.localisation_bias.yaw; }},
      {"localisation_noise", "m", 0.11, [](const Variation& v) { return v.localisation_noise; }},
      {"localisation_noise_yaw", "rad", 0.12,
       [](const Variation& v) { return v.localisation_noise_yaw; }},
      {"ghost_rate", "1/s", 0.13, [](const Variation& v) { return v.ghost_rate; }},
      {"wheel_slip", "share", 0.14, [](const Variation& v) { return v.wheel_slip; }},
      {"floor_roughness", "m", 0.015, [](const Variation& v) { return v.floor_roughness; }},
      {"command_delay", "s", 0.16, [](const Variation& v) { return v.command_delay; }},
      {"late_cycle_probability", "share", 0.17,
       [](const Variation& v) { return v.late_cycle_probability; }},
      {"late_cycle_delay", "s", 0.18, [](const Variation& v) { return v.late_cycle_delay; }},
      {"loop_damping", "factor", 0.19, [](const Variation& v) { return v.loop_damping_factor; }},
      {"wheel_damping", "factor", 0.25, [](const Variation& v) { return v.wheel_damping_factor; }},
      {"sway", "factor", 0.2, [](const Variation& v) { return v.sway_factor; }},
      {"detection_noise", "m", 0.021, [](const Variation& v) { return v.detection_noise; }},
      {"detection_noise_yaw", "rad", 0.22,
       [](const Variation& v) { return v.detection_noise_yaw; }},
      {"recognition_errors", "factor", 1.4,
       [](const Variation& v) { return v.recognition_errors; }},
      {"scan_noise", "m", 0.024, [](const Variation& v) { return v.scan_noise; }},
      {"encoder_noise", "rad", 0.023, [](const Variation& v) { return v.encoder_noise; }},
  };
  for (const Slot& slot : slots) {
    const Variation v = SampleVariation(
        Parse(slot.name + ": {distribution: fixed, value: " + std::to_string(slot.value) +
              ", unit: " + slot.unit + ", source: a}"),
        base::Rng(1));
    for (const Slot& other : slots) {
      EXPECT_EQ(other.get(v), other.name == slot.name ? slot.value : other.get(Variation()))
          << slot.name << " in " << other.name;
    }
  }
}

TEST(UncertaintyTest, OneQuantityMoreLeavesTheOthersDrawsAlone) {
  const std::string mass =
      "object_mass: {distribution: uniform, lower: 0.8, upper: 1.2, unit: factor, source: a}\n";
  const std::string others =
      "command_delay: {distribution: uniform, lower: 0.0, upper: 0.1, unit: s, source: a}\n"
      "start_x: {distribution: normal, mean: 0.0, sd: 0.05, unit: m, source: a}\n";
  for (int i = 0; i < 100; ++i) {
    const base::Rng rng = base::Rng(8).Fork(i);
    EXPECT_EQ(SampleVariation(Parse(mass), rng).mass_factor,
              SampleVariation(Parse(others + mass), rng).mass_factor);
  }
}

TEST(UncertaintyTest, SamplingTheSameStreamTwiceGivesTheSame) {
  const Uncertainty uncertainty =
      Parse("start_x: {distribution: normal, mean: 0.0, sd: 0.05, unit: m, source: a}");
  const base::Rng rng(2);
  EXPECT_EQ(SampleVariation(uncertainty, rng).start_offset.x,
            SampleVariation(uncertainty, rng).start_offset.x);
  EXPECT_NE(SampleVariation(uncertainty, rng).start_offset.x,
            SampleVariation(uncertainty, base::Rng(3)).start_offset.x);
}

TEST(UncertaintyTest, TheConfiguredFileLoads) {
  const Uncertainty uncertainty =
      LoadUncertainty(std::string(HIRES_SOURCE_DIR) + "/config/uncertainty.yaml");
  EXPECT_GT(uncertainty.quantities.size(), 5u);
}

TEST(SampleVariationTest, HowTheRobotCameTellsHowFarItIsOff) {
  const Uncertainty uncertainty = ParseUncertainty(
      "start_x: {distribution: fixed, value: 0.1, unit: m, source: a}\n"
      "start_yaw: {distribution: fixed, value: 0.2, unit: rad, source: a}\n"
      "docked_x: {distribution: fixed, value: 0.01, unit: m, source: a}\n"
      "grasp_z: {distribution: fixed, value: 0.004, unit: m, source: a}\n",
      "test");
  const simulation::Variation driven = SampleVariation(uncertainty, base::Rng(1));
  EXPECT_EQ(driven.start_offset.x, 0.1);
  EXPECT_EQ(driven.start_offset.yaw, 0.2);
  const simulation::Variation docked = SampleVariation(uncertainty, base::Rng(1), Arrival::kDocked);
  EXPECT_EQ(docked.start_offset.x, 0.01);
  EXPECT_EQ(docked.start_offset.yaw, 0.0);
  EXPECT_EQ(docked.grasp_offset.y(), 0.004);
}

}  // namespace
}  // namespace hires::imagination::uncertainty_test
