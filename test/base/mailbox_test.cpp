#include "hires/base/mailbox.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

namespace hires::base::mailbox_test {
namespace {

using ::testing::Optional;

constexpr std::chrono::duration<double> kLong{30.0};  // [s] longer than any test may take

TEST(MailboxTest, IsEmptyAtFirst) {
  Mailbox<int> mailbox;
  EXPECT_EQ(mailbox.Take(), std::nullopt);
}

TEST(MailboxTest, GivesMessagesInTheOrderOfPosting) {
  Mailbox<int> mailbox;
  for (int i = 0; i < 3; ++i) mailbox.Post(i);
  for (int i = 0; i < 3; ++i) EXPECT_THAT(mailbox.Take(), Optional(i));
  EXPECT_EQ(mailbox.Take(), std::nullopt);
}

TEST(MailboxTest, CarriesWhatCannotBeCopied) {
  Mailbox<std::unique_ptr<int>> mailbox;
  mailbox.Post(std::make_unique<int>(7));
  const auto message = mailbox.Take();
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(**message, 7);
}

TEST(MailboxTest, WaitingEndsAtOnceIfAMessageIsThere) {
  Mailbox<int> mailbox;
  mailbox.Post(1);
  EXPECT_THAT(mailbox.WaitAndTake(kLong), Optional(1));
}

TEST(MailboxTest, WaitingForNothingEndsWithNothing) {
  Mailbox<int> mailbox;
  EXPECT_EQ(mailbox.WaitAndTake(std::chrono::duration<double>(0.0)), std::nullopt);
  EXPECT_EQ(mailbox.WaitAndTake(std::chrono::duration<double>(-1.0)), std::nullopt);
  EXPECT_EQ(mailbox.WaitAndTake(std::chrono::duration<double>(0.001)), std::nullopt);
}

TEST(MailboxTest, AMessageOfAnotherThreadWakesTheOneThatWaits) {
  Mailbox<int> requests, answers;
  std::thread doubler([&] {
    while (const auto request = requests.WaitAndTake(kLong)) {
      if (*request < 0) return;
      answers.Post(2 * *request);
    }
  });
  for (int i = 0; i < 200; ++i) {
    requests.Post(i);
    EXPECT_THAT(answers.WaitAndTake(kLong), Optional(2 * i));
  }
  requests.Post(-1);
  doubler.join();
}

struct Numbered {
  int sender;
  int number;
};

TEST(MailboxTest, ManySendersLoseNothingAndEachKeepsItsOrder) {
  constexpr int kSenders = 4, kEach = 1000;
  Mailbox<Numbered> mailbox;
  std::vector<std::thread> senders;
  for (int s = 0; s < kSenders; ++s) {
    senders.emplace_back([&mailbox, s] {
      for (int i = 0; i < kEach; ++i) mailbox.Post({s, i});
    });
  }
  std::vector<int> next(kSenders, 0);
  for (int i = 0; i < kSenders * kEach; ++i) {
    const auto message = mailbox.WaitAndTake(kLong);
    ASSERT_TRUE(message.has_value()) << "after " << i << " messages";
    EXPECT_EQ(message->number, next[message->sender]++);
  }
  for (std::thread& sender : senders) sender.join();
  EXPECT_FALSE(mailbox.Take().has_value());
}

TEST(MailboxTest, EachMessageReachesOneOfManyReceivers) {
  constexpr int kReceivers = 3, kMessages = 3000;
  Mailbox<int> mailbox;
  std::vector<std::vector<int>> received(kReceivers);
  std::vector<std::thread> receivers;
  for (int r = 0; r < kReceivers; ++r) {
    receivers.emplace_back([&mailbox, &mine = received[r]] {
      for (auto message = mailbox.WaitAndTake(kLong); message && *message >= 0;
           message = mailbox.WaitAndTake(kLong)) {
        mine.push_back(*message);
      }
    });
  }
  for (int i = 0; i < kMessages; ++i) mailbox.Post(i);
  for (int r = 0; r < kReceivers; ++r) mailbox.Post(-1);
  for (std::thread& receiver : receivers) receiver.join();
  std::vector<int> times(kMessages, 0);
  for (const auto& mine : received) {
    EXPECT_TRUE(std::is_sorted(mine.begin(), mine.end()));
    for (const int message : mine) ++times[message];
  }
  EXPECT_THAT(times, ::testing::Each(1));
}

}  // namespace
}  // namespace hires::base::mailbox_test
