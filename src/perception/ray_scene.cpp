#include "perception/ray_scene.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "hires/base/check.h"
#include "hires/base/log.h"
#include "perception/shape_mesh.h"

namespace hires::perception {
namespace {

using Eigen::Vector3d;
using MeshPointer = std::shared_ptr<const geometry::TriangleMesh>;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};

/// One for the process. It builds with the thread that asks: scenes are small, and many workers
/// share the processor.
RTCDevice Device() {
  static const std::unique_ptr<RTCDeviceTy, DeviceDeleter> device = [] {
    std::unique_ptr<RTCDeviceTy, DeviceDeleter> made(rtcNewDevice("threads=1,set_affinity=0"));
    if (!made) {
      throw std::runtime_error(
          fmt::format("Embree has no device (error {}): does this processor have SSE2?",
                      static_cast<int>(rtcGetDeviceError(nullptr))));
    }
    const auto log = [](void*, RTCError code, const char* text) {
      base::Log(base::LogLevel::kError,
                fmt::format("embree error={} text={}", static_cast<int>(code), text));
    };
    rtcSetDeviceErrorFunction(made.get(), log, nullptr);
    return made;
  }();
  return device.get();
}

ScenePointer NewScene(RTCBuildQuality quality) {
  ScenePointer scene(rtcNewScene(Device()));
  rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                           RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene.get(), quality);
  return scene;
}

void Attach(RTCGeometry geometry, RTCScene scene) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

template <typename T>
T* NewBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t size) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(T), size);
  if (buffer == nullptr) throw std::runtime_error("Embree has no memory for a mesh");
  return static_cast<T*>(buffer);
}

ScenePointer SceneOf(const geometry::TriangleMesh& mesh) {
  ScenePointer scene = NewScene(RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = rtcNewGeometry(Device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corner =
      NewBuffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices.size());
  for (const Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) *corner++ = static_cast<float>(vertex[axis]);
  }
  auto* index =
      NewBuffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const int vertex : triangle) *index++ = static_cast<unsigned>(vertex);
  }
  Attach(geometry, scene.get());
  rtcCommitScene(scene.get());
  return scene;
}

RTCRay MakeRay(const Vector3d& from_M, const Vector3d& direction, double max_distance) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(from_M.x());
  ray.org_y = static_cast<float>(from_M.y());
  ray.org_z = static_cast<float>(from_M.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0.0f;
  ray.tfar = static_cast<float>(max_distance);
  ray.mask = 0xffffffffu;
  return ray;
}

}  // namespace

MeshLibrary::MeshLibrary()
    : box_(SceneOf(UnitBoxMesh())),
      cylinder_(SceneOf(UnitCylinderMesh())),
      sphere_(SceneOf(UnitSphereMesh())) {}

void MeshLibrary::Add(const geometry::Shape& shape) {
  const auto* mesh = std::get_if<MeshPointer>(&shape);
  if (mesh != nullptr && meshes_.count(*mesh) == 0) meshes_[*mesh] = SceneOf(**mesh);
}

RTCScene MeshLibrary::Find(const geometry::Shape& shape) const {
  if (std::holds_alternative<geometry::Box>(shape)) return box_.get();
  if (std::holds_alternative<geometry::Cylinder>(shape)) return cylinder_.get();
  if (std::holds_alternative<geometry::Sphere>(shape)) return sphere_.get();
  const auto found = meshes_.find(std::get<MeshPointer>(shape));
  return found == meshes_.end() ? nullptr : found->second.get();
}

/// Embree hands it to the filter for each surface that a ray meets.
struct RayScene::Context {
  RTCIntersectContext base;  // first: Embree knows this part alone
  const std::vector<Instance>* instances{nullptr};
  Eigen::Vector3f directions[RayScene::kPacket];  // by the ray's number
  int except_owner{-1};
};

RayScene::RayScene() : scene_(NewScene(RTC_BUILD_QUALITY_LOW)) {}

void RayScene::Add(const MeshLibrary& library, const geometry::Shape& shape,
                   const geometry::Pose3& X_MS, int owner) {
  RTCScene mesh = library.Find(shape);
  if (mesh == nullptr) {
    own_.push_back(SceneOf(*std::get<MeshPointer>(shape)));
    mesh = own_.back().get();
  }
  const Vector3d scale = ScaleOf(shape);
  const Eigen::Matrix3d rotation = X_MS.rotation.toRotationMatrix();
  Eigen::Matrix<float, 3, 4> transform;
  transform.leftCols<3>() = (rotation * scale.asDiagonal()).cast<float>();
  transform.col(3) = X_MS.translation.cast<float>();
  RTCGeometry geometry = rtcNewGeometry(Device(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
  Attach(geometry, scene_.get());
  const Eigen::Matrix3d to_shape = scale.cwiseInverse().asDiagonal() * rotation.transpose();
  instances_.push_back({owner, to_shape.cast<float>()});
}

void RayScene::Commit() { rtcCommitScene(scene_.get()); }

void RayScene::Accept(const RTCFilterFunctionNArguments* arguments) {
  const auto* context = reinterpret_cast<const Context*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] != -1) continue;
    const unsigned instance = RTCHitN_instID(arguments->hit, n, i, 0);
    const Eigen::Vector3f normal(RTCHitN_Ng_x(arguments->hit, n, i),
                                 RTCHitN_Ng_y(arguments->hit, n, i),
                                 RTCHitN_Ng_z(arguments->hit, n, i));
    const Instance& met = (*context->instances)[instance];
    const Eigen::Vector3f& direction = context->directions[RTCRayN_id(arguments->ray, n, i)];
    const bool is_from_inside = normal.dot(met.to_shape * direction) >= 0.0f;
    if (is_from_inside || met.owner == context->except_owner) arguments->valid[i] = 0;
  }
}

RayScene::Context RayScene::MakeContext(int except_owner) const {
  Context context;
  rtcInitIntersectContext(&context.base);
  context.base.filter = &RayScene::Accept;
  context.instances = &instances_;
  context.except_owner = except_owner;
  return context;
}

// Normals turn with the inverse transposed of what turns directions.
Vector3d RayScene::NormalInMap(const Instance& met, const Eigen::Vector3f& n_S) {
  return (met.to_shape.transpose() * n_S).cast<double>().normalized();
}

std::optional<RayHit> RayScene::FirstHit(const Vector3d& from_M, const Vector3d& direction,
                                         double max_distance, int except_owner) const {
  Context context = MakeContext(except_owner);
  context.directions[0] = direction.cast<float>();
  RTCRayHit query{};
  query.ray = MakeRay(from_M, direction, max_distance);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context.base, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Instance& met = instances_[query.hit.instID[0]];
  return RayHit{query.ray.tfar, met.owner,
                NormalInMap(met, {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z})};
}

void RayScene::FirstHits(const Vector3d& from_M, const std::vector<Eigen::Vector3f>& directions,
                         int owner_offset, std::vector<RayHit>* hits) const {
  HIRES_CHECK(directions.size() <= kPacket && hits->size() == directions.size(),
              "rays of a packet");
  Context context = MakeContext(-1);
  context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) int valid[kPacket] = {};
  RTCRayHit8 query{};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    valid[i] = -1;
    context.directions[i] = directions[i];
    query.ray.org_x[i] = static_cast<float>(from_M.x());
    query.ray.org_y[i] = static_cast<float>(from_M.y());
    query.ray.org_z[i] = static_cast<float>(from_M.z());
    query.ray.dir_x[i] = directions[i].x();
    query.ray.dir_y[i] = directions[i].y();
    query.ray.dir_z[i] = directions[i].z();
    query.ray.tfar[i] = static_cast<float>((*hits)[i].distance);
    query.ray.mask[i] = 0xffffffffu;
    query.ray.id[i] = static_cast<unsigned>(i);
    query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid, scene_.get(), &context.base, &query);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const Instance& met = instances_[query.hit.instID[0][i]];
    (*hits)[i] = {query.ray.tfar[i], owner_offset + met.owner,
                  NormalInMap(met, {query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]})};
  }
}

bool RayScene::IsBlocked(const Vector3d& from_M, const Vector3d& direction, double max_distance,
                         int except_owner) const {
  Context context = MakeContext(except_owner);
  context.directions[0] = direction.cast<float>();
  RTCRay ray = MakeRay(from_M, direction, max_distance);
  rtcOccluded1(scene_.get(), &context.base, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace hires::perception
