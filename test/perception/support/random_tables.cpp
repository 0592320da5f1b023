#include "perception/support/random_tables.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "hires/geometry/angles.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "hires/robot/load_robot.h"
#include "hires/world/object_catalogue.h"

namespace hires::test_support {
namespace {

using base::Rng;
using Eigen::Vector3d;
using geometry::Pose3;

constexpr int kMostThings = 8;
constexpr double kUnknownShare = 0.2;  // of things
constexpr double kUnlike = 0.015;  // [m] by which an unknown one differs from all known, at least
constexpr double kGap = 0.02;      // [m] between things, at least
constexpr double kTorso[] = {0.0115, 0.16, 0.31};  // [m] down, half way, up
const Vector3d kTable(1.6, 0.8, 0.71);             // [m] as the model table_160x80
constexpr double kMostHidden = 0.6;  // of the surface of each thing towards the camera

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

geometry::Polygon OutlineOf(const world::ObjectModel& model, const geometry::Pose2& X_MO) {
  const geometry::Aabb b = BoundsOf(model);
  return geometry::Transformed(X_MO, {{b.lower.x() - kGap / 2, b.lower.y() - kGap / 2},
                                      {b.upper.x() + kGap / 2, b.lower.y() - kGap / 2},
                                      {b.upper.x() + kGap / 2, b.upper.y() + kGap / 2},
                                      {b.lower.x() - kGap / 2, b.upper.y() + kGap / 2}});
}

}  // namespace

struct RandomTables::Impl {
  world::ObjectModel Unknown(Rng* rng) const;
  void Furnish(Rng* rng, world::World* world, RandomTable* table) const;

  robot::Robot robot;
  std::vector<perception::KnownModel> known;
};

RandomTables::RandomTables(const std::string& source) : impl_(std::make_unique<Impl>()) {
  impl_->robot = robot::LoadRobot(source + "/config/robots/pr2.yaml");
  const std::string catalogue = source + "/worlds/objects.yaml";
  std::set<std::string> labels;
  for (const auto& [instance, model] : world::LoadCatalogueModels(catalogue)) {
    if (SortedSize(*model).z() < 0.6 && labels.insert(model->name).second)
      catalogue_.push_back({model->name, "", model});
  }
  impl_->known = catalogue_;
}
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
    if (std::all_of(known.begin(), known.end(), [&](const perception::KnownModel& one) {
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
    for (int attempt = 0; attempt < 30; ++attempt) {
      const geometry::Pose2 X_MO{rng->Uniform(-0.5, 0.5) * (kTable.x() - 0.3),
                                 rng->Uniform(-0.5, 0.5) * (kTable.y() - 0.3),
                                 rng->Uniform(-geometry::kPi, geometry::kPi)};
      const geometry::Polygon outline = OutlineOf(model, X_MO);
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
      state.X_MO = geometry::Lift(X_MO, kTable.z());
      world->initial.objects.push_back(state);
      table->things.push_back(thing);
      break;
    }
  }
}

RandomTable RandomTables::Make(std::uint64_t seed) const {
  RandomTable table;
  Rng rng = Rng(seed).Fork(0);
  world::World world;
  world.statics.emplace_back();
  world.statics.back().name = "table";
  world.statics.back().X_MB.translation.z() = kTable.z() / 2.0;
  world.statics.back().collisions.emplace_back();
  world.statics.back().collisions.back().shape = geometry::Box{kTable};
  impl_->Furnish(&rng, &world, &table);

  table.torso = rng.Index(3);
  robot::JointPositions posture = impl_->robot.profile.joints;
  posture[impl_->robot.profile.upper_body->torso_joint] = kTorso[table.torso];
  // In front of the table's long side, on which things are 0.4 m to 1.5 m deep.
  const geometry::Pose2 X_MB{rng.Uniform(-0.4, 0.4), rng.Uniform(-1.4, -0.8), geometry::kPi / 2};
  const Vector3d eye = perception::ViewOf(impl_->robot, X_MB, posture).X_MC.translation;
  const Vector3d middle(rng.Uniform(-0.2, 0.2), rng.Uniform(-0.1, 0.1), kTable.z());
  perception::PinholeCamera camera = perception::LookAt(eye, middle, 640, 480, 1.0123);
  table.distance = (eye - middle).norm();

  const auto surroundings = std::make_shared<perception::Surroundings>(world);
  std::vector<world::ObjectState> objects = world.initial.objects;
  const Pose3 X_CM = (camera.X_MC * perception::OpticalFrame()).Inverse();
  perception::CameraView view = perception::ViewFrom(impl_->robot, camera.X_MC);
  view.width = 1.0123;
  view.height = 2.0 * std::atan(std::tan(view.width / 2.0) * 0.75);
  for (bool is_settled = false; !is_settled;) {  // what is hidden too much is not there
    is_settled = true;
    const perception::LineOfSight sight(surroundings, objects);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      table.things[i].visible_share = sight.VisibleShare(view, objects[i].name);
      if (table.things[i].visible_share >= 1.0 - kMostHidden) continue;
      objects.erase(objects.begin() + static_cast<long>(i));
      table.things.erase(table.things.begin() + static_cast<long>(i));
      is_settled = false;
      break;
    }
  }
  const perception::LineOfSight sight(surroundings, objects);
  const perception::RangePicture picture = sight.Look(camera, 5.0);
  for (std::size_t i = 0; i < objects.size(); ++i) table.things[i].X_CO = X_CM * objects[i].X_MO;
  std::vector<int> thing_of(picture.names.size(), -1);
  for (std::size_t i = 0; i < picture.names.size(); ++i)
    for (std::size_t k = 0; k < table.things.size(); ++k)
      if (picture.names[i] == table.things[k].name) thing_of[i] = static_cast<int>(k);
  table.owner.assign(picture.owner.size(), -1);
  const perception::DepthSensorParams sensor;
  for (std::size_t i = 0; i < picture.owner.size(); ++i) {
    if (picture.owner[i] == perception::RangePicture::kNothing) continue;
    table.owner[i] = thing_of[picture.owner[i]];
    const bool in_range =
        picture.depth[i] >= sensor.min_range && picture.depth[i] <= sensor.max_range;
    if (table.owner[i] >= 0 && in_range) ++table.things[table.owner[i]].num_points;
  }
  Rng noise = Rng(seed).Fork(1);
  table.cloud = perception::Measure(picture, camera, sensor, &noise);
  table.stand = {X_CM.rotation * Vector3d::UnitZ(), eye.z()};
  return table;
}

}  // namespace hires::test_support
