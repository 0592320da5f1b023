#include "perception/self/mesh_distance.h"

#include <algorithm>
#include <limits>

namespace hires::perception {
namespace {

using Eigen::Vector3f;

/// The point of a triangle that is nearest to p: a corner, on an edge, or within, by the region
/// that p lies over [Ericson 2005, "Real-Time Collision Detection", 5.1.5].
Vector3f NearestOnTriangle(const Vector3f& p, const Vector3f& a, const Vector3f& b,
                           const Vector3f& c) {
  const Vector3f ab = b - a, ac = c - a;
  const float d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0.0f && d2 <= 0.0f) return a;
  const float d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0.0f && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return a + d1 / (d1 - d3) * ab;
  const float d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0.0f && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const float sum = va + vb + vc;
  return sum > 0.0f ? Vector3f(a + (vb / sum) * ab + (vc / sum) * ac) : a;
}

struct Query {
  const geometry::TriangleMesh* mesh;
  Vector3f p;
};

/// Called by Embree for each triangle within the radius, which shrinks to the nearest one so far.
bool Consider(RTCPointQueryFunctionArguments* arguments) {
  const Query& query = *static_cast<const Query*>(arguments->userPtr);
  const auto& corners = query.mesh->triangles[arguments->primID];
  const auto corner = [&](int k) -> Vector3f {
    return query.mesh->vertices[corners[k]].cast<float>();
  };
  const float distance =
      (NearestOnTriangle(query.p, corner(0), corner(1), corner(2)) - query.p).norm();
  if (distance >= arguments->query->radius) return false;
  arguments->query->radius = distance;
  return true;
}

/// What a ray meets first from within a closed mesh, it leaves.
bool IsInside(RTCScene scene, const Vector3f& p) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = p.x();
  ray.ray.org_y = p.y();
  ray.ray.org_z = p.z();
  ray.ray.dir_x = 0.36f;  // any; not along an axis, along which edges of meshes lie
  ray.ray.dir_y = 0.48f;
  ray.ray.dir_z = 0.80f;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = 0xffffffffu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  return ray.hit.Ng_x * ray.ray.dir_x + ray.hit.Ng_y * ray.ray.dir_y +
             ray.hit.Ng_z * ray.ray.dir_z >
         0.0f;
}

}  // namespace

float DistanceToMesh(RTCScene scene, const geometry::TriangleMesh& mesh, const Vector3f& p,
                     float limit) {
  if (IsInside(scene, p)) return 0.0f;
  Query query{&mesh, p};
  RTCPointQuery nearest{p.x(), p.y(), p.z(), 0.0f, limit};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &nearest, &context, Consider, &query);
  return std::min(nearest.radius, limit);
}

}  // namespace hires::perception
