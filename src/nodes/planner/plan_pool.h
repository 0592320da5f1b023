#pragma once

#include <hires/PlanGoal.h>
#include <hires/PlanResult.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include "hires/base/mailbox.h"
#include "hires/base/thread_pool.h"

namespace hires_ros {

/// One request, shared by the thread that spins and the one that searches. The constant part is set
/// before it is submitted; of the rest, each field has one writer.
struct PlanJob {
  int id{0};
  hires::PlanGoalConstPtr goal;
  double accepted{0.0};  ///< [s] steady
  double end{0.0};       ///< [s] steady, when its time is over

  std::atomic<bool> is_cancelled{false};  ///< by the thread that spins, or the pool at its end
  std::atomic<double> begun{-1.0};        ///< [s] steady; negative: it waits
  std::atomic<std::uint64_t> expansions{0};
  std::atomic<int> depth{0};
  std::atomic<int> plans{0};
  std::atomic<double> best_cost{std::numeric_limits<double>::infinity()};
};

/// An answer on its way to the thread that spins.
struct PlanAnswered {
  int id;
  hires::PlanResult result;
};

/// Threads that answer requests in the order in which they came.
class PlanPool {
 public:
  using Answer = std::function<hires::PlanResult(PlanJob*)>;

  /// @param answer    Called on a thread of the pool; must not throw.
  /// @param answered  Where the answers go.  @pre outlives the pool.
  PlanPool(int num_threads, Answer answer, hires::base::Mailbox<PlanAnswered>* answered);
  ~PlanPool();  ///< Cancels what runs, forgets what waits.
  PlanPool(const PlanPool&) = delete;
  PlanPool& operator=(const PlanPool&) = delete;

  void Submit(std::shared_ptr<PlanJob> job);

  /// Takes back a job that waits. False if it has begun, or is unknown: then its answer comes.
  bool Withdraw(int id);

  int num_waiting() const;
  int num_running() const;

 private:
  void AnswerNext();
  std::shared_ptr<PlanJob> Next();  ///< nothing where the job was withdrawn, and at the end

  const Answer answer_;
  hires::base::Mailbox<PlanAnswered>* const answered_;
  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<PlanJob>> waiting_;
  std::vector<std::shared_ptr<PlanJob>> running_;
  bool is_ending_{false};
  hires::base::ThreadPool threads_;  // last: it uses the others
};

}  // namespace hires_ros
