#include "world/files/missing_files.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::world {

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

}  // namespace hires::world
