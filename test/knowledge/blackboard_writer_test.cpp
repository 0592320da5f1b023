#include "hires/knowledge/blackboard_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <optional>

#include "hires/base/error.h"
#include "knowledge/support/store_world.h"

namespace hires::knowledge::blackboard_writer_test {
namespace {

namespace knowledge = hires::knowledge;
using hires::test_support::At;
using hires::test_support::MakeFluent;
using hires::test_support::PoseAt;
using hires::test_support::SmallOntology;
using ::testing::ElementsAre;
using ::testing::SizeIs;

/// A writer whose thread can be held, so that requests pile up.
class BlackboardWriterTest : public ::testing::Test {
 protected:
  ~BlackboardWriterTest() override {
    if (held_) Release();
  }

  void Start(const BlackboardWriter::Limits& limits = {}) {
    writer_.emplace(
        Store(":memory:", SmallOntology()), limits, [] { return 100.0; },
        [this](const Store& store, const std::vector<Change>& changes) {
          EXPECT_EQ(store.last_sequence(), changes.back().sequence);
          transactions_.push_back(changes);
        });
  }
  void Hold() {
    std::promise<void> reached;
    held_.emplace();
    holder_ = std::async(std::launch::async, [this, &reached] {
      writer_->RunAlways([this, &reached](Store*) {
        reached.set_value();
        held_->get_future().wait();
        return std::vector<Change>();
      });
    });
    reached.get_future().wait();
  }
  void Release() {
    held_->set_value();
    holder_.get();
    held_.reset();
  }
  /// Asks on a thread of its own; returns when the request waits.
  template <typename Call>
  auto Ask(const Call& call) {
    const int before = writer_->num_waiting();
    auto answer = std::async(std::launch::async, call);
    while (writer_->num_waiting() == before) std::this_thread::yield();
    return answer;
  }
  auto AskAdd(std::vector<Fluent> fluents, const Assertion& by = At(0.0)) {
    return Ask([this, fluents, by] { return writer_->Add(fluents, by); });
  }

  std::vector<std::vector<Change>> transactions_;  // of the writer's thread, until it is gone
  std::optional<std::promise<void>> held_;
  std::future<void> holder_;
  std::optional<BlackboardWriter> writer_;
};

TEST_F(BlackboardWriterTest, WhatWaitsSharesATransactionAndEachIsToldItsPart) {
  Start();
  Hold();
  auto a = AskAdd({PoseAt("p1", 1.0), PoseAt("p2", 2.0)});
  auto b = AskAdd({PoseAt("p3", 3.0)});
  Release();
  EXPECT_EQ(a.get().num_changed, 2u);
  EXPECT_EQ(b.get().num_changed, 1u);
  writer_.reset();
  EXPECT_THAT(transactions_, ElementsAre(SizeIs(3)));
}

TEST_F(BlackboardWriterTest, OneThatIsWrongSpoilsNoOther) {
  Start();
  Hold();
  auto a = AskAdd({PoseAt("p1", 1.0)});
  auto b = AskAdd({MakeFluent("Pozze", "p2")});
  auto c = AskAdd({PoseAt("p3", 3.0)});
  Release();
  EXPECT_EQ(a.get().num_changed, 1u);
  EXPECT_THROW(b.get(), base::ConfigError);
  EXPECT_EQ(c.get().num_changed, 1u);
}

TEST_F(BlackboardWriterTest, RequestsAboutOneInstanceKeepTheirOrder) {
  Start();
  Hold();
  auto a = AskAdd({PoseAt("p1", 1.0)});
  auto b = AskAdd({PoseAt("P1", 2.0)});
  auto c = Ask([this] { return writer_->Remove({"p1"}, At(0.0)); });
  Release();
  EXPECT_EQ(a.get().sequence, 1u);
  EXPECT_EQ(b.get().sequence, 2u);
  EXPECT_EQ(c.get().sequence, 3u);
  writer_.reset();
  EXPECT_THAT(transactions_, ElementsAre(SizeIs(1), SizeIs(1), SizeIs(1)));
}

TEST_F(BlackboardWriterTest, AGroupIsNoLargerThanAllowedAndOfOneWord) {
  Start({10, 2});
  Hold();
  auto a = AskAdd({PoseAt("p1", 1.0)});
  auto b = AskAdd({PoseAt("p2", 1.0)});
  auto c = AskAdd({PoseAt("p3", 1.0)});
  auto d = AskAdd({PoseAt("p4", 1.0)}, At(50.0));
  Release();
  for (auto* answer : {&a, &b, &c, &d}) EXPECT_EQ(answer->get().num_changed, 1u);
  writer_.reset();
  EXPECT_THAT(transactions_, ElementsAre(SizeIs(2), SizeIs(1), SizeIs(1)));
}

TEST_F(BlackboardWriterTest, AnAnswerComesAfterTheCommitAndTimeZeroIsNow) {
  Start();
  writer_->Add({PoseAt("p1", 1.0)}, At(0.0));
  writer_->Run([](Store* store) {
    EXPECT_EQ(store->Find("p1").value().start.earliest, 100.0);
    return std::vector<Change>();
  });
}

TEST_F(BlackboardWriterTest, MoreThanMayWaitAreTurnedAwayButNotWhatMustBeDone) {
  Start({1, 10});
  Hold();
  auto a = AskAdd({PoseAt("p1", 1.0)});
  try {
    writer_->Add({PoseAt("p2", 1.0)}, At(0.0));
    FAIL() << "not turned away";
  } catch (const Unavailable& unavailable) {
    EXPECT_EQ(unavailable.reason, Unavailable::Reason::kBusy);
  }
  auto always = Ask([this] {
    writer_->RunAlways([](Store*) { return std::vector<Change>(); });
    return true;
  });
  Release();
  EXPECT_EQ(a.get().num_changed, 1u);
  EXPECT_TRUE(always.get());
}

TEST_F(BlackboardWriterTest, ATaskThatThrowsTellsWhoAsked) {
  Start();
  EXPECT_THROW(writer_->Run([](Store*) -> std::vector<Change> { throw base::ConfigError("no"); }),
               base::ConfigError);
  EXPECT_EQ(writer_->Add({PoseAt("p1", 1.0)}, At(0.0)).num_changed, 1u);
}

TEST_F(BlackboardWriterTest, WhoWaitsAtTheEndIsToldSo) {
  Start({1, 10});
  Hold();
  auto a = AskAdd({PoseAt("p1", 1.0)});
  BlackboardWriter* writer = &*writer_;
  auto end = std::async(std::launch::async, [this] { writer_.reset(); });
  auto reason = Unavailable::Reason::kBusy;
  while (reason == Unavailable::Reason::kBusy) {  // until it takes no more at all
    try {
      writer->Add({PoseAt("p2", 1.0)}, At(0.0));
      FAIL() << "not turned away";
    } catch (const Unavailable& unavailable) {
      reason = unavailable.reason;
    }
  }
  Release();
  end.get();
  EXPECT_THROW(a.get(), Unavailable);
}

}  // namespace
}  // namespace hires::knowledge::blackboard_writer_test
