#include "loop/message_line.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/error.h"

namespace hires::loop::message_line_test {
namespace {

using testing::HasSubstr;

struct Arrival {
  int number;
  double time;  // [s]
  bool operator==(const Arrival& other) const {
    return number == other.number && time == other.time;
  }
};

/// Of messages that are sent every 0.1 s.
std::vector<Arrival> Arrivals(const MessageParams& params, int count, std::uint64_t seed) {
  VirtualClock clock(1.0);
  MessageLine line(params, base::Rng(seed), &clock);
  std::vector<Arrival> arrivals;
  for (int i = 0; i < count; ++i) {
    clock.At(1.0 + 0.1 * i, [&, i] {
      line.Send([&, i] { arrivals.push_back({i, clock.now()}); });
    });
  }
  while (clock.Step()) {
  }
  EXPECT_EQ(line.num_lost() + static_cast<int>(arrivals.size()), count);
  return arrivals;
}

TEST(MessageLineTest, WithoutChanceEachTakesTheDelay) {
  const auto arrivals = Arrivals({0.02, 0.0, 0.0}, 3, 1);
  ASSERT_EQ(arrivals.size(), 3u);
  EXPECT_DOUBLE_EQ(arrivals[2].time, 1.22);
}

TEST(MessageLineTest, NoneOvertakesAnotherHoweverLateThatIs) {
  const auto arrivals = Arrivals({0.0, 0.5, 0.0}, 200, 1);
  for (int i = 0; i < 200; ++i) {
    const Arrival& arrival = arrivals.at(static_cast<std::size_t>(i));
    ASSERT_EQ(arrival.number, i);
    EXPECT_GE(arrival.time, 1.0 + 0.1 * i);
    EXPECT_LE(arrival.time, 1.5 + 0.1 * i);
  }
}

TEST(MessageLineTest, TheShareThatIsLostIsTheOneThatWasWanted) {
  const int num_arrived = static_cast<int>(Arrivals({0.0, 0.0, 0.3}, 10000, 1).size());
  EXPECT_NEAR(num_arrived, 7000, 5.0 * std::sqrt(10000 * 0.3 * 0.7));  // five deviations
}

TEST(MessageLineTest, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
  const MessageParams params{0.01, 0.2, 0.2};
  EXPECT_TRUE(Arrivals(params, 100, 1) == Arrivals(params, 100, 1));
  EXPECT_FALSE(Arrivals(params, 100, 1) == Arrivals(params, 100, 2));
}

TEST(MessageLineTest, KindsThatNobodyAsksForAgainCannotBeLost) {
  const auto read = [](const std::string& text, bool may_lose) {
    return ReadMessageParams(base::ParamReader::FromString(text, "loop.yaml"), may_lose);
  };
  EXPECT_EQ(read("{delay: 0.1, jitter: 0.2, loss: 0.3}", true).loss, 0.3);
  try {
    read("{delay: 0.1, jitter: 0.2, loss: 0.3}", false);
    FAIL() << "nothing was wrong";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("loss"));
  }
}

}  // namespace
}  // namespace hires::loop::message_line_test
