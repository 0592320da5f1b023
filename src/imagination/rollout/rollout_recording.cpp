#include "hires/imagination/rollout_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "hires/simulation/fall_watch.h"
#include "imagination/rollout/load_monitor.h"

namespace hires::imagination {
namespace {

constexpr double kEpilogue = 1.0;         // [s] of physics after all was counted
constexpr double kShortestFlight = 0.02;  // [s] what hops for less long only rattles
constexpr double kTippingShare = 10.0;    // times shaking_tilt: it tips, and no longer only shakes

std::vector<std::string> NamesOf(const world::WorldState& state) {
  std::vector<std::string> names;
  for (const world::ObjectState& object : state.objects) names.push_back(object.name);
  return names;
}

/// When the action begins, by the simulator's clock [s].
double BeginOf(const RolloutSetup& setup) {
  const double time_step = setup.physics.time_step;
  return time_step * std::lround(setup.params.settling_time / time_step);
}

/// Notes a rollout while it is played.
class Recorder {
 public:
  Recorder(const RolloutSetup& setup, RolloutRecording* recording, RolloutWatcher* watcher)
      : setup_(setup), begin_(BeginOf(setup)), recording_(*recording), watcher_(watcher) {}

  /// It may begin again, with more of what stands about.
  void Begin(const simulation::RobotSimulator& simulator) {
    recording_.objects = NamesOf(simulator.GetWorldState());
    recording_.samples.clear();
    recording_.events.clear();
    objects_.assign(recording_.objects.size(), Object(setup_.standing));
    is_late_ = touches_ = false;
    NoteFallsWhileSettling(simulator);
    if (watcher_ != nullptr) watcher_->OnBegin();
  }

  void NoteSample(const simulation::RobotSimulator& simulator) {
    RolloutSample sample;
    sample.time = TimeOf(simulator);
    sample.X_MB = simulator.X_MB();
    sample.V_B = simulator.base().V_B;
    sample.A_B = simulator.base().A_B;
    sample.joints = simulator.GetRobotState().joints;
    for (const world::ObjectState& object : simulator.GetWorldState().objects) {
      sample.X_MO.push_back(object.X_MO);
    }
    recording_.samples.push_back(std::move(sample));
    if (watcher_ != nullptr) watcher_->OnSample(simulator);
  }

  void Look(const simulation::RobotSimulator& simulator) {
    last_look_ = TimeOf(simulator);
    NoteBase(simulator);
    for (std::size_t i = 0; i < objects_.size(); ++i) NoteObject(simulator, static_cast<int>(i));
  }

  void NoteLateCycle(const simulation::RobotSimulator& simulator, double delay) {
    Say(Kind::kLateCycle, TimeOf(simulator), fmt::format("cycle late {:.2f} s", delay));
  }

  /// What came late while it came no further had no part in it.
  void NoteStall(double time, const std::string& text) {
    const double since = time - begin_;
    auto& events = recording_.events;
    const auto is_false_trail = [&](const RolloutEvent& event) {
      return event.time >= since &&
             (event.kind == Kind::kLateCycle || event.kind == Kind::kTimedOut);
    };
    events.erase(std::remove_if(events.begin(), events.end(), is_false_trail), events.end());
    Say(Kind::kStall, since, "comes no further: " + text);
  }

 private:
  using Kind = RolloutEvent::Kind;

  struct Object {
    explicit Object(const world::StandingCriterion& standing) : watch(standing) {}
    simulation::FallWatch watch;
    bool is_tipping_told{false}, is_flight_told{false};
    double last_upright{0.0}, last_touched{0.0};  // [s]
    std::string cause;                            // of its leaning
  };

  double TimeOf(const simulation::RobotSimulator& simulator) const {
    return simulator.time() - begin_;
  }

  void NoteFallsWhileSettling(const simulation::RobotSimulator& simulator) {
    const geometry::Pose3 X_BM = geometry::Lift(setup_.robot_state.X_MB).Inverse();
    for (std::size_t i = 0; i < recording_.objects.size(); ++i) {
      const world::ObjectState* start = setup_.world_state.Find(recording_.objects[i]);
      if (start == nullptr ||
          !FellWhileSettling(simulator, static_cast<int>(i), X_BM * start->X_MO, setup_.standing)) {
        continue;
      }
      Say(Kind::kFalls, 0.0, recording_.objects[i] + " falls: off the robot while it settled");
    }
  }

  void NoteBase(const simulation::RobotSimulator& simulator) {
    const bool is_late = simulator.base().timed_out;
    if (is_late && !is_late_) {
      Say(Kind::kTimedOut, last_look_, "no command in time: the base brakes by itself");
    }
    is_late_ = is_late;
    if (simulator.contact() && !touches_) {
      touches_ = true;
      Say(Kind::kContact, last_look_, ToString(*simulator.contact()));
    }
  }

  void NoteObject(const simulation::RobotSimulator& simulator, int index) {
    Object& object = objects_[index];
    const std::string& name = recording_.objects[index];
    const world::Fall fall = object.watch.Look(simulator, index);
    const world::Departure& now = object.watch.detector().now();
    NoteTipping(simulator, index, now.tilt);
    NoteFlight(simulator, index);
    if (fall != world::Fall::kNone) Say(Kind::kFalls, last_look_, name + FallText(fall, now));
  }

  /// That it began to tip is known once it leans well beyond shaking.
  void NoteTipping(const simulation::RobotSimulator& simulator, int index, double tilt) {
    Object& object = objects_[index];
    if (tilt <= setup_.params.shaking_tilt) {
      object.last_upright = last_look_;
      object.cause.clear();
      object.is_tipping_told = false;
      return;
    }
    if (object.cause.empty()) object.cause = CauseNow(simulator);
    if (object.is_tipping_told || tilt <= kTippingShare * setup_.params.shaking_tilt) return;
    object.is_tipping_told = true;
    Say(Kind::kTips, object.last_upright,
        fmt::format("{} begins to tip ({})", recording_.objects[index], object.cause));
  }

  void NoteFlight(const simulation::RobotSimulator& simulator, int index) {
    Object& object = objects_[index];
    if (simulator.IsTouched(index)) {
      object.last_touched = last_look_;
      object.is_flight_told = false;
    } else if (!object.is_flight_told && last_look_ - object.last_touched >= kShortestFlight) {
      object.is_flight_told = true;
      Say(Kind::kLiftsOff, object.last_touched, recording_.objects[index] + " lifts off");
    }
  }

  static std::string FallText(world::Fall fall, const world::Departure& now) {
    switch (fall) {
      case world::Fall::kToppled:
        return fmt::format(" falls: leans {:.2f} rad", now.tilt);
      case world::Fall::kDropped:
        return fmt::format(" falls: {:.2f} m lower than it stood", now.drop);
      case world::Fall::kSlid:
        return fmt::format(" slides: {:.2f} m from where it stood", now.slide);
      default:
        return " is lost";
    }
  }

  void Say(Kind kind, double time, const std::string& text) {
    recording_.events.push_back({kind, time, text});
  }

  const RolloutSetup& setup_;
  const double begin_;  // [s] of the action
  RolloutRecording& recording_;
  RolloutWatcher* const watcher_;
  std::vector<Object> objects_;
  double last_look_{0.0};  // [s] since the action began
  bool is_late_{false}, touches_{false};
};

std::string Header(const RolloutRecording& recording) {
  std::string header =
      "time [s],x [m],y [m],z [m],roll [rad],pitch [rad],yaw [rad],vx [m/s],vy [m/s],wz [rad/s],"
      "speed [m/s],acceleration [m/s^2],angular_acceleration [rad/s^2],jerk [m/s^3]";
  for (const std::string& name : recording.objects) {
    for (const char* column : {"x [m]", "y [m]", "z [m]", "tilt [rad]"}) {
      header += fmt::format(",{}.{}", name, column);
    }
  }
  return header + ",event\n";
}

/// What happened in the samples' interval that ends with sample i; behind the last all that is
/// left.
std::string EventsUpTo(const RolloutRecording& recording, std::size_t i) {
  const double after = i == 0 ? -1e9 : recording.samples[i - 1].time;
  const bool is_last = i + 1 == recording.samples.size();
  std::vector<std::string> texts;
  for (const RolloutEvent& event : recording.events) {
    const bool is_later = event.time > recording.samples[i].time && !is_last;
    if (event.time > after && !is_later) texts.push_back(event.text);
  }
  return base::Join(texts, "; ");
}

/// Nobody sends commands when the action is over.
void DropWhatTheEndCauses(RolloutRecording* recording) {
  auto& events = recording->events;
  const auto is_caused = [&](const RolloutEvent& event) {
    return event.kind == RolloutEvent::Kind::kTimedOut && event.time > recording->result.duration;
  };
  events.erase(std::remove_if(events.begin(), events.end(), is_caused), events.end());
}

RolloutEvent EndOf(const RolloutResult& result) {
  const base::Failure failure = FailureOf(result);
  std::string text = result.action_finished ? "goal reached" : "action ends";
  if (failure) text += ", failed: " + ToString(failure);
  return {RolloutEvent::Kind::kEnd, result.duration, text};
}

}  // namespace

std::optional<RolloutRecording> RecordRollout(const RolloutSetup& setup,
                                              const base::ActionCall& action, int index,
                                              const std::function<bool()>& cancelled,
                                              RolloutWatcher* watcher) {
  using simulation::RobotSimulator;
  RolloutRecording recording;
  recording.action = action;
  recording.index = index;
  recording.seed = setup.seed;
  Recorder recorder(setup, &recording, watcher);
  RolloutHooks hooks;
  hooks.cancelled = cancelled;
  hooks.on_begin = [&](const RobotSimulator& simulator) { recorder.Begin(simulator); };
  hooks.on_look = [&](const RobotSimulator& simulator) { recorder.Look(simulator); };
  hooks.on_sample = [&](const RobotSimulator& simulator, double) {
    recorder.NoteSample(simulator);
  };
  hooks.on_late_cycle = [&](const RobotSimulator& simulator, double delay) {
    recorder.NoteLateCycle(simulator, delay);
  };
  hooks.on_stall = [&](double time, const std::string& text) { recorder.NoteStall(time, text); };
  hooks.epilogue = kEpilogue;
  const std::optional<RolloutResult> result = PlayRollout(setup, action, index, hooks);
  if (!result) return std::nullopt;
  recording.result = *result;
  DropWhatTheEndCauses(&recording);
  recording.events.push_back(EndOf(*result));
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const RolloutEvent& a, const RolloutEvent& b) { return a.time < b.time; });
  return recording;
}

bool IsAmong(const Evidence& evidence, const RolloutResult& result) {
  const base::Failure failure = FailureOf(result);
  if (failure && evidence.failures.count(failure) == 0) return false;
  if (ActionFailed(result)) return static_cast<bool>(failure);
  return std::binary_search(evidence.durations.begin(), evidence.durations.end(), result.duration);
}

double JerkAt(const std::vector<RolloutSample>& samples, std::size_t i) {
  if (i == 0) return 0.0;
  const geometry::Twist2 &now = samples[i].A_B, &before = samples[i - 1].A_B;
  return std::hypot(now.vx - before.vx, now.vy - before.vy) /
         (samples[i].time - samples[i - 1].time);
}

std::string ToCsv(const RolloutRecording& recording) {
  std::string csv = Header(recording);
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const RolloutSample& s = recording.samples[i];
    const Eigen::Vector3d& p = s.X_MB.translation;
    const Eigen::Matrix3d R = s.X_MB.rotation.toRotationMatrix();
    const double roll = std::atan2(R(2, 1), R(2, 2)),
                 pitch = -std::asin(std::clamp(R(2, 0), -1.0, 1.0));
    csv += fmt::format("{:.3f}", s.time);
    for (const double value :
         {p.x(), p.y(), p.z(), roll, pitch, geometry::YawOf(s.X_MB.rotation), s.V_B.vx, s.V_B.vy,
          s.V_B.wz, std::hypot(s.V_B.vx, s.V_B.vy), std::hypot(s.A_B.vx, s.A_B.vy), s.A_B.wz,
          JerkAt(recording.samples, i)}) {
      csv += fmt::format(",{:.6g}", value);
    }
    for (const geometry::Pose3& X_MO : s.X_MO) {
      const Eigen::Vector3d& o = X_MO.translation;
      csv += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g}", o.x(), o.y(), o.z(),
                         geometry::TiltOf(X_MO.rotation));
    }
    const std::string events = EventsUpTo(recording, i);
    csv += events.empty() ? ",\n" : fmt::format(",\"{}\"\n", events);
  }
  return csv;
}

}  // namespace hires::imagination
