#include "hires/relay/liveness.h"

#include <gmock/gmock.h>

namespace hires::relay::liveness_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr PingReply kRefused{PingReply::Kind::kRefused, 0};
constexpr PingReply kSilent{PingReply::Kind::kSilent, 0};
PingReply Answered(int pid) { return {PingReply::Kind::kAnswered, pid}; }

TEST(LivenessTest, NewNodesArePingedAtOnceAndOthersEveryPeriod) {
  Liveness liveness(1.0);
  EXPECT_THAT(liveness.Due({"b", "a"}, 10.0), ElementsAre("a", "b"));
  EXPECT_THAT(liveness.Due({"a", "b"}, 10.9), IsEmpty());
  EXPECT_THAT(liveness.Due({"a", "b", "c"}, 10.95), ElementsAre("c"));
  EXPECT_THAT(liveness.Due({"a", "b", "c"}, 11.0), ElementsAre("a", "b"));
}

TEST(LivenessTest, ANodeLivesOnlyAfterItsFirstAnswer) {
  Liveness liveness(1.0);
  EXPECT_FALSE(liveness.IsAlive("a"));
  liveness.Due({"a"}, 0.0);
  EXPECT_FALSE(liveness.IsAlive("a"));
  liveness.Record("a", Answered(7));
  EXPECT_TRUE(liveness.IsAlive("a"));
}

TEST(LivenessTest, ARefusalIsDeathAndAnAnswerALifeAgain) {
  Liveness liveness(1.0);
  liveness.Due({"a"}, 0.0);
  liveness.Record("a", Answered(7));
  liveness.Record("a", kRefused);
  EXPECT_FALSE(liveness.IsAlive("a"));
  liveness.Record("a", Answered(8));
  EXPECT_TRUE(liveness.IsAlive("a"));
}

TEST(LivenessTest, SilenceIsForgivenUntilItHappensTooOftenInARow) {
  Liveness liveness(1.0);
  liveness.Due({"a"}, 0.0);
  liveness.Record("a", Answered(7));
  for (int i = 1; i < Liveness::kMaxSilent; ++i) liveness.Record("a", kSilent);
  EXPECT_TRUE(liveness.IsAlive("a"));
  liveness.Record("a", Answered(7));
  for (int i = 1; i < Liveness::kMaxSilent; ++i) liveness.Record("a", kSilent);
  EXPECT_TRUE(liveness.IsAlive("a"));
  liveness.Record("a", kSilent);
  EXPECT_FALSE(liveness.IsAlive("a"));
}

TEST(LivenessTest, AnotherProcessAtTheSameAddressIsADeathAndThenANewLife) {
  Liveness liveness(1.0);
  liveness.Due({"a"}, 0.0);
  liveness.Record("a", Answered(7));
  liveness.Record("a", Answered(8));
  EXPECT_FALSE(liveness.IsAlive("a"));
  EXPECT_THAT(liveness.Due({"a"}, 0.1), ElementsAre("a"));
  liveness.Record("a", Answered(8));
  EXPECT_TRUE(liveness.IsAlive("a"));
}

TEST(LivenessTest, NodesThatAreNoLongerListedAreForgotten) {
  Liveness liveness(1.0);
  liveness.Due({"a"}, 0.0);
  liveness.Record("a", Answered(7));
  liveness.Due({}, 0.1);
  EXPECT_FALSE(liveness.IsAlive("a"));
  EXPECT_THAT(liveness.Due({"a"}, 0.2), ElementsAre("a"));
}

TEST(LivenessTest, MisuseIsTheCallersFault) {
  EXPECT_THROW(Liveness(0.0), std::logic_error);
  Liveness liveness(1.0);
  EXPECT_THROW(liveness.Record("never listed", kSilent), std::logic_error);
}

}  // namespace
}  // namespace hires::relay::liveness_test
