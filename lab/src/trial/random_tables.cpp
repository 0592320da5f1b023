#include "lab/src/trial/random_tables.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/perception/camera_view.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"

namespace hires::perception {
namespace {

using base::Rng;
using Eigen::Vector3d;
using geometry::Pose3;

constexpr int kMostThings = 8;
constexpr double kUnknownShare = 0.2;  // of things
constexpr double kUnlike = 0.015;  // [m] by which an unknown one differs from all known, at least
constexpr const char* kTorso[] = {"torsodownposture", "torsomiddleposture", "torsoupposture"};
constexpr int kWidth = 640, kHeight = 480;        // [pixels]
constexpr std::uint64_t kMountStream = 1u << 20;  // beyond those of looks
constexpr double kSight = 5.0;                    // [m]

geometry::Aabb BoundsOf(const world::ObjectModel& model) {
  geometry::Aabb bounds;
  for (const geometry::Collision& one : model.collisions)
    bounds.Include(geometry::BoundsOf(one.shape, one.X_BS));
  return bounds;
}

Vector3d SortedSize(const world::ObjectModel& model) {
  Vector3d size = BoundsOf(model).upper - BoundsOf(model).lower;
  std::sort(size.data(), size.data() + 3);
  return size;
}

/// @param margin  [m] around it.
geometry::Polygon OutlineOf(const world::ObjectModel& model, const geometry::Pose2& X_MO,
                            double margin) {
  const geometry::Aabb b = BoundsOf(model);
  return geometry::Transformed(X_MO, {{b.lower.x() - margin, b.lower.y() - margin},
                                      {b.upper.x() + margin, b.lower.y() - margin},
                                      {b.upper.x() + margin, b.upper.y() + margin},
                                      {b.lower.x() - margin, b.upper.y() + margin}});
}

/// What is on a table and who looks at it, before anything is measured.
struct Scene {
  std::vector<world::ObjectState> objects{};
  std::shared_ptr<const Surroundings> surroundings{};
  std::vector<geometry::Collision> robot_M{};
  PinholeCamera camera{};
  CameraView view{};

  LineOfSight Sight() const { return {surroundings, objects, robot_M}; }
};

/// Turns pan and tilt until the camera's axis goes through a point.
void TurnHead(const robot::Robot& robot, const geometry::Pose2& X_MB, const Vector3d& p_M,
              robot::JointPositions* posture) {
  constexpr int kRounds = 8;  // the camera moves with the head; each is ten times nearer
  const robot::UpperBodyProfile& body = *robot.profile.upper_body;
  for (int round = 0; round < kRounds; ++round) {
    const Vector3d p_C = ViewOf(robot, X_MB, *posture).X_MC.Inverse() * p_M;
    (*posture)[body.head_pan_joint] += std::atan2(p_C.y(), p_C.x());
    (*posture)[body.head_tilt_joint] -= std::atan2(p_C.z(), p_C.head<2>().norm());
  }
}

}  // namespace

struct RandomTables::Impl {
  world::ObjectModel Unknown(Rng* rng) const;
  void Furnish(Rng* rng, world::World* world, RandomTable* table) const;
  Scene Lay(Rng* rng, RandomTable* table) const;

  robot::Robot robot;
  TableVariety variety;
  std::vector<KnownModel> known;
};

RandomTables::RandomTables(robot::Robot robot, const RecogniserConfig& known,
                           const TableVariety& variety)
    : impl_(std::make_unique<Impl>()) {
  if (!robot.profile.upper_body) {
    throw base::ConfigError("robot '" + robot.model.name +
                            "' has no camera on a head (upper_body in its profile)");
  }
  for (const char* torso : kTorso) {
    if (robot.profile.upper_body->torso_postures.count(torso) > 0) continue;
    throw base::ConfigError("robot '" + robot.model.name + "' has no posture '" + torso +
                            "' (torso in its profile); add it");
  }
  impl_->robot = std::move(robot);
  impl_->variety = variety;
  impl_->known = NoLargerThan(known.params.max_extent, known.catalogue);
}
const std::vector<KnownModel>& RandomTables::catalogue() const { return impl_->known; }
RandomTables::~RandomTables() = default;

/// A box or a cylinder that is no known thing, however it is turned.
world::ObjectModel RandomTables::Impl::Unknown(Rng* rng) const {
  world::ObjectModel model = *known.front().model;
  model.collisions.resize(1);
  for (;;) {
    const double height = rng->Uniform(0.05, 0.3);
    model.collisions[0].X_BS.translation = {0.0, 0.0, height / 2.0};
    if (rng->Bernoulli(0.5)) {
      model.collisions[0].shape =
          geometry::Box{{rng->Uniform(0.05, 0.25), rng->Uniform(0.05, 0.25), height}};
    } else {
      model.collisions[0].shape = geometry::Cylinder{rng->Uniform(0.02, 0.11), height};
    }
    const Vector3d size = SortedSize(model);
    if (std::all_of(known.begin(), known.end(), [&](const KnownModel& one) {
          return (SortedSize(*one.model) - size).cwiseAbs().maxCoeff() > kUnlike;
        })) {
      return model;
    }
  }
}

void RandomTables::Impl::Furnish(Rng* rng, world::World* world, RandomTable* table) const {
  const int num_things = 1 + rng->Index(kMostThings);
  std::vector<geometry::Polygon> outlines;
  for (int i = 0; i < num_things; ++i) {
    TableThing thing;
    thing.name = "thing" + std::to_string(i);
    thing.is_known = !rng->Bernoulli(kUnknownShare);
    world::ObjectModel model =
        thing.is_known ? *known[rng->Index(static_cast<int>(known.size()))].model : Unknown(rng);
    if (!thing.is_known) model.name = thing.name + "_model";
    thing.model = model.name;
    thing.size = BoundsOf(model).upper - BoundsOf(model).lower;
    thing.middle = 0.5 * (BoundsOf(model).upper + BoundsOf(model).lower);
    for (int attempt = 0; attempt < 30; ++attempt) {
      const geometry::Pose2 X_MO{rng->Uniform(-0.5, 0.5) * (variety.table.x() - 0.3),
                                 rng->Uniform(-0.5, 0.5) * (variety.table.y() - 0.3),
                                 rng->Uniform(-geometry::kPi, geometry::kPi)};
      const geometry::Polygon outline = OutlineOf(model, X_MO, 0.5 * variety.gap);
      if (std::any_of(outlines.begin(), outlines.end(), [&](const geometry::Polygon& other) {
            return geometry::Distance(outline, other) <= 0.0;
          })) {
        continue;
      }
      outlines.push_back(outline);
      world->models[model.name] = std::make_shared<world::ObjectModel>(model);
      world::ObjectState state;
      state.name = thing.name;
      state.model = model.name;
      state.X_MO = geometry::Lift(X_MO, variety.table.z());
      world->initial.objects.push_back(state);
      table->things.push_back(thing);
      break;
    }
  }
}

/// A table with things, and a camera on it from in front of its long side, over which things are
/// 0.4 m to 1.5 m deep.
Scene RandomTables::Impl::Lay(Rng* rng, RandomTable* table) const {
  world::World world;
  world.statics.emplace_back();
  world.statics.back().name = "table";
  world.statics.back().X_MB.translation.z() = variety.table.z() / 2.0;
  world.statics.back().collisions.emplace_back();
  world.statics.back().collisions.back().shape = geometry::Box{variety.table};
  Furnish(rng, &world, table);

  table->torso = rng->Index(static_cast<int>(std::size(kTorso)));
  const robot::UpperBodyProfile& body = *robot.profile.upper_body;
  robot::JointPositions posture = robot.profile.joints;
  posture[body.torso_joint] = body.torso_postures.at(kTorso[table->torso]);
  const geometry::Pose2 X_MB{rng->Uniform(-0.4, 0.4), rng->Uniform(-variety.farthest, -0.8),
                             geometry::kPi / 2};
  const Vector3d middle(rng->Uniform(-0.2, 0.2), rng->Uniform(-0.1, 0.1), variety.table.z());
  TurnHead(robot, X_MB, middle, &posture);

  Scene scene;
  scene.objects = world.initial.objects;
  scene.surroundings = std::make_shared<const Surroundings>(world);
  scene.robot_M = ShapesOf(robot, X_MB, posture);
  scene.view = ViewOf(robot, X_MB, posture);
  scene.camera = CameraOf(kWidth, kHeight, body.camera_width);
  scene.camera.X_MC = scene.view.X_MC;
  table->distance = (scene.view.X_MC.translation - middle).norm();
  const Pose3 X_BM = geometry::Lift(X_MB).Inverse();
  table->X_BC = X_BM * scene.camera.X_MC * OpticalFrame();
  table->robot_B = scene.robot_M;
  for (geometry::Collision& shape : table->robot_B) shape.X_BS = X_BM * shape.X_BS;
  return scene;
}

/// What is hidden too much is not there.
void TakeHiddenAway(double most_hidden, Scene* scene, RandomTable* table) {
  for (bool is_settled = false; !is_settled;) {
    is_settled = true;
    const LineOfSight sight = scene->Sight();
    for (std::size_t i = 0; i < scene->objects.size(); ++i) {
      const VisiblePart part = sight.Visible(scene->view, scene->objects[i].name);
      table->things[i].view = LookAtThing(sight, scene->view, scene->objects, i, part);
      if (part.share >= 1.0 - most_hidden) continue;
      scene->objects.erase(scene->objects.begin() + static_cast<long>(i));
      table->things.erase(table->things.begin() + static_cast<long>(i));
      is_settled = false;
      break;
    }
  }
}

/// Whose surface each pixel shows.
void NoteOwners(const RangePicture& picture, const DepthSensorParams& sensor, RandomTable* table) {
  std::vector<int> thing_of(picture.names.size(), -1);
  for (std::size_t i = 0; i < picture.names.size(); ++i)
    for (std::size_t k = 0; k < table->things.size(); ++k)
      if (picture.names[i] == table->things[k].name) thing_of[i] = static_cast<int>(k);
  table->owner.assign(picture.owner.size(), -1);
  for (std::size_t i = 0; i < picture.owner.size(); ++i) {
    if (picture.owner[i] == RangePicture::kNothing) continue;
    table->owner[i] = thing_of[picture.owner[i]];
    const bool in_range =
        picture.depth[i] >= sensor.min_range && picture.depth[i] <= sensor.max_range;
    if (table->owner[i] >= 0 && in_range) ++table->things[table->owner[i]].num_points;
  }
}

/// The same at all looks from one stand.
Pose3 MountError(const TableVariety& variety, Rng* rng) {
  const auto draw = [&](double sd) {
    const double x = rng->Normal(0.0, sd), y = rng->Normal(0.0, sd), z = rng->Normal(0.0, sd);
    return Vector3d(x, y, z);
  };
  const Vector3d turn = draw(variety.mount_angle);
  return {draw(variety.mount_position), geometry::RotationFromRpy(turn.x(), turn.y(), turn.z())};
}

RandomTable RandomTables::Make(std::uint64_t seed, int look) const {
  RandomTable table;
  Rng rng = Rng(seed).Fork(0);
  Scene scene = impl_->Lay(&rng, &table);
  TakeHiddenAway(impl_->variety.most_hidden, &scene, &table);
  const Pose3 X_CM = (scene.camera.X_MC * OpticalFrame()).Inverse();
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    table.things[i].X_CO = X_CM * scene.objects[i].X_MO;
  const RangePicture picture = scene.Sight().Look(scene.camera, kSight);
  DepthSensorParams sensor;
  sensor.min_range = scene.view.min_range;
  sensor.max_range = scene.view.max_range;
  NoteOwners(picture, sensor, &table);
  Rng noise = Rng(seed).Fork(1 + static_cast<std::uint64_t>(look));
  table.cloud = Measure(picture, scene.camera, sensor, &noise);
  Rng mount = Rng(seed).Fork(kMountStream);
  table.X_BCknown = table.X_BC * MountError(impl_->variety, &mount);
  table.stand = {table.X_BCknown.rotation.conjugate() * Vector3d::UnitZ(),
                 table.X_BCknown.translation.z()};
  return table;
}

TabletopView LookAtTable(std::shared_ptr<const Recogniser> recogniser, const RandomTable& table,
                         const robot::Robot& robot, const base::Rng& rng) {
  TabletopRecogniser eye(std::move(recogniser), {});
  auto view = eye.Look(table.cloud, table.X_BCknown, table.robot_B, robot.profile.tray_link, rng);
  if (view) return std::move(*view);
  TabletopView nothing;
  nothing.thing_of.assign(table.cloud.points.size(), -1);
  return nothing;
}

}  // namespace hires::perception
