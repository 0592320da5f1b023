// What do both methods of the contact solver take: on a standing, a sliding and a tipping object,
// and on a stack?
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>

#include "physics/contact_solver.h"

namespace hires::physics {
namespace {

using Eigen::Vector3d;

constexpr double kSoftness = 1e-5;  // [1/kg] CFM 1e-8 at 1 kHz

struct Case {
  std::vector<SolverBody> bodies;
  std::vector<SolverContact> contacts;
};

/// Cylinders of radius 33 mm and height 0.2 m on one another, on the rim's four points and the one
/// ahead, pushed along x with `speed` [m/s] and turning about y with `tipping` [rad/s].
Case Stack(int height, double speed, double tipping, double friction) {
  Case made;
  for (int k = 0; k < height; ++k) {
    SolverBody body;
    body.mass = 0.5;
    body.inertia = body.mass * Vector3d(0.0036, 0.0036, 0.00054).asDiagonal();
    body.p_WC = {0.0, 0.0, 0.1 + 0.2 * k};
    body.v = {speed, 0.0, -0.00981};
    body.w = {0.0, tipping, 0.0};
    made.bodies.push_back(body);
    for (int i = 0; i < 5; ++i) {
      const double angle = i == 4 ? 0.1 : 0.7 + 1.5708 * i;
      SolverContact contact;
      contact.position = {0.033 * std::cos(angle), 0.033 * std::sin(angle), 0.2 * k};
      contact.normal = Vector3d::UnitZ();
      contact.friction = friction;
      contact.body = k;
      contact.other = k - 1;
      made.contacts.push_back(contact);
    }
  }
  return made;
}

void Run(benchmark::State& state, Case made) {
  const auto method = static_cast<ContactMethod>(state.range(0));
  SolverEffort effort;
  for (auto _ : state) {
    effort = SolveContacts(kSoftness, &made.contacts, &made.bodies, method);
    benchmark::DoNotOptimize(made.bodies[0].impulse);
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(method == ContactMethod::kNewton ? "newton" : "gauss-seidel");
  state.counters["rounds"] = effort.newton_rounds + effort.bound_rounds;
  state.counters["sweeps"] = effort.sweeps;
}

void BM_Standing(benchmark::State& state) { Run(state, Stack(1, 0.0, 0.0, 0.4)); }
void BM_Sliding(benchmark::State& state) { Run(state, Stack(1, 0.5, 0.0, 0.2)); }
void BM_TippingWhileSliding(benchmark::State& state) { Run(state, Stack(1, 0.5, 0.05, 0.4)); }
void BM_StackOfFour(benchmark::State& state) { Run(state, Stack(4, 0.002, 0.0, 0.4)); }
BENCHMARK(BM_Standing)->Arg(0)->Arg(1);
BENCHMARK(BM_Sliding)->Arg(0)->Arg(1);
BENCHMARK(BM_TippingWhileSliding)->Arg(0)->Arg(1);
BENCHMARK(BM_StackOfFour)->Arg(0)->Arg(1);

}  // namespace
}  // namespace hires::physics
