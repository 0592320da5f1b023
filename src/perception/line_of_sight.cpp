#include "hires/perception/line_of_sight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "perception/ray_scene.h"
#include "perception/surroundings_impl.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// [m] by which a ray ends before the point that it looks at, so that the point's own surface, or
/// the one that it touches, does not hide it.
constexpr double kEndsBefore = 1e-3;

double DistanceToFloor(const Vector3d& from_M, const Vector3d& direction) {
  if (from_M.z() < 0.0 || direction.z() >= 0.0) return kInfinity;
  return -from_M.z() / direction.z();
}

}  // namespace

struct LineOfSight::Impl {
  const Surroundings::Impl& world() const { return *surroundings->impl_; }
  int FindObject(const std::string& name) const;
  bool IsFree(const Vector3d& from_M, const Vector3d& to_M, int except) const;
  VisiblePart PartSeen(const CameraView& view, const std::vector<SurfacePoint>& surface,
                       const geometry::Pose3& X_MO, int except) const;

  std::shared_ptr<const Surroundings> surroundings;
  std::vector<world::ObjectState> objects;
  RayScene loose;                        // objects, then the robot
  std::vector<std::string> owner_names;  // of `loose`
};

int LineOfSight::Impl::FindObject(const std::string& name) const {
  for (std::size_t i = 0; i < objects.size() && !name.empty(); ++i) {
    if (base::ToLower(objects[i].name) == base::ToLower(name)) return static_cast<int>(i);
  }
  return -1;
}

bool LineOfSight::Impl::IsFree(const Vector3d& from_M, const Vector3d& to_M, int except) const {
  const Vector3d way = to_M - from_M;
  const double distance = way.norm() - kEndsBefore;
  if (distance <= 0.0) return true;
  const Vector3d direction = way.normalized();
  return DistanceToFloor(from_M, direction) >= distance &&
         !loose.IsBlocked(from_M, direction, distance, except) &&
         !world().statics.IsBlocked(from_M, direction, distance);
}

VisiblePart LineOfSight::Impl::PartSeen(const CameraView& view,
                                        const std::vector<SurfacePoint>& surface,
                                        const geometry::Pose3& X_MO, int except) const {
  const Vector3d p_MC = view.X_MC.translation;
  double facing = 0.0, seen = 0.0;
  VisiblePart part;
  for (const SurfacePoint& point : surface) {
    const Vector3d p_M = X_MO * point.p_O;
    const Vector3d way = p_MC - p_M;
    const double facing_way = (X_MO.rotation * point.n_O).dot(way);
    if (facing_way <= 0.0) continue;
    facing += point.area;
    if (!view.Contains(p_M) || !IsFree(p_MC, p_M, except)) continue;
    seen += point.area;
    part.size += point.area * facing_way / (way.squaredNorm() * way.norm());
  }
  if (facing > 0.0) part.share = seen / facing;
  return part;
}

LineOfSight::LineOfSight(std::shared_ptr<const Surroundings> surroundings,
                         const std::vector<world::ObjectState>& objects,
                         const std::vector<geometry::Collision>& robot_M)
    : impl_(std::make_unique<Impl>()) {
  impl_->surroundings = std::move(surroundings);
  impl_->objects = objects;
  const MeshLibrary& library = impl_->world().library;
  for (const world::ObjectState& object : objects) {
    if (!object.X_MO.IsFinite()) {
      throw base::ConfigError(fmt::format("object '{}': its pose is not finite", object.name));
    }
    const int owner = static_cast<int>(impl_->owner_names.size());
    impl_->owner_names.push_back(object.name);
    for (const auto& collision : impl_->world().Require(object.model).description->collisions) {
      impl_->loose.Add(library, collision.shape, object.X_MO * collision.X_BS, owner);
    }
  }
  for (const geometry::Collision& shape_M : robot_M) {
    const int owner = static_cast<int>(impl_->owner_names.size());
    impl_->owner_names.push_back(shape_M.name);
    impl_->loose.Add(library, shape_M.shape, shape_M.X_BS, owner);
  }
  impl_->loose.Commit();
}

LineOfSight::~LineOfSight() = default;
LineOfSight::LineOfSight(LineOfSight&&) noexcept = default;
LineOfSight& LineOfSight::operator=(LineOfSight&&) noexcept = default;

VisiblePart LineOfSight::Visible(const CameraView& view, const std::string& object) const {
  const int index = impl_->FindObject(object);
  HIRES_CHECK(index >= 0, "object '" + object + "' is not among those in sight's world");
  const world::ObjectState& state = impl_->objects[index];
  return impl_->PartSeen(view, impl_->surroundings->Surface(state.model), state.X_MO, index);
}

double LineOfSight::VisibleShareAt(const CameraView& view, const std::string& model,
                                   const geometry::Pose3& X_MO, const std::string& except) const {
  return impl_->PartSeen(view, impl_->surroundings->Surface(model), X_MO, impl_->FindObject(except))
      .share;
}

const Surroundings& LineOfSight::surroundings() const { return *impl_->surroundings; }

bool LineOfSight::Sees(const CameraView& view, const Vector3d& p_M,
                       const std::string& except) const {
  return view.Contains(p_M) && impl_->IsFree(view.X_MC.translation, p_M, impl_->FindObject(except));
}

double LineOfSight::Cast(const Vector3d& from_M, const Vector3d& direction) const {
  const auto hit = FirstHit(from_M, direction);
  return hit ? hit->distance : kInfinity;
}

std::vector<double> LineOfSight::Cast(const Vector3d& from_M,
                                      const std::vector<Vector3d>& directions) const {
  std::vector<double> distances;
  distances.reserve(directions.size());
  std::vector<Eigen::Vector3f> packet;
  std::vector<RayHit> hits;
  for (std::size_t begin = 0; begin < directions.size(); begin += RayScene::kPacket) {
    packet.clear();
    hits.clear();
    const std::size_t end = std::min(begin + RayScene::kPacket, directions.size());
    for (std::size_t i = begin; i < end; ++i) {
      packet.push_back(directions[i].cast<float>());
      hits.push_back({DistanceToFloor(from_M, directions[i]), 0, Vector3d::UnitZ()});
    }
    impl_->world().statics.FirstHits(from_M, packet, 0, &hits);
    impl_->loose.FirstHits(from_M, packet, 0, &hits);
    for (const RayHit& hit : hits) distances.push_back(hit.distance);
  }
  return distances;
}

std::optional<Hit> LineOfSight::FirstHit(const Vector3d& from_M, const Vector3d& direction) const {
  HIRES_CHECK(direction.norm() > 0.0, "a ray needs a direction");
  const Vector3d ray = direction.normalized();
  std::optional<Hit> first;
  double nearest = DistanceToFloor(from_M, ray);
  if (nearest < kInfinity) first = Hit{nearest, "floor"};
  if (const auto hit = impl_->world().statics.FirstHit(from_M, ray, nearest)) {
    nearest = hit->distance;
    first = Hit{nearest, impl_->world().static_names[hit->owner]};
  }
  if (const auto hit = impl_->loose.FirstHit(from_M, ray, nearest)) {
    first = Hit{hit->distance, impl_->owner_names[hit->owner]};
  }
  return first;
}

RangePicture LineOfSight::Look(const PinholeCamera& camera, double max_range) const {
  RangePicture out;
  out.width = camera.width;
  out.height = camera.height;
  out.names = impl_->world().static_names;
  const int num_statics = static_cast<int>(out.names.size());
  out.names.insert(out.names.end(), impl_->owner_names.begin(), impl_->owner_names.end());
  const int floor = static_cast<int>(out.names.size());
  out.names.emplace_back("floor");
  const Vector3d from_M = camera.X_MC.translation;
  const Vector3d forward = camera.X_MC.rotation * Vector3d::UnitX();
  const int num_pixels = out.width * out.height;
  out.depth.reserve(num_pixels);
  out.incidence.reserve(num_pixels);
  out.owner.reserve(num_pixels);
  std::vector<Eigen::Vector3f> directions;
  std::vector<RayHit> hits;
  for (int begin = 0; begin < num_pixels; begin += RayScene::kPacket) {
    directions.clear();
    hits.clear();
    for (int i = begin; i < std::min(begin + RayScene::kPacket, num_pixels); ++i) {
      const Vector3d direction =
          camera.DirectionAt(i % out.width + 0.5, i / out.width + 0.5);  // NOLINT: whole rows
      const double to_floor = DistanceToFloor(from_M, direction);
      directions.push_back(direction.cast<float>());
      hits.push_back(to_floor < max_range ? RayHit{to_floor, floor, Vector3d::UnitZ()}
                                          : RayHit{max_range, RangePicture::kNothing, -direction});
    }
    impl_->world().statics.FirstHits(from_M, directions, 0, &hits);
    impl_->loose.FirstHits(from_M, directions, num_statics, &hits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Vector3d direction = directions[i].cast<double>();
      const bool is_there = hits[i].owner != RangePicture::kNothing;
      out.depth.push_back(is_there ? static_cast<float>(hits[i].distance * direction.dot(forward))
                                   : std::numeric_limits<float>::infinity());
      out.incidence.push_back(static_cast<float>(std::abs(direction.dot(hits[i].n_M))));
      out.owner.push_back(hits[i].owner);
    }
  }
  return out;
}

}  // namespace hires::perception
