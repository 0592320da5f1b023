#include "physics/contact_solver.h"

#include <numeric>

#include "physics/contact_island.h"

namespace hires::physics {
namespace {

using Eigen::Vector3d;

bool IsMovable(const std::vector<SolverBody>& bodies, int body) {
  return body >= 0 && bodies[body].mass > 0.0;
}

/// For each body the first one of its island.
std::vector<int> FirstOfIslands(const std::vector<SolverContact>& contacts,
                                const std::vector<SolverBody>& bodies) {
  std::vector<int> parents(bodies.size());
  std::iota(parents.begin(), parents.end(), 0);
  const auto first = [&](int body) {
    while (parents[body] != body) body = parents[body];
    return body;
  };
  for (const SolverContact& contact : contacts) {
    if (!IsMovable(bodies, contact.body) || !IsMovable(bodies, contact.other)) continue;
    const int a = first(contact.body), b = first(contact.other);
    parents[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < parents.size(); ++i) parents[i] = first(static_cast<int>(i));
  return parents;
}

}  // namespace

SolverEffort SolveContacts(double softness, std::vector<SolverContact>* contacts,
                           std::vector<SolverBody>* bodies, ContactMethod method) {
  for (SolverBody& body : *bodies) body.impulse = body.torque_impulse = Vector3d::Zero();
  const std::vector<int> firsts = FirstOfIslands(*contacts, *bodies);
  std::vector<std::vector<int>> of_island(bodies->size());
  std::vector<bool> has_many(bodies->size(), false);
  for (std::size_t i = 0; i < contacts->size(); ++i) {
    SolverContact& contact = (*contacts)[i];
    contact.impulse.setZero();
    const bool is_body = IsMovable(*bodies, contact.body);
    if (!is_body && !IsMovable(*bodies, contact.other)) continue;
    const int first = firsts[is_body ? contact.body : contact.other];
    of_island[first].push_back(static_cast<int>(i));
    if (is_body && IsMovable(*bodies, contact.other)) has_many[first] = true;
  }
  SolverEffort effort;
  for (std::size_t i = 0; i < of_island.size(); ++i) {
    if (of_island[i].empty()) continue;
    if (has_many[i]) {
      island::Island<Eigen::Dynamic>(of_island[i], softness, contacts, bodies)
          .Solve(method, &effort);
    } else {
      island::Island<6>(of_island[i], softness, contacts, bodies).Solve(method, &effort);
    }
  }
  return effort;
}

}  // namespace hires::physics
