#include "mapping/pose_graph.h"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"

namespace hires::mapping {
namespace {

using geometry::Pose2;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kGraphConverged = 1e-5;  // [m], [rad]
// Dynamic covariance scaling [Agarwal et al. 2013, ICRA, 62-69]: an edge whose error exceeds this
// (squared, in sd) counts less.
constexpr double kTrusted = 20.0;
constexpr double kBelieved = 0.5;  // of the weight of an edge that cannot be wrong

/// An edge about the poses it joins.
struct Linearised {
  Eigen::Vector3d error;
  Eigen::Matrix3d A, B;  // by the poses it comes from and goes to
};

Linearised Linearise(const PoseGraph::Edge& edge, const Pose2& from, const Pose2& to) {
  const double c = std::cos(from.yaw), s = std::sin(from.yaw);
  Eigen::Matrix2d turn, turn_by_yaw;  // map to `from`
  turn << c, s, -s, c;
  turn_by_yaw << -s, c, -c, -s;
  const Eigen::Vector2d way = to.position() - from.position();
  Linearised linear;
  linear.error.head<2>() = turn * way - edge.X_FT.position();
  linear.error.z() = geometry::WrapToPi(to.yaw - from.yaw - edge.X_FT.yaw);
  linear.A.setZero();
  linear.A.topLeftCorner<2, 2>() = -turn;
  linear.A.topRightCorner<2, 1>() = turn_by_yaw * way;
  linear.A(2, 2) = -1.0;
  linear.B.setZero();
  linear.B.topLeftCorner<2, 2>() = turn;
  linear.B(2, 2) = 1.0;
  return linear;
}

double TrustIn(const PoseGraph::Edge& edge, const Eigen::Vector3d& error) {
  if (!edge.may_be_wrong) return 1.0;
  const double squared = error.dot(edge.information * error);
  const double scale = std::min(1.0, 2.0 * kTrusted / (kTrusted + squared));
  return scale * scale;
}

/// The first pose has no columns.
void AddBlock(int i, int j, const Eigen::Matrix3d& block, Triplets* triplets) {
  if (i == 0 || j == 0) return;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      triplets->emplace_back(3 * (i - 1) + row, 3 * (j - 1) + column, block(row, column));
}

}  // namespace

int PoseGraph::AddPose(const Pose2& X_M) {
  poses_.push_back(X_M);
  return size() - 1;
}

void PoseGraph::AddEdge(const Edge& edge) {
  HIRES_CHECK(edge.from >= 0 && edge.to >= 0 && edge.from < size() && edge.to < size(),
              "an edge joins poses");
  edges_.push_back(edge);
}

bool PoseGraph::CloseLoop(Edge edge, bool is_large) {
  edge.may_be_wrong = !is_large;
  if (!is_large) {
    AddEdge(edge);
    Optimise();
    return true;
  }
  const std::vector<Pose2> before = poses_;
  const int num_before = NumBelieved();
  AddEdge(edge);
  Optimise();
  edges_.back().may_be_wrong = true;
  Optimise();
  if (NumBelieved() > num_before) return true;
  poses_ = before;
  Optimise();
  return false;
}

int PoseGraph::NumBelieved() const {
  return std::count_if(edges_.begin(), edges_.end(), [&](const Edge& edge) {
    const Linearised linear = Linearise(edge, poses_[edge.from], poses_[edge.to]);
    return edge.may_be_wrong && TrustIn(edge, linear.error) >= kBelieved;
  });
}

double PoseGraph::Optimise(int most_iterations) {
  if (size() < 2) return 0.0;
  const std::vector<Pose2> before = poses_;
  for (int i = 0; i < most_iterations; ++i)
    if (Step() < kGraphConverged) break;
  double farthest = 0.0;
  for (int i = 0; i < size(); ++i)
    farthest = std::max(farthest, (poses_[i].position() - before[i].position()).norm());
  return farthest;
}

double PoseGraph::Step() {
  Triplets triplets;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * (size() - 1));
  for (const Edge& edge : edges_) {
    const Linearised linear = Linearise(edge, poses_[edge.from], poses_[edge.to]);
    const Eigen::Matrix3d W = TrustIn(edge, linear.error) * edge.information;
    AddBlock(edge.from, edge.from, linear.A.transpose() * W * linear.A, &triplets);
    AddBlock(edge.from, edge.to, linear.A.transpose() * W * linear.B, &triplets);
    AddBlock(edge.to, edge.from, linear.B.transpose() * W * linear.A, &triplets);
    AddBlock(edge.to, edge.to, linear.B.transpose() * W * linear.B, &triplets);
    const Eigen::Vector3d pull = W * linear.error;
    if (edge.from > 0) gradient.segment<3>(3 * (edge.from - 1)) += linear.A.transpose() * pull;
    if (edge.to > 0) gradient.segment<3>(3 * (edge.to - 1)) += linear.B.transpose() * pull;
  }
  for (int i = 0; i < gradient.size(); ++i)
    triplets.emplace_back(i, i, 1e-6);  // poses without edges
  Eigen::SparseMatrix<double> hessian(gradient.size(), gradient.size());
  hessian.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(hessian);
  if (solver.info() != Eigen::Success) return 0.0;
  const Eigen::VectorXd step = -solver.solve(gradient);
  for (int i = 1; i < size(); ++i) {
    poses_[i].x += step[3 * (i - 1)];
    poses_[i].y += step[3 * (i - 1) + 1];
    poses_[i].yaw = geometry::WrapToPi(poses_[i].yaw + step[3 * (i - 1) + 2]);
  }
  return step.cwiseAbs().maxCoeff();
}

}  // namespace hires::mapping
