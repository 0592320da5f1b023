// A process that writes at full rate is killed in the middle of it, again and again. What it
// acknowledged must be there, and nothing by half. HIRES_DURABILITY_ROUNDS sets how often (20).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "knowledge/support/store_workload.h"
#include "support/temporary_folder.h"

namespace hires::knowledge::durability_test {
namespace {

using test_support::Ever;
using test_support::QueryAll;
using test_support::SmallOntology;
using test_support::StoreWorkload;

int NumRounds() {
  const char* text = std::getenv("HIRES_DURABILITY_ROUNDS");
  return text != nullptr ? std::atoi(text) : 20;
}

/// The helper program at work on a store.
class WriterProcess {
 public:
  WriterProcess(const std::string& path, const StoreWorkload& workload, Durability durability) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    acknowledged_ = ends[0];
    std::vector<std::string> words = {HIRES_STORE_WRITER, path, std::to_string(workload.seed),
                                      std::to_string(workload.text_bytes),
                                      durability == Durability::kPower ? "power" : "process"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    const int error =
        posix_spawn(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) throw std::runtime_error("cannot start " + words[0]);
  }
  ~WriterProcess() { close(acknowledged_); }
  WriterProcess(const WriterProcess&) = delete;
  WriterProcess& operator=(const WriterProcess&) = delete;

  /// Kills it as soon as it has acknowledged so many calls.
  /// @return the last change that it acknowledged, also while it was being killed.
  std::uint64_t KillAfter(int num_acknowledged) {
    std::uint64_t last = 0;
    for (int i = 0; i < num_acknowledged; ++i) EXPECT_TRUE(Read(&last)) << "it ended by itself";
    kill(process_, SIGKILL);
    while (Read(&last)) {
    }
    int status = 0;
    EXPECT_EQ(waitpid(process_, &status, 0), process_);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
    return last;
  }

 private:
  /// Eight bytes are put into a pipe as a whole.
  bool Read(std::uint64_t* sequence) {
    return read(acknowledged_, sequence, sizeof *sequence) == sizeof *sequence;
  }

  pid_t process_{0};
  int acknowledged_{-1};
};

void ExpectSame(const Change& a, const Change& b) {
  ASSERT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.kind, b.kind) << a.sequence;
  EXPECT_EQ(a.fluent, b.fluent) << a.sequence;
  EXPECT_EQ(a.time, b.time) << a.sequence;
}

void ExpectSame(const std::vector<Change>& a, const std::vector<Change>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ExpectSame(a[i], b[i]);
}

/// One file, and beside it what must be in it.
class Life {
 public:
  Life(StoreWorkload workload, Durability durability)
      : workload_(workload), durability_(durability) {}

  /// Lets a writer go on with the file, kills it, and looks at what it left.
  void Die(int num_acknowledged) {
    WriterProcess writer(path_, workload_, durability_);
    const std::uint64_t acknowledged = writer.KillAfter(num_acknowledged);
    const auto begin = std::chrono::steady_clock::now();
    const Store store(path_, SmallOntology());
    open_time_ = std::chrono::steady_clock::now() - begin;
    const std::uint64_t last = store.last_sequence();
    EXPECT_GE(last, acknowledged);
    const std::uint64_t before = wanted_.last_sequence();
    while (wanted_.last_sequence() < last) {
      workload_.Write(StoreWorkload::Next(wanted_), &wanted_);
    }
    ASSERT_EQ(wanted_.last_sequence(), last) << "a batch is there by half";
    ExpectSame(store.ChangesSince(before, last), wanted_.ChangesSince(before, last));
    EXPECT_EQ(QueryAll(store, Ever()), QueryAll(wanted_, Ever()));
    EXPECT_EQ(store.Stats().fluents, wanted_.Stats().fluents);
  }

  double open_time() const { return open_time_.count(); }

 private:
  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "blackboard.db").string();
  StoreWorkload workload_;
  Durability durability_;
  Store wanted_{":memory:", SmallOntology()};
  std::chrono::duration<double> open_time_{};
};

TEST(DurabilityTest, WhatWasAcknowledgedSurvivesEveryKillAndNothingIsThereByHalf) {
  base::Rng rng(5);
  std::unique_ptr<Life> life;
  double slowest = 0.0;
  for (int round = 0; round < NumRounds(); ++round) {
    if (round % 4 == 0) {
      const auto durability = round % 8 == 4 ? Durability::kPower : Durability::kProcess;
      life =
          std::make_unique<Life>(StoreWorkload{static_cast<std::uint64_t>(round), 0}, durability);
    }
    life->Die(1 + rng.Index(round % 8 < 4 ? 400 : 40));  // a sync to the disk takes long
    ASSERT_FALSE(HasFailure()) << "in round " << round;
    slowest = std::max(slowest, life->open_time());
  }
  std::cout << "opened again within " << slowest << " s" << std::endl;
}

/// With texts so large that the log goes into the file every 120 batches, and kills around that.
TEST(DurabilityTest, AKillWhileTheLogGoesIntoTheFileLosesNothing) {
  base::Rng rng(6);
  double slowest = 0.0;
  for (int round = 0; round < NumRounds() / 5; ++round) {
    Life life({static_cast<std::uint64_t>(round), 1 << 20}, Durability::kProcess);
    life.Die(110 + rng.Index(30));
    life.Die(1 + rng.Index(20));
    ASSERT_FALSE(HasFailure()) << "in round " << round;
    slowest = std::max(slowest, life.open_time());
  }
  std::cout << "opened again within " << slowest << " s" << std::endl;
}

}  // namespace
}  // namespace hires::knowledge::durability_test
