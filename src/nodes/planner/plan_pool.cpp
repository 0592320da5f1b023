#include "nodes/planner/plan_pool.h"

#include <algorithm>

#include "hires/base/process.h"

namespace hires_ros {

PlanPool::PlanPool(int num_threads, Answer answer, hires::base::Mailbox<PlanAnswered>* answered)
    : answer_(std::move(answer)), answered_(answered), threads_(num_threads) {}

PlanPool::~PlanPool() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_ending_ = true;
  waiting_.clear();
  for (const auto& job : running_) job->is_cancelled = true;
}

void PlanPool::Submit(std::shared_ptr<PlanJob> job) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(job));
  }
  threads_.Post([this] { AnswerNext(); });
}

bool PlanPool::Withdraw(int id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto job = std::find_if(waiting_.begin(), waiting_.end(),
                                [id](const auto& waiting) { return waiting->id == id; });
  if (job == waiting_.end()) return false;
  waiting_.erase(job);
  return true;
}

int PlanPool::num_waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(waiting_.size());
}

int PlanPool::num_running() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(running_.size());
}

std::shared_ptr<PlanJob> PlanPool::Next() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_ending_ || waiting_.empty()) return nullptr;
  std::shared_ptr<PlanJob> job = std::move(waiting_.front());
  waiting_.pop_front();
  running_.push_back(job);
  job->begun = hires::base::SteadyNow();
  return job;
}

void PlanPool::AnswerNext() {
  const std::shared_ptr<PlanJob> job = Next();
  if (job == nullptr) return;
  hires::PlanResult result = answer_(job.get());
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    running_.erase(std::find(running_.begin(), running_.end(), job));
  }
  answered_->Post({job->id, std::move(result)});
}

}  // namespace hires_ros
