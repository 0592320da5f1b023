#include "world/files/missing_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/files/nearest_file.h"
#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"

namespace hires::world {
namespace {

namespace fs = std::filesystem;

/// Names of the folders in all of them, each once.
std::vector<std::string> FoldersIn(const std::vector<std::string>& folders) {
  std::vector<std::string> names;
  for (const std::string& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_directory(ignored)) names.push_back(entry->path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// " (did you mean 'model://crate/block.obj'?)", or nothing.
std::string DidYouMean(const std::string& scheme, const std::vector<std::string>& folders,
                       const std::string& name) {
  for (const std::string& folder : folders) {
    const std::string nearest = base::NearestFile(folder, name);
    if (!nearest.empty()) {
      return fmt::format(" (did you mean '{}{}', which is '{}'?)", scheme, nearest,
                         (fs::path(folder) / nearest).string());
    }
  }
  return "";
}

}  // namespace

void MissingFiles::Add(const std::string& place, const std::string& error) {
  const bool has_place = error.rfind(place + ": ", 0) == 0;
  const std::string text = has_place ? error.substr(place.size() + 2) : error;
  std::vector<std::string>& places = places_[text];
  if (places.empty()) texts_.push_back(text);
  places.push_back(place);
}

void MissingFiles::ThrowIfAny(const std::string& path) const {
  if (texts_.empty()) return;
  std::vector<std::string> lines;
  for (const std::string& text : texts_) {
    const std::vector<std::string>& places = places_.at(text);
    lines.push_back(
        fmt::format("{}: {}{}", places.front(), text,
                    places.size() > 1 ? fmt::format(" (named {} times)", places.size()) : ""));
  }
  if (lines.size() == 1) throw base::ConfigError(lines.front());
  throw base::ConfigError(fmt::format("{}: {} files are missing:\n  {}", path, lines.size(),
                                      base::Join(lines, "\n  ")));
}

std::string WhyNoModel(const std::string& uri, const std::vector<std::string>& folders,
                       const std::string& where) {
  const std::size_t begin = uri.find("://") + 3;
  const std::string scheme = uri.substr(0, begin), name = uri.substr(begin);
  const std::string model = name.substr(0, name.find('/'));
  std::error_code error;
  for (const std::string& folder : folders) {
    const fs::path of_model = fs::path(folder) / model;
    if (model.size() >= name.size() || !fs::is_directory(of_model, error)) continue;
    const std::string inside = name.substr(model.size() + 1);
    const std::string nearest = base::NearestFile(of_model.string(), inside);
    return fmt::format("{}: '{}' is not there: model '{}' is {}, which has no '{}'; {}", where, uri,
                       model, of_model.string(), inside,
                       nearest.empty()
                           ? "correct the path, or put the file there"
                           : fmt::format("did you mean '{}{}/{}'?", scheme, model, nearest));
  }
  const std::vector<std::string> alike = base::LikelyNames(model, FoldersIn(folders));
  const std::string guess =
      alike.empty() ? DidYouMean(scheme, folders, name)
                    : fmt::format(" (did you mean model '{}'?)", base::Join(alike, "' or '"));
  return fmt::format(
      "{}: '{}' is not there: no model folder '{}' found, looked in {}{}; add its folder to the "
      "model path or to GAZEBO_MODEL_PATH",
      where, uri, model, folders.empty() ? "no folder" : base::Join(folders, ", "), guess);
}

}  // namespace hires::world
