#include "loop/robot_side.h"

#include <cmath>
#include <utility>

namespace hires::loop {
namespace {

constexpr double kBegin = 1.0;  // [s] 0 means "no time yet"
const long kTrayPeriod = std::lround(1000.0 * sensing::ObjectEstimator::kScanPeriod);  // [ms]

}  // namespace

RobotSide::RobotSide(const LoopSetup::Parts& parts, const imagination::StartState& start,
                     const sim_robot::Truth& truth, const sim_robot::SimSensorParams& sensors,
                     std::uint64_t seed, VirtualClock* clock, Hooks hooks)
    : clock_(*clock),
      hooks_(std::move(hooks)),
      world_(parts.world, start, seed, truth),
      sensors_(sensors, seed, world_.scene()),
      truth_(parts.world.standing) {
  const sim_robot::SimRobotLasers& lasers = sensors_.lasers();
  if (hooks_.hears_clouds && lasers.has_tilting_laser())
    gathering_.emplace(lasers.num_scans_of_a_sweep());
}

void RobotSide::Begin() {
  truth_.Look(world_.simulator());
  clock_.At(Stamp(), [this] { Tick(); });
}

double RobotSide::Stamp() const {
  return kBegin + 0.001 * static_cast<double>(world_.milliseconds());
}

void RobotSide::Tick() {
  SensorNews news;
  news.stamp = Stamp();
  news.readings = world_.Sense();
  news.is_tick = true;
  if (sensors_.has_laser()) news.scan = sensors_.Scan(world_, news.readings);
  news.seen = sensors_.Look(world_, news.readings);
  const sim_robot::SimRobotLasers& lasers = sensors_.lasers();
  if (lasers.has_tray_laser() && world_.milliseconds() % kTrayPeriod == 0) {
    news.tray =
        TrayScan{lasers.tray().link, simulation::ReadingOf(lasers.TrayScan(world_), lasers.tray())};
  }
  if (hooks_.hears_heat && news.seen) news.heat = sensors_.LookForHeat(world_, news.readings);
  news.sweep = std::exchange(sweep_, nullptr);
  readings_ = news.readings;
  hooks_.hear(news);
  hooks_.look(news.stamp);
  for (const robot::Command& command : std::exchange(commands_, {})) world_.Apply(command);
  Advance();
  clock_.At(Stamp(), [this] { Tick(); });
}

/// The world is ahead of the clock by a tick at most; what it says waits for its time.
void RobotSide::Advance() {
  for (long done = 0; done < sim_robot::kSensorTick; done += sim_robot::kJointTick) {
    if (done > 0) {
      SensorNews news;
      news.stamp = Stamp();
      news.readings = world_.Sense();
      const double stamp = news.stamp;
      clock_.At(stamp, [this, news = std::move(news)] { hooks_.hear(news); });
    }
    if (gathering_) {
      sim_robot::PlayJointTick(&world_, &truth_, [this] { Sweep(); });
    } else {
      sim_robot::PlayJointTick(&world_, &truth_);
    }
  }
}

/// The laser that nods measures, if it is its time; a sweep that is over is told of with the next
/// tick.
void RobotSide::Sweep() {
  const sim_robot::SimRobotLasers& lasers = sensors_.lasers();
  if (!lasers.IsTiltDue(world_)) return;
  auto cloud = gathering_->Add(lasers.TiltPhase(world_), lasers.tilting(), lasers.TiltScan(world_),
                               lasers.X_OTilt(world_, readings_));
  if (cloud) sweep_ = std::make_shared<const perception::PointCloud>(std::move(*cloud));
}

}  // namespace hires::loop
