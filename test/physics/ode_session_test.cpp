#include "physics/ode_session.h"

#include <gmock/gmock.h>
#include <ode/ode.h>

#include <stdexcept>
#include <thread>

namespace hires::physics::ode_session_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class OdeSessionTest : public ::testing::Test {
 protected:
  OdeSessionTest() {
    EnsureOdeIsReady();
    TakeOdeMessages();
  }
};

TEST_F(OdeSessionTest, MessagesAreKeptUntilTaken) {
  dMessage(7, "x is %d", 3);
  dMessage(8, "again");
  EXPECT_THAT(TakeOdeMessages(), ElementsAre("ODE message 7: x is 3", "ODE message 8: again"));
  EXPECT_THAT(TakeOdeMessages(), IsEmpty());
}

TEST_F(OdeSessionTest, FloodIsCounted) {
  for (int i = 0; i < 150; ++i) dMessage(1, "flood");
  const std::vector<std::string> taken = TakeOdeMessages();
  ASSERT_EQ(taken.size(), 101u);
  EXPECT_EQ(taken.back(), "ODE: 50 more messages");
}

TEST_F(OdeSessionTest, ErrorsAreThrownInsteadOfEndingTheProcess) {
  EXPECT_THROW(dError(5, "no %s", "memory"), std::logic_error);
  EXPECT_THROW(dDebug(6, "assertion"), std::logic_error);
}

TEST_F(OdeSessionTest, EachThreadHasItsOwnMessages) {
  std::vector<std::string> others;
  std::thread([&others] {
    EnsureOdeIsReady();
    dMessage(1, "other");
    others = TakeOdeMessages();
  }).join();
  EXPECT_THAT(others, ElementsAre("ODE message 1: other"));
  EXPECT_THAT(TakeOdeMessages(), IsEmpty());
}

}  // namespace
}  // namespace hires::physics::ode_session_test
