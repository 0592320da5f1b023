#pragma once

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::benchmark_support {

/// One body on a plate that moves as told, in MuJoCo: elliptic friction cones, hard contacts, no
/// rolling or torsional friction. Gravity acts on the body alone.
class MujocoScene {
 public:
  static constexpr double kTimeStep = 5e-4;  ///< [s]

  /// @param friction   of the contact
  /// @param plate_top  [m] height of the plate's upper face in its frame P
  /// @param X_WP, X_WB  poses of plate and body at the start
  MujocoScene(const geometry::MassProperties& mass,
              const std::vector<geometry::Collision>& shapes_B, double friction, double plate_top,
              const geometry::Pose3& X_WP, const geometry::Pose3& X_WB,
              const Eigen::Vector3d& start_velocity_W)
      : weight_(9.81 * mass.mass) {
    const std::string xml = Xml(mass, shapes_B, friction, plate_top);
    auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    std::array<char, 500> error{};
    model_.reset(
        mj_loadXML("scene.xml", files.get(), error.data(), static_cast<int>(error.size())));
    mj_deleteVFS(files.get());
    if (model_ == nullptr) throw std::runtime_error(fmt::format("MuJoCo: {}", error.data()));
    data_.reset(mj_makeData(model_.get()));
    SetPose(0, X_WP);
    SetPose(7, X_WB);
    for (int i = 0; i < 3; ++i) data_->qvel[6 + i] = start_velocity_W(i);
    force_ = data_->xfrc_applied + 6 * 2;  // world, plate, body
  }

  /// The plate moves from one pose to another within `duration` [s].
  void Move(const geometry::Pose3& X_WPfrom, const geometry::Pose3& X_WPto, double duration) {
    const int steps = std::max(1, static_cast<int>(std::lround(duration / kTimeStep)));
    const Eigen::Vector3d way = X_WPto.translation - X_WPfrom.translation;
    const Eigen::Quaterniond from(X_WPfrom.rotation), to(X_WPto.rotation);
    const Eigen::AngleAxisd turn(from.inverse() *
                                 to);  // its axis is that of the plate's frame, too
    for (int i = 0; i < steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      geometry::Pose3 X_WP;
      X_WP.translation = X_WPfrom.translation + share * way;
      X_WP.rotation = from * Eigen::AngleAxisd(share * turn.angle(), turn.axis());
      SetPose(0, X_WP);
      for (int k = 0; k < 3; ++k) {
        data_->qvel[k] = way(k) / duration;
        data_->qvel[3 + k] = turn.axis()(k) * turn.angle() / duration;
      }
      force_[2] = -weight_;
      mj_step(model_.get(), data_.get());
    }
  }

  geometry::Pose3 X_WB() const {
    const double* q = data_->qpos + 7;
    geometry::Pose3 X_WB;
    X_WB.translation = {q[0], q[1], q[2]};
    X_WB.rotation = Eigen::Quaterniond(q[3], q[4], q[5], q[6]);
    return X_WB;
  }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  void SetPose(int at, const geometry::Pose3& X) {
    const Eigen::Quaterniond q(X.rotation);
    const double values[] = {
        X.translation.x(), X.translation.y(), X.translation.z(), q.w(), q.x(), q.y(), q.z()};
    std::copy(std::begin(values), std::end(values), data_->qpos + at);
  }

  static std::string PoseXml(const geometry::Pose3& X) {
    const Eigen::Quaterniond q(X.rotation);
    const Eigen::Vector3d& p = X.translation;
    return fmt::format("pos='{} {} {}' quat='{} {} {} {}'", p.x(), p.y(), p.z(), q.w(), q.x(),
                       q.y(), q.z());
  }

  /// @param assets  where meshes are added
  static std::string ShapeXml(const geometry::Shape& shape, std::string* assets) {
    if (const auto* box = std::get_if<geometry::Box>(&shape)) {
      const Eigen::Vector3d half = 0.5 * box->size;
      return fmt::format("type='box' size='{} {} {}'", half.x(), half.y(), half.z());
    }
    if (const auto* cylinder = std::get_if<geometry::Cylinder>(&shape))
      return fmt::format("type='cylinder' size='{} {}'", cylinder->radius, cylinder->length / 2);
    if (const auto* sphere = std::get_if<geometry::Sphere>(&shape))
      return fmt::format("type='sphere' size='{}'", sphere->radius);
    const std::string name = fmt::format("mesh{}", assets->size());
    *assets += fmt::format("<mesh name='{}' vertex='", name);
    for (const Eigen::Vector3d& v :
         std::get<std::shared_ptr<const geometry::TriangleMesh>>(shape)->vertices)
      *assets += fmt::format("{} {} {} ", v.x(), v.y(), v.z());
    *assets += "'/>";
    return fmt::format("type='mesh' mesh='{}'", name);
  }

  static std::string Xml(const geometry::MassProperties& mass,
                         const std::vector<geometry::Collision>& shapes_B, double friction,
                         double plate_top) {
    std::string assets, geoms;
    for (const geometry::Collision& shape : shapes_B) {
      geoms += fmt::format("<geom {} {} friction='{} 0 0' condim='3' mass='0'/>",
                           ShapeXml(shape.shape, &assets), PoseXml(shape.X_BS), friction);
    }
    const Eigen::Matrix3d& I = mass.I_BBcm;
    return fmt::format(
        "<mujoco><compiler balanceinertia='true'/>"
        "<option timestep='{}' cone='elliptic' impratio='20' iterations='200' tolerance='1e-12' "
        "noslip_iterations='20' gravity='0 0 0'><flag multiccd='enable'/></option>"
        "<default><geom solref='0.004 1' solimp='0.99 0.999 0.0005'/></default><asset>{}</asset>"
        "<worldbody><body name='plate'><freejoint/>"
        "<inertial pos='0 0 0' mass='1e6' diaginertia='1e6 1e6 1e6'/>"
        "<geom type='box' size='3 3 0.05' pos='0 0 {}' friction='{} 0 0' mass='0'/></body>"
        "<body name='object'><freejoint/>"
        "<inertial pos='{} {} {}' mass='{}' fullinertia='{} {} {} {} {} {}'/>{}</body>"
        "</worldbody></mujoco>",
        kTimeStep, assets, plate_top - 0.05, friction, mass.p_BBcm.x(), mass.p_BBcm.y(),
        mass.p_BBcm.z(), mass.mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2), geoms);
  }

  const double weight_;  // [N]
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  double* force_{nullptr};
};

}  // namespace hires::benchmark_support
