#include "reports/episode/episode_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "hires/base/text.h"
#include "hires/translation/classification.h"

namespace hires::reports {
namespace {

using imagination::ImaginationSetup;

constexpr char kUnnamedArm[] = "armunnamedposture";  // of AtomsOf, where no posture fits
constexpr char kUnnamedTorso[] = "torsoposture";

/// Samples from the last one at rest to the first one at rest again.
struct Run {
  std::size_t first{0}, last{0};
};

/// Stretches in which something moves; rests of at most `pause` [s] are part of them. One that goes
/// on at the end of the episode is left out, as nobody knows how it ended, and so is what came
/// before a hole in the recording.
/// @param moves  whether it does between samples i - 1 and i.
std::vector<Run> RunsOf(const std::vector<EpisodeSample>& samples, double pause,
                        const std::function<bool(std::size_t)>& moves) {
  std::vector<Run> runs;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (!moves(i)) continue;
    const bool goes_on =
        !runs.empty() && samples[i - 1].time - samples[runs.back().last].time <= pause;
    if (!goes_on) runs.push_back({i - 1, i});
    runs.back().last = i;
  }
  const bool is_cut = !runs.empty() && runs.back().last + 1 >= samples.size();
  if (is_cut) runs.pop_back();
  return runs;
}

/// The motions of one episode.
class Motions {
 public:
  Motions(const Episode& episode, const ImaginationSetup& setup, const MotionParams& params)
      : episode_(episode), samples_(episode.samples), setup_(setup), params_(params) {}

  std::vector<EpisodeStep> All() {
    AddDrives();
    if (setup_.scene->robot.profile.upper_body) {
      AddTorso();
      AddArms();
    }
    std::stable_sort(steps_.begin(), steps_.end(),
                     [](const EpisodeStep& a, const EpisodeStep& b) { return a.begin < b.begin; });
    return std::move(steps_);
  }

 private:
  void AddDrives();
  void AddDrive(const Run& run);
  void AddTorso();
  void AddArms();
  std::string ActionOfArms(const Run& run, const std::vector<std::string>& moved,
                           base::ActionCall* action) const;

  EpisodeStep StepOf(const Run& run) const {
    EpisodeStep step;
    step.begin = samples_[run.first].time;
    step.duration = samples_[run.last].time - step.begin;
    step.fate = ActionFate::kSucceeded;  // it is taken for what it ended as
    return step;
  }
  std::string MotionSetFor(double peak) const;
  /// What holds at a sample, by predicate and, for arms, by arm.
  std::string Symbol(std::size_t sample, const std::string& predicate,
                     const std::string& arm = "") const;
  std::vector<std::size_t> IndicesOf(const std::vector<std::string>& joints) const;
  double Reach(const Run& run, const std::vector<std::size_t>& joints) const;
  std::function<bool(std::size_t)> Moving(std::vector<std::size_t> joints, double still) const;

  const Episode& episode_;
  const std::vector<EpisodeSample>& samples_;
  const ImaginationSetup& setup_;
  const MotionParams& params_;
  std::vector<EpisodeStep> steps_;
};

std::string Motions::Symbol(std::size_t sample, const std::string& predicate,
                            const std::string& arm) const {
  const imagination::StartState state = StartOf(episode_, samples_[sample]);
  for (const base::Atom& atom :
       translation::AtomsOf(setup_.translator, {state.world, state.robot})) {
    if (base::ToLower(atom.predicate) != predicate) continue;
    if (arm.empty() || base::ToLower(atom.arguments.front()) == arm) {
      return base::ToLower(atom.arguments.back());
    }
  }
  return "";
}

std::string Motions::MotionSetFor(double peak) const {
  const auto& sets = setup_.skills->motion_sets;
  std::string best = setup_.skills->default_motion_set;
  double limit = std::numeric_limits<double>::infinity();
  for (const auto& [name, set] : sets) {
    const bool allows = peak <= (1.0 + params_.speed_slack) * set.max_linear_velocity;
    if (!allows || set.max_linear_velocity >= limit) continue;
    best = name;
    limit = set.max_linear_velocity;
  }
  return best;
}

void Motions::AddDrives() {
  const auto moves = [this](std::size_t i) {
    const geometry::Twist2& V_B = samples_[i].V_B;
    return std::hypot(V_B.vx, V_B.vy) > params_.still_speed ||
           std::abs(V_B.wz) > params_.still_turning;
  };
  for (const Run& run : RunsOf(samples_, params_.pause, moves)) AddDrive(run);
}

void Motions::AddDrive(const Run& run) {
  double way = 0.0, turned = 0.0, peak = 0.0;
  for (std::size_t i = run.first + 1; i <= run.last; ++i) {
    const geometry::Twist2& V_B = samples_[i].V_B;
    const double dt = samples_[i].time - samples_[i - 1].time, speed = std::hypot(V_B.vx, V_B.vy);
    way += speed * dt;
    turned += std::abs(V_B.wz) * dt;
    peak = std::max(peak, speed);
  }
  if (way < params_.least_drive && turned < params_.least_turn) return;
  const geometry::Pose2 &from = samples_[run.first].X_WB, &to = samples_[run.last].X_WB;
  const double beeline = (to.position() - from.position()).norm();
  EpisodeStep step = StepOf(run);
  step.motion =
      fmt::format("drove {:.2f} m, turned {:.2f} rad, at most {:.2f} m/s", way, turned, peak);
  const translation::Area* area = setup_.translator.areas.Find(Symbol(run.last, "robotat"));
  const bool is_at_area = area != nullptr && area->kind == translation::AreaKind::kStanding;
  if (!is_at_area) step.goal = to;
  const std::string goal =
      is_at_area ? area->name : fmt::format("recorded_end_of_drive_{}", steps_.size() + 1);
  const bool is_blind = way <= params_.blind_distance && beeline >= params_.straightness * way;
  step.action = is_blind ? base::ActionCall{"move_base_blind", {goal}}
                         : base::ActionCall{"move_base_param", {goal, MotionSetFor(peak)}};
  steps_.push_back(std::move(step));
}

std::vector<std::size_t> Motions::IndicesOf(const std::vector<std::string>& joints) const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < episode_.joint_names.size(); ++i) {
    if (std::count(joints.begin(), joints.end(), episode_.joint_names[i]) > 0) indices.push_back(i);
  }
  return indices;
}

double Motions::Reach(const Run& run, const std::vector<std::size_t>& joints) const {
  double reach = 0.0;
  for (const std::size_t joint : joints) {
    double low = samples_[run.first].joints[joint], high = low;
    for (std::size_t i = run.first; i <= run.last; ++i) {
      low = std::min(low, samples_[i].joints[joint]);
      high = std::max(high, samples_[i].joints[joint]);
    }
    reach = std::max(reach, high - low);
  }
  return reach;
}

std::function<bool(std::size_t)> Motions::Moving(std::vector<std::size_t> joints,
                                                 double still) const {
  return [this, joints = std::move(joints), still](std::size_t i) {
    const double dt = samples_[i].time - samples_[i - 1].time;
    return std::any_of(joints.begin(), joints.end(), [&](std::size_t joint) {
      return std::abs(samples_[i].joints[joint] - samples_[i - 1].joints[joint]) > still * dt;
    });
  };
}

void Motions::AddTorso() {
  const auto joint = IndicesOf({setup_.scene->robot.profile.upper_body->torso_joint});
  for (const Run& run : RunsOf(samples_, params_.pause, Moving(joint, params_.still_torso))) {
    const double lift = Reach(run, joint);
    if (lift < params_.least_lift) continue;
    EpisodeStep step = StepOf(run);
    step.motion = fmt::format("moved the torso by {:.2f} m", lift);
    const std::string posture = Symbol(run.last, "hastorsoposture");
    if (posture.empty() || posture == kUnnamedTorso) {
      step.why_not = "the torso ended in no posture that the robot's profile names";
    } else {
      step.action = {"move_torso", {posture}};
    }
    steps_.push_back(std::move(step));
  }
}

/// @return why it is no action.
std::string Motions::ActionOfArms(const Run& run, const std::vector<std::string>& moved,
                                  base::ActionCall* action) const {
  const auto posture = [&](const std::string& arm) {
    return Symbol(run.last, "hasarmposture", arm);
  };
  for (const std::string& arm : moved) {
    if (!posture(arm).empty() && posture(arm) != kUnnamedArm) continue;
    return fmt::format("{} ended in no posture that the robot's profile names", arm);
  }
  const bool is_side = moved.size() == 1 && posture(moved.front()) == "armtosideposture";
  const std::string left = posture("leftarm1"), right = posture("rightarm1");
  if (is_side) {
    *action = {"move_arm_to_side", moved};
  } else if (left == "armcarryposture" && right == "armcarryposture") {
    *action = {"move_arms_to_carryposture", {}};
  } else if (left == kUnnamedArm || right == kUnnamedArm || left.empty() || right.empty()) {
    return "the other arm is in no posture that the robot's profile names";
  } else {
    *action = {"tuck_arms", {left, right}};
  }
  return "";
}

void Motions::AddArms() {
  const auto& arms = setup_.scene->robot.profile.upper_body->arms;
  std::vector<std::string> joints;
  for (const auto& [name, arm] : arms) {
    joints.insert(joints.end(), arm.joints.begin(), arm.joints.end());
  }
  const auto all = IndicesOf(joints);
  for (const Run& run : RunsOf(samples_, params_.pause, Moving(all, params_.still_joint))) {
    std::vector<std::string> moved;
    for (const auto& [name, arm] : arms) {
      if (Reach(run, IndicesOf(arm.joints)) >= params_.least_reach) moved.push_back(name);
    }
    if (moved.empty()) continue;
    EpisodeStep step = StepOf(run);
    step.motion =
        fmt::format("moved {} by at most {:.2f} rad", base::Join(moved, " and "), Reach(run, all));
    step.why_not = ActionOfArms(run, moved, &step.action);
    steps_.push_back(std::move(step));
  }
}

}  // namespace

std::vector<EpisodeStep> MotionsOf(const Episode& episode, const ImaginationSetup& setup,
                                   const MotionParams& params) {
  return Motions(episode, setup, params).All();
}

imagination::StartState StartOf(const Episode& episode, const EpisodeSample& sample) {
  imagination::StartState start;
  start.robot.X_MB = sample.X_WB;
  for (std::size_t i = 0; i < episode.joint_names.size(); ++i) {
    start.robot.joints[episode.joint_names[i]] = sample.joints[i];
  }
  for (const robot::SeenObject& object : sample.objects) {
    start.world.objects.push_back({object.name, object.model, object.X_MO, {}, object.attached_to});
  }
  return start;
}

}  // namespace hires::reports
