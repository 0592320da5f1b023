// Eight writers hand over to the one thread that owns the store, eight subscribers follow demand
// topics over queues with an end, two readers look at the file meanwhile.
// HIRES_STRESS_TRANSACTIONS sets how many calls each writer makes (600).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <future>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/mailbox.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/knowledge/demand.h"
#include "knowledge/support/store_world.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::concurrency_test {
namespace {

using test_support::At;
using test_support::MakeFluent;
using test_support::PoseAt;
using test_support::QueryAll;
using test_support::SmallOntology;
using Fluents = std::map<std::string, Fluent>;  // by instance

constexpr int kNumWriters = 8;
constexpr std::size_t kShort = 3;   // messages in the queue of one who stops reading
constexpr std::size_t kLong = 100;  // ... of one who keeps up

int NumTransactions() {
  const char* text = std::getenv("HIRES_STRESS_TRANSACTIONS");
  return text != nullptr ? std::atoi(text) : 600;
}

/// Holds so many messages. Whoever posts one more waits, or the oldest is lost.
template <typename T>
class Queue {
 public:
  Queue(std::size_t capacity, bool waits) : capacity_(capacity), waits_(waits) {}

  void Post(T message) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (waits_) changed_.wait(lock, [this] { return messages_.size() < capacity_; });
    if (messages_.size() == capacity_) messages_.pop_front();
    messages_.push_back(std::move(message));
    changed_.notify_all();
  }
  void Close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
  }
  /// The oldest message; nothing once it is closed and empty.
  std::optional<T> Take() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return is_closed_ || !messages_.empty(); });
    if (messages_.empty()) return std::nullopt;
    T message = std::move(messages_.front());
    messages_.pop_front();
    changed_.notify_all();
    return message;
  }
  /// Reads nothing until the oldest message is one that was posted after others were lost.
  void WaitForLoss(std::uint64_t known) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] {
      return is_closed_ || (!messages_.empty() && messages_.front().previous > known);
    });
  }

 private:
  const std::size_t capacity_;
  const bool waits_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> messages_;
  bool is_closed_{false};
};

/// A call of a writer.
struct Request {
  std::vector<Fluent> add;
  std::vector<std::string> remove;
  std::promise<std::vector<Change>> changes;
};

/// What a subscriber knows by the messages of its topic.
class Follower {
 public:
  void Begin(const DemandUpdate& snapshot) {
    for (const Change& change : snapshot.changes) Put(change.fluent);
    known_ = snapshot.last_sequence;
  }
  /// A message that follows on what is known. Nothing may enter twice, nor leave that is not there.
  void Take(const DemandUpdate& update) {
    EXPECT_FALSE(update.changes.empty());
    EXPECT_GT(update.first_sequence, known_);
    for (const Change& change : update.changes) {
      EXPECT_GE(change.sequence, known_);  // by one change, several may enter through their links
      known_ = change.sequence;
      const bool was_there = fluents_.count(base::ToLower(change.fluent.instance)) > 0;
      EXPECT_EQ(was_there, change.kind != Change::Kind::kAdded) << change.fluent.instance;
      Note(change);
    }
    known_ = update.last_sequence;
  }
  void Note(const Change& change) {
    told_.push_back(change.sequence);
    if (change.kind == Change::Kind::kRemoved) {
      fluents_.erase(base::ToLower(change.fluent.instance));
    } else {
      Put(change.fluent);
    }
  }
  void KnowsUpTo(std::uint64_t sequence) { known_ = sequence; }

  std::uint64_t known() const { return known_; }
  const std::vector<std::uint64_t>& told() const { return told_; }
  const Fluents& fluents() const { return fluents_; }

 private:
  void Put(const Fluent& fluent) { fluents_[base::ToLower(fluent.instance)] = fluent; }

  std::uint64_t known_{0};
  std::vector<std::uint64_t> told_;
  Fluents fluents_;
};

DemandTopic Below(const std::string& concept_name) {
  DemandTopic topic;
  topic.name = "below" + concept_name;
  topic.below = {concept_name};
  return topic;
}

DemandTopic With(const std::string& role) {
  DemandTopic topic;
  topic.name = "with" + role;
  topic.properties = {role};
  return topic;
}

DemandTopic Selected(const std::string& name, const std::string& query) {
  DemandTopic topic;
  topic.name = name;
  topic.queries = {query};
  return topic;
}

/// Eight wishes: simple ones, and joins by which a fluent enters through changes of others.
std::vector<DemandTopic> Topics() {
  return {Below("Pose"),
          Below("Pose"),
          Below("Object"),
          With("hasX"),
          Below("Pose"),
          Below("On"),
          Selected("onSomething",
                   "select ?m where { ?on a upper:On ; upper:hasObject ?m . ?m a upper:Mug }"),
          Selected("placed", "select ?m where { ?m upper:hasPose ?p . ?p upper:hasX ?x }")};
}
bool KeepsUp(std::size_t subscriber) { return subscriber != 1 && subscriber != 4; }

/// One topic, and the thread that follows it.
class Subscriber {
 public:
  Subscriber(const DemandTopic& topic, bool keeps_up, const std::string& path)
      : demand_(topic, SmallOntology()),
        keeps_up_(keeps_up),
        path_(path),
        queue_(keeps_up ? kLong : kShort, keeps_up) {}

  void Start(const Store& store) {  // by the owner, as the rest
    follower_.Begin(demand_.Snapshot(store));
    thread_ = std::thread([this] { keeps_up_ ? KeepUp() : StopAndCatchUp(); });
  }
  void Publish(const std::vector<Change>& changes, const Store& store) {
    DemandUpdate update = demand_.Apply(changes, store);
    if (!update.changes.empty()) queue_.Post(std::move(update));
  }
  void Finish() {
    queue_.Close();
    thread_.join();
  }

  const Follower& follower() const { return follower_; }
  int num_losses() const { return num_losses_; }

 private:
  void KeepUp() {
    while (const auto update = queue_.Take()) {
      EXPECT_EQ(update->previous, follower_.known());  // that is: nothing was missed
      follower_.Take(*update);
    }
  }

  /// Reads ten messages, waits until some are lost, and so on.
  void StopAndCatchUp() {
    StoreOptions options;
    options.read_only = true;
    const Store reader(path_, SmallOntology(), options);
    for (int i = 1;; ++i) {
      if (i % 10 == 0) queue_.WaitForLoss(follower_.known());
      const auto update = queue_.Take();
      if (!update) break;
      if (update->previous > follower_.known()) CatchUp(reader);
      if (update->last_sequence > follower_.known()) follower_.Take(*update);
    }
  }

  /// The topic is that of poses.
  void CatchUp(const Store& reader) {
    ++num_losses_;
    for (;;) {
      const std::vector<Change> changes = reader.ChangesSince(follower_.known(), 50);
      if (changes.empty()) return;
      for (const Change& change : changes) {
        if (change.fluent.concept_name == "Pose") follower_.Note(change);
      }
      follower_.KnowsUpTo(changes.back().sequence);
    }
  }

  Demand demand_;
  const bool keeps_up_;
  const std::string path_;
  Queue<DemandUpdate> queue_;
  Follower follower_;
  int num_losses_{0};
  std::thread thread_;
};

/// The owner of the store: does one call after another, and tells the subscribers.
class Owner {
 public:
  Owner(const std::string& path, std::vector<std::unique_ptr<Subscriber>>* subscribers)
      : store_(path, SmallOntology()), subscribers_(subscribers) {
    for (const auto& subscriber : *subscribers_) subscriber->Start(store_);
    thread_ = std::thread([this] { Work(); });
  }
  void Finish() {
    mailbox_.Post(std::nullopt);
    thread_.join();
    for (const auto& subscriber : *subscribers_) subscriber->Finish();
  }

  /// By any thread: what the call changed.
  std::vector<Change> Do(Request request) {
    std::future<std::vector<Change>> changes = request.changes.get_future();
    mailbox_.Post(std::move(request));
    return changes.get();
  }
  const Store& store() const { return store_; }  ///< once it has finished

 private:
  void Work() {
    for (;;) {
      auto request = mailbox_.WaitAndTake(std::chrono::duration<double>(1.0));
      if (!request) continue;
      if (!*request) return;
      WorkOn(&**request);
    }
  }
  void WorkOn(Request* request) {
    std::vector<Change> changes;
    const Assertion by = At(++time_);
    try {
      changes = request->remove.empty() ? store_.Add(request->add, by)
                                        : store_.Remove(request->remove, by);
    } catch (...) {
      request->changes.set_exception(std::current_exception());
      return;
    }
    request->changes.set_value(changes);
    for (const auto& subscriber : *subscribers_) subscriber->Publish(changes, store_);
  }

  Store store_;
  double time_{0.0};
  base::Mailbox<std::optional<Request>> mailbox_;
  std::vector<std::unique_ptr<Subscriber>>* subscribers_;
  std::thread thread_;
};

/// One who says things about what all share, and about a pair of poses of its own that always
/// stand at the same place.
class Writer {
 public:
  Writer(int index, Owner* owner) : index_(index), owner_(owner), rng_(base::Rng(7).Fork(Id())) {}

  void Work() {
    for (int i = 0; i < NumTransactions(); ++i) {
      try {
        NoteAnswer(owner_->Do(i % 4 == 0 ? MovePair(i) : Anything(i)));
      } catch (const base::ConfigError&) {
        ++num_refused_;  // somebody else had removed it
      }
    }
  }
  std::uint64_t last() const { return last_; }
  std::size_t num_changes() const { return num_changes_; }
  int num_refused() const { return num_refused_; }

 private:
  std::uint64_t Id() const { return static_cast<std::uint64_t>(index_); }
  std::string Shared(const std::string& kind) { return kind + std::to_string(rng_.Index(20)); }

  Request MovePair(int i) const {
    const std::string name = "pair" + std::to_string(index_);
    Request request;
    request.add = {PoseAt(name + "a", i), PoseAt(name + "b", i)};
    return request;
  }
  Request Anything(int i) {
    Request request;
    if (rng_.Bernoulli(0.3)) {
      request.remove = {Shared(rng_.Bernoulli(0.5) ? "mug" : rng_.Bernoulli(0.5) ? "on" : "pose")};
      return request;
    }
    for (int n = 1 + rng_.Index(5); n > 0; --n) request.add.push_back(Something(i));
    return request;
  }
  Fluent Something(int i) {
    switch (rng_.Index(3)) {
      case 0:
        return MakeFluent(
            "Mug", Shared("mug"),
            {{"hasPose", "Pose", Shared("pose")}, {"hasCount", "xsd:int", std::int64_t{i}}});
      case 1:
        return MakeFluent("On", Shared("on"), {{"hasObject", "Mug", Shared("mug")}});
      default:
        return PoseAt(Shared("pose"), i);
    }
  }
  void NoteAnswer(const std::vector<Change>& changes) {
    num_changes_ += changes.size();
    for (const Change& change : changes) {
      EXPECT_GT(change.sequence, last_);
      last_ = change.sequence;
    }
  }

  const int index_;
  Owner* owner_;
  base::Rng rng_;
  std::uint64_t last_{0};
  std::size_t num_changes_{0};
  int num_refused_{0};
};

/// Looks at the file while it is being written: pairs stand together, numbers only grow.
void LookAround(const std::string& path, const std::atomic<bool>& is_done,
                std::atomic<int>* looks) {
  StoreOptions options;
  options.read_only = true;
  const Store reader(path, SmallOntology(), options);
  std::uint64_t last = 0;
  do {
    FluentQuery query;
    query.concepts = {{"Pose"}};
    const FluentPage page = reader.Query(query);
    EXPECT_GE(page.sequence, last);
    last = page.sequence;
    std::map<std::string, Fluent> poses;
    for (const Fluent& fluent : page.fluents)
      EXPECT_TRUE(poses.emplace(fluent.instance, fluent).second);
    for (int i = 0; i < kNumWriters; ++i) {
      const std::string name = "pair" + std::to_string(i);
      EXPECT_EQ(poses[name + "a"].properties, poses[name + "b"].properties);
    }
    ++*looks;
  } while (!is_done);
}

class ConcurrencyTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const DemandTopic& topic : Topics()) {
      subscribers_.push_back(
          std::make_unique<Subscriber>(topic, KeepsUp(subscribers_.size()), path_));
    }
    owner_.emplace(path_, &subscribers_);
    for (int i = 0; i < kNumWriters; ++i) writers_.emplace_back(i, &*owner_);
  }

  void Run() {
    std::atomic<bool> is_done{false};
    std::vector<std::thread> reading, writing;
    for (std::atomic<int>& looks : looks_) {
      reading.emplace_back([&] { LookAround(path_, is_done, &looks); });
    }
    for (Writer& writer : writers_) writing.emplace_back([&] { writer.Work(); });
    for (std::thread& thread : writing) thread.join();
    owner_->Finish();
    is_done = true;
    for (std::thread& thread : reading) thread.join();
  }

  /// The changes that a topic over `fits` must have told, one by one from the store.
  std::vector<std::uint64_t> Wanted(const std::function<bool(const Fluent&)>& fits) {
    std::vector<std::uint64_t> wanted;
    std::set<std::string> members;
    std::uint64_t last = 0;
    for (;;) {
      const std::vector<Change> changes = owner_->store().ChangesSince(last, 1000);
      if (changes.empty()) return wanted;
      for (const Change& change : changes) {
        EXPECT_EQ(change.sequence, ++last);
        const bool enters = change.kind != Change::Kind::kRemoved && fits(change.fluent);
        const bool was_there = members.erase(change.fluent.instance) > 0;
        if (enters) members.insert(change.fluent.instance);
        if (enters || was_there) wanted.push_back(change.sequence);
      }
    }
  }

  void Report(double seconds) const {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const std::uint64_t last = owner_->store().last_sequence();
    std::cout << kNumWriters * NumTransactions() << " calls, " << last << " changes in " << seconds
              << " s; readers looked " << looks_[0] + looks_[1] << " times, losses noticed "
              << subscribers_[1]->num_losses() + subscribers_[4]->num_losses() << ", at most "
              << usage.ru_maxrss / 1024 << " MB" << std::endl;
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "blackboard.db").string();
  std::vector<std::unique_ptr<Subscriber>> subscribers_;
  std::optional<Owner> owner_;
  std::deque<Writer> writers_;
  std::array<std::atomic<int>, 2> looks_{};
};

TEST_F(ConcurrencyTest, EverySubscriberHasWhatTheStoreHas) {
  const auto begin = std::chrono::steady_clock::now();
  Run();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  const Store& store = owner_->store();
  std::size_t num_changes = 0;
  for (const Writer& writer : writers_) {
    num_changes += writer.num_changes();
    EXPECT_GT(writer.num_refused(), 0);
  }
  EXPECT_EQ(num_changes, store.last_sequence());  // each was acknowledged to exactly one

  const std::vector<DemandTopic> topics = Topics();
  for (std::size_t i = 0; i < topics.size(); ++i) {
    Follower fresh;
    fresh.Begin(Demand(topics[i], SmallOntology()).Snapshot(store));
    EXPECT_EQ(subscribers_[i]->follower().fluents(), fresh.fluents()) << topics[i].name;
    EXPECT_FALSE(subscribers_[i]->follower().told().empty());
  }
  const auto is = [](const char* name) {
    return [name](const Fluent& fluent) { return fluent.concept_name == name; };
  };
  const std::vector<std::uint64_t> poses = Wanted(is("Pose"));
  for (const std::size_t i : {0, 1, 3, 4})
    EXPECT_EQ(subscribers_[i]->follower().told(), poses) << i;
  EXPECT_EQ(subscribers_[2]->follower().told(), Wanted(is("Mug")));
  EXPECT_EQ(subscribers_[5]->follower().told(), Wanted(is("On")));
  for (const std::size_t i : {1, 4}) EXPECT_GT(subscribers_[i]->num_losses(), 0);
  for (const std::atomic<int>& looks : looks_) EXPECT_GT(looks, 0);
  Report(taken.count());
}

}  // namespace
}  // namespace hires::knowledge::concurrency_test
