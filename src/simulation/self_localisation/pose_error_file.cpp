#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <filesystem>

#include "hires/base/hash.h"
#include "hires/base/param_reader.h"
#include "hires/simulation/pose_error.h"

namespace hires::simulation {
namespace {

using base::Between;
using base::ParamReader;

constexpr const char* kOfErrors[] = {"ahead", "left", "turn"};
constexpr double kLargest = 10.0;   // of any element
constexpr double kRounding = 1e-9;  // by which a covariance may be no covariance

Eigen::Matrix3d ReadMatrix(ParamReader* in, const char* key) {
  Eigen::Matrix3d matrix;
  ParamReader rows = in->Sub(key);
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> row = rows.GetNumbers(kOfErrors[i], 3);
    for (int j = 0; j < 3; ++j) {
      if (std::abs(row[j]) > kLargest)
        rows.Fail(kOfErrors[i],
                  fmt::format("holds {:g}, wanted -{:g} to {:g}", row[j], kLargest, kLargest));
      matrix(i, j) = row[j];
    }
  }
  return matrix;
}

Eigen::Matrix3d ReadCovariance(ParamReader* in, const char* key) {
  const Eigen::Matrix3d matrix = ReadMatrix(in, key);
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kRounding)
    in->Fail(key, "is not symmetric, wanted a covariance");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  if (solver.eigenvalues().minCoeff() < -kRounding)
    in->Fail(key, "has a negative variance in some direction, wanted a covariance");
  return matrix;
}

std::string TextOf(const char* key, const Eigen::Matrix3d& matrix) {
  std::string text = fmt::format("{}:\n", key);
  for (int i = 0; i < 3; ++i)
    text += fmt::format("  {}: [{:.6g}, {:.6g}, {:.6g}]\n", kOfErrors[i], matrix(i, 0),
                        matrix(i, 1), matrix(i, 2));
  return text;
}

}  // namespace

PoseErrorFile ReadPoseError(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  PoseErrorFile file;
  file.hash = in.GetString("fitted_to");
  PoseErrorParams& params = file.params;
  params.update_distance = in.Get("update_distance", Between(0.001, 100.0));
  params.update_turn = in.Get("update_turn", Between(0.001, 10.0));
  params.kept = ReadMatrix(&in, "kept");
  if (params.kept.eigenvalues().cwiseAbs().maxCoeff() >= 1.0)
    in.Fail("kept", "lets errors grow from correction to correction, wanted eigenvalues below 1");
  params.added = ReadCovariance(&in, "added");
  params.start = ReadCovariance(&in, "start");
  params.stretch = in.Get("stretch", Between(0.0, 0.5));
  params.walk = in.Get("walk", Between(0.0, 1.0));
  params.walk_yaw = in.Get("walk_yaw", Between(0.0, 1.0));
  in.RejectUnknownKeys();
  return file;
}

std::string ToYaml(const PoseErrorFile& file) {
  const PoseErrorParams& params = file.params;
  return fmt::format("fitted_to: \"{}\"\nupdate_distance: {:.6g}\nupdate_turn: {:.6g}\n", file.hash,
                     params.update_distance, params.update_turn) +
         TextOf("kept", params.kept) + TextOf("added", params.added) +
         TextOf("start", params.start) +
         fmt::format("stretch: {:.6g}\nwalk: {:.6g}\nwalk_yaw: {:.6g}\n", params.stretch,
                     params.walk, params.walk_yaw);
}

std::string PlaceHash(const std::string& self_localisation, const world::World& world,
                      double laser_height) {
  const SelfLocalisationParams params = LoadSelfLocalisation(self_localisation);
  base::Hasher hasher;
  ParamReader in = ParamReader::FromFile(self_localisation);
  hasher.Add(in.Canonical());
  for (const char* key : {"filter", "odometry_filter"}) {
    const auto path = std::filesystem::path(self_localisation).parent_path() / in.GetString(key);
    hasher.Add(ParamReader::FromFile(path.string()).Canonical());
  }
  const world::OccupancyGrid map = MapIn(params, world, laser_height);
  for (const double number : {map.resolution, map.origin.x(), map.origin.y()}) hasher.Add(number);
  hasher.Add(static_cast<std::uint64_t>(map.width));
  for (const world::Cell cell : map.cells) hasher.Add(static_cast<std::uint64_t>(cell));
  return base::HexOf(hasher.value());
}

}  // namespace hires::simulation
