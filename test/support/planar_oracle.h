#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace hires::test_support {

/// A rigid body in a vertical plane, on two contact points; independent of everything in src.
/// x forward, z up; tilt is positive when the top moves forward.
struct PlanarBody {
  double b{0.0};         ///< [m] half the distance between the two contact points
  double c{0.0};         ///< [m] height of the center of mass
  double gyration{0.0};  ///< I / m [m^2] about the center of mass
};

/// The plate below the body.
struct PlatePose {
  double x{0.0}, z{0.0};  ///< [m]
  double pitch{0.0};      ///< [rad] positive: front down
};

/// A motion of the plate from time 0 on.
struct PlateMotion {
  std::function<PlatePose(double time)> pose;
  double start_speed{0.0};  ///< [m/s] of plate and body before time 0
  double end{0.0};          ///< [s] from then on the plate moves steadily
};

enum class PlanarVerdict { kStays, kSlides, kTips };

struct PlanarResult {
  PlanarVerdict verdict{PlanarVerdict::kStays};
  double slide{0.0};  ///< [m] largest distance of the base's center from its start on the plate
  double last_slide{0.0};  ///< [m] at the end, positive forward
  double max_tilt{0.0};    ///< [rad] against the plate
  double violation{0.0};   ///< largest violation of a complementarity condition in any step
};

/// Coulomb friction by enumeration of contact modes: each contact point is open, sticks or slides
/// forward or backward. The impulses of each step satisfy all conditions of Signorini and Coulomb
/// exactly (velocity level [Moreau 1988, Unilateral contact and dry friction]; the mode of the
/// previous step is tried first, then all). Impacts are inelastic and located within the step.
class PlanarOracle {
 public:
  PlanarOracle(const PlanarBody& body, double friction, const PlateMotion& motion, double time_step)
      : body_(body), friction_(friction), motion_(motion), time_step_(time_step) {
    plate_ = motion.pose(0.0);
    const auto [tangent, normal] = Axes(plate_);
    state_.q << plate_.x + body.c * normal.x(), plate_.z + body.c * normal.y(), plate_.pitch;
    state_.u << motion.start_speed, 0.0, 0.0;
  }

  /// Until it has tipped, has slid too far or rests.
  /// @param most_slide  [m] beyond which it counts as slid
  PlanarResult Run(double most_slide) {
    const double balance = std::atan2(body_.b, body_.c);
    double quiet = 0.0;
    for (long i = 1; time_ < motion_.end + kLongest && quiet < kQuiet; ++i) {
      Step(i * time_step_);
      const double tilt = std::abs(state_.q.z() - plate_.pitch);
      result_.max_tilt = std::max(result_.max_tilt, tilt);
      result_.last_slide = Slide();
      result_.slide = std::max(result_.slide, std::abs(result_.last_slide));
      if (tilt > balance + kBeyondBalance) result_.verdict = PlanarVerdict::kTips;
      if (result_.slide > most_slide) result_.verdict = PlanarVerdict::kSlides;
      if (result_.verdict != PlanarVerdict::kStays) return result_;
      const bool moves = tilt > 1e-4 || std::abs(SlideSpeed()) > 1e-5 || time_ < motion_.end;
      quiet = moves ? 0.0 : quiet + time_step_;
    }
    return result_;
  }

  void Step(double until) {
    for (int i = 0; time_ < until; ++i) {
      const PlatePose next = motion_.pose(until);
      double step = until - time_;
      State trial = Advance(step, next);
      // A new touch within the step: go exactly to it.
      if (i < kMostTouches && Penetration(trial, next) > kTouching) {
        double before = 0.0, after = step;
        while (after - before > 1e-9 * time_step_) {
          const double middle = 0.5 * (before + after);
          const PlatePose at = motion_.pose(time_ + middle);
          (Penetration(Advance(middle, at), at) > 0.0 ? after : before) = middle;
        }
        step = after;
      }
      const PlatePose to = step < until - time_ ? motion_.pose(time_ + step) : next;
      state_ = Advance(step, to);
      time_ = step < until - time_ ? time_ + step : until;
      plate_ = to;
      Project();
      mode_ = state_.mode;
      result_.violation = std::max(result_.violation, state_.violation);
    }
  }

  double time() const { return time_; }
  double tilt() const { return state_.q.z() - plate_.pitch; }
  double Slide() const {  ///< [m] of the base's center along the plate
    const auto [tangent, normal] = Axes(plate_);
    const double angle = state_.q.z();
    const Vector2 center(state_.q.x() - body_.c * std::sin(angle) - plate_.x,
                         state_.q.y() - body_.c * std::cos(angle) - plate_.z);
    return tangent.dot(center);
  }

 private:
  using Vector2 = Eigen::Vector2d;
  using Vector3 = Eigen::Vector3d;
  enum Friction { kStick, kForward, kBackward };
  struct Mode {
    std::array<bool, 2> closed{false, false};  // front, rear
    Friction friction{kStick};
  };
  struct State {
    Vector3 q, u;  // x, z, tilt of the center of mass
    Mode mode;
    double violation{0.0};
  };
  struct Contact {
    Vector3 normal, tangent;             // generalised directions
    double plate_normal, plate_tangent;  // [m/s] the plate's own velocity there
    bool active;
  };

  static constexpr double kGravity = 9.81;
  static constexpr double kTouching = 1e-9;       // [m]
  static constexpr double kLongest = 8.0;         // [s] after the plate moves steadily
  static constexpr double kQuiet = 0.05;          // [s]
  static constexpr double kBeyondBalance = 0.25;  // [rad] from there nothing returns
  static constexpr int kMostTouches = 8;          // in one step

  static std::pair<Vector2, Vector2> Axes(const PlatePose& plate) {
    const double c = std::cos(plate.pitch), s = std::sin(plate.pitch);
    return {Vector2(c, -s), Vector2(s, c)};
  }
  Vector2 ArmOf(int point, double angle) const {
    const double c = std::cos(angle), s = std::sin(angle), b = point == 0 ? body_.b : -body_.b;
    return {b * c - body_.c * s, -b * s - body_.c * c};
  }
  double GapOf(int point, const Vector3& q, const PlatePose& plate) const {
    const Vector2 arm = ArmOf(point, q.z());
    return Axes(plate).second.dot(Vector2(q.x() + arm.x() - plate.x, q.y() + arm.y() - plate.z));
  }
  /// Of points that were apart before the step.
  double Penetration(const State& trial, const PlatePose& plate) const {
    double deepest = 0.0;
    for (int i = 0; i < 2; ++i) {
      if (GapOf(i, state_.q, plate_) <= kTouching) continue;
      deepest = std::max(deepest, -GapOf(i, trial.q, plate));
    }
    return deepest;
  }
  double SlideSpeed() const {
    const PlatePose before = motion_.pose(time_ - time_step_);
    return state_.u.x() - (plate_.x - before.x) / time_step_;
  }

  std::array<Contact, 2> Contacts(double step, const PlatePose& next) const {
    const auto [tangent, normal] = Axes(plate_);
    const Vector2 velocity((next.x - plate_.x) / step, (next.z - plate_.z) / step);
    const double turning = (next.pitch - plate_.pitch) / step;
    std::array<Contact, 2> contacts;
    for (int i = 0; i < 2; ++i) {
      const Vector2 arm = ArmOf(i, state_.q.z());
      const auto row = [&](const Vector2& axis) {
        return Vector3(axis.x(), axis.y(), axis.x() * arm.y() - axis.y() * arm.x());
      };
      const Vector2 from(state_.q.x() + arm.x() - plate_.x, state_.q.y() + arm.y() - plate_.z);
      const Vector2 moving = velocity + turning * Vector2(from.y(), -from.x());
      contacts[i] = {row(normal), row(tangent), normal.dot(moving), tangent.dot(moving),
                     GapOf(i, state_.q, plate_) <= kTouching};
    }
    return contacts;
  }

  /// @return the largest violation of the mode's conditions; the new velocity in `u`.
  double Try(const Mode& mode, const std::array<Contact, 2>& contacts, const Vector3& free,
             Vector3* u) const {
    std::vector<int> closed;
    for (int i = 0; i < 2; ++i) {
      if (mode.closed[i]) closed.push_back(i);
    }
    const Vector3 inverse_mass(1.0, 1.0, 1.0 / body_.gyration);
    *u = free;
    const int num_closed = static_cast<int>(closed.size());
    double violation = 0.0;
    if (num_closed > 0) {
      // Two closed points lie on the plate's line: they have one tangential velocity.
      const bool sticks = mode.friction == kStick;
      const int n = num_closed + (sticks ? 1 : 0);
      Vector3 tangent = Vector3::Zero();
      double plate_tangent = 0.0;
      for (const int i : closed) {
        tangent += contacts[i].tangent / num_closed;
        plate_tangent += contacts[i].plate_tangent / num_closed;
      }
      const double sign = mode.friction == kForward ? 1.0 : -1.0;
      Eigen::Matrix3d rows = Eigen::Matrix3d::Zero(), forces = rows;
      Vector3 wanted = Vector3::Zero();
      for (int k = 0; k < num_closed; ++k) {
        const Contact& contact = contacts[closed[k]];
        rows.row(k) = contact.normal;
        forces.row(k) = contact.normal;
        if (!sticks) forces.row(k) -= sign * friction_ * tangent.transpose();
        wanted(k) = contact.plate_normal;
      }
      if (sticks) {
        rows.row(n - 1) = tangent;
        forces.row(n - 1) = tangent;
        wanted(n - 1) = plate_tangent;
      }
      Eigen::Matrix3d matrix = rows * inverse_mass.asDiagonal() * forces.transpose();
      for (int k = n; k < 3; ++k) matrix(k, k) = 1.0;  // conditions that there are not
      const Vector3 lacking = wanted - rows * free;
      const Vector3 impulses = matrix.partialPivLu().solve(lacking);
      if (!((matrix * impulses - lacking).norm() < 1e-9)) return HUGE_VAL;  // singular
      *u += inverse_mass.cwiseProduct(forces.transpose() * impulses);
      double normal_sum = 0.0;
      for (int k = 0; k < num_closed; ++k) {
        violation = std::max(violation, -impulses(k));
        normal_sum += impulses(k);
      }
      const double slip = tangent.dot(*u) - plate_tangent;
      violation = std::max(
          violation, sticks ? std::abs(impulses(n - 1)) - friction_ * normal_sum : -sign * slip);
    }
    for (int i = 0; i < 2; ++i) {
      if (!contacts[i].active || mode.closed[i]) continue;
      violation = std::max(violation, contacts[i].plate_normal - contacts[i].normal.dot(*u));
    }
    return violation;
  }

  State Advance(double step, const PlatePose& next) const {
    const std::array<Contact, 2> contacts = Contacts(step, next);
    const Vector3 free = state_.u + Vector3(0.0, -step * kGravity, 0.0);
    State best = state_;
    best.violation = HUGE_VAL;
    const auto consider = [&](const Mode& mode) {
      for (int i = 0; i < 2; ++i) {
        if (mode.closed[i] && !contacts[i].active) return false;
      }
      Vector3 u;
      const double violation = Try(mode, contacts, free, &u);
      if (violation < best.violation) {
        best.u = u;
        best.mode = mode;
        best.violation = violation;
      }
      return violation < kExact;
    };
    if (!consider(mode_)) {
      for (const Mode& mode : AllModes()) {
        if (consider(mode)) break;
      }
    }
    best.q = state_.q + step * best.u;
    return best;
  }

  static const std::vector<Mode>& AllModes() {
    static const std::vector<Mode> modes = [] {
      std::vector<Mode> all{{{false, false}, kStick}};
      for (const Friction friction : {kStick, kForward, kBackward}) {
        all.push_back({{true, true}, friction});
        all.push_back({{true, false}, friction});
        all.push_back({{false, true}, friction});
      }
      return all;
    }();
    return modes;
  }

  /// Takes out what a step's finite rotation moves closed points off the plate.
  void Project() {
    const double lowest = std::min(GapOf(0, state_.q, plate_), GapOf(1, state_.q, plate_));
    const bool holds = state_.mode.closed[0] || state_.mode.closed[1];
    if (!holds && lowest > 0.0) return;
    const Vector2 normal = Axes(plate_).second;
    state_.q.head<2>() -= lowest * normal;
  }

  static constexpr double kExact = 1e-12;
  const PlanarBody body_;
  const double friction_;
  const PlateMotion motion_;
  const double time_step_;
  double time_{0.0};
  PlatePose plate_;
  State state_;
  Mode mode_;
  PlanarResult result_;
};

/// The stop of a plate that moves at `speed` [m/s], within no time.
inline PlateMotion SuddenStop(double speed) {
  return {[speed](double time) {
            return PlatePose{std::min(time, 0.0) * speed, 0.0, 0.0};
          },
          speed, 0.0};
}

/// From `speed` to a stand with `deceleration` [m/s^2], which rises linearly within `rise` [s].
/// @pre rise is shorter than the stop.
inline PlateMotion RampedStop(double speed, double deceleration, double rise = 0.0) {
  // v = speed - a t^2 / (2 rise) up to `rise`, then speed - a (t - rise / 2).
  const double full = std::min(rise, std::sqrt(2.0 * speed * rise / deceleration));
  const double jerk = rise > 0.0 ? deceleration / rise : 0.0;
  const double v1 = speed - 0.5 * jerk * full * full;
  const double end = full + v1 / deceleration;
  const auto pose = [=](double time) {
    const double t1 = std::clamp(time, 0.0, full), t2 = std::clamp(time - full, 0.0, end - full);
    const double x =
        speed * t1 - jerk * t1 * t1 * t1 / 6.0 + v1 * t2 - 0.5 * deceleration * t2 * t2;
    return PlatePose{time < 0.0 ? speed * time : x, 0.0, 0.0};
  };
  return {pose, speed, end};
}

/// From rest with `acceleration` [m/s^2] for `duration` [s], then on at a steady speed.
inline PlateMotion Pulse(double acceleration, double duration) {
  const auto pose = [=](double time) {
    const double t = std::clamp(time, 0.0, duration);
    return PlatePose{
        0.5 * acceleration * t * t + acceleration * duration * std::max(0.0, time - duration), 0.0,
        0.0};
  };
  return {pose, 0.0, duration};
}

/// The smallest value in lower..upper at which the body does not stay, by halving.
/// @param motion  of the plate for a value; the body is taken to stay below its limit.
inline double PlanarLimit(const PlanarBody& body, double friction, double most_slide,
                          const std::function<PlateMotion(double)>& motion, double lower,
                          double upper, double time_step, PlanarResult* beyond = nullptr) {
  for (int i = 0; i < 14; ++i) {
    const double middle = 0.5 * (lower + upper);
    const PlanarResult result =
        PlanarOracle(body, friction, motion(middle), time_step).Run(most_slide);
    if (result.verdict == PlanarVerdict::kStays) {
      lower = middle;
    } else {
      upper = middle;
      if (beyond != nullptr) *beyond = result;
    }
  }
  return upper;
}

}  // namespace hires::test_support
