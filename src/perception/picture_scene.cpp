#include "hires/perception/picture_scene.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "perception/colours.h"
#include "perception/ray_scene.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;

constexpr double kLongestShadow = 60.0;  // [m]
constexpr double kLift = 1e-4;           // [m] off a surface, so that a ray does not meet it again
constexpr double kTile = 0.5;            // [m]
constexpr double kGlassShare = 0.22;
constexpr int kMostPanes = 6;
constexpr int kNothing = -2, kFloor = -1;  // beside the owners of shapes
const Vector3d kTileColours[] = {{188, 186, 180}, {174, 172, 167}};

Vector3d ToVector(const Colour& colour) {
  return {1.0 * colour[0], 1.0 * colour[1], 1.0 * colour[2]};
}

/// What a ray meets first, the floor included.
struct Surface {
  int owner{kNothing};
  double distance{0.0};
  Vector3d n_M{Vector3d::UnitZ()};
};

/// What one ray brings, and what tells its surface from others.
struct Ray {
  Vector3d colour;
  int owner{kNothing};
  Vector3d n_M;
};

bool AreAlike(const Ray& a, const Ray& b) {
  return a.owner == b.owner && a.n_M.dot(b.n_M) > 0.95 && (a.colour - b.colour).norm() < 24.0;
}

/// One picture being drawn.
class Painter {
 public:
  Painter(const RayScene& rays, const std::vector<const PaintedBody*>& bodies,
          const Lighting& lighting)
      : rays_(rays),
        bodies_(bodies),
        lighting_(lighting),
        to_sun_(lighting.to_sun.normalized()),
        background_(ToVector(lighting.background)) {}

  Ray Look(const Vector3d& from_M, const Vector3d& direction) const {
    Vector3d colour = Vector3d::Zero(), from = from_M;
    double through = 1.0;
    for (int pane = 0; pane <= kMostPanes; ++pane) {
      const Surface surface = First(from, direction);
      const Vector3d p_M = from + surface.distance * direction;
      const bool is_glass = surface.owner >= 0 && bodies_[surface.owner]->is_glass;
      if (!is_glass) {
        return {colour + through * ColourOf(surface, p_M), surface.owner, surface.n_M};
      }
      colour += through * kGlassShare * ColourOf(surface, p_M);
      through *= 1.0 - kGlassShare;
      from = p_M + kLift * direction;
    }
    return {colour + through * background_, kNothing, Vector3d::UnitZ()};
  }

 private:
  Surface First(const Vector3d& from_M, const Vector3d& direction) const {
    Surface surface;
    surface.distance = lighting_.farthest;
    const double to_floor = -from_M.z() / direction.z();
    if (direction.z() < 0.0 && from_M.z() > 0.0 && to_floor < lighting_.farthest) {
      surface = {kFloor, to_floor, Vector3d::UnitZ()};
    }
    const auto hit = rays_.FirstHit(from_M, direction, surface.distance);
    if (hit) surface = {hit->owner, hit->distance, hit->n_M};
    return surface;
  }

  Vector3d ColourOf(const Surface& surface, const Vector3d& p_M) const {
    if (surface.owner == kNothing) return background_;
    if (surface.owner == kFloor) {
      const auto tile =
          static_cast<long>(std::floor(p_M.x() / kTile) + std::floor(p_M.y() / kTile));
      return Lit(kTileColours[tile & 1], surface.n_M, p_M);
    }
    return Lit(ToVector(bodies_[surface.owner]->colour), surface.n_M, p_M);
  }

  Vector3d Lit(const Vector3d& colour, const Vector3d& n_M, const Vector3d& p_M) const {
    const double towards = n_M.dot(to_sun_);
    const bool is_sunny = towards > 0.0 && !IsShaded(p_M + kLift * n_M);
    const double light = lighting_.ambient + lighting_.sky * (0.5 + 0.5 * n_M.z()) +
                         (is_sunny ? lighting_.sun * towards : 0.0);
    return std::min(light, 1.0) * colour;
  }

  /// Glass lets light through.
  bool IsShaded(const Vector3d& from_M) const {
    Vector3d from = from_M;
    for (int pane = 0; pane <= kMostPanes; ++pane) {
      const auto hit = rays_.FirstHit(from, to_sun_, kLongestShadow);
      if (!hit) return false;
      if (!bodies_[hit->owner]->is_glass) return true;
      from += (hit->distance + kLift) * to_sun_;
    }
    return false;
  }

  const RayScene& rays_;
  const std::vector<const PaintedBody*>& bodies_;
  const Lighting& lighting_;
  const Vector3d to_sun_, background_;
};

Picture Paint(const PinholeCamera& camera, const Painter& painter) {
  const int width = camera.width, height = camera.height;
  const Vector3d& eye = camera.X_MC.translation;
  std::vector<Ray> rays(static_cast<std::size_t>(width) * height);
  const auto ray = [&](int column, int row) -> Ray& { return rays[row * width + column]; };
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      ray(column, row) = painter.Look(eye, camera.DirectionAt(column + 0.5, row + 0.5));
    }
  }
  Picture picture(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Ray& own = ray(column, row);
      const bool is_edge = !AreAlike(own, ray(std::max(column - 1, 0), row)) ||
                           !AreAlike(own, ray(std::min(column + 1, width - 1), row)) ||
                           !AreAlike(own, ray(column, std::max(row - 1, 0))) ||
                           !AreAlike(own, ray(column, std::min(row + 1, height - 1)));
      Vector3d colour = own.colour;
      if (is_edge) {
        colour.setZero();
        for (const auto& [x, y] :
             {std::pair(0.25, 0.375), {0.625, 0.25}, {0.75, 0.625}, {0.375, 0.75}}) {
          colour += 0.25 * painter.Look(eye, camera.DirectionAt(column + x, row + y)).colour;
        }
      }
      picture.At(column, row) = ToColour(colour);
    }
  }
  return picture;
}

void AddMeshes(const PaintedBody& body, MeshLibrary* library) {
  for (const geometry::Collision& part : body.shapes_B) library->Add(part.shape);
}

}  // namespace

struct PictureScene::Impl {
  std::vector<PaintedBody> fixed;
  MeshLibrary library;
};

PictureScene::PictureScene(std::vector<PaintedBody> fixed, const std::vector<PaintedBody>& movable)
    : impl_(std::make_unique<Impl>()) {
  impl_->fixed = std::move(fixed);
  for (const PaintedBody& body : impl_->fixed) AddMeshes(body, &impl_->library);
  for (const PaintedBody& body : movable) AddMeshes(body, &impl_->library);
}

PictureScene::~PictureScene() = default;

Picture PictureScene::Draw(const PinholeCamera& camera, const std::vector<PaintedBody>& moving,
                           const Lighting& lighting) const {
  HIRES_CHECK(camera.width > 0 && camera.height > 0, "a picture has pixels");
  std::vector<const PaintedBody*> bodies;
  for (const PaintedBody& body : impl_->fixed) bodies.push_back(&body);
  for (const PaintedBody& body : moving) bodies.push_back(&body);
  RayScene rays;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const geometry::Collision& part : bodies[i]->shapes_B) {
      rays.Add(impl_->library, part.shape, bodies[i]->X_MB * part.X_BS, static_cast<int>(i));
    }
  }
  rays.Commit();
  return Paint(camera, Painter(rays, bodies, lighting));
}

}  // namespace hires::perception
