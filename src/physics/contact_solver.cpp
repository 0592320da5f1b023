#include "physics/contact_solver.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "physics/boxed_lcp.h"

namespace hires::physics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kTooMuch = 1e-9;  // of a bound: more is no rounding

/// Bodies that push one another, directly or through others, by the first of them.
class Islands {
 public:
  Islands(const std::vector<SolverContact>& contacts, const std::vector<SolverBody>& bodies)
      : bodies_(bodies), parents_(bodies.size()) {
    std::iota(parents_.begin(), parents_.end(), 0);
    for (const SolverContact& contact : contacts) {
      if (!IsMovable(contact.body) || !IsMovable(contact.other)) continue;
      const int a = First(contact.body), b = First(contact.other);
      parents_[std::max(a, b)] = std::min(a, b);
    }
  }

  int Of(const SolverContact& contact) const {
    return First(IsMovable(contact.body) ? contact.body : contact.other);
  }

 private:
  bool IsMovable(int body) const { return body >= 0 && bodies_[body].mass > 0.0; }
  int First(int body) const {
    while (parents_[body] != body) body = parents_[body];
    return body;
  }

  const std::vector<SolverBody>& bodies_;
  std::vector<int> parents_;
};

/// The contacts of one island: velocities at them, and what impulses at them do.
class Island {
 public:
  explicit Island(std::vector<SolverBody>* bodies)
      : bodies_(*bodies), columns_(bodies->size(), -1) {}

  void Add(const SolverContact& contact) {
    contacts_.push_back(&contact);
    AddBody(contact.body);
    AddBody(contact.other);
  }

  bool Solve(double softness) {
    lcp_.softness = softness;
    FillMasses();
    FillRows();
    VectorXd pushes, impulses;
    std::vector<Place> places(num(), Place::kBetween);
    if (!physics::Solve(WithoutFriction(), &places, &pushes)) return false;
    lcp_.lower = VectorXd::Zero(3 * num());
    lcp_.upper = VectorXd::Constant(3 * num(), kUnbounded);
    for (int i = 0; i < num(); ++i) {
      const double most = contacts_[i]->friction * pushes[i];
      lcp_.upper[num() + i] = lcp_.upper[2 * num() + i] = most;
    }
    lcp_.lower.tail(2 * num()) = -lcp_.upper.tail(2 * num());
    places.resize(3 * num(), Place::kBetween);
    if (!physics::Solve(lcp_, &places, &impulses)) return false;
    if (TurnWhatSlides(places, impulses) && !physics::Solve(lcp_, &places, &impulses)) return false;
    const VectorXd all = lcp_.JT * impulses;
    for (std::size_t k = 0; k < used_.size(); ++k) {
      bodies_[used_[k]].impulse = all.segment<3>(6 * k);
      bodies_[used_[k]].turning = all.segment<3>(6 * k + 3);
    }
    return true;
  }

 private:
  int num() const { return static_cast<int>(contacts_.size()); }

  BoxedLcp WithoutFriction() const {
    BoxedLcp smooth = lcp_;
    smooth.JT.conservativeResize(Eigen::NoChange, num());
    smooth.b.conservativeResize(num());
    smooth.lower = VectorXd::Zero(num());
    smooth.upper = VectorXd::Constant(num(), kUnbounded);
    return smooth;
  }

  /// The friction of all contacts between the same two bodies as this one, where none slips.
  Vector3d FrictionOfPair(const SolverContact& pair, const VectorXd& impulses, double* most) const {
    Vector3d sum = Vector3d::Zero();
    *most = 0.0;
    for (int i = 0; i < num(); ++i) {
      const SolverContact& contact = *contacts_[i];
      if (contact.body != pair.body || contact.other != pair.other) continue;
      *most += contact.slips ? kUnbounded : lcp_.upper[num() + i];
      sum += impulses[num() + i] * contact.along + impulses[2 * num() + i] * contact.across;
    }
    return sum;
  }

  /// Bounds of both components let friction be larger askew. Where that keeps two bodies from
  /// beginning to slide, their contacts' axes are turned along what it would take to stick. True if
  /// some are.
  bool TurnWhatSlides(std::vector<Place> places, const VectorXd& impulses) {
    VectorXd sticking;
    BoxedLcp turned = lcp_;
    for (int i = 0; i < num(); ++i) {
      double most = 0.0;
      if (FrictionOfPair(*contacts_[i], impulses, &most).norm() <= (1.0 + kTooMuch) * most)
        continue;
      if (sticking.size() == 0 && !Stick(&places, &sticking)) return false;
      const Vector3d towards = FrictionOfPair(*contacts_[i], sticking, &most);
      Turn(i, contacts_[i]->along.dot(towards), contacts_[i]->across.dot(towards), &turned);
    }
    lcp_ = std::move(turned);
    return sticking.size() > 0;
  }

  /// What it would take to stick.
  bool Stick(std::vector<Place>* places, VectorXd* impulses) const {
    BoxedLcp sticking = lcp_;
    sticking.upper.setConstant(kUnbounded);
    sticking.lower.tail(2 * num()).setConstant(-kUnbounded);
    for (int row = num(); row < 3 * num(); ++row) (*places)[row] = Place::kBetween;
    return physics::Solve(sticking, places, impulses);
  }

  /// Turns the axes of a contact's friction by the angle of (x, y).
  void Turn(int contact, double x, double y, BoxedLcp* lcp) const {
    const int along = num() + contact, across = 2 * num() + contact;
    const double length = std::hypot(x, y);
    if (length <= 0.0) return;
    const double cosine = x / length, sine = y / length;
    lcp->JT.col(along) = cosine * lcp_.JT.col(along) + sine * lcp_.JT.col(across);
    lcp->JT.col(across) = cosine * lcp_.JT.col(across) - sine * lcp_.JT.col(along);
    lcp->b[along] = cosine * lcp_.b[along] + sine * lcp_.b[across];
    lcp->b[across] = cosine * lcp_.b[across] - sine * lcp_.b[along];
  }

  void AddBody(int body) {
    if (body < 0 || bodies_[body].mass <= 0.0 || columns_[body] >= 0) return;
    columns_[body] = 6 * static_cast<int>(used_.size());
    used_.push_back(body);
  }

  void FillMasses() {
    const int size = 6 * static_cast<int>(used_.size());
    lcp_.mass = lcp_.inverse_mass = MatrixXd::Zero(size, size);
    for (std::size_t k = 0; k < used_.size(); ++k) {
      const SolverBody& body = bodies_[used_[k]];
      const auto at = static_cast<int>(6 * k);
      lcp_.mass.block<3, 3>(at, at).diagonal().setConstant(body.mass);
      lcp_.mass.block<3, 3>(at + 3, at + 3) = body.inertia;
      lcp_.inverse_mass.block<3, 3>(at, at).diagonal().setConstant(1.0 / body.mass);
      lcp_.inverse_mass.block<3, 3>(at + 3, at + 3) = body.inertia.inverse();
    }
  }

  /// Rows of J: all normals, then all along, then all across.
  void FillRows() {
    lcp_.JT = MatrixXd::Zero(6 * used_.size(), 3 * num());
    lcp_.b.resize(3 * num());
    for (int i = 0; i < num(); ++i) {
      const SolverContact& contact = *contacts_[i];
      const Vector3d directions[3] = {contact.normal, contact.along, contact.across};
      for (int k = 0; k < 3; ++k) {
        const int row = k * num() + i;
        lcp_.b[row] = contact.wanted[k];
        FillRow(row, contact.body, contact.position, directions[k]);
        if (contact.other >= 0) FillRow(row, contact.other, contact.position, -directions[k]);
      }
    }
  }

  void FillRow(int row, int index, const Vector3d& position, const Vector3d& direction) {
    const SolverBody& body = bodies_[index];
    const Vector3d turning = (position - body.p_WC).cross(direction);
    lcp_.b[row] -= direction.dot(body.v) + turning.dot(body.w);
    const int at = columns_[index];
    if (at < 0) return;
    lcp_.JT.block<3, 1>(at, row) = direction;
    lcp_.JT.block<3, 1>(at + 3, row) = turning;
  }

  std::vector<SolverBody>& bodies_;
  std::vector<int> columns_;  // where its velocities begin, by body; -1: it has none
  std::vector<int> used_;
  std::vector<const SolverContact*> contacts_;
  BoxedLcp lcp_;  // b: velocities that the contacts want and the bodies lack
};

}  // namespace

bool SolveContacts(const std::vector<SolverContact>& contacts, double softness,
                   std::vector<SolverBody>* bodies) {
  for (SolverBody& body : *bodies) body.impulse = body.turning = Vector3d::Zero();
  const Islands islands(contacts, *bodies);
  std::vector<int> firsts;
  for (const SolverContact& contact : contacts) firsts.push_back(islands.Of(contact));
  for (const int first : std::set<int>(firsts.begin(), firsts.end())) {
    Island island(bodies);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (firsts[i] == first) island.Add(contacts[i]);
    }
    if (!island.Solve(softness)) return false;
  }
  return true;
}

}  // namespace hires::physics
