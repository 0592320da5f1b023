#include "hires/world/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "hires/world/unknown_box.h"
#include "world/content_hash.h"

namespace hires::world {
namespace {

std::vector<const StaticBody*> InOrderOfNames(const std::vector<StaticBody>& bodies) {
  std::vector<const StaticBody*> ordered;
  for (const StaticBody& body : bodies) ordered.push_back(&body);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto* a, const auto* b) {
    return base::ToLower(a->name) < base::ToLower(b->name);
  });
  return ordered;
}

}  // namespace

const ObjectState* WorldState::Find(const std::string& name) const {
  const std::string lower = base::ToLower(name);
  const auto found = std::find_if(objects.begin(), objects.end(), [&](const ObjectState& object) {
    return base::ToLower(object.name) == lower;
  });
  return found == objects.end() ? nullptr : &*found;
}

ObjectState* WorldState::Find(const std::string& name) {
  return const_cast<ObjectState*>(static_cast<const WorldState*>(this)->Find(name));
}

std::optional<geometry::Pose3> World::FindFrame(const std::string& name) const {
  const auto found = frames.find(base::ToLower(name));
  if (found == frames.end()) return std::nullopt;
  return found->second;
}

Eigen::AlignedBox2d World::ExtentOf(const std::string& area) const {
  const auto said = extents.find(base::ToLower(area));
  if (said != extents.end()) return said->second;
  return {Eigen::Vector2d::Constant(-kAreaSize / 2), Eigen::Vector2d::Constant(kAreaSize / 2)};
}

std::vector<std::string> World::FrameNames() const {
  std::vector<std::string> names;
  for (const auto& [lower, pose] : frames) {
    const auto as_in_file = frame_names.find(lower);
    names.push_back(as_in_file == frame_names.end() ? lower : as_in_file->second);
  }
  return names;
}

std::shared_ptr<const ObjectModel> World::FindModel(const std::string& model) const {
  const auto found = models.find(model);
  if (found != models.end()) return found->second;
  if (!SaysUnknownBox(model)) return nullptr;
  try {
    return std::make_shared<const ObjectModel>(MakeUnknownBox(model));
  } catch (const base::ConfigError&) {
    return nullptr;
  }
}

std::shared_ptr<const ObjectModel> World::RequireModel(const std::string& model) const {
  if (auto found = FindModel(model)) return found;
  if (SaysUnknownBox(model)) SizeOfUnknownBox(model);  // says what is wrong with it
  std::vector<std::string> known;
  for (const auto& [one, description] : models) known.push_back(one);
  throw base::ConfigError(base::UnknownName("object model", model, known));
}

std::shared_ptr<const ObjectModel> World::ModelOf(const ObjectState& object) const {
  try {
    return RequireModel(object.model);
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(
        fmt::format("object '{}' in world '{}': {}", object.name, name, error.what()));
  }
}

std::uint64_t World::ComputeHash() const {
  base::Hasher hasher;
  hasher.Add(base::ToLower(name));
  hasher.Add(gravity);
  hasher.Add(floor_friction);
  if (ground_depth > 0.0) hasher.Add(ground_depth);
  hasher.Add(static_cast<std::uint64_t>(statics.size()));
  for (const StaticBody* body : InOrderOfNames(statics)) AddTo(&hasher, *body);
  hasher.Add(static_cast<std::uint64_t>(frames.size()));
  for (const auto& [lower, X_MF] : frames) {
    hasher.Add(lower);
    AddTo(&hasher, X_MF);
  }
  hasher.Add(static_cast<std::uint64_t>(extents.size()));
  for (const auto& [lower, extent] : extents) {
    hasher.Add(lower);
    for (const double edge :
         {extent.min().x(), extent.min().y(), extent.max().x(), extent.max().y()}) {
      hasher.Add(edge);
    }
  }
  hasher.Add(static_cast<std::uint64_t>(models.size()));
  for (const auto& [model_name, model] : models) {
    hasher.Add(model_name);
    AddTo(&hasher, *model);
  }
  return hasher.value();
}

std::string NameOf(const StaticBody& body, const geometry::Collision& shape) {
  if (body.collisions.size() == 1 || shape.name.empty()) return body.name;
  return body.name + "::" + shape.name;
}

std::string SourceOf(const std::string& name, const World& world) {
  const auto found = world.sources.find(name);
  return found == world.sources.end() ? "" : found->second;
}

Eigen::AlignedBox2d Inset(const Eigen::AlignedBox2d& extent, double edge) {
  return {(extent.min().array() + edge).min(0.0).matrix(),
          (extent.max().array() - edge).max(0.0).matrix()};
}

World WithModel(World world, ObjectModel model) {
  HIRES_CHECK(!model.name.empty(), "an object model needs a name");
  const std::string lower = base::ToLower(model.name);
  const auto same = std::find_if(world.models.begin(), world.models.end(), [&](const auto& entry) {
    return base::ToLower(entry.first) == lower;
  });
  // The key of the model that is replaced stays, for the objects that name it.
  const std::string key = same == world.models.end() ? model.name : same->first;
  world.models[key] = std::make_shared<const ObjectModel>(std::move(model));
  world.hash = world.ComputeHash();
  return world;
}

}  // namespace hires::world
