#include "perception/patches/ransac_plane.h"

#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <cmath>
#include <memory>

namespace hires::perception {
namespace {

// PCL has this type's templates compiled; the colours stay black.
using PclPoint = pcl::PointXYZRGBA;

Eigen::Vector4f TowardsCamera(const Eigen::VectorXf& plane) {
  return plane[3] < 0.0F ? Eigen::Vector4f(-plane) : Eigen::Vector4f(plane);
}

/// PCL's own model of a plane across an axis takes either of its sides for the upper one.
class LevelPlane : public pcl::SampleConsensusModelPlane<PclPoint> {
 public:
  LevelPlane(const pcl::PointCloud<PclPoint>::ConstPtr& cloud, const Eigen::Vector3d& up,
             double max_inclination)
      : pcl::SampleConsensusModelPlane<PclPoint>(cloud, /*random=*/false),
        up_(up.cast<float>()),
        least_(static_cast<float>(std::cos(max_inclination))) {}

 protected:
  bool isModelValid(const Eigen::VectorXf& plane) const override {
    return pcl::SampleConsensusModelPlane<PclPoint>::isModelValid(plane) &&
           TowardsCamera(plane).head<3>().dot(up_) >= least_;
  }

 private:
  Eigen::Vector3f up_;
  float least_;  // of the cosine between normal and up
};

/// PCL tells of each sample of points on a line, and where there is no plane; callers say that. Its
/// level is one of the process, so it is set once: threads that set it back would hear each other.
void SilencePcl() {
  static const bool is_silent = [] {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    return true;
  }();
  static_cast<void>(is_silent);
}

}  // namespace

std::optional<Eigen::Vector4d> FindPlaneByRansac(const std::vector<Eigen::Vector3d>& points,
                                                 const Eigen::Vector3d& up,
                                                 const RansacPlaneParams& params) {
  if (points.size() < 3) return std::nullopt;
  auto cloud = std::make_shared<pcl::PointCloud<PclPoint>>();
  cloud->resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    cloud->points[i].getVector3fMap() = points[i].cast<float>();
  SilencePcl();
  pcl::RandomSampleConsensus<PclPoint> ransac(
      std::make_shared<LevelPlane>(cloud, up, params.max_inclination), params.tolerance);
  ransac.setMaxIterations(params.max_samples);
  if (!ransac.computeModel()) return std::nullopt;
  Eigen::VectorXf plane;
  ransac.getModelCoefficients(plane);
  return TowardsCamera(plane).cast<double>();
}

}  // namespace hires::perception
