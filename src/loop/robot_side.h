#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hires/simulation/truth_record.h"
#include "loop/loop_parts.h"
#include "loop/robot_senses.h"
#include "loop/virtual_clock.h"

namespace hires::loop {

/// The robot that stands in for a real one, its world, and the truth about both; from tick to tick
/// in virtual time. In a tick its sensors speak, who controls it answers at once, and the world
/// goes on by 0.05 s.
class RobotSide {
 public:
  struct Hooks {
    std::function<void(const SensorNews&)> hear;  ///< at the time of its stamp
    std::function<void(double stamp)> look;       ///< all sensors of a tick have spoken
    bool hears_heat{false};    ///< the thermal camera takes pictures, with those of the other one
    bool hears_clouds{false};  ///< of the laser that nods
  };

  /// @param sensors  under this truth.  @pre all outlive this.
  RobotSide(const LoopSetup::Parts& parts, const imagination::StartState& start,
            const sim_robot::Truth& truth, const sim_robot::SimSensorParams& sensors,
            std::uint64_t seed, VirtualClock* clock, Hooks hooks);

  void Begin();
  /// Carried out at the end of this tick, or at the next one.
  void Command(const robot::Command& command) { commands_.push_back(command); }

  const simulation::LaserParams& laser() const { return sensors_.laser(); }
  const simulation::TruthRecord& truth() const { return truth_; }

 private:
  double Stamp() const;
  void Tick();
  void Advance();
  void Sweep();

  VirtualClock& clock_;
  const Hooks hooks_;
  sim_robot::SimRobotWorld world_;
  sim_robot::SimRobotSensors sensors_;
  simulation::TruthRecord truth_;
  std::vector<robot::Command> commands_;
  sim_robot::SensorReadings readings_;  // of the last tick
  std::optional<sim_robot::SweepCloud> gathering_;
  std::shared_ptr<const perception::PointCloud> sweep_;  // over and not told of yet
};

}  // namespace hires::loop
