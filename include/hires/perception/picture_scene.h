#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/shape.h"
#include "hires/perception/picture.h"
#include "hires/perception/pinhole_camera.h"

namespace hires::perception {

/// Something to be drawn.
struct PaintedBody {
  std::vector<geometry::Collision> shapes_B;
  geometry::Pose3 X_MB;
  Colour colour{};
  bool is_glass{false};  ///< one looks through it, and it casts no shadow
};

/// How a scene is lit. Light falls in from one side, with shadows, and softly from above.
struct Lighting {
  Eigen::Vector3d to_sun{0.35, -0.45, 0.82};  ///< towards the light; of any length above 0
  double sun{0.55};                           ///< share of a face's colour that the sun brings ...
  double sky{0.12};                           ///< ... that falls from above ...
  double ambient{0.40};                       ///< ... and that is everywhere
  Colour background{214, 222, 232};
  double farthest{60.0};  ///< [m] from the camera on there is background alone
};

/// Draws bodies by casting rays (Embree): Lambert's shading with hard shadows on a floor z = 0 of
/// tiles of 0.5 m, edges smoothed by four rays a pixel. What never moves and all meshes are
/// prepared once; constant then, so several threads may draw. Round shapes have 64 sides. On one
/// kind of processor the same calls give the same bits.
class PictureScene {
 public:
  /// @param fixed    what never moves, drawn in each picture.
  /// @param movable  what Draw will be given; of these the meshes are prepared alone.
  explicit PictureScene(std::vector<PaintedBody> fixed,
                        const std::vector<PaintedBody>& movable = {});
  ~PictureScene();

  /// @throws std::logic_error for a picture without pixels.
  Picture Draw(const PinholeCamera& camera, const std::vector<PaintedBody>& moving,
               const Lighting& lighting = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::perception
