#include "lab/src/decision/action_loop.h"

#include <limits>

#include "loop/loop_parts.h"
#include "loop/middle_layer.h"
#include "loop/robot_side.h"
#include "loop/virtual_clock.h"

namespace hires::lab {
namespace {

constexpr double kFirstLook = 0.5;  // [s] until all sensors have spoken
constexpr int kActivity = 1;

/// Robot and middle layer, wired.
class ActionPlay {
 public:
  ActionPlay(const loop::LoopSetup::Parts& parts, const ActionOrder& order)
      : order_(order),
        aftermath_(parts.world.rollout.aftermath),
        clock_(loop::kStart),
        robot_(parts, order.start, order.truth, parts.SensorsUnder(order.truth), order.seed,
               &clock_,
               {[this](const loop::SensorNews& news) { middle_layer_.Hear(news, robot_.laser()); },
                [this](double stamp) { middle_layer_.Look(stamp); }}),
        middle_layer_(parts.world, loop::FramesOf(parts.world.scene->robot), parts.config.runner,
                      parts.config.scan,
                      {[this](const robot::Command& command) { robot_.Command(command); },
                       [this](int, control::ActionEnd end, const base::Failure& failure) {
                         OnEnded(end, failure);
                       }}) {
    middle_layer_.OnKnownObjects(loop::kStart, order.start.world);
  }

  std::optional<ActionRun> Run(const std::function<bool()>& cancelled) {
    robot_.Begin();
    clock_.At(loop::kStart + kFirstLook, [this] {
      begun_ = clock_.now();
      middle_layer_.Start(kActivity, order_.action, order_.time_limit);
    });
    while (clock_.Step() && clock_.now() < end_) {
      if (cancelled && cancelled()) return std::nullopt;
    }
    run_.truth = {robot_.truth().objects(), robot_.truth().contact()};
    run_.virtual_seconds = clock_.now() - loop::kStart;
    return run_;
  }

 private:
  void OnEnded(control::ActionEnd end, const base::Failure& failure) {
    run_.failure = end == control::ActionEnd::kSucceeded ? base::Failure() : failure;
    run_.duration = clock_.now() - begun_;
    end_ = clock_.now() + aftermath_;
  }

  const ActionOrder& order_;
  const double aftermath_;  // [s] in which what still shakes falls or not, as in rollouts
  loop::VirtualClock clock_;
  loop::RobotSide robot_;
  loop::MiddleLayer middle_layer_;
  double begun_{0.0};  // [s]
  double end_{std::numeric_limits<double>::infinity()};
  ActionRun run_;
};

}  // namespace

std::optional<ActionRun> PlayAction(const loop::LoopSetup& setup, const ActionOrder& order,
                                    const std::function<bool()>& cancelled) {
  return ActionPlay(setup.parts(), order).Run(cancelled);
}

}  // namespace hires::lab
