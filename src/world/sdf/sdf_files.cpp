#include "world/sdf/sdf_files.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <filesystem>

#include "base/files/plain_xml.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/sdf/check_names.h"
#include "world/sdf/line_printer.h"
#include "world/sdf/pose_chains.h"
#include "world/sdf/prune_sdf.h"
#include "world/sdf/urdf_model.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

void CollectNames(const XMLElement& element, SdfFile* file) {
  file->elements.insert(element.Name());
  ++file->num_elements;
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    CollectNames(*child, file);
  }
}

std::string LastPartOf(const std::string& uri) {
  const std::size_t end = uri.find_last_not_of('/');
  if (end == std::string::npos) return "model";
  const std::size_t slash = uri.rfind('/', end);
  return uri.substr(slash == std::string::npos ? 0 : slash + 1,
                    end - (slash == std::string::npos ? 0 : slash + 1) + 1);
}

/// Keeps the name, so that what counts from it is no second complaint.
void MakeEmptyModel(XMLElement* include) {
  std::string name = TrimmedText(include->FirstChildElement("name"));
  if (name.empty()) name = LastPartOf(TrimmedText(include->FirstChildElement("uri")));
  include->DeleteChildren();
  include->SetName("model");
  include->SetAttribute("name", name.c_str());
  XMLElement* link = include->GetDocument()->NewElement("link");
  link->SetAttribute("name", "hires_missing");
  XMLElement* is_static = include->GetDocument()->NewElement("static");
  is_static->SetText("true");
  include->InsertEndChild(is_static);
  include->InsertEndChild(link);
}

/// Ends the walk: what includes such a file would grow further.
class TooLarge : public base::ConfigError {
 public:
  using base::ConfigError::ConfigError;
};

/// Walks a file and all it includes before libsdformat does, which trusts its input.
class Walk {
 public:
  Walk(const ResourceFinder& finder, const XmlLimits& limits, LoadNotes* notes)
      : finder_(finder), limits_(limits), notes_(notes) {}

  const SdfFile& VisitFile(const std::string& path) {
    CheckIncludes(path);
    const auto known = files_.find(path);
    if (known != files_.end()) return known->second;
    open_files_.push_back(path);
    SdfFile file = Read(path);
    open_files_.pop_back();
    return files_[path] = std::move(file);
  }

  SdfFiles Take() { return std::move(files_); }

 private:
  void CheckIncludes(const std::string& path) const {
    if (std::find(open_files_.begin(), open_files_.end(), path) != open_files_.end()) {
      throw base::ConfigError(fmt::format("{}: includes itself ({} -> {}); break the circle",
                                          open_files_.front(), base::Join(open_files_, " -> "),
                                          path));
    }
    if (static_cast<int>(open_files_.size()) > limits_.max_include_depth) {
      throw base::ConfigError(fmt::format("{}: files include files more than {} deep; flatten them",
                                          open_files_.front(), limits_.max_include_depth));
    }
  }

  SdfFile Read(const std::string& path) {
    tinyxml2::XMLDocument document;
    const std::string text = base::ReadTextFile(path, limits_.max_file_bytes);
    const bool is_main = open_files_.size() == 1;
    const std::string plain = base::PlainXml(text, path);
    ParseXml(plain, path, limits_, &document);
    if (document.RootElement() == nullptr) return {};
    if (!is_main && document.RootElement()->Name() == std::string("robot"))
      ParseXml(base::PlainXml(SdfTextOfUrdf(plain, path), path), path, limits_, &document);
    SdfFile file;
    file.root = document.RootElement()->Name();
    if (file.root != "sdf") return file;
    PruneSdf(document.RootElement(), path, &file, notes_);
    CheckNumbers(*document.RootElement(), path);
    CheckPoseChains(*document.RootElement(), path, limits_.max_pose_chain);
    Include(document.RootElement(), path, &file);
    CollectParts(document.RootElement()->FirstChildElement("model"), &file);
    CollectNames(*document.RootElement(), &file);
    CheckSize(path, file);
    LineKeepingPrinter printer;
    document.RootElement()->Accept(&printer);
    file.text = printer.CStr();
    return file;
  }

  static int CountOf(const char* name, const XMLElement& parent) {
    int count = 0;
    for (const auto* child = parent.FirstChildElement(name); child != nullptr;
         child = child->NextSiblingElement(name)) {
      ++count;
    }
    return count;
  }

  /// Before they are read, which takes a millisecond for a model, and more for each link of many.
  void CheckNumbers(const XMLElement& element, const std::string& path) const {
    const std::string name = element.Name();
    const int num_models = CountOf("model", element) + CountOf("include", element);
    const int num_frames = CountOf("frame", element), num_links = CountOf("link", element);
    if (std::max(num_models, num_frames) > limits_.max_models || num_links > limits_.max_links) {
      throw base::ConfigError(fmt::format(
          "{}:{}: <{}> has {} models, {} frames and {} links, at most {}, {} and {} are loaded; "
          "join what stands",
          path, element.GetLineNum(), name, num_models, num_frames, num_links, limits_.max_models,
          limits_.max_models, limits_.max_links));
    }
    for (const auto* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (name == "sdf" || child->Name() == std::string("model")) CheckNumbers(*child, path);
    }
  }

  void CheckSize(const std::string& path, const SdfFile& file) const {
    if (file.num_elements <= limits_.max_elements) return;
    throw TooLarge(
        fmt::format("{}: more than {} elements, includes counted; split the world or replace many "
                    "bodies by a mesh",
                    path, limits_.max_elements));
  }

  void Include(XMLElement* parent, const std::string& path, SdfFile* file) {
    XMLElement* next = nullptr;
    for (XMLElement* child = parent->FirstChildElement(); child != nullptr; child = next) {
      next = child->NextSiblingElement();
      if (child->Name() != std::string("include")) {
        Include(child, path, file);
        continue;
      }
      const std::string place = fmt::format("{}:{}", path, child->GetLineNum());
      try {
        if (!LeadsToModel(*child, place, path, file)) parent->DeleteChild(child);
      } catch (const TooLarge&) {
        throw;
      } catch (const base::ConfigError& error) {
        notes_->AddProblem(error.what());
        MakeEmptyModel(child);
      }
    }
    CheckNames(parent, path, file->version, FilesOf(*file), notes_);
    FillEmptyModel(parent);
  }

  /// Of the includes of a file.
  FileOfInclude FilesOf(const SdfFile& file) const {
    return [&](const XMLElement& include) -> const SdfFile& {
      return files_.at(file.includes.at(TrimmedText(include.FirstChildElement("uri"))));
    };
  }

  void CollectParts(const XMLElement* model, SdfFile* file) const {
    if (model == nullptr) return;
    for (const auto* part = model->FirstChildElement(); part != nullptr;
         part = part->NextSiblingElement()) {
      if (part->FirstChildElement(kMerged) != nullptr) return file->part_names.clear();
      const std::string name = NameOfPart(*part, FilesOf(*file));
      if (!name.empty()) file->part_names.insert(name);
    }
  }

  /// False: to a light or the like, which is not needed.
  bool LeadsToModel(const XMLElement& include, const std::string& place, const std::string& path,
                    SdfFile* file) {
    const std::string uri = TrimmedText(include.FirstChildElement("uri"));
    if (uri.empty()) {
      throw base::ConfigError(
          fmt::format("{}: <include> has no <uri>; add <uri>model://name</uri>", place));
    }
    const std::string target = finder_.FindModel(uri, place, path);
    const SdfFile& included = Included(target, uri, place);
    file->includes[uri] = target;
    file->num_elements += included.num_elements;
    return included.num_models > 0;
  }

  const SdfFile& Included(const std::string& target, const std::string& uri,
                          const std::string& place) {
    const auto failed = failed_.find(target);
    if (failed != failed_.end()) throw base::ConfigError(failed->second);
    const std::size_t num_open = open_files_.size();
    try {
      const SdfFile& file = VisitFile(target);
      if (file.root == "sdf" && file.num_worlds == 0) return file;
      throw base::ConfigError(fmt::format(
          "{}: '{}' is {}, whose outermost element is <{}>{}; an <include> takes a model", place,
          uri, target, file.root, file.num_worlds > 0 ? " round a <world>" : ""));
    } catch (const TooLarge&) {
      throw;
    } catch (const base::ConfigError& error) {
      open_files_.resize(num_open);
      return Fail(target, error.what());
    }
  }

  const SdfFile& Fail(const std::string& target, const std::string& message) {
    const bool is_circle =
        std::find(open_files_.begin(), open_files_.end(), target) != open_files_.end();
    if (!is_circle) failed_[target] = message;
    throw base::ConfigError(message);
  }

  const ResourceFinder& finder_;
  XmlLimits limits_;
  LoadNotes* notes_;
  std::vector<std::string> open_files_;
  std::map<std::string, std::string> failed_;  // file -> message
  SdfFiles files_;
};

}  // namespace

SdfFiles ReadSdfFiles(const std::string& path, const ResourceFinder& finder,
                      const XmlLimits& limits, LoadNotes* notes) {
  Walk walk(finder, limits, notes);
  walk.VisitFile(path);
  return walk.Take();
}

}  // namespace hires::world
