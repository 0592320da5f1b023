#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/execution/monitor.h"
#include "hires/execution/monitor_config.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/kept_rollouts.h"
#include "hires/imagination/report.h"
#include "hires/imagination/scheduler.h"
#include "hires/imagination/start_spread.h"
#include "loop/achieve.h"
#include "loop/blackboard.h"
#include "loop/rollout_pool.h"
#include "loop/virtual_clock.h"

namespace hires::loop {

/// How much virtual time imagining takes.
struct ImaginationPace {
  double speed{100.0};       ///< [s] simulated in rollouts per second, of each worker
  int workers{2};            ///< simulators that imagine
  double translation{0.05};  ///< [s] until the state is geometry
};

/// Imagines steps for the execution monitor: the state becomes geometry, the scheduler hands out
/// rollouts to workers that exist in virtual time alone, and deadlines cut it short there. What a
/// rollout gives is played by real threads, as many as there are; their number changes nothing.
/// A request that begins again goes on with the rollouts that cannot depend on what has changed:
/// they take no time.
class ImaginationDesk {
 public:
  using OnAnswer = std::function<void(const execution::ImagineAnswered&)>;

  /// @pre all outlive this.
  ImaginationDesk(const imagination::ImaginationSetup& setup,
                  const translation::TranslatorContext& context,
                  const imagination::ClientConfig& config,
                  const execution::ImaginingParams& imagining, const ImaginationPace& pace,
                  VirtualClock* clock, Blackboard* blackboard, RolloutPool* pool,
                  OnAnswer on_answer);

  /// Where the robot says now that it stands; what begins there is imagined as uncertain as that.
  void OnLocalised(const imagination::BelievedPose& believed) { believed_ = believed; }
  ~ImaginationDesk();

  void Start(const execution::StartImagination& command);
  void Move(const execution::MoveDeadline& command);
  void Cancel(const execution::CancelImagination& command);
  void CancelAll();

  /// Of all requests, in their order; `dispatch` is not filled in.
  const std::vector<ImaginedStep>& steps() const { return steps_; }

 private:
  struct Session;
  using SessionPtr = std::shared_ptr<Session>;

  SessionPtr Find(int request) const;
  void Begin(const SessionPtr& session);
  void Handle(const SessionPtr& session, const imagination::Event& event);
  void CarryOut(const SessionPtr& session, const std::vector<imagination::Command>& commands);
  void Play(const SessionPtr& session, const imagination::Assign& assign);
  struct Played;
  const Played& Rollout(const SessionPtr& session, int alternative, int index);
  void Finished(const SessionPtr& session, const imagination::Assign& assign, int index,
                const Played& played);
  imagination::Report Book(const SessionPtr& session);
  void Finish(const SessionPtr& session);
  void BreakOff(const SessionPtr& session);
  void Refuse(const SessionPtr& session, execution::ImagineAnswered::Outcome outcome,
              const std::string& why);
  void End(const SessionPtr& session, ImaginedOutcome outcome);

  const imagination::ImaginationSetup& setup_;
  const translation::TranslatorContext& context_;
  const imagination::SchedulerParams scheduler_;
  const execution::ImaginingParams imagining_;
  const ImaginationPace pace_;
  VirtualClock& clock_;
  Blackboard& blackboard_;
  RolloutPool& pool_;
  const OnAnswer on_answer_;
  std::map<int, SessionPtr> sessions_;  // by request
  imagination::KeptRollouts kept_;
  std::optional<imagination::BelievedPose> believed_;
  std::vector<double> free_from_;  // [s] each worker, after all that it was assigned
  std::vector<ImaginedStep> steps_;
};

}  // namespace hires::loop
