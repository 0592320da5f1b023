#include "world/urdf_object.h"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>

#include "base/files/plain_xml.h"
#include "base/files/urdf_friction.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/console_bridge_capture.h"
#include "world/files/missing_files.h"
#include "world/mend_object.h"
#include "world/sdf_file.h"
#include "world/sdf_model.h"
#include "world/xml_check.h"

namespace hires::world {
namespace {

/// urdfdom refuses a mass without <inertia>: it gets one of no meaning.
/// @return whether nothing lacked.
bool AddInertia(std::string* text) {
  tinyxml2::XMLDocument document;
  document.Parse(text->data(), text->size());
  bool is_said = true;
  tinyxml2::XMLElement* robot = document.RootElement();
  if (robot == nullptr) return true;  // of which others tell
  for (tinyxml2::XMLElement* link = robot->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    tinyxml2::XMLElement* inertial = link->FirstChildElement("inertial");
    if (inertial == nullptr || inertial->FirstChildElement("mass") == nullptr) continue;
    if (inertial->FirstChildElement("inertia") != nullptr) continue;
    is_said = false;
    auto* inertia = inertial->InsertNewChildElement("inertia");
    for (const char* moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1.0);
    for (const char* product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0.0);
  }
  if (is_said) return true;
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  *text = printer.CStr();
  return false;
}

urdf::ModelInterfaceSharedPtr Parse(const std::string& text, const std::string& path) {
  const ConsoleBridgeCapture console;
  std::string thrown;
  try {
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    if (model != nullptr && console.errors().empty()) return model;
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  throw base::ConfigError(
      fmt::format("{}: no valid URDF: {} {}", path, base::Join(console.errors(), "; "), thrown));
}

geometry::Pose3 ToPose(const urdf::Pose& pose, const std::string& where) {
  const urdf::Rotation& q = pose.rotation;
  const geometry::Pose3 result{{pose.position.x, pose.position.y, pose.position.z},
                               Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized()};
  CheckPose(result, where);
  return result;
}

geometry::Shape ShapeOf(const urdf::Geometry& shape, const std::string& path,
                        const ResourceFinder& finder, MeshCache* meshes, const std::string& where) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&shape)) {
    return geometry::Box{{box->dim.x, box->dim.y, box->dim.z}};
  }
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&shape)) {
    return geometry::Cylinder{cylinder->radius, cylinder->length};
  }
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&shape)) {
    return geometry::Sphere{sphere->radius};
  }
  const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape);
  if (mesh == nullptr) {
    throw base::ConfigError(where +
                            ": its shape is not supported; use box, cylinder, sphere, mesh");
  }
  return meshes->Read(finder.FindMesh(mesh->filename, path, where),
                      {mesh->scale.x, mesh->scale.y, mesh->scale.z}, where);
}

geometry::MassProperties MassPropertiesOf(const urdf::Link& link, const std::string& where) {
  if (link.inertial == nullptr) {
    throw base::ConfigError(where + ": has no <inertial>; add mass and inertia");
  }
  const urdf::Inertial& in = *link.inertial;
  const geometry::Pose3 X_BI = ToPose(in.origin, where + ": <inertial>");
  Eigen::Matrix3d I_I;
  I_I << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
  const Eigen::Matrix3d R_BI = X_BI.rotation.toRotationMatrix();
  const geometry::MassProperties result{in.mass, X_BI.translation, R_BI * I_I * R_BI.transpose()};
  const std::string wrong = geometry::WhyUnphysical(result);
  if (wrong.empty()) return result;
  throw base::ConfigError(fmt::format("{}: {}; correct its <inertial>", where, wrong));
}

/// What urdfdom skips.
double FrictionIn(const std::string& text, const std::string& link, const std::string& path,
                  LoadNotes* notes) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const base::UrdfFriction friction = base::ReadUrdfFriction(*document.RootElement());
  for (const base::UrdfFriction::Place& place : friction.wrong) {
    if (place.link != link) continue;
    throw base::ConfigError(fmt::format("{}:{}: <{}> is no number; write a friction coefficient",
                                        path, place.line, place.element));
  }
  for (const base::UrdfFriction::Place& place : friction.endless) {
    if (place.link != link) continue;
    notes->Add("element",
               fmt::format("<{}> that is infinite or negative: {} is taken, by which nothing slips",
                           place.element, base::kNoSlip),
               fmt::format("{}:{} '{}'", path, place.line, link));
  }
  const auto found = friction.of_links.find(link);
  return found == friction.of_links.end() ? geometry::Collision().friction : found->second;
}

std::string CollisionName(const urdf::Collision& collision, std::size_t index) {
  return collision.name.empty() ? fmt::format("collision_{}", index + 1) : collision.name;
}

std::string WhereIs(const urdf::Link& link, const std::string& collision, const std::string& path) {
  return fmt::format("{}: link '{}', collision '{}'", path, link.name, collision);
}

/// All at once.
void RefuseMissingMeshes(const urdf::Link& link, const std::string& path,
                         const ResourceFinder& finder) {
  MissingFiles missing;
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    const urdf::Collision& collision = *link.collision_array[i];
    const auto* mesh = dynamic_cast<const urdf::Mesh*>(collision.geometry.get());
    if (mesh == nullptr) continue;
    const std::string where = WhereIs(link, CollisionName(collision, i), path);
    try {
      finder.FindMesh(mesh->filename, path, where);
    } catch (const base::ConfigError& error) {
      missing.Add(where, error.what());
    }
  }
  missing.ThrowIfAny(path);
}

std::vector<geometry::Collision> CollisionsOf(const urdf::Link& link, double friction,
                                              const std::string& path, const ResourceFinder& finder,
                                              MeshCache* meshes) {
  std::vector<geometry::Collision> collisions;
  RefuseMissingMeshes(link, path, finder);
  for (const urdf::CollisionSharedPtr& in : link.collision_array) {
    const std::string name = CollisionName(*in, collisions.size());
    const std::string where = WhereIs(link, name, path);
    if (in->geometry == nullptr) throw base::ConfigError(where + ": has no <geometry>; add one");
    collisions.push_back({name, ShapeOf(*in->geometry, path, finder, meshes, where),
                          ToPose(in->origin, where), friction, 0.0});
    CheckCollision(collisions.back(), where);
  }
  std::sort(collisions.begin(), collisions.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return collisions;
}

}  // namespace

ObjectModel LoadUrdfObject(const std::string& path, const ResourceFinder& finder,
                           LoadNotes* notes) {
  const XmlLimits limits;
  const std::string text = base::PlainXml(base::ReadTextFile(path, limits.max_file_bytes), path);
  CheckXml(text, path, limits);
  std::string whole = text;
  const bool says_inertia = AddInertia(&whole);
  const urdf::ModelInterfaceSharedPtr model = Parse(whole, path);
  if (model->links_.size() != 1) {
    throw base::ConfigError(
        fmt::format("{}: robot '{}' has {} links; an object is one link without joints: merge them",
                    path, model->getName(), model->links_.size()));
  }
  const urdf::Link& link = *model->links_.begin()->second;
  const std::string where = fmt::format("{}: link '{}'", path, link.name);
  ObjectModel object{model->getName(), MassPropertiesOf(link, where), {}};
  MeshCache meshes("scale=\"{}\"");
  const double friction = FrictionIn(text, link.name, path, notes);
  object.collisions = CollisionsOf(link, friction, path, finder, &meshes);
  object.notes = meshes.Doubts();
  if (object.collisions.empty()) {
    throw base::ConfigError(where +
                            ": has no <collision>, so it would fall through the floor; add one");
  }
  const std::string mended = MendInertia(says_inertia, &object);
  if (!mended.empty()) notes->Add("link", mended, fmt::format("{} '{}'", path, link.name));
  return object;
}

}  // namespace hires::world
