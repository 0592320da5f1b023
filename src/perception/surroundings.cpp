#include "hires/perception/surroundings.h"

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/world/unknown_box.h"
#include "perception/shape_mesh.h"
#include "perception/surroundings_impl.h"

namespace hires::perception {

Surroundings::Surroundings(const world::World& world) : impl_(std::make_unique<Impl>()) {
  for (const world::StaticBody& body : world.statics) {
    const int owner = static_cast<int>(impl_->static_names.size());
    impl_->static_names.push_back(body.name);
    for (const geometry::Collision& collision : body.collisions) {
      impl_->library.Add(collision.shape);
      impl_->statics.Add(impl_->library, collision.shape, body.X_MB * collision.X_BS, owner);
    }
  }
  impl_->statics.Commit();
  for (const auto& [name, model] : world.models) {
    for (const geometry::Collision& collision : model->collisions) {
      impl_->library.Add(collision.shape);
    }
    impl_->models[name] = {model, SurfacePattern(model->collisions)};
  }
}

Surroundings::~Surroundings() = default;

const Surroundings::Impl::Model& Surroundings::Impl::Require(const std::string& model) const {
  const auto found = models.find(model);
  if (found != models.end()) return found->second;
  if (world::SaysUnknownBox(model)) {
    const std::lock_guard<std::mutex> lock(boxes_mutex);
    const auto box = boxes.find(model);
    if (box != boxes.end()) return box->second;
    const auto made = std::make_shared<const world::ObjectModel>(world::MakeUnknownBox(model));
    return boxes.emplace(model, Model{made, SurfacePattern(made->collisions)}).first->second;
  }
  std::vector<std::string> known;
  for (const auto& [name, unused] : models) known.push_back(name);
  throw base::ConfigError(base::UnknownName("object model", model, known));
}

const world::ObjectModel& Surroundings::Model(const std::string& model) const {
  return *impl_->Require(model).description;
}

bool Surroundings::Has(const std::string& model) const {
  return impl_->models.count(model) > 0 || world::SaysUnknownBox(model);
}

const std::vector<SurfacePoint>& Surroundings::Surface(const std::string& model) const {
  return impl_->Require(model).surface;
}

}  // namespace hires::perception
