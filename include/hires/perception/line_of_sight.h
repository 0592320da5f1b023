#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/perception/camera_view.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/range_picture.h"
#include "hires/perception/surroundings.h"

namespace hires::perception {

/// What a ray meets first.
struct Hit {
  double distance{0.0};  ///< [m]
  std::string name;      ///< static body, object, shape of the robot, or "floor"
};

/// What a camera sees of an object.
struct VisiblePart {
  double share{0.0};  ///< of its surface that faces the camera, 0 .. 1
  double size{0.0};   ///< [sr] of what is seen
};

/// Whether nothing stands between the camera and things that it looks at: rays against static
/// bodies, the floor z = 0, loose objects and, where wanted, the robot's own links. Made again for
/// each look, which is cheap; constant, so several threads may ask.
///
/// A ray passes through a surface from its inside: a camera within the robot's head looks out.
class LineOfSight {
 public:
  /// @param objects  each in its true or believed pose; held ones included.
  /// @param robot_M  shapes of the robot in the map (ShapesOf); empty: the robot hides nothing.
  /// @throws base::ConfigError for an object whose model the world does not have, or whose pose is
  /// no number.
  LineOfSight(std::shared_ptr<const Surroundings> surroundings,
              const std::vector<world::ObjectState>& objects,
              const std::vector<geometry::Collision>& robot_M = {});
  ~LineOfSight();
  LineOfSight(LineOfSight&&) noexcept;
  LineOfSight& operator=(LineOfSight&&) noexcept;

  /// Share of the object's surface towards the camera that the camera sees, 0..1: by a fixed
  /// pattern of points on its hull, weighted by area. Points outside of the view are not seen. The
  /// object does not hide itself.  @pre the object is one of those given.
  double VisibleShare(const CameraView& view, const std::string& object) const {
    return Visible(view, object).share;
  }
  VisiblePart Visible(const CameraView& view, const std::string& object) const;
  /// The same for an object that may not be there: what would be seen of it at X_MO. `except` (an
  /// object's name) is looked through.
  /// @throws base::ConfigError for a model that the world does not have.
  double VisibleShareAt(const CameraView& view, const std::string& model,
                        const geometry::Pose3& X_MO, const std::string& except = "") const;
  /// Whether a point in space is in view and not hidden; `except` is looked through.
  bool Sees(const CameraView& view, const Eigen::Vector3d& p_M,
            const std::string& except = "") const;
  const Surroundings& surroundings() const;
  /// Distance along a ray to the first hit [m]; infinite without one.
  /// @param direction  of any length above 0.
  double Cast(const Eigen::Vector3d& from_M, const Eigen::Vector3d& direction) const;
  /// The same for rays that go side by side, which costs a tenth.
  /// @param directions  each of length 1.
  std::vector<double> Cast(const Eigen::Vector3d& from_M,
                           const std::vector<Eigen::Vector3d>& directions) const;
  /// Likewise for one, with the name of what is hit.
  std::optional<Hit> FirstHit(const Eigen::Vector3d& from_M,
                              const Eigen::Vector3d& direction) const;
  /// What each pixel of a camera looks at, by rays side by side (packets of eight).
  /// @param max_range  [m] from the camera; beyond it is nothing.
  RangePicture Look(const PinholeCamera& camera, double max_range) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::perception
