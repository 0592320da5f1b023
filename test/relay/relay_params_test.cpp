#include "hires/relay/relay_params.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"

namespace hires::relay::relay_params_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr char kGood[] =
    "foreign_master: http://localhost:11411/\n"
    "namespace: /worker_1\n"
    "alias_prefix: /mirrored\n"
    "poll_period: 0.05\n"
    "ping_period: 1.0\n"
    "call_timeout: 0.5\n"
    "local_pubs: [\"{ns}/sim_state\"]\n"
    "foreign_pubs: [\"{ns}/.*\"]\n"
    "local_services: [/pause]\n"
    "foreign_services: [/unpause]\n"
    "actions:\n"
    "  - {name: \"{ns}/rollout\", server: foreign}\n"
    "  - {name: /achieve, server: local}\n";

RelayParams Read(const std::string& yaml, const RelayOverrides& overrides = {}) {
  return ReadRelayParams(base::ParamReader::FromString(yaml, "relay.yaml"), overrides);
}

/// kGood with the first `from` replaced.
std::string With(const std::string& from, const std::string& to) {
  std::string yaml = kGood;
  const auto at = yaml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return yaml.replace(at, from.size(), to);
}

std::string ErrorOf(const std::string& yaml, const RelayOverrides& overrides = {}) {
  try {
    Read(yaml, overrides);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadRelayParamsTest, ListsGoTheWayTheirNamesSay) {
  const RelayParams params = Read(kGood);
  EXPECT_EQ(params.foreign_master, "http://localhost:11411/");
  EXPECT_TRUE(params.local.topics.Matches("/worker_1/sim_state"));
  EXPECT_FALSE(params.local.topics.Matches("/worker_1/scan"));
  EXPECT_TRUE(params.foreign.topics.Matches("/worker_1/scan"));
  EXPECT_TRUE(params.local.services.Matches("/pause"));
  EXPECT_FALSE(params.local.services.Matches("/unpause"));
  EXPECT_TRUE(params.foreign.services.Matches("/unpause"));
}

TEST(ReadRelayParamsTest, AnActionIsFiveTopicsOfWhichTheClientPublishesTwo) {
  const RelayParams params = Read(With("[\"{ns}/.*\"]", "[]"));
  for (const char* topic : {"/worker_1/rollout/goal", "/worker_1/rollout/cancel"}) {
    EXPECT_TRUE(params.local.topics.Matches(topic)) << topic;
    EXPECT_FALSE(params.foreign.topics.Matches(topic)) << topic;
  }
  for (const char* topic :
       {"/worker_1/rollout/status", "/worker_1/rollout/feedback", "/worker_1/rollout/result"}) {
    EXPECT_TRUE(params.foreign.topics.Matches(topic)) << topic;
    EXPECT_FALSE(params.local.topics.Matches(topic)) << topic;
  }
  EXPECT_TRUE(params.local.topics.Matches("/achieve/result"));
  EXPECT_TRUE(params.foreign.topics.Matches("/achieve/goal"));
  EXPECT_FALSE(params.foreign.topics.Matches("/worker_1/rollout"));
}

TEST(ReadRelayParamsTest, TheNodesOwnParametersWin) {
  const RelayParams params = Read(kGood, {"http://station:11413/", "/worker_3"});
  EXPECT_EQ(params.foreign_master, "http://station:11413/");
  EXPECT_TRUE(params.foreign.topics.Matches("/worker_3/scan"));
  EXPECT_FALSE(params.foreign.topics.Matches("/worker_1/scan"));
}

TEST(ReadRelayParamsTest, BadValuesAreNamedWithKeyAndLine) {
  EXPECT_THAT(ErrorOf(With("http://localhost:11411/", "localhost")),
              AllOf(HasSubstr("relay.yaml: foreign_master is 'localhost'"),
                    HasSubstr("address of a ROS master"), HasSubstr("line 1")));
  EXPECT_THAT(ErrorOf(With("namespace: /worker_1", "namespace: worker_1")),
              AllOf(HasSubstr("namespace is 'worker_1'"), HasSubstr("line 2")));
  EXPECT_THAT(ErrorOf(With("/mirrored", "/mirrored/")), HasSubstr("alias_prefix is '/mirrored/'"));
  EXPECT_THAT(ErrorOf(With("0.05", "0.0001")),
              AllOf(HasSubstr("poll_period is '0.0001'"), HasSubstr("between 0.01 and 10")));
  EXPECT_THAT(ErrorOf(With("1.0", ".nan")), HasSubstr("ping_period is '.nan'"));
  EXPECT_THAT(ErrorOf(With("call_timeout: 0.5\n", "")), HasSubstr("call_timeout is missing"));
  EXPECT_THAT(ErrorOf(With("[/pause]", "/pause")), HasSubstr("local_services is '/pause'"));
  EXPECT_THAT(ErrorOf(With("local_pubs", "local_pub")), HasSubstr("did you mean 'local_pubs'"));
  EXPECT_THAT(ErrorOf(std::string(kGood) + "speed: 3\n"), HasSubstr("key 'speed' is unknown"));
}

TEST(ReadRelayParamsTest, BadActionsAreNamedWithTheirPlace) {
  EXPECT_THAT(ErrorOf(With("server: foreign", "server: there")),
              AllOf(HasSubstr("actions[0].server is 'there'"), HasSubstr("line 12")));
  EXPECT_THAT(ErrorOf(With("name: /achieve", "name: achieve")),
              HasSubstr("actions[1].name is 'achieve'"));
  EXPECT_THAT(ErrorOf(With("name: /achieve,", "")), HasSubstr("actions[1].name is missing"));
  EXPECT_THAT(ErrorOf(With("name: /achieve", "nam: 1, name: /achieve")),
              HasSubstr("'actions[1].nam' is unknown"));
}

TEST(ReadRelayParamsTest, APlaceholderNeedsANamespace) {
  EXPECT_THAT(ErrorOf(With("namespace: /worker_1", "namespace: \"\"")),
              AllOf(HasSubstr("local_pubs"), HasSubstr("needs a namespace")));
}

TEST(ReadRelayParamsTest, BadOverridesAreNamed) {
  EXPECT_THAT(ErrorOf(kGood, {"nonsense", ""}), HasSubstr("~foreign_master is 'nonsense'"));
  EXPECT_THAT(ErrorOf(kGood, {"", "worker 3"}), HasSubstr("~namespace is 'worker 3'"));
}

TEST(ReadRelayParamsTest, ARelayThatWouldCarryNothingIsAMistake) {
  const std::string yaml =
      "foreign_master: http://h:1/\nnamespace: \"\"\nalias_prefix: /m\npoll_period: 1\n"
      "ping_period: 1\ncall_timeout: 1\nlocal_pubs: []\nforeign_pubs: []\nlocal_services: []\n"
      "foreign_services: []\n";
  EXPECT_THAT(ErrorOf(yaml), HasSubstr("nothing would cross"));
}

TEST(ReadRelayParamsTest, TheShippedFileCarriesTheRolloutActionAndTheWorkersTopicsOnly) {
  const RelayParams params = ReadRelayParams(
      base::ParamReader::FromFile(std::string(HIRES_SOURCE_DIR) + "/config/relay.yaml"));
  EXPECT_TRUE(params.foreign.topics.Matches("/worker_1/state"));
  EXPECT_TRUE(params.local.topics.Matches("/worker_1/rollout/goal"));
  EXPECT_FALSE(params.foreign.topics.Matches("/odom"));
  EXPECT_FALSE(params.foreign.topics.Matches("/clock"));
  EXPECT_FALSE(params.local.topics.Matches("/worker_1/state"));
  EXPECT_TRUE(params.local.services.is_empty());
  EXPECT_TRUE(params.foreign.services.is_empty());
}

TEST(TagOfTest, IsTheNamespaceInOneWord) {
  EXPECT_EQ(TagOf("/worker_1"), "worker_1");
  EXPECT_EQ(TagOf("/lab/worker_1"), "lab_worker_1");
  EXPECT_EQ(TagOf(""), "relay");
}

}  // namespace
}  // namespace hires::relay::relay_params_test
