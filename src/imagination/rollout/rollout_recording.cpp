#include "hires/imagination/rollout_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::imagination {
namespace {

constexpr char kChoices[] = "worst, median, first_fall or a number from 0, and @RANK behind it";

int ParseNumber(const std::string& digits, const std::string& text) {
  int number = -1;
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, number);
  if (error == std::errc() && rest == end && number >= 0) return number;
  throw base::ConfigError(fmt::format("rollout '{}': wanted {}", text, kChoices));
}

std::vector<std::string> NamesOf(const world::WorldState& state) {
  std::vector<std::string> names;
  for (const world::ObjectState& object : state.objects) names.push_back(object.name);
  return names;
}

/// Notes a rollout while it is played.
class Recorder {
 public:
  Recorder(const RolloutParams& params, RolloutRecording* recording)
      : params_(params), recording_(*recording) {}

  void Note(const simulation::RobotSimulator& simulator) {
    if (!recording_.samples.empty() && simulator.time() <= recording_.samples.back().time) Forget();
    const world::WorldState world = simulator.GetWorldState();
    if (recording_.samples.empty()) Begin(world);
    RolloutSample sample;
    sample.time = simulator.time();
    sample.X_MB = simulator.X_MB();
    sample.V_B = simulator.base().V_B;
    sample.A_B = simulator.base().A_B;
    sample.joints = simulator.GetRobotState().joints;
    for (const world::ObjectState& object : world.objects) sample.X_MO.push_back(object.X_MO);
    NoteEvents(simulator, sample);
    recording_.samples.push_back(std::move(sample));
  }

  void NoteEnd(const std::vector<std::string>& down) {
    if (!down.empty()) Say(recording_.samples.back().time, base::Join(down, ", ") + " down");
  }

 private:
  /// It begins again, with more of what stands about.
  void Forget() {
    recording_.samples.clear();
    recording_.events.clear();
  }

  void Begin(const world::WorldState& world) {
    recording_.objects = NamesOf(world);
    leans_.assign(world.objects.size(), false);
    lies_.assign(world.objects.size(), false);
    is_late_ = touches_ = false;
  }

  void NoteEvents(const simulation::RobotSimulator& simulator, const RolloutSample& sample) {
    const bool is_late = simulator.base().timed_out;
    if (is_late && !is_late_) Say(sample.time, "no command in time: the base brakes by itself");
    is_late_ = is_late;
    if (simulator.contact() && !touches_) {
      touches_ = true;
      Say(sample.time, fmt::format("{} touches {}", simulator.contact()->robot_part,
                                   simulator.contact()->obstacle));
    }
    for (std::size_t i = 0; i < sample.X_MO.size(); ++i) {
      const double tilt = geometry::TiltOf(sample.X_MO[i].rotation);
      NoteTilt(sample.time, i, tilt, params_.shaking_tilt, "leans by more than", &leans_);
      NoteTilt(sample.time, i, tilt, params_.topple_tilt, "topples: over", &lies_);
    }
  }

  void NoteTilt(double time, std::size_t object, double tilt, double threshold,
                const std::string& what, std::vector<bool>* noted) {
    if (tilt <= threshold || (*noted)[object]) return;
    (*noted)[object] = true;
    Say(time, fmt::format("{} {} {} rad", recording_.objects[object], what, threshold));
  }

  void Say(double time, const std::string& text) { recording_.events.push_back({time, text}); }

  const RolloutParams& params_;
  RolloutRecording& recording_;
  std::vector<bool> leans_, lies_;
  bool is_late_{false}, touches_{false};
};

std::string Header(const RolloutRecording& recording) {
  std::string header =
      "time,x,y,z,roll,pitch,yaw,vx,vy,wz,speed,acceleration,angular_acceleration,jerk";
  for (const std::string& name : recording.objects) {
    for (const char* column : {"x", "y", "z", "tilt"})
      header += fmt::format(",{}.{}", name, column);
  }
  return header + ",event\n";
}

std::string EventsAt(const RolloutRecording& recording, double time) {
  std::vector<std::string> texts;
  for (const RolloutEvent& event : recording.events) {
    if (event.time == time) texts.push_back(event.text);
  }
  return base::Join(texts, "; ");
}

}  // namespace

RolloutChoice ParseRolloutChoice(const std::string& text) {
  const std::size_t at = text.find('@');
  const std::string which = text.substr(0, at);
  RolloutChoice choice;
  if (at != std::string::npos) choice.rank = ParseNumber(text.substr(at + 1), text);
  if (choice.rank < 1) {
    throw base::ConfigError(fmt::format("rollout '{}': ranks count from 1", text));
  }
  if (which == "worst") {
    choice.kind = RolloutChoice::Kind::kWorst;
  } else if (which == "median") {
    choice.kind = RolloutChoice::Kind::kMedian;
  } else if (which == "first_fall") {
    choice.kind = RolloutChoice::Kind::kFirstFailed;
  } else {
    choice.kind = RolloutChoice::Kind::kIndex;
    choice.index = ParseNumber(which, text);
  }
  return choice;
}

int IndexOf(const RolloutChoice& choice, const Evidence& evidence) {
  int index = choice.index;
  if (choice.kind == RolloutChoice::Kind::kWorst) index = evidence.worst_rollout;
  if (choice.kind == RolloutChoice::Kind::kMedian) index = evidence.median_rollout;
  if (choice.kind == RolloutChoice::Kind::kFirstFailed) index = evidence.first_failed;
  if (index >= 0 && index < evidence.num_rollouts) return index;
  throw base::ConfigError(
      choice.kind == RolloutChoice::Kind::kIndex
          ? fmt::format("there is no rollout {}: {} were played, counted from 0", index,
                        evidence.num_rollouts)
          : fmt::format("of {} rollouts there is none such ({}); choose another",
                        evidence.num_rollouts,
                        choice.kind == RolloutChoice::Kind::kFirstFailed ? "all succeeded"
                                                                         : "none finished"));
}

std::optional<RolloutRecording> RecordRollout(const RolloutSetup& setup,
                                              const base::ActionCall& action, int index,
                                              const std::function<bool()>& cancelled,
                                              RolloutWatcher* watcher) {
  RolloutRecording recording;
  recording.action = action;
  recording.index = index;
  recording.seed = setup.seed;
  Recorder recorder(setup.params, &recording);
  RolloutHooks hooks;
  hooks.cancelled = cancelled;
  hooks.on_sample = [&](const simulation::RobotSimulator& simulator, double) {
    recorder.Note(simulator);
    if (watcher != nullptr) watcher->OnSample(simulator);
  };
  hooks.on_end = [&](const std::vector<std::string>& down) { recorder.NoteEnd(down); };
  const std::optional<RolloutResult> result = PlayRollout(setup, action, index, hooks);
  if (!result) return std::nullopt;
  recording.result = *result;
  if (!recording.samples.empty()) {
    const base::Failure failure = FailureOf(*result);
    recording.events.push_back({recording.samples.back().time,
                                failure ? "ends: " + ToString(failure) : "ends: succeeded"});
  }
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
    csv += fmt::format("{:.3f},{},{},{},{},{},{},{},{},{},{},{},{},{}", s.time, p.x(), p.y(), p.z(),
                       roll, pitch, geometry::YawOf(s.X_MB.rotation), s.V_B.vx, s.V_B.vy, s.V_B.wz,
                       std::hypot(s.V_B.vx, s.V_B.vy), std::hypot(s.A_B.vx, s.A_B.vy), s.A_B.wz,
                       JerkAt(recording.samples, i));
    for (const geometry::Pose3& X_MO : s.X_MO) {
      const Eigen::Vector3d& o = X_MO.translation;
      csv += fmt::format(",{},{},{},{}", o.x(), o.y(), o.z(), geometry::TiltOf(X_MO.rotation));
    }
    const std::string events = EventsAt(recording, s.time);
    csv += events.empty() ? ",\n" : fmt::format(",\"{}\"\n", events);
  }
  return csv;
}

}  // namespace hires::imagination
