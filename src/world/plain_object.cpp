#include "world/plain_object.h"

#include <filesystem>

#include "hires/base/param_reader.h"

namespace hires::world {
namespace {

using base::Between;

constexpr double kSmallest = 0.001, kLargest = 10.0;  // [m]

template <typename Solid>
void Fill(const Solid& solid, double height, double mass, ObjectModel* model) {
  model->mass_properties.mass = mass;
  model->mass_properties.I_BBcm = geometry::SolidInertia(solid, mass);
  geometry::Collision collision;
  collision.name = "body";
  collision.shape = solid;
  collision.X_BS.translation.z() = height / 2.0;
  model->collisions.push_back(std::move(collision));
}

}  // namespace

ObjectModel LoadPlainObject(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  ObjectModel model;
  model.name = std::filesystem::path(path).stem().string();
  const std::string shape = in.Get("shape", base::OneOf({"cylinder", "box"}));
  const double height = in.Get("height", Between(kSmallest, kLargest));
  const double mass = in.Get("mass", Between(0.0001, 1000.0));
  if (shape == "cylinder") {
    const double radius = in.Get("radius", Between(kSmallest, kLargest));
    Fill(geometry::Cylinder{radius, height}, height, mass, &model);
  } else {
    const double depth = in.Get("depth", Between(kSmallest, kLargest));
    const double width = in.Get("width", Between(kSmallest, kLargest));
    Fill(geometry::Box{{depth, width, height}}, height, mass, &model);
  }
  double& com_height = model.mass_properties.p_BBcm.z();
  com_height = height / 2.0;
  if (in.Has("com_height")) com_height = in.Get("com_height", Between(0.0, height));
  if (in.Has("friction")) {
    model.collisions.front().friction = in.Get("friction", Between(0.0, 10.0));
  }
  in.RejectUnknownKeys();
  return model;
}

}  // namespace hires::world
