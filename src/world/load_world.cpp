#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <locale>
#include <optional>
#include <sdf/Frame.hh>
#include <sdf/Model.hh>
#include <sdf/World.hh>
#include <set>
#include <sstream>

#include "base/files/model_folders.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/world/world.h"
#include "world/content_hash.h"
#include "world/floor_level.h"
#include "world/load_world_in_parts.h"
#include "world/mend_object.h"
#include "world/plain_object.h"
#include "world/sdf/model_folders.h"
#include "world/sdf_file.h"
#include "world/sdf_model.h"
#include "world/urdf_object.h"

namespace hires::world {
namespace {

constexpr std::size_t kMaxShapes = 50'000;        // that stand, of all models together
constexpr std::size_t kMaxTriangles = 2'000'000;  // of their meshes
constexpr char kExtent[] = "hires:extent";
constexpr std::size_t kModelsPerPart = 64;  // some 30 MB of libsdformat's

bool ComesBefore(const std::string& a, const std::string& b) {
  return base::ToLower(a) < base::ToLower(b);
}

/// A model of the file, as far as a world holds it.
struct WorldModel {
  std::string name;
  std::string where;  ///< for messages
  std::string place;  ///< "hall.world:12"
  geometry::Pose3 X_MB;
  StaticShapes shapes;                ///< of what is still
  std::optional<ObjectModel> object;  ///< what can move, under the name that its kind should have
};

/// The model folder that an <include> names, else the model's own name.
std::string NameOfKind(const sdf::Model& model) {
  const sdf::ElementPtr include = model.Element()->GetIncludeElement();
  if (include == nullptr) return model.Name();
  const std::string uri = include->Get<std::string>("uri");
  const std::string stem = uri.rfind("http", 0) == 0 ? FuelNameOf(uri).model
                                                     : std::filesystem::path(uri).stem().string();
  return stem.empty() ? model.Name() : stem;
}

/// What a <frame> says of where things stand on it.
std::optional<Eigen::AlignedBox2d> ExtentIn(sdf::Element& frame, const std::string& where) {
  if (!frame.HasElement(kExtent)) return std::nullopt;
  const std::string text = frame.GetElement(kExtent)->Get<std::string>();
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Eigen::AlignedBox2d extent;
  in >> extent.min().x() >> extent.min().y() >> extent.max().x() >> extent.max().y();
  const bool is_read = !in.fail() && (in >> std::ws).eof();
  const double farthest = is_read ? std::max(-extent.min().minCoeff(), extent.max().maxCoeff()) : 0;
  if (is_read && extent.contains(Eigen::Vector2d::Zero()) && farthest <= kMaxDistance) {
    return extent;
  }
  throw base::ConfigError(
      fmt::format("{}: <{}> is '{}', wanted 'xmin ymin xmax ymax' [m] round the frame's origin: "
                  "minima of at most 0, maxima of at least 0, none farther than {} m",
                  where, kExtent, text, kMaxDistance));
}

/// Puts an SDF world together from its parts (see ReadSdfWorld).
class WorldBuilder {
 public:
  WorldBuilder(const ResourceFinder* finder, const std::vector<WorldJoint>& joints,
               LoadNotes* notes)
      : reading_{*finder, &meshes_, notes}, joints_(joints), notes_(notes) {
    FindHolds();
  }

  void Add(const SdfWorldPart& part, const std::string& path) {
    const sdf::World& in = part.world;
    if (part.is_first) Try([&] { SetGravity(in, path); });
    for (std::uint64_t i = 0; i < in.ModelCount(); ++i) {
      Try([&] { models_[part.places[i]] = WorldModelOf(*in.ModelByIndex(i)); });
      CheckSize(models_[part.places[i]], path);
    }
    if (!part.is_first) return;
    world_.name = in.Name();
    for (std::uint64_t i = 0; i < in.FrameCount(); ++i) {
      Try([&] { AddFrame(*in.FrameByIndex(i)); });
    }
  }

  /// Models keep the order of the file till here, as names of kinds depend on it. What comes out is
  /// in the order of names, so that the layout of the file changes no result.
  World Finish(const std::string& path, const std::vector<NamedArea>& more_areas) {
    NoteUselessJoints();
    for (auto& [place, model] : models_) {
      Try([&] { Place(std::move(model)); });
    }
    if (!has_near_ && !far_.empty()) notes_->AddProblem(far_);
    for (const Area& area : areas_) {
      Try([&] { Place(area); });
    }
    notes_->ThrowIfProblems(path);
    for (const std::string& note : notes_->Sentences()) {
      world_.notes.push_back(note);
      base::Log(base::LogLevel::kWarn, fmt::format("world={} note=\"{}\"", world_.name, note));
    }
    const auto by_name = [](const auto& a, const auto& b) { return ComesBefore(a.name, b.name); };
    std::sort(world_.statics.begin(), world_.statics.end(), by_name);
    std::sort(world_.initial.objects.begin(), world_.initial.objects.end(), by_name);
    for (const std::string& doubt : meshes_.Doubts()) world_.notes.push_back(doubt);
    world_.hash = world_.ComputeHash();
    return OnItsFloor(std::move(world_), floor_, more_areas);
  }

 private:
  /// What is wrong with one thing is no reason not to look at the others.
  template <typename Action>
  void Try(Action action) {
    try {
      action();
    } catch (const base::ConfigError& error) {
      notes_->AddProblem(error.what());
    }
  }

  struct Area {
    std::string name;
    std::string where;  ///< for messages
    std::string model;  ///< whose part it is, or ""
    geometry::Pose3 X_MF;
    std::optional<Eigen::AlignedBox2d> extent;
  };

  /// A mesh that is placed a hundred times is gone through a hundred times.
  void CheckSize(const WorldModel& model, const std::string& path) {
    num_shapes_ += model.shapes.collisions.size();
    for (const geometry::Collision& collision : model.shapes.collisions) {
      const auto* mesh =
          std::get_if<std::shared_ptr<const geometry::TriangleMesh>>(&collision.shape);
      if (mesh != nullptr) num_triangles_ += (*mesh)->triangles.size();
    }
    if (num_shapes_ <= kMaxShapes && num_triangles_ <= kMaxTriangles) return;
    throw base::ConfigError(fmt::format(
        "{}: up to model '{}' there are {} collision shapes and {} triangles of meshes, at most {} "
        "and {} are loaded; replace meshes by boxes, or leave models out",
        path, model.name, num_shapes_, num_triangles_, kMaxShapes, kMaxTriangles));
  }

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
    constexpr double kEarths = 9.81, kOff = 0.1;  // [m/s^2] what worlds of the Earth differ by
    if (std::abs(world_.gravity - kEarths) <= kOff) return;
    notes_->Add("world",
                fmt::format("whose <gravity> is {:g} m/s^2: all falls and tips by that, as nothing "
                            "does on Earth",
                            world_.gravity),
                fmt::format("{} '{}'", path, in.Name()));
  }

  WorldModel WorldModelOf(const sdf::Model& model) {
    WorldModel result;
    result.name = model.Name();
    result.where = Where(model);
    result.place = PlaceOf(model.Element());
    result.X_MB = PoseIn(model.SemanticPose(), "", result.where, kMaxWritten);
    PlayedModel played = PlayedModelOf(model, result.X_MB, HoldOf(model), reading_);
    result.shapes = std::move(played.shapes);
    result.object = std::move(played.object);
    if (result.object) {
      result.object->name = NameOfKind(model);
    }
    return result;
  }

  /// What the world's own joints do with a model.
  Hold HoldOf(const sdf::Model& model) const {
    const auto held = holds_.find(model.Name());
    return held == holds_.end() ? Hold::kNone : held->second;
  }

  void FindHolds() {
    for (const WorldJoint& joint : joints_) {
      const std::string parent = ModelIn(joint.parent), child = ModelIn(joint.child);
      const bool is_to_world = parent == "world" || child == "world";
      for (const std::string& name : {parent, child}) {
        Hold& hold = holds_.emplace(name, Hold::kJoint).first->second;
        if (joint.is_fixed && is_to_world) hold = Hold::kFixed;
      }
    }
  }

  void NoteUselessJoints() const {
    std::set<std::string> known{"world"};
    for (const auto& [place, model] : models_) known.insert(model.name);
    for (const WorldJoint& joint : joints_) {
      if (known.count(ModelIn(joint.parent)) > 0 && known.count(ModelIn(joint.child)) > 0) continue;
      notes_->Add("joint",
                  "of the world that names no model of it at one end: that end is left out",
                  joint.place);
    }
  }

  /// "door" of "door::leaf".
  static std::string ModelIn(const std::string& name) { return name.substr(0, name.find("::")); }

  void AddFrame(const sdf::Frame& frame) {
    Area area;
    area.name = frame.Name();
    area.where = fmt::format("{}: frame '{}'", PlaceOf(frame.Element()), frame.Name());
    std::string body;
    ThrowIfAny(frame.ResolveAttachedToBody(body), area.where);
    area.model = body.substr(0, body.find("::"));
    area.X_MF = PoseIn(frame.SemanticPose(), "world", area.where);
    area.extent = ExtentIn(*frame.Element(), area.where);
    areas_.push_back(std::move(area));
  }

  /// Names live in one space, case ignored, as plans and knowledge spell them differently.
  void ClaimName(const std::string& name, const std::string& where) {
    const auto [claimed, is_new] = names_.emplace(base::ToLower(name), where);
    if (is_new) return;
    throw base::ConfigError(
        fmt::format("{}: has the name of another (case does not count): {}; rename one", where,
                    claimed->second));
  }

  /// What lies so far away is no part of what is imagined, as mountains behind a town. Where
  /// nothing is left, it is the origin that lies far away.
  void LeaveOutFar(WorldModel* model) {
    const auto is_far = [&](const geometry::Collision& shape) {
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, model->X_MB * shape.X_BS);
      const Eigen::Vector3d nearest =
          Eigen::Vector3d::Zero().cwiseMax(bounds.lower).cwiseMin(bounds.upper);
      return nearest.norm() > kMaxDistance;
    };
    std::vector<geometry::Collision>& shapes =
        model->object ? model->object->collisions : model->shapes.collisions;
    const auto left = std::remove_if(shapes.begin(), shapes.end(), is_far);
    const bool is_some = left != shapes.end(), is_all = left == shapes.begin();
    if (!is_some || (model->object && !is_all)) {  // a thing is played whole
      has_near_ = has_near_ || !shapes.empty();
      return;
    }
    notes_->Add("model",
                fmt::format("farther than {} m from the origin, or with parts that are: what is "
                            "so far away is left out",
                            kMaxDistance),
                fmt::format("{} '{}'", model->place, model->name));
    const Eigen::Vector3d p = model->X_MB * shapes.front().X_BS.translation;
    if (far_.empty()) {
      far_ = fmt::format(
          "{}: lies at ({:g}, {:g}, {:g}) m, farther than {:g} m from the origin, as all that "
          "stands does; move the origin closer",
          model->where, p.x(), p.y(), p.z(), kMaxDistance);
    }
    has_near_ = has_near_ || !is_all;
    shapes.erase(left, shapes.end());
  }

  /// Nobody asks for an obstacle by its name, so it may get another one.
  void ClaimObstacle(WorldModel* model) {
    const std::string wanted = model->name;
    const auto is_taken = [&] { return names_.count(base::ToLower(model->name)) > 0; };
    if (is_taken() && obstacles_.count(base::ToLower(wanted)) > 0) {
      for (int i = 2; is_taken(); ++i) model->name = fmt::format("{}_{}", wanted, i);
    }
    ClaimName(model->name, model->where);
    obstacles_.insert(base::ToLower(model->name));
  }

  void Place(WorldModel model) {
    if (model.object) {
      ClaimName(model.name, model.where);
    } else {
      ClaimObstacle(&model);
    }
    LeaveOutFar(&model);
    if (model.object && model.object->collisions.empty()) return;
    if (model.object) {
      world_.initial.objects.push_back(
          {model.name, Share(*std::move(model.object)), model.X_MB, {}, ""});
      world_.sources[model.name] = model.place;  // as of what is static
      return;
    }
    for (const FloorPlane& floor : model.shapes.floors) AddFloor(floor);
    if (model.shapes.collisions.empty()) return;  // a floor, or there to be looked at only
    world_.statics.push_back({model.name, model.X_MB, std::move(model.shapes.collisions)});
    const StaticBody& body = world_.statics.back();
    for (const geometry::Collision& shape : body.collisions)
      world_.sources[NameOf(body, shape)] =
          model.shapes.places[shape.name] + meshes_.DoubtAbout(shape.shape);
  }

  /// The highest plane is the floor: nothing gets below it.
  void AddFloor(const FloorPlane& plane) {
    constexpr double kSame = 1e-6;  // [m]
    if (floor_) {
      const bool is_same = std::abs(plane.height - floor_->height) <= kSame;
      const FloorPlane& lower = plane.height < floor_->height ? plane : *floor_;
      if (!is_same) {
        notes_->Add("plane", "below another one, which is the floor: nothing gets there",
                    lower.where);
      } else if (plane.friction == floor_->friction) {
        notes_->Add("plane", "more at the height of the floor: the same floor", plane.where);
      } else {
        notes_->Add("plane",
                    fmt::format("more at the height of the floor, with friction {} instead of {}: "
                                "the larger one counts",
                                plane.friction, floor_->friction),
                    plane.where);
      }
      if (is_same ? plane.friction <= floor_->friction : plane.height < floor_->height) return;
    }
    floor_ = plane;
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

  void Place(const Area& area) {
    ClaimName(area.name, area.where);
    if (world_.initial.Find(area.model) != nullptr) {
      throw base::ConfigError(
          fmt::format("{}: is attached to '{}', which can move; areas stay where they are: attach "
                      "it to the world or to something <static>",
                      area.where, area.model));
    }
    const std::string lower = base::ToLower(area.name);
    world_.frames[lower] = area.X_MF;
    world_.frame_names[lower] = area.name;
    if (area.extent) world_.extents[lower] = *area.extent;
  }

  MeshCache meshes_;
  ModelReading reading_;
  std::vector<WorldJoint> joints_;
  std::map<std::string, Hold> holds_;  // by model
  LoadNotes* notes_;
  World world_;
  std::map<std::size_t, WorldModel> models_;      // by place in the file
  std::size_t num_shapes_{0}, num_triangles_{0};  // of what stands
  std::vector<Area> areas_;
  std::string far_;       // what is wrong if nothing is near
  bool has_near_{false};  // anything that stands or is loose
  std::optional<FloorPlane> floor_;
  std::map<std::string, std::string> names_;    // lower case -> where
  std::set<std::string> obstacles_;             // names that what stands has, lower case
  std::map<std::uint64_t, std::string> kinds_;  // hash of an object model -> its key
  std::set<std::string> kind_names_;            // lower case
};

ObjectModel LoadSdfObject(const std::string& path, const ResourceFinder& finder, LoadNotes* notes) {
  const std::optional<sdf::Root> root = ReadSdf(path, finder, notes);
  notes->ThrowIfProblems(path);
  const sdf::Model* model = root ? root->Model() : nullptr;
  if (model == nullptr) {
    throw base::ConfigError(
        fmt::format("{}: has no <model> at its top; an object file holds one", path));
  }
  if (model->Static()) {
    throw base::ConfigError(fmt::format(
        "{}: is <static>, so it is no object; remove <static>, or include it in a world",
        Where(*model)));
  }
  MeshCache meshes;
  ObjectModel object = LooseObjectOf(*model, {finder, &meshes, notes});
  object.notes = meshes.Doubts();
  return object;
}

/// What it is called in requests and plans, which know letters, digits and _ alone: others become
/// _.
std::string PlainName(const std::string& name) {
  std::string plain;
  for (const unsigned char letter : name) {
    const bool is_plain = std::isalnum(letter) != 0 || letter == '_';
    if (is_plain || plain.empty() || plain.back() != '_')
      plain += is_plain ? static_cast<char>(letter) : '_';
  }
  return plain;
}

ObjectModel ReadObject(const std::string& path, LoadNotes* notes) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  // Models stand beside each other: model://other is found from models/this/model.sdf.
  const ResourceFinder finder(base::ModelFoldersFor(path, {folder.parent_path().string()}));
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  if (ending == ".urdf") return LoadUrdfObject(path, finder, notes);
  if (ending == ".sdf") return LoadSdfObject(path, finder, notes);
  if (ending == ".yaml") return LoadPlainObject(path);
  throw base::ConfigError(fmt::format(
      "{}: an object file ends in .sdf, .urdf or .yaml, or is a folder with a model.sdf; "
      "rename or convert it",
      path));
}

/// @param path  a file, or a model's folder as Gazebo has it.
ObjectModel LoadObjectOf(const std::string& path, LoadNotes* notes) {
  const std::filesystem::path in_folder = std::filesystem::path(path) / "model.sdf";
  ObjectModel object = ReadObject(base::Exists(in_folder) ? in_folder.string() : path, notes);
  const std::string plain = PlainName(object.name);
  if (plain == object.name) return object;
  notes->Add("object",
             fmt::format("whose name has more than letters, digits and _: it is {}", plain),
             fmt::format("{} '{}'", path, object.name));
  object.name = plain;
  return object;
}

}  // namespace

World LoadWorld(const std::string& sdf_path, const std::vector<std::string>& model_path) {
  return LoadWorldInParts(sdf_path, model_path, kModelsPerPart);
}

World LoadWorldWithAreas(const std::string& sdf_path, const std::vector<NamedArea>& areas) {
  return LoadWorldInParts(sdf_path, {}, kModelsPerPart, areas);
}

World LoadWorldInParts(const std::string& sdf_path, const std::vector<std::string>& model_path,
                       std::size_t models_per_part, const std::vector<NamedArea>& areas) {
  const ResourceFinder finder(base::ModelFoldersFor(sdf_path, model_path));
  LoadNotes notes;
  const SdfFiles files = ReadWorldFiles(sdf_path, finder, &notes);
  WorldBuilder builder(&finder, files.at(sdf_path).world_joints, &notes);
  ReadSdfWorld(files, sdf_path, models_per_part, &notes,
               [&](const SdfWorldPart& part) { builder.Add(part, sdf_path); });
  return builder.Finish(sdf_path, areas);
}

std::string ObjectNameIn(const std::string& path) {
  LoadNotes unsaid;
  return LoadObjectOf(path, &unsaid).name;
}

ObjectModel LoadObjectModel(const std::string& path) {
  LoadNotes notes;
  ObjectModel object = LoadObjectOf(path, &notes);
  const std::string place = fmt::format("{} '{}'", path, object.name);
  const bool is_doubted = !object.notes.empty();  // a mesh by itself
  const std::string large = is_doubted ? "" : DoubtOfSize(object);
  if (!large.empty()) notes.Add("object", large, place);
  for (const std::string& doubt : DoubtsOfMass(object)) notes.Add("object", doubt, place);
  const std::string moved = PutOriginAtUnderside(&object);
  if (!moved.empty()) notes.Add("object", moved, place);
  for (std::string& note : notes.Sentences()) object.notes.push_back(std::move(note));
  for (const std::string& note : object.notes)
    base::Log(base::LogLevel::kWarn, fmt::format("object={} note=\"{}\"", object.name, note));
  return object;
}

}  // namespace hires::world
