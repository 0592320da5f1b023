#include "hires/imagination/local_imagination.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>

#include "hires/base/mailbox.h"
#include "hires/base/thread_pool.h"

namespace hires::imagination {
namespace {

constexpr double kInterimPeriod = 0.2;  // [s] between two reports of progress

double SteadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One thread that plays what it is assigned and posts what comes out.
class LocalWorker {
 public:
  LocalWorker(int id, const PlayOne& play, base::Mailbox<Event>* events)
      : id_(id), play_(play), events_(*events) {}
  ~LocalWorker() { stop_ = true; }

  void Post(const Assign& assign) {
    thread_.Post([this, assign] { CarryOut(assign); });
  }
  void Cancel(int assignment) { cancelled_up_to_ = assignment; }

 private:
  void CarryOut(const Assign& assign) {
    try {
      Play(assign);
    } catch (const std::exception& error) {
      events_.Post(AssignmentFailed{id_, assign.assignment, error.what(), false});
    }
  }

  void Play(const Assign& assign) {
    // Assignment numbers grow, so that "cancelled up to" needs no list.
    const auto unwanted = [&] { return stop_ || cancelled_up_to_ >= assign.assignment; };
    for (int i = assign.first_index; i < assign.first_index + assign.count; ++i) {
      auto result = play_(assign.alternative, i, {unwanted, {}});
      if (!result) return;
      events_.Post(
          RolloutFinished{id_, assign.assignment, assign.alternative, i, *std::move(result)});
    }
    events_.Post(AssignmentFinished{id_, assign.assignment});
  }

  const int id_;
  const PlayOne& play_;
  base::Mailbox<Event>& events_;
  std::atomic<bool> stop_{false};
  std::atomic<int> cancelled_up_to_{-1};
  base::ThreadPool thread_{1};  // last: it uses the others
};

}  // namespace

Report ImagineLocally(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                      const SchedulerParams& params, int num_threads, const OnInterim& on_interim,
                      const std::function<bool()>& cancelled) {
  const PlayOne play = [&](int alternative, int index, const RolloutHooks& hooks) {
    return PlayRollout(setup, actions[static_cast<std::size_t>(alternative)], index, hooks);
  };
  return ImagineLocally(setup, actions, params, num_threads, play, on_interim, cancelled);
}

Report ImagineLocally(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions,
                      const SchedulerParams& wanted, int num_threads, const PlayOne& play,
                      const OnInterim& on_interim, const std::function<bool()>& cancelled) {
  CheckSetupForAll(setup, actions);
  SchedulerParams params = wanted;
  params.criteria.prices.time_limit = setup.params.time_limit;
  const double start = SteadySeconds();
  Scheduler scheduler(params, static_cast<int>(actions.size()), start);
  base::Mailbox<Event> events;
  std::vector<std::unique_ptr<LocalWorker>> workers;
  const auto carry_out = [&](const std::vector<Command>& commands) {
    for (const Command& command : commands) {
      if (const auto* assign = std::get_if<Assign>(&command)) {
        workers[assign->worker]->Post(*assign);
      } else if (const auto* cancel = std::get_if<CancelAssignment>(&command)) {
        workers[cancel->worker]->Cancel(cancel->assignment);
      }
    }
  };
  for (int id = 0; id < num_threads; ++id) {
    workers.push_back(std::make_unique<LocalWorker>(id, play, &events));
    events.Post(WorkerJoined{id});
  }
  double next_interim = start + kInterimPeriod;
  while (!scheduler.finished()) {
    const auto event = events.WaitAndTake(std::chrono::milliseconds(50));
    const double now = SteadySeconds();
    carry_out(event ? scheduler.Handle(*event, now) : scheduler.Tick(now));
    if (cancelled && cancelled()) carry_out(scheduler.Cancel(now));
    if (on_interim && (now >= next_interim || scheduler.finished())) {
      next_interim = now + kInterimPeriod;
      on_interim({scheduler.ProgressAt(now),
                  PredictionsOf(scheduler, scheduler.RankingSoFar(), actions, false), num_threads});
    }
  }
  return MakeReport(scheduler, actions, setup.seed, SteadySeconds() - start, {},
                    setup.uncertainty->quantities.empty());
}

}  // namespace hires::imagination
