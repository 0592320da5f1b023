#include "world/sdf/model_folders.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/files/model_folders.h"
#include "base/files/nearest_file.h"
#include "base/files/plain_xml.h"
#include "base/trimmed.h"
#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "world/xml_check.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

bool IsNumber(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool HoldsModel(const fs::path& folder) {
  return base::Exists(folder / "model.config") || base::Exists(folder / "model.sdf");
}

/// The folder itself, or the newest of its versions.
std::string NewestIn(const fs::path& folder) {
  if (HoldsModel(folder)) return folder.string();
  fs::path newest;
  long version = -1;
  for (const fs::path& entry : base::EntriesOf(folder)) {
    const std::string name = entry.filename().string();
    if (!IsNumber(name) || name.size() > 9 || !HoldsModel(entry)) continue;
    if (std::stol(name) > version) newest = entry, version = std::stol(name);
  }
  return newest.empty() ? folder.string() : newest.string();
}

/// "1.10" -> 10; -1 for what is no SDF 1.x.
int MinorOf(const char* version) {
  const std::string text = version == nullptr ? "" : version;
  return text.rfind("1.", 0) == 0 && IsNumber(text.substr(2)) && text.size() < 6
             ? std::stoi(text.substr(2))
             : -1;
}

/// Of several, libsdformat's newest (1.9) or the nearest below; else the oldest above it.
std::string FileNamedIn(const tinyxml2::XMLElement& model) {
  constexpr int kNewest = 9;
  std::string best;
  int best_minor = -2;
  for (const auto* sdf = model.FirstChildElement("sdf"); sdf != nullptr;
       sdf = sdf->NextSiblingElement("sdf")) {
    if (sdf->GetText() == nullptr) continue;
    const int minor = MinorOf(sdf->Attribute("version"));
    const bool is_better =
        best_minor > kNewest ? minor < best_minor : minor <= kNewest && minor > best_minor;
    if (!best.empty() && !is_better) continue;
    best = sdf->GetText();
    best_minor = minor;
  }
  return base::Trimmed(best);
}

}  // namespace

std::string AlikeName(const std::string& name) {
  std::string alike;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name.compare(i, 3, "%20") == 0) {
      alike += '_';
      i += 2;
    } else {
      alike += name[i] == ' ' ? '_' : name[i];
    }
  }
  return base::ToLower(alike);
}

FuelName FuelNameOf(const std::string& uri) {
  std::vector<std::string> parts;
  const std::size_t scheme = uri.find("://");
  for (const std::string& part :
       base::Split(scheme == std::string::npos ? uri : uri.substr(scheme + 3), '/')) {
    if (!part.empty()) parts.push_back(part);
  }
  const auto models = std::find(parts.begin(), parts.end(), "models");
  if (models == parts.end() || models + 1 == parts.end())
    return {parts.empty() ? "" : parts.back(), ""};
  FuelName result{*(models + 1), ""};
  auto rest = models + 2;
  if (rest != parts.end() && (IsNumber(*rest) || *rest == "tip")) ++rest;
  if (rest != parts.end() && *rest == "files") ++rest;
  result.inside = base::Join({rest, parts.end()}, "/");
  return result;
}

std::string FindAlike(const std::vector<std::string>& folders, const std::string& name) {
  const std::string wanted = AlikeName(name);
  for (const std::string& folder : folders) {
    for (const fs::path& entry : base::EntriesOf(folder)) {
      if (AlikeName(entry.filename().string()) == wanted && base::IsFolder(entry))
        return NewestIn(entry);
    }
  }
  return "";
}

std::string NearestName(const std::vector<std::string>& folders, const std::string& name) {
  std::vector<std::string> known;
  for (const std::string& folder : folders) {
    for (const fs::path& entry : base::EntriesOf(folder))
      known.push_back(entry.filename().string());
  }
  const std::vector<std::string> likely = base::LikelyNames(name, known);
  return likely.empty() ? "" : fmt::format("; did you mean '{}'?", base::Join(likely, "' or '"));
}

std::string ModelFileIn(const std::string& folder_of_versions, const std::string& uri,
                        const std::string& where) {
  const std::string folder = NewestIn(folder_of_versions);
  const std::string config = folder + "/model.config";
  if (!base::Exists(config)) {
    if (base::Exists(folder + "/model.sdf")) return folder + "/model.sdf";
    throw base::ConfigError(fmt::format(
        "{}: '{}' is the folder {}, which has no model.config; add one that names its SDF file",
        where, uri, folder));
  }
  tinyxml2::XMLDocument document;
  ParseXml(base::PlainXml(base::ReadTextFile(config, 1u << 20), config), config, {}, &document);
  const tinyxml2::XMLElement* root = document.RootElement();
  const std::string named = root == nullptr ? "" : FileNamedIn(*root);
  const std::string file = folder + "/" + named;
  if (!named.empty() && base::Exists(file) && !base::IsFolder(file)) return file;
  throw base::ConfigError(fmt::format(
      "{}: '{}': {} names no SDF file that is there{}; correct its <sdf>{}", where, uri, config,
      named.empty() ? "" : " ('" + named + "')", named.empty() ? "" : base::DidYouMeanFile(file)));
}

}  // namespace hires::world
