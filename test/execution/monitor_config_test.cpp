#include "hires/execution/monitor_config.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::execution::monitor_config_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kShipped = HIRES_SOURCE_DIR "/config/execution_monitor.yaml";

/// The shipped file with `from` replaced by `to`.
class MonitorConfigTest : public ::testing::Test {
 protected:
  MonitorConfig Read(const std::string& from, const std::string& to) {
    std::string text = base::ReadTextFile(kShipped);
    EXPECT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
    return ReadMonitorConfig(folder_.Write("monitor.yaml", text));
  }
  std::string ErrorOf(const std::string& from, const std::string& to) {
    try {
      Read(from, to);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  const test_support::TemporaryFolder folder_;
};

TEST_F(MonitorConfigTest, PathsCountFromTheFilesFolder) {
  const MonitorConfig config = Read("domains/restaurant.lisp", "other.lisp");
  EXPECT_EQ(config.domain, (folder_.path() / "other.lisp").string());
  EXPECT_EQ(config.ontology.size(), 2u);
}

TEST_F(MonitorConfigTest, ValuesGoWhereTheyBelong) {
  EXPECT_EQ(Read("imagination: domain", "imagination: thesis").monitor.imagination,
            MonitorParams::ImaginePolicy::kThesis);
  EXPECT_EQ(Read("effect_timeout: 3.0", "effect_timeout: 7.5").monitor.effect_timeout, 7.5);
  EXPECT_EQ(Read("observation_delay: 30.0", "observation_delay: 9.5").monitor.observation_delay,
            9.5);
  EXPECT_EQ(Read("late_wait: 30.0", "late_wait: 7.5").monitor.late_wait, 7.5);
  EXPECT_EQ(Read("seed: 1", "seed: 42").imagining.seed, 42u);
  EXPECT_EQ(Read("server_loss: 0.5", "server_loss: 0.25").servers.server_loss, 0.25);
  EXPECT_EQ(Read("pose_angle: 0.2", "pose_angle: 0.3").pose_angle, 0.3);
}

TEST_F(MonitorConfigTest, BadValuesAreErrorsThatNameTheKey) {
  EXPECT_THAT(
      ErrorOf("imagination: domain", "imagination: sometimes"),
      AllOf(HasSubstr("monitor.yaml"), HasSubstr("monitor.imagination"), HasSubstr("sometimes")));
  EXPECT_THAT(ErrorOf("overdue_factor: 3.0", "overdue_factor: 0.5"),
              HasSubstr("monitor.overdue_factor"));
  EXPECT_THAT(ErrorOf("rollouts: 400", "rollouts: 0"), HasSubstr("imagining.rollouts"));
  EXPECT_THAT(ErrorOf("ranking: \"\"", "ranking: best"), HasSubstr("imagining.ranking"));
  EXPECT_THAT(ErrorOf("silence: 5.0", "silences: 5.0"), HasSubstr("servers.silence"));
  EXPECT_THAT(ErrorOf("feedback_period: 0.2", "feedback_period: 0.2\nfeedback: 1"),
              HasSubstr("feedback"));
}

TEST_F(MonitorConfigTest, FilesOfOlderVersionsAreRead) {
  const MonitorConfig config = Read("robot: robots/pr2.yaml", "");
  EXPECT_EQ(config.robot, "");
  const auto old = Read("  late_wait: 30.0", "");
  EXPECT_EQ(old.monitor.late_wait, MonitorParams().late_wait);
}

planning::OperatorData DrivingAndPlacing() {
  planning::OperatorData data;
  data.operators["drive"].imagine.emplace().parameters = {"motion_set"};
  data.operators["place"].imagine.emplace().parameters = {"spot"};
  data.operators["wait"];
  return data;
}

TEST(ReadDefaultsTest, ReadsPairsInLowerCase) {
  using Defaults = std::map<std::string, std::string>;
  const auto data = DrivingAndPlacing();
  EXPECT_EQ(ReadDefaults("", data), Defaults());
  EXPECT_EQ(ReadDefaults("Motion_set=Fast,spot=any", data),
            (Defaults{{"motion_set", "fast"}, {"spot", "any"}}));
}

TEST(ReadDefaultsTest, NamesAllErrorsAtOnce) {
  try {
    ReadDefaults("fast,motion_sets=fast,spot=", DrivingAndPlacing());
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("'fast' is no PARAMETER=VALUE"),
                                    HasSubstr("did you mean 'motion_set'"),
                                    HasSubstr("'spot=' is no PARAMETER=VALUE")));
  }
}

TEST(ReadImaginePolicyTest, NamesTheChoices) {
  EXPECT_EQ(ReadImaginePolicy("off"), MonitorParams::ImaginePolicy::kOff);
  EXPECT_THROW(ReadImaginePolicy(""), base::ConfigError);
  for (const char* word : {"domain", "thesis", "off"}) {
    EXPECT_TRUE(ImaginePolicyWord().holds(word));
    EXPECT_NO_THROW(ReadImaginePolicy(word));
  }
}

}  // namespace
}  // namespace hires::execution::monitor_config_test
