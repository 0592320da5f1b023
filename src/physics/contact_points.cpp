#include "physics/contact_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/geometry/angles.h"

namespace hires::physics {
namespace {

using Eigen::Vector3d;

/// As many as it takes: with the lowest point and the one in the direction of the lean among them,
/// 8, 16 or 24 points tell falling from standing no better (docs/notes_physics.md).
constexpr int kRimPoints = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Below this sine of the tilt, heights along the rim differ by less than a nanometre or so and its
/// lowest point means nothing.
constexpr double kUpright = 1e-8;
/// Points of the rim that are closer together than this (cosine of the angle) count as one.
constexpr double kSamePoint = 0.9986;

struct CosSin {
  double cos, sin;
};

std::array<CosSin, kRimPoints> MakeRim() {
  std::array<CosSin, kRimPoints> rim;
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle = 2.0 * geometry::kPi * i / kRimPoints;
    rim[i] = {std::cos(angle), std::sin(angle)};
  }
  return rim;
}
const std::array<CosSin, kRimPoints> kRim = MakeRim();

/// Collects the points of one cylinder on one face, in the face's frame F: origin in the face, z
/// out of the solid.
class FaceContacts {
 public:
  FaceContacts(const PlacedCylinder& cylinder, const FlatFace& face, const Vector3d& lean,
               ContactList* contacts)
      : face_(face), contacts_(contacts), radius_(cylinder.radius) {
    R_WF_.col(0) = face.u;
    R_WF_.col(1) = face.v;
    R_WF_.col(2) = face.normal;
    const Vector3d axis = R_WF_.transpose() * cylinder.axis;
    down_ = axis.z() > 0.0 ? Vector3d(-axis) : axis;
    height_ = 2.0 * cylinder.half_length;
    rim_centre_ =
        R_WF_.transpose() * (cylinder.centre - face.centre) + down_ * cylinder.half_length;
    lean_ = R_WF_.transpose() * lean;
    lean_ -= down_ * down_.dot(lean_);
    ChooseRimAxes();
  }

  void Collect() {
    AddRim();
    AddLean();
    AddGenerator();
    if (all_inside_) return;
    if (face_.disc_radius > 0.0) {
      AddDiscCrossings();
    } else if (face_.corners.empty()) {
      AddRectangleCrossings();
      AddCorners();
    } else {
      AddPolygonCrossings();
      for (const Eigen::Vector2d& corner : face_.corners) AddCorner(corner.x(), corner.y());
    }
  }

 private:
  /// One side of a polygon, in the face.
  struct Border {
    Eigen::Vector2d from, to;
    Eigen::Vector2d outwards;  ///< unit
    double offset;             ///< [m] the face has outwards . p <= offset
  };

  Border BorderAfter(std::size_t corner) const {
    const Eigen::Vector2d& from = face_.corners[corner];
    const Eigen::Vector2d& to = face_.corners[(corner + 1) % face_.corners.size()];
    const Eigen::Vector2d outwards =
        Eigen::Vector2d(to.y() - from.y(), from.x() - to.x()).normalized();
    return {from, to, outwards, outwards.dot(from)};
  }

  bool IsInside(const Vector3d& p) const {
    if (face_.disc_radius > 0.0) {
      return p.x() * p.x() + p.y() * p.y() <= face_.disc_radius * face_.disc_radius;
    }
    for (std::size_t i = 0; i < face_.corners.size(); ++i) {
      const Border border = BorderAfter(i);
      if (border.outwards.dot(p.head<2>()) > border.offset) return false;
    }
    if (!face_.corners.empty()) return true;
    return std::abs(p.x()) <= face_.half_u && std::abs(p.y()) <= face_.half_v;
  }

  void Add(const Vector3d& p_F) {
    if (p_F.z() <= 0.0) contacts_->Add(face_.centre + R_WF_ * p_F, face_.normal, -p_F.z());
  }

  void AddIfInside(const Vector3d& p_F) {
    if (p_F.z() > 0.0) return;
    if (IsInside(p_F)) {
      Add(p_F);
    } else {
      all_inside_ = false;
    }
  }

  /// lowest_ points from the rim's centre to its lowest point, side_ is square to it in the rim.
  void ChooseRimAxes() {
    Vector3d lowest(down_.x() * down_.z(), down_.y() * down_.z(), down_.z() * down_.z() - 1.0);
    double length = lowest.norm();
    if (length < kUpright) {
      lowest = lean_;
      length = lowest.norm();
    }
    if (length < kUpright) {
      const Vector3d any = std::abs(down_.x()) < 0.7 ? Vector3d::UnitX() : Vector3d::UnitY();
      lowest = any - down_ * down_.dot(any);
      length = lowest.norm();
    }
    lowest_ = lowest / length;
    side_ = down_.cross(lowest_);
  }

  Vector3d RimPoint(double cos, double sin) const {
    return rim_centre_ + radius_ * (cos * lowest_ + sin * side_);
  }

  void AddRim() {
    for (const CosSin& at : kRim) AddIfInside(RimPoint(at.cos, at.sin));
  }

  void AddLean() {
    const double length = lean_.norm();
    if (length < kUpright) return;
    const double cos = lean_.dot(lowest_) / length, sin = lean_.dot(side_) / length;
    for (const CosSin& at : kRim) {
      if (cos * at.cos + sin * at.sin > kSamePoint) return;
    }
    AddIfInside(RimPoint(cos, sin));
  }

  /// The line along the side between the lowest points of both rims, clipped to the face. Its lower
  /// end is a point of the rim already unless it was clipped away.
  void AddGenerator() {
    const Vector3d low = rim_centre_ + radius_ * lowest_, high = low - height_ * down_;
    if (low.z() > 0.0) return;
    const bool low_is_inside = IsInside(low), high_is_inside = IsInside(high);
    if (low_is_inside && high_is_inside) return Add(high);
    double from = 0.0, to = 1.0;
    ClipToFace(low, high - low, &from, &to);
    if (from >= to) return;
    if (!low_is_inside) Add(low + from * (high - low));
    Add(low + to * (high - low));
  }

  void ClipToFace(const Vector3d& start, const Vector3d& way, double* from, double* to) const {
    if (face_.disc_radius > 0.0) {
      const double a = way.head<2>().squaredNorm(), b = start.head<2>().dot(way.head<2>());
      const double c = start.head<2>().squaredNorm() - face_.disc_radius * face_.disc_radius;
      const double root = b * b - a * c;
      if (a <= 0.0 || root <= 0.0) {
        *to = *from;
        return;
      }
      *from = std::max(*from, (-b - std::sqrt(root)) / a);
      *to = std::min(*to, (-b + std::sqrt(root)) / a);
      return;
    }
    for (std::size_t i = 0; i < face_.corners.size(); ++i) {
      const Border border = BorderAfter(i);
      const double speed = border.outwards.dot(way.head<2>());
      const double room = border.offset - border.outwards.dot(start.head<2>());
      if (speed > 0.0) *to = std::min(*to, room / speed);
      if (speed < 0.0) *from = std::max(*from, room / speed);
      if (speed == 0.0 && room < 0.0) *to = *from;
    }
    if (!face_.corners.empty()) return;
    ClipToStrip(start.x(), way.x(), face_.half_u, from, to);
    ClipToStrip(start.y(), way.y(), face_.half_v, from, to);
  }

  static void ClipToStrip(double start, double way, double half, double* from, double* to) {
    if (way == 0.0) {
      if (std::abs(start) > half) *to = *from;
      return;
    }
    const double enter = (-std::copysign(half, way) - start) / way;
    const double leave = (std::copysign(half, way) - start) / way;
    *from = std::max(*from, enter);
    *to = std::min(*to, leave);
  }

  /// Where the rim crosses the lines x = +-half_u and y = +-half_v.
  void AddRectangleCrossings() {
    for (const double border : {-face_.half_u, face_.half_u}) AddRimCrossings(0, border);
    for (const double border : {-face_.half_v, face_.half_v}) AddRimCrossings(1, border);
  }

  void AddRimCrossings(int axis, double border) {
    const double a = radius_ * lowest_[axis], b = radius_ * side_[axis];
    const double c = border - rim_centre_[axis];
    const double length2 = a * a + b * b;
    if (c * c >= length2) return;
    const double root = std::sqrt(length2 - c * c);
    for (const double sign : {-1.0, 1.0}) {
      const double cos = (a * c - sign * b * root) / length2;
      const double sin = (b * c + sign * a * root) / length2;
      const Vector3d p = RimPoint(cos, sin);
      const double half = axis == 0 ? face_.half_v : face_.half_u;
      if (std::abs(p[1 - axis]) <= half) Add(p);
    }
  }

  /// Where the rim crosses the sides of a polygon.
  void AddPolygonCrossings() {
    for (std::size_t i = 0; i < face_.corners.size(); ++i) {
      const Border border = BorderAfter(i);
      const double a = radius_ * border.outwards.dot(lowest_.head<2>());
      const double b = radius_ * border.outwards.dot(side_.head<2>());
      const double c = border.offset - border.outwards.dot(rim_centre_.head<2>());
      const double length2 = a * a + b * b;
      if (c * c >= length2) continue;
      const double root = std::sqrt(length2 - c * c);
      for (const double sign : {-1.0, 1.0}) {
        const Vector3d p =
            RimPoint((a * c - sign * b * root) / length2, (b * c + sign * a * root) / length2);
        const Eigen::Vector2d along = border.to - border.from;
        const double at = along.dot(p.head<2>() - border.from);
        if (at >= 0.0 && at <= along.squaredNorm()) Add(p);
      }
    }
  }

  /// The face's corners that lie under the cylinder's flat end.
  void AddCorners() {
    for (const double x : {-face_.half_u, face_.half_u}) {
      for (const double y : {-face_.half_v, face_.half_v}) AddCorner(x, y);
    }
  }

  void AddCorner(double x, double y) {
    const Vector3d p(x, y, HeightOfEndAt(x, y));
    if ((p - rim_centre_).squaredNorm() <= radius_ * radius_) Add(p);
  }

  /// Where the rim crosses the border of a disc, both taken as circles seen along the normal.
  void AddDiscCrossings() {
    const Eigen::Vector2d centre = rim_centre_.head<2>();
    const double distance = centre.norm(), border = face_.disc_radius;
    if (distance <= 0.0) return;
    const double along =
        (distance * distance + border * border - radius_ * radius_) / (2.0 * distance);
    const double across2 = border * border - along * along;
    if (across2 <= 0.0) return;
    const Eigen::Vector2d e = centre / distance;
    for (const double across : {-std::sqrt(across2), std::sqrt(across2)}) {
      const double x = along * e.x() - across * e.y(), y = along * e.y() + across * e.x();
      Add({x, y, HeightOfEndAt(x, y)});
    }
  }

  double HeightOfEndAt(double x, double y) const {
    if (std::abs(down_.z()) < 0.5) return kInfinity;  // it lies: its end stands upright
    return rim_centre_.z() -
           (down_.x() * (x - rim_centre_.x()) + down_.y() * (y - rim_centre_.y())) / down_.z();
  }

  const FlatFace& face_;
  ContactList* contacts_;
  double radius_, height_;
  Eigen::Matrix3d R_WF_;
  Vector3d down_;        // along the axis, towards the face
  Vector3d rim_centre_;  // of the lower rim
  Vector3d lean_;        // in the plane of the rim
  Vector3d lowest_, side_;
  bool all_inside_{true};
};

FlatFace FaceOf(const PlacedBox& box, int axis, double sign) {
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  FlatFace face;
  face.normal = sign * box.R_WB.col(axis);
  face.u = box.R_WB.col(next);
  face.v = sign * box.R_WB.col(last);
  face.centre = box.centre + box.half_size[axis] * face.normal;
  face.half_u = box.half_size[next];
  face.half_v = box.half_size[last];
  return face;
}

/// Least overlap along the cylinder's axis and square to it and one of the box's edges: those ways
/// out that are no face's normal. All in the box's frame. Negative: apart.
double LeastEdgeOverlap(const Vector3d& p, const Vector3d& axis, const PlacedCylinder& cylinder,
                        const Vector3d& half_size) {
  double least = half_size.dot(axis.cwiseAbs()) + cylinder.half_length - std::abs(p.dot(axis));
  for (int i = 0; i < 3; ++i) {
    Vector3d way = Vector3d::Unit(i).cross(axis);
    const double length = way.norm();
    if (length < 1e-6) continue;
    way /= length;
    least = std::min(least, half_size.dot(way.cwiseAbs()) + cylinder.radius - std::abs(p.dot(way)));
  }
  return least;
}

}  // namespace

void ContactList::Add(const Vector3d& position, const Vector3d& normal, double depth) {
  if (size_ == kCapacity) Reduce();
  points_[size_++] = {position, normal, depth};
}

void ContactList::FlipNormals() {
  for (int i = 0; i < size_; ++i) points_[i].normal = -points_[i].normal;
}

void ContactList::Reduce() {
  if (size_ <= kAtMost) return;
  const auto deeper = [](const ContactPoint& a, const ContactPoint& b) {
    return a.depth < b.depth;
  };
  std::swap(points_[0], *std::max_element(points_.begin(), points_.begin() + size_, deeper));
  std::array<double, kCapacity> distance2;  // to the nearest point that is kept
  distance2.fill(kInfinity);
  for (int kept = 1; kept < kAtMost; ++kept) {
    int farthest = kept;
    for (int i = kept; i < size_; ++i) {
      const double d = (points_[i].position - points_[kept - 1].position).squaredNorm();
      distance2[i] = std::min(distance2[i], d);
      if (distance2[i] > distance2[farthest]) farthest = i;
    }
    std::swap(points_[kept], points_[farthest]);
    std::swap(distance2[kept], distance2[farthest]);
  }
  size_ = kAtMost;
}

double ReachAlong(double axis_component, const PlacedCylinder& cylinder) {
  const double sine2 = std::max(0.0, 1.0 - axis_component * axis_component);
  return std::abs(axis_component) * cylinder.half_length + cylinder.radius * std::sqrt(sine2);
}

Vector3d BetweenEdges(const PlacedEdge& a, const PlacedEdge& b) {
  const double cosine = a.along.dot(b.along), square = 1.0 - cosine * cosine;
  const Vector3d between = b.middle - a.middle;
  const double s = (between.dot(a.along) - cosine * between.dot(b.along)) / square;
  const double t = (cosine * between.dot(a.along) - between.dot(b.along)) / square;
  const Vector3d on_a = a.middle + std::clamp(s, -a.half_length, a.half_length) * a.along;
  const Vector3d on_b = b.middle + std::clamp(t, -b.half_length, b.half_length) * b.along;
  return 0.5 * (on_a + on_b);
}

FlatFace FloorFace() {
  return {Vector3d::Zero(),  Vector3d::UnitX(), Vector3d::UnitY(),
          Vector3d::UnitZ(), kInfinity,         kInfinity};
}

void AddCylinderOnFace(const PlacedCylinder& cylinder, const FlatFace& face, const Vector3d& lean,
                       ContactList* contacts) {
  FaceContacts(cylinder, face, lean, contacts).Collect();
}

QuickLook AddCylinderOnBox(const PlacedCylinder& cylinder, const PlacedBox& box,
                           const Vector3d& lean, ContactList* contacts) {
  const Vector3d p = box.R_WB.transpose() * (cylinder.centre - box.centre);
  const Vector3d axis = box.R_WB.transpose() * cylinder.axis;
  double least = kInfinity;
  int face_axis = 0;
  for (int i = 0; i < 3; ++i) {
    const double overlap = box.half_size[i] + ReachAlong(axis[i], cylinder) - std::abs(p[i]);
    if (overlap < 0.0) return QuickLook::kApart;
    if (overlap < least) {
      least = overlap;
      face_axis = i;
    }
  }
  const double edges = LeastEdgeOverlap(p, axis, cylinder, box.half_size);
  if (edges < 0.0) return QuickLook::kApart;
  if (least > edges + kFacePreference) return QuickLook::kUndecided;
  const int before = contacts->size();
  AddCylinderOnFace(cylinder, FaceOf(box, face_axis, p[face_axis] < 0.0 ? -1.0 : 1.0), lean,
                    contacts);
  return contacts->size() > before ? QuickLook::kOnFace : QuickLook::kUndecided;
}

QuickLook AddCylinderOnCylinder(const PlacedCylinder& a, const PlacedCylinder& b,
                                const Vector3d& lean, ContactList* contacts) {
  const Vector3d p_BA = a.centre - b.centre;
  const double reach_a = std::hypot(a.radius, a.half_length);
  const double reach_b = std::hypot(b.radius, b.half_length);
  if (p_BA.squaredNorm() > (reach_a + reach_b) * (reach_a + reach_b)) return QuickLook::kApart;
  if (a.radius > b.radius) {  // the wider one lends its end, the narrower one its rim
    ContactList flipped;
    const QuickLook look = AddCylinderOnCylinder(b, a, -lean, &flipped);
    flipped.FlipNormals();
    for (const ContactPoint& point : flipped) {
      contacts->Add(point.position, point.normal, point.depth);
    }
    return look;
  }
  const double cosine = a.axis.dot(b.axis), along = p_BA.dot(b.axis);
  const double overlap = b.half_length + ReachAlong(cosine, a) - std::abs(along);
  if (overlap < 0.0) return QuickLook::kApart;
  const double sideways = a.radius + b.radius - (p_BA - along * b.axis).norm();
  if (std::abs(cosine) < 0.9 || overlap > sideways + kFacePreference) return QuickLook::kUndecided;
  FlatFace face;
  face.normal = along < 0.0 ? Vector3d(-b.axis) : b.axis;
  face.u = std::abs(b.axis.x()) < 0.7 ? Vector3d::UnitX() : Vector3d::UnitY();
  face.u = (face.u - face.normal * face.normal.dot(face.u)).normalized();
  face.v = face.normal.cross(face.u);
  face.centre = b.centre + b.half_length * face.normal;
  face.half_u = face.half_v = face.disc_radius = b.radius;
  const int before = contacts->size();
  AddCylinderOnFace(a, face, lean, contacts);
  return contacts->size() > before ? QuickLook::kOnFace : QuickLook::kUndecided;
}

}  // namespace hires::physics
