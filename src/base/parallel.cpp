#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <optional>
#include <variant>

#include "hires/base/mailbox.h"
#include "hires/base/thread_pool.h"

namespace hires::base {
namespace {

using Clock = std::chrono::steady_clock;

struct Advanced {
  double units;
};
struct TaskFailed {
  int task;
  std::exception_ptr error;
};
struct ThreadEnded {};
using Event = std::variant<Advanced, TaskFailed, ThreadEnded>;

/// What the threads share: the number of the next task and the way to the owner of the rest.
class Team {
 public:
  Team(int num_tasks, const Crew& crew, const std::function<void(int, const Advance&)>& work)
      : num_tasks_(num_tasks),
        size_(std::clamp(crew.threads, 1, std::max(1, num_tasks))),
        crew_(crew),
        work_(work),
        threads_(size_) {
    for (int i = 0; i < size_; ++i) threads_.Post([this] { Run(); });
  }

  int size() const { return size_; }
  Mailbox<Event>& events() { return events_; }

 private:
  void Run() {
    for (int task = next_++; task < num_tasks_ && !has_failed_; task = next_++) {
      if (crew_.cancelled && crew_.cancelled()) break;
      Do(task);
    }
    events_.Post(ThreadEnded{});
  }

  void Do(int task) {
    try {
      work_(task, [this](double units) { events_.Post(Advanced{units}); });
    } catch (...) {
      has_failed_ = true;
      events_.Post(TaskFailed{task, std::current_exception()});
    }
  }

  const int num_tasks_, size_;
  const Crew& crew_;
  const std::function<void(int, const Advance&)>& work_;
  Mailbox<Event> events_;
  std::atomic<int> next_{0};
  std::atomic<bool> has_failed_{false};
  ThreadPool threads_;  // last: it uses the others
};

/// The owner of what is known about the progress; lives on the calling thread.
class Watch {
 public:
  Watch(double total_units, const Crew& crew) : total_units_(total_units), crew_(crew) {}

  void Handle(const Event& event) {
    if (const auto* advanced = std::get_if<Advanced>(&event)) units_ += advanced->units;
    if (const auto* failed = std::get_if<TaskFailed>(&event)) errors_[failed->task] = failed->error;
    if (std::holds_alternative<ThreadEnded>(event)) ++num_ended_;
  }

  /// @param is_last  whatever was shown before, and when
  void Show(bool is_last = false) {
    constexpr auto kPeriod = std::chrono::milliseconds(200);
    const Clock::time_point now = Clock::now();
    if (!crew_.on_progress || total_units_ <= 0.0) return;
    if (now < shown_ + kPeriod && !is_last) return;
    shown_ = now;
    crew_.on_progress(std::min(1.0, units_ / total_units_),
                      std::chrono::duration<double>(now - start_).count());
  }

  int num_ended() const { return num_ended_; }
  void ThrowFirstError() const {
    if (!errors_.empty()) std::rethrow_exception(errors_.begin()->second);
  }

 private:
  const double total_units_;
  const Crew& crew_;
  const Clock::time_point start_{Clock::now()};
  Clock::time_point shown_{start_};
  double units_{0.0};
  int num_ended_{0};
  std::map<int, std::exception_ptr> errors_;
};

}  // namespace

bool DoInParallel(int num_tasks, double total_units, const Crew& crew,
                  const std::function<void(int, const Advance&)>& work) {
  Watch watch(total_units, crew);
  {
    Team team(num_tasks, crew, work);
    while (watch.num_ended() < team.size()) {
      if (const auto event = team.events().WaitAndTake(std::chrono::milliseconds(100))) {
        watch.Handle(*event);
      }
      watch.Show();
    }
  }
  watch.ThrowFirstError();
  if (crew.cancelled && crew.cancelled()) return false;
  watch.Show(true);
  return true;
}

}  // namespace hires::base
