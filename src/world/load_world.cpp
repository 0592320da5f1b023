#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sdf/Frame.hh>
#include <sdf/Model.hh>
#include <sdf/World.hh>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/world/world.h"
#include "world/content_hash.h"
#include "world/plain_object.h"
#include "world/sdf_file.h"
#include "world/sdf_model.h"
#include "world/urdf_object.h"

namespace hires::world {
namespace {

constexpr std::uint64_t kMaxModels = 5000;

bool ComesBefore(const std::string& a, const std::string& b) {
  return base::ToLower(a) < base::ToLower(b);
}

/// Puts the parts of an SDF world together, one by one.
class WorldBuilder {
 public:
  explicit WorldBuilder(const ResourceFinder* finder) : finder_(finder) {}

  World Build(const sdf::World& in, const std::string& path) {
    world_.name = in.Name();
    SetGravity(in, path);
    CheckNumber(in, path);
    for (std::uint64_t i = 0; i < in.ModelCount(); ++i) AddModel(*in.ModelByIndex(i));
    for (std::uint64_t i = 0; i < in.FrameCount(); ++i) AddFrame(*in.FrameByIndex(i));
    return Finish();
  }

 private:
  void SetGravity(const sdf::World& in, const std::string& path) {
    const auto gravity = in.Gravity();
    const bool is_down = gravity.X() == 0.0 && gravity.Y() == 0.0 && gravity.Z() <= 0.0;
    if (!is_down || gravity.Z() < -100.0) {
      throw base::ConfigError(
          fmt::format("{}: world '{}': <gravity> is ({}, {}, {}) m/s^2, wanted 0 0 -g with g "
                      "between 0 and 100; 0 0 -9.81 is the Earth's",
                      path, in.Name(), gravity.X(), gravity.Y(), gravity.Z()));
    }
    world_.gravity = std::abs(gravity.Z());
  }

  static void CheckNumber(const sdf::World& in, const std::string& path) {
    if (in.ModelCount() <= kMaxModels && in.FrameCount() <= kMaxModels) return;
    throw base::ConfigError(fmt::format(
        "{}: world '{}' has {} models and {} frames, at most {} of each are loaded; join static "
        "models",
        path, in.Name(), in.ModelCount(), in.FrameCount(), kMaxModels));
  }

  /// Names live in one space, case ignored, as plans and knowledge spell them differently.
  void ClaimName(const std::string& name, const std::string& where) {
    const auto [claimed, is_new] = names_.emplace(base::ToLower(name), where);
    if (is_new) return;
    throw base::ConfigError(
        fmt::format("{}: has the name of another (case does not count): {}; rename one", where,
                    claimed->second));
  }

  void AddModel(const sdf::Model& model) {
    const std::string where = Where(model);
    ClaimName(model.Name(), where);
    const geometry::Pose3 X_MB = PoseIn(model.SemanticPose(), "", where);
    if (IsStatic(model)) {
      AddStatic(model, X_MB, where);
    } else {
      AddLoose(model, X_MB);
    }
  }

  void AddStatic(const sdf::Model& model, const geometry::Pose3& X_MB, const std::string& where) {
    StaticShapes shapes = StaticShapesOf(model, X_MB, *finder_, &meshes_);
    if (shapes.floor_friction) SetFloor(*shapes.floor_friction, where);
    if (shapes.collisions.empty()) return;  // a floor, or there to be looked at only
    std::sort(shapes.collisions.begin(), shapes.collisions.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
    world_.statics.push_back({model.Name(), X_MB, std::move(shapes.collisions)});
  }

  void SetFloor(double friction, const std::string& where) {
    if (!floor_.empty()) {
      throw base::ConfigError(
          fmt::format("{}: is a second floor beside {}; keep one plane", where, floor_));
    }
    floor_ = where;
    world_.floor_friction = friction;
  }

  void AddLoose(const sdf::Model& model, const geometry::Pose3& X_MO) {
    ObjectModel object = LooseObjectOf(model, *finder_, &meshes_);
    object.name = NameOfKind(model);
    world_.initial.objects.push_back({model.Name(), Share(std::move(object)), X_MO, {}, ""});
  }

  /// The model folder that an <include> names, else the model's own name.
  static std::string NameOfKind(const sdf::Model& model) {
    const sdf::ElementPtr include = model.Element()->GetIncludeElement();
    if (include == nullptr) return model.Name();
    const std::string uri = include->Get<std::string>("uri");
    const std::string stem = std::filesystem::path(uri).stem().string();
    return stem.empty() ? model.Name() : stem;
  }

  /// The key of an equal model that is there already, or of this one, added.
  std::string Share(ObjectModel object) {
    base::Hasher hasher;
    AddTo(&hasher, object);
    const auto known = kinds_.find(hasher.value());
    if (known != kinds_.end()) return known->second;
    const std::string wanted = object.name;
    for (int i = 2; !kind_names_.insert(base::ToLower(object.name)).second; ++i) {
      object.name = fmt::format("{}_{}", wanted, i);
    }
    const std::string key = object.name;
    kinds_[hasher.value()] = key;
    world_.models[key] = std::make_shared<const ObjectModel>(std::move(object));
    return key;
  }

  void AddFrame(const sdf::Frame& frame) {
    const std::string where = fmt::format("{}: frame '{}'", PlaceOf(frame.Element()), frame.Name());
    ClaimName(frame.Name(), where);
    std::string body;
    ThrowIfAny(frame.ResolveAttachedToBody(body), where);
    if (world_.initial.Find(body.substr(0, body.find("::"))) != nullptr) {
      throw base::ConfigError(
          fmt::format("{}: is attached to '{}', which can move; areas stay where they are: attach "
                      "it to the world or to something <static>",
                      where, body));
    }
    const std::string lower = base::ToLower(frame.Name());
    world_.frames[lower] = PoseIn(frame.SemanticPose(), "world", where);
    world_.frame_names[lower] = frame.Name();
  }

  /// In the order of names, so that the layout of the file changes no result.
  World Finish() {
    const auto by_name = [](const auto& a, const auto& b) { return ComesBefore(a.name, b.name); };
    std::sort(world_.statics.begin(), world_.statics.end(), by_name);
    std::sort(world_.initial.objects.begin(), world_.initial.objects.end(), by_name);
    world_.hash = world_.ComputeHash();
    return std::move(world_);
  }

  const ResourceFinder* finder_;
  MeshCache meshes_;
  World world_;
  std::string floor_;                           // where the floor was found
  std::map<std::string, std::string> names_;    // lower case -> where
  std::map<std::uint64_t, std::string> kinds_;  // hash of an object model -> its key
  std::set<std::string> kind_names_;            // lower case
};

ObjectModel LoadSdfObject(const std::string& path, const ResourceFinder& finder) {
  const sdf::Root root = ReadSdf(path, finder);
  if (root.Model() == nullptr) {
    throw base::ConfigError(
        fmt::format("{}: has no <model> at its top; an object file holds one", path));
  }
  if (root.Model()->Static()) {
    throw base::ConfigError(fmt::format(
        "{}: is <static>, so it is no object; remove <static>, or include it in a world",
        Where(*root.Model())));
  }
  MeshCache meshes;
  return LooseObjectOf(*root.Model(), finder, &meshes);
}

}  // namespace

World LoadWorld(const std::string& sdf_path, const std::vector<std::string>& model_path) {
  const ResourceFinder finder(ModelFoldersFor(sdf_path, model_path));
  const sdf::Root root = ReadSdf(sdf_path, finder);
  if (root.WorldCount() != 1) {
    throw base::ConfigError(
        fmt::format("{}: has {} <world> elements, wanted 1", sdf_path, root.WorldCount()));
  }
  return WorldBuilder(&finder).Build(*root.WorldByIndex(0), sdf_path);
}

ObjectModel LoadObjectModel(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  // Models stand beside each other: model://other is found from models/this/model.sdf.
  const ResourceFinder finder(ModelFoldersFor(path, {folder.parent_path().string()}));
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  if (ending == ".urdf") return LoadUrdfObject(path, finder);
  if (ending == ".sdf") return LoadSdfObject(path, finder);
  if (ending == ".yaml") return LoadPlainObject(path);
  throw base::ConfigError(
      fmt::format("{}: an object file ends in .sdf, .urdf or .yaml; rename or convert it", path));
}

}  // namespace hires::world
