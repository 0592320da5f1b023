// Private to contact_solver.cpp: the contacts of one island, and both methods to solve them.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "physics/contact_solver.h"

namespace hires::physics::island {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline Matrix3d CrossMatrix(const Vector3d& r) {
  Matrix3d m;
  m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return m;
}

enum class State : char { kOpen, kSticks, kSlides };

/// A contact while it is solved.
struct Point {
  SolverContact* contact;
  std::array<int, 2> bodies{-1, -1};  // of the island: `body` and `other`; -1: not moved
  std::array<Vector3d, 2> arms;       // from C
  Vector3d u0;                        // [m/s] relative to `wanted`, without contacts
  Vector3d u;                         // the same with them
  State state{State::kOpen};
  Vector3d direction;  // kSlides: unit, of slip
  double drag;         // kSlides: [kg] impulse across the direction by slip across it
  Vector3d impulse{Vector3d::Zero()};  // [N s]
  double bound{0.0};                   // [N s] of friction
  Matrix3d W;                          // [1/kg] velocity at the point per impulse there
};

/// Bodies that push one another, directly or through others, and their contacts.
/// @tparam kSize  six times the number of bodies, or Eigen::Dynamic
template <int kSize>
class Island {
 public:
  Island(const std::vector<int>& which, double softness, std::vector<SolverContact>* contacts,
         std::vector<SolverBody>* bodies)
      : softness_(softness) {
    points_.reserve(which.size());
    for (const int i : which) AddPoint(&(*contacts)[i], bodies);
  }

  void Solve(ContactMethod method, SolverEffort* effort) {
    for (const Point& point : points_) largest_ = std::max(largest_, ClosingImpulse(point));
    if (largest_ <= 0.0) return;
    if (method == ContactMethod::kGaussSeidel || !SolveByNewton(effort)) {
      PrepareSweeps();
      Sweep(kMostSweeps, effort);
    }
    for (Point& point : points_) {
      point.contact->impulse = point.impulse;
      for (const int side : {0, 1}) {
        if (point.bodies[side] < 0) continue;
        SolverBody& body = *bodies_[point.bodies[side]];
        const Vector3d impulse = Sign(side) * point.impulse;
        body.impulse += impulse;
        body.torque_impulse += point.arms[side].cross(impulse);
      }
    }
  }

 private:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  static constexpr int kFirstSweeps = 6, kMostSweeps = 400;
  static constexpr int kMostRounds = 8;  // of Newton's method from one guess
  /// Guesses by fixed bounds of friction, Newton rounds for each, and the guess without bounds:
  /// where several solutions exist, the one that sticks.
  static constexpr int kMostBounds = 8, kMostBoundRounds = 12, kUnbounded = 2;
  /// Fractions of the largest impulse that count as rounding.
  static constexpr double kRounding = 1e-9, kSweepRounding = 1e-8;
  /// Sine of the angle by which a direction of sliding may be off.
  static constexpr double kSameDirection = 1e-7;

  static double Sign(int side) { return side == 0 ? 1.0 : -1.0; }

  void AddPoint(SolverContact* contact, std::vector<SolverBody>* bodies) {
    Point point;
    point.contact = contact;
    point.u0 = -contact->wanted;
    const std::array<int, 2> indices{contact->body, contact->other};
    for (const int side : {0, 1}) {
      if (indices[side] < 0) continue;
      SolverBody& body = (*bodies)[indices[side]];
      point.arms[side] = contact->position - body.p_WC;
      point.u0 += Sign(side) * (body.v + body.w.cross(point.arms[side]));
      if (body.mass > 0.0) point.bodies[side] = IndexOf(&body);
    }
    points_.push_back(point);
  }

  int IndexOf(SolverBody* body) {
    const auto at = std::find(bodies_.begin(), bodies_.end(), body);
    if (at != bodies_.end()) return static_cast<int>(at - bodies_.begin());
    bodies_.push_back(body);
    return static_cast<int>(bodies_.size()) - 1;
  }

  /// [N s] An upper bound of the impulse of the contact alone.
  double ClosingImpulse(const Point& point) const {
    if (point.contact->normal.dot(point.u0) >= 0.0) return 0.0;
    double mass = 0.0;
    for (const int body : point.bodies) {
      if (body >= 0) mass = std::max(mass, bodies_[body]->mass);
    }
    return mass * point.u0.norm();
  }

  /// How the impulse answers to the velocity: p = -K u.
  Matrix3d Stiffness(const Point& point) const {
    if (point.state == State::kSticks) return Matrix3d::Identity() / softness_;
    const Vector3d& n = point.contact->normal;
    const Vector3d across = n.cross(point.direction);
    return (n - point.contact->friction * point.direction) * (n / softness_).transpose() +
           point.drag * across * across.transpose();
  }

  /// False if no guess of the states leads to a solution.
  bool SolveByNewton(SolverEffort* effort) {
    for (Point& point : points_) GuessFromFreeMotion(&point);
    if (Iterate(effort)) return true;
    PrepareSweeps();
    Sweep(kFirstSweeps, effort);
    if (IterateFromImpulses(effort)) return true;
    for (int i = 0; i < kMostBounds; ++i) {
      for (Point& point : points_) {
        const double p_n = std::max(0.0, point.contact->normal.dot(point.impulse));
        point.bound = i == kUnbounded ? HUGE_VAL : point.contact->friction * p_n;
      }
      SolveForBounds(effort);
      if (IterateFromImpulses(effort)) return true;
    }
    return false;
  }

  /// Newton's method from the states that the impulses show; if it does not converge, the impulses
  /// are as before.
  bool IterateFromImpulses(SolverEffort* effort) {
    std::vector<Vector3d> before;
    before.reserve(points_.size());
    for (Point& point : points_) {
      before.push_back(point.impulse);
      GuessFromImpulse(&point);
    }
    if (Iterate(effort)) return true;
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i].impulse = before[i];
    return false;
  }

  bool Iterate(SolverEffort* effort) {
    for (int round = 0; round < kMostRounds; ++round) {
      ++effort->newton_rounds;
      FindVelocities();
      bool is_changed = false;
      for (Point& point : points_) is_changed = Update(&point) || is_changed;
      if (!is_changed) return true;
    }
    return false;
  }

  /// It sticks if the impulse that stops its approach gives friction enough to stop its slip.
  static void GuessFromFreeMotion(Point* point) {
    const Vector3d& n = point->contact->normal;
    const double u_n = n.dot(point->u0);
    const Vector3d u_t = point->u0 - u_n * n;
    const double slip = u_t.norm();
    point->state = u_n >= 0.0 ? State::kOpen : State::kSticks;
    if (u_n >= 0.0 || slip <= -u_n * point->contact->friction) return;
    point->state = State::kSlides;
    point->direction = u_t / slip;
    point->drag = 0.0;
  }

  void GuessFromImpulse(Point* point) const {
    const Vector3d& n = point->contact->normal;
    const double p_n = n.dot(point->impulse);
    const Vector3d p_t = point->impulse - p_n * n;
    const double length = p_t.norm(), most = point->contact->friction * p_n;
    point->state = p_n <= 0.0 ? State::kOpen : State::kSticks;
    if (most <= 0.0 || length < (1.0 - kRounding) * point->bound) return;
    const Vector3d u_t = point->u - n.dot(point->u) * n;
    point->state = State::kSlides;
    point->direction = length > 0.0 ? Vector3d(-p_t / length) : u_t.normalized();
    point->drag = most / std::max(u_t.norm(), softness_ * most);
  }

  /// Velocities and impulses if no contact changes its state.
  void FindVelocities() {
    const Matrix M = Masses();
    Matrix A = M;
    Vector b = Vector::Zero(A.rows());
    for (const Point& point : points_) {
      if (point.state != State::kOpen) AddStiffness(point, Stiffness(point), &A);
    }
    const Eigen::PartialPivLU<Matrix> factors(A);
    for (Point& point : points_) {
      point.u = point.u0;
      AddImpulse(&point, &b);
    }
    Vector change = factors.solve(b);
    b = -M * change;  // a second time, for rounding
    for (Point& point : points_) {
      point.u = point.u0 + VelocityAt(point, change);
      AddImpulse(&point, &b);
    }
    change += factors.solve(b);
    for (Point& point : points_) {
      point.u = point.u0 + VelocityAt(point, change);
      AddImpulse(&point, &b);
    }
  }

  Matrix Masses() const {
    const int size = 6 * static_cast<int>(bodies_.size());
    Matrix M = Matrix::Zero(size, size);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      M.template block<3, 3>(6 * k, 6 * k).diagonal().setConstant(bodies_[k]->mass);
      M.template block<3, 3>(6 * k + 3, 6 * k + 3) = bodies_[k]->inertia;
    }
    return M;
  }

  void AddStiffness(const Point& point, const Matrix3d& K, Matrix* A) const {
    for (const int row : {0, 1}) {
      if (point.bodies[row] < 0) continue;
      const Matrix3d R = CrossMatrix(point.arms[row]);
      const Matrix3d RK = R * K;
      for (const int column : {0, 1}) {
        if (point.bodies[column] < 0) continue;
        const Matrix3d C = CrossMatrix(point.arms[column]);
        const double sign = Sign(row) * Sign(column);
        auto block = A->template block<6, 6>(6 * point.bodies[row], 6 * point.bodies[column]);
        block.template topLeftCorner<3, 3>() += sign * K;
        block.template topRightCorner<3, 3>() -= sign * K * C;
        block.template bottomLeftCorner<3, 3>() += sign * RK;
        block.template bottomRightCorner<3, 3>() -= sign * RK * C;
      }
    }
  }

  void AddImpulse(Point* point, Vector* sum) const {
    point->impulse.setZero();
    if (point->state == State::kOpen) return;
    point->impulse = -Stiffness(*point) * point->u;
    AddTo(*point, point->impulse, sum);
  }

  void AddTo(const Point& point, const Vector3d& impulse, Vector* sum) const {
    for (const int side : {0, 1}) {
      if (point.bodies[side] < 0) continue;
      sum->template segment<3>(6 * point.bodies[side]) += Sign(side) * impulse;
      sum->template segment<3>(6 * point.bodies[side] + 3) +=
          Sign(side) * point.arms[side].cross(impulse);
    }
  }

  Vector3d VelocityAt(const Point& point, const Vector& velocities) const {
    Vector3d u = Vector3d::Zero();
    for (const int side : {0, 1}) {
      if (point.bodies[side] < 0) continue;
      const int at = 6 * point.bodies[side];
      u += Sign(side) * (velocities.template segment<3>(at) +
                         velocities.template segment<3>(at + 3).cross(point.arms[side]));
    }
    return u;
  }

  /// Corrects the contact's state. True if that may change the solution.
  bool Update(Point* point) const {
    const Vector3d& n = point->contact->normal;
    const double u_n = n.dot(point->u), p_n = -u_n / softness_;
    const double tiny = kRounding * largest_;
    if (point->state == State::kOpen) {
      if (p_n <= tiny) return false;
      point->state = State::kSticks;
      return true;
    }
    if (p_n < -tiny) {
      point->state = State::kOpen;
      return true;
    }
    const Vector3d u_t = point->u - u_n * n;
    const double slip = u_t.norm(), most = point->contact->friction * std::max(0.0, p_n);
    if (point->state == State::kSticks) {
      if (slip / softness_ <= most + tiny) return false;
      point->state = State::kSlides;
    } else if (u_t.dot(point->direction) <= softness_ * (most - tiny)) {
      point->state = State::kSticks;
      return true;
    } else if (u_t.cross(point->direction).norm() * std::max(point->drag, most / slip) <=
               kSameDirection * most + tiny) {
      return false;
    }
    point->direction = u_t / slip;
    point->drag = std::min(most / slip, 1.0 / softness_);
    return true;
  }

  /// Velocities and impulses with fixed bounds of friction: a convex problem, on which Newton's
  /// method with line search converges from anywhere.
  void SolveForBounds(SolverEffort* effort) {
    const int size = 6 * static_cast<int>(bodies_.size());
    Vector change = Vector::Zero(size);
    for (int round = 0; round < kMostBoundRounds; ++round) {
      ++effort->bound_rounds;
      Matrix H = Masses();
      Vector lack = -H * change;
      AddBoundImpulses(change, &lack, &H);
      const Vector step = H.partialPivLu().solve(lack);
      const double slope = step.dot(lack);
      const double share = ShareOfStep(change, step, slope);
      change += share * step;
      if (slope <= kRounding * kRounding * largest_ * largest_ / bodies_[0]->mass) break;
    }
    Vector unused = Vector::Zero(size);
    AddBoundImpulses(change, &unused, nullptr);
  }

  /// The fraction of the step at which the energy is least.
  /// @param slope  of the energy at the step's beginning, negated
  double ShareOfStep(const Vector& change, const Vector& step, double slope) {
    const Vector M_step = Masses() * step, M_change = Masses() * change;
    const auto slope_at = [&](double share) {
      Vector lack = -M_change - share * M_step;
      AddBoundImpulses(change + share * step, &lack, nullptr);
      return step.dot(lack);
    };
    double low = 0.0, high = 1.0;
    if (slope_at(1.0) >= -0.1 * slope) return 1.0;
    for (int i = 0; i < 30; ++i) {
      const double middle = 0.5 * (low + high), at = slope_at(middle);
      if (std::abs(at) <= 0.1 * slope) return middle;
      (at > 0.0 ? low : high) = middle;
    }
    return low > 0.0 ? low : high;
  }

  /// Sets the impulses of friction with fixed bounds at these velocities, and adds them to `sum`.
  /// @param H  if not nullptr, their derivatives are added to it
  void AddBoundImpulses(const Vector& change, Vector* sum, Matrix* H) {
    for (Point& point : points_) {
      const Vector3d& n = point.contact->normal;
      point.u = point.u0 + VelocityAt(point, change);
      const double u_n = n.dot(point.u), p_n = std::max(0.0, -u_n / softness_);
      const Vector3d u_t = point.u - u_n * n;
      const double slip = u_t.norm();
      const bool slides = slip > softness_ * point.bound;
      const double drag = slides ? point.bound / slip : 1.0 / softness_;
      point.impulse = p_n * n - drag * u_t;
      AddTo(point, point.impulse, sum);
      if (H == nullptr) continue;
      Matrix3d K = drag * (Matrix3d::Identity() - n * n.transpose());
      if (slides) K -= drag / (slip * slip) * u_t * u_t.transpose();
      if (p_n > 0.0) K += n * n.transpose() / softness_;
      AddStiffness(point, K, H);
    }
  }

  void PrepareSweeps() {
    added_ = Vector::Zero(6 * static_cast<int>(bodies_.size()));
    inverses_.clear();
    for (const SolverBody* body : bodies_) inverses_.push_back(body->inertia.inverse());
    for (Point& point : points_) {
      point.impulse.setZero();
      point.W = softness_ * Matrix3d::Identity();
      for (const int side : {0, 1}) {
        if (point.bodies[side] < 0) continue;
        const Matrix3d R = CrossMatrix(point.arms[side]);
        point.W.diagonal().array() += 1.0 / bodies_[point.bodies[side]]->mass;
        point.W -= R * inverses_[point.bodies[side]] * R;
      }
    }
  }

  /// Continues from the last sweep, until one changes next to nothing.
  void Sweep(int most, SolverEffort* effort) {
    for (int sweep = 0; sweep < most; ++sweep) {
      ++effort->sweeps;
      double most_changed = 0.0;
      for (Point& point : points_) {
        const Vector3d before = point.impulse;
        point.u = point.u0 + VelocityAt(point, added_) + softness_ * before;
        Relax(&point);
        const Vector3d change = point.impulse - before;
        most_changed = std::max(most_changed, change.norm());
        for (const int side : {0, 1}) {
          const int body = point.bodies[side];
          if (body < 0) continue;
          const Vector3d impulse = Sign(side) * change;
          added_.template segment<3>(6 * body) += impulse / bodies_[body]->mass;
          added_.template segment<3>(6 * body + 3) +=
              inverses_[body] * point.arms[side].cross(impulse);
        }
      }
      if (most_changed <= kSweepRounding * largest_) return;
    }
  }

  /// The impulse of one contact: first along the normal, then friction within its cone.
  static void Relax(Point* point) {
    const Vector3d& n = point->contact->normal;
    const Vector3d before = point->impulse;
    const Vector3d Wn = point->W * n;
    const double was = n.dot(before);
    const double p_n = std::max(0.0, was - n.dot(point->u) / n.dot(Wn));
    const Vector3d u = point->u + (p_n - was) * Wn;
    const double largest = point->W.trace() - n.dot(Wn);  // >= any of the tangential block
    Vector3d p_t = (before - was * n) - (u - n.dot(u) * n) / largest;
    point->bound = point->contact->friction * p_n;
    const double length = p_t.norm();
    if (length > point->bound) p_t *= point->bound / length;
    point->impulse = p_n * n + p_t;
  }

  double softness_;
  double largest_{0.0};  // [N s] the scale of the impulses
  std::vector<SolverBody*> bodies_;
  std::vector<Point> points_;
  std::vector<Matrix3d> inverses_;  // of inertias
  Vector added_;                    // velocities that the impulses of the sweeps cause
};

}  // namespace hires::physics::island
