#include "lab/src/series/world_file.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <locale>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using knowledge::PoseMove;
using tinyxml2::XMLElement;

std::string NameOf(const XMLElement& element) {
  if (std::strcmp(element.Name(), "include") == 0) {
    const XMLElement* name = element.FirstChildElement("name");
    return name == nullptr || name->GetText() == nullptr ? "" : name->GetText();
  }
  const char* name = element.Attribute("name");
  return name == nullptr ? "" : name;
}

bool IsThing(const XMLElement& element) {
  const std::string kind = element.Name();
  return kind == "include" || kind == "model" || kind == "frame";
}

bool IsRelative(const XMLElement& element, const char* attribute) {
  const char* frame = element.Attribute(attribute);
  return frame != nullptr && *frame != '\0' && std::strcmp(frame, "world") != 0;
}

}  // namespace

geometry::Pose3 Moved(const geometry::Pose3& X_MB, const std::vector<PoseMove>& moves) {
  geometry::Pose3 moved = X_MB;
  for (const PoseMove& move : moves) {
    knowledge::MovePoint(move, &moved.translation.x(), &moved.translation.y());
    moved.translation.z() += move.z;
    if (move.yaw == 0.0) continue;
    moved.rotation = geometry::RotationFromRpy(0.0, 0.0, move.yaw) * moved.rotation;
  }
  return moved;
}

geometry::Pose2 Moved(const geometry::Pose2& X_MB, const std::vector<PoseMove>& moves) {
  geometry::Pose2 moved = X_MB;
  for (const PoseMove& move : moves) {
    knowledge::MovePoint(move, &moved.x, &moved.y);
    moved.yaw += move.yaw;
  }
  return moved;
}

WorldFile::WorldFile(const std::string& path) : path_(path) {
  const std::string ending = base::ToLower(fs::path(path).extension().string());
  if (ending == ".yaml" || ending == ".yml") return;
  const std::string text = base::ReadTextFile(path);
  document_ = std::make_unique<tinyxml2::XMLDocument>();
  if (document_->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw base::ConfigError(
        fmt::format("{}:{}: {}", path, document_->ErrorLineNum(), document_->ErrorStr()));
  }
  XMLElement* root = document_->FirstChildElement("sdf");
  XMLElement* world = root == nullptr ? nullptr : root->FirstChildElement("world");
  if (world == nullptr) throw base::ConfigError(path + ": has no <world> in an <sdf>");
  for (XMLElement* each = world->FirstChildElement(); each != nullptr;
       each = each->NextSiblingElement()) {
    const std::string name = IsThing(*each) ? NameOf(*each) : "";
    if (!name.empty()) things_[base::ToLower(name)] = each;
  }
}

std::vector<std::string> WorldFile::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, element] : things_) names.push_back(NameOf(*element));
  return names;
}

bool WorldFile::IsFrame(const std::string& name) const {
  return std::strcmp(things_.at(name)->Name(), "frame") == 0;
}

void WorldFile::Fail(const XMLElement& element, const std::string& what) const {
  throw base::ConfigError(
      fmt::format("{}:{}: <{}>: {}", path_, element.GetLineNum(), element.Name(), what));
}

XMLElement* WorldFile::PoseElementOf(const std::string& name) const {
  XMLElement* thing = things_.at(name);
  XMLElement* pose = thing->FirstChildElement("pose");
  if (IsRelative(*thing, "attached_to") || (pose != nullptr && IsRelative(*pose, "relative_to"))) {
    Fail(*thing,
         fmt::format("'{}' stands in the frame of something else, and would be moved twice; "
                     "attach it to the world",
                     NameOf(*thing)));
  }
  return pose;
}

std::vector<double> WorldFile::NumbersOf(const std::string& name) const {
  const XMLElement* pose = PoseElementOf(name);
  std::vector<double> numbers(6, 0.0);
  if (pose == nullptr) return numbers;
  std::istringstream in(pose->GetText() == nullptr ? "" : pose->GetText());
  in.imbue(std::locale::classic());
  for (double& number : numbers) in >> number;
  const bool is_plain = !in.fail() && (in >> std::ws).eof() &&
                        pose->Attribute("degrees") == nullptr &&
                        pose->Attribute("rotation_format") == nullptr;
  if (!is_plain) Fail(*pose, "wanted x y z roll pitch yaw [m, rad], to be able to move it");
  return numbers;
}

geometry::Pose3 WorldFile::PoseOf(const std::string& name) const {
  const std::vector<double> n = NumbersOf(name);
  return {{n[0], n[1], n[2]}, geometry::RotationFromRpy(n[3], n[4], n[5])};
}

void WorldFile::Move(const std::string& name, const std::vector<PoseMove>& moves) {
  std::vector<double> n = NumbersOf(name);
  for (const PoseMove& move : moves) {
    knowledge::MovePoint(move, &n[0], &n[1]);
    n[2] += move.z;
    n[5] += move.yaw;  // fixed axes: yaw comes last
  }
  XMLElement* pose = PoseElementOf(name);
  if (pose == nullptr) pose = things_.at(name)->InsertNewChildElement("pose");
  pose->SetText(fmt::format("{}", fmt::join(n, " ")).c_str());
}

std::string WorldFile::WriteTo(const std::string& folder) const {
  if (document_ == nullptr) return path_;
  tinyxml2::XMLPrinter printer;
  document_->Print(&printer);
  const fs::path models = fs::absolute(path_).parent_path() / "models";
  const fs::path link = fs::path(folder) / "models";
  std::error_code ignored;
  fs::remove(link, ignored);
  if (fs::is_directory(models)) fs::create_directory_symlink(models, link);
  const std::string file = folder + "/" + fs::path(path_).filename().string();
  base::ReplaceTextFile(file, printer.CStr());
  return file;
}

}  // namespace hires::lab
