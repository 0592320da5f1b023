#include "world/sdf/check_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "world/sdf/prune_sdf.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

/// How many numbers an element holds; 0: none, or it is read elsewhere.
std::size_t NumbersWanted(const XMLElement& element, const std::string& parent) {
  static const std::map<std::pair<std::string, std::string>, std::size_t> wanted{
      {{"box", "size"}, 3},
      {{"plane", "size"}, 2},
      {{"plane", "normal"}, 3},
      {{"cylinder", "radius"}, 1},
      {{"cylinder", "length"}, 1},
      {{"sphere", "radius"}, 1},
      {{"mesh", "scale"}, 3},
      {{"world", "gravity"}, 3},
      {{"ode", "mu"}, 1},
      {{"ode", "mu2"}, 1},
      {{"bounce", "restitution_coefficient"}, 1}};
  if (element.Name() == std::string("pose")) {
    const char* format = element.Attribute("rotation_format");
    return format != nullptr && format == std::string("quat_xyzw") ? 7 : 6;
  }
  const auto found = wanted.find({parent, element.Name()});
  return found == wanted.end() ? 0 : found->second;
}

/// Commas behind them are forgiven, as libsdformat does in poses.
bool HoldsNumbers(const std::string& text, std::size_t count) {
  std::size_t found = 0;
  const char* at = text.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    std::strtod(at, &end);
    if (end == at) return false;
    ++found;
    at = end + (*end == ',' ? 1 : 0);
    while (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r') ++at;
  }
  return found == count;
}

/// Asks of <static> alone: what else is true or false is read elsewhere, or left out.
void CheckStatic(XMLElement* element, const std::string& path, LoadNotes* notes) {
  const std::string text = base::ToLower(TrimmedText(element));
  if (text.empty() || text == "1" || text == "0" || text == "true" || text == "false") return;
  notes->AddProblem(fmt::format("{}:{}: <static> is '{}', wanted true or false", path,
                                element->GetLineNum(), TrimmedText(element)));
  element->SetText("1");
}

}  // namespace

void CheckValueOf(XMLElement* element, const std::string& path, LoadNotes* notes) {
  const XMLElement* parent = element->Parent()->ToElement();
  const std::string within = parent == nullptr ? "" : parent->Name();
  if (within.rfind(kShapePrefix, 0) == 0) return;  // as inertials, which may not be needed
  if (element->Name() == std::string("static")) return CheckStatic(element, path, notes);
  const std::size_t wanted = NumbersWanted(*element, within);
  std::string text = TrimmedText(element);
  if (wanted == 0 || text.empty()) return;
  if (HoldsNumbers(text, wanted)) {
    std::replace(text.begin(), text.end(), ',', ' ');
    if (text != TrimmedText(element)) element->SetText(text.c_str());
    return;
  }
  notes->AddProblem(fmt::format("{}:{}: <{}> in <{}> is '{}', wanted {}", path,
                                element->GetLineNum(), element->Name(), within, text,
                                base::Counted(wanted, "number")));
  element->DeleteChildren();
  if (element->Name() == std::string("pose")) return;
  std::string filler = "1";
  for (std::size_t i = 1; i < wanted; ++i) filler += " 1";
  element->SetText(within == "world"                  ? "0 0 -9.81"
                   : within == "plane" && wanted == 3 ? "0 0 1"
                                                      : filler.c_str());
}

}  // namespace hires::world
