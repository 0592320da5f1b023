#include "world/sdf/mend_friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/files/urdf_friction.h"
#include "world/sdf/prune_sdf.h"

namespace hires::world {
namespace {

using tinyxml2::XMLElement;

/// Null if it is not there.
XMLElement* Within(XMLElement* element, const char* name) {
  return element == nullptr ? nullptr : element->FirstChildElement(name);
}

/// Nothing if it is not there, or is none; of that others tell.
std::optional<double> CoefficientIn(const XMLElement* element) {
  const std::string text = TrimmedText(element);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const bool is_whole = !text.empty() && *end == '\0' && !std::isnan(number);
  return is_whole ? std::optional<double>(number) : std::nullopt;
}

/// The smallest, as a contact slips that way first, with SDF's default for the first.
double SmallestOf(XMLElement* engine, const char* one, const char* other) {
  const auto meant = [&](const char* name, double not_there) {
    const double mu = CoefficientIn(Within(engine, name)).value_or(not_there);
    return std::isfinite(mu) && mu >= 0.0 ? mu : base::kNoSlip;
  };
  const double first = meant(one, 1.0);
  return std::min(first, meant(other, first));
}

}  // namespace

void MendFriction(XMLElement* collision, const std::string& path, LoadNotes* notes) {
  XMLElement* friction = Within(Within(collision, "surface"), "friction");
  if (friction == nullptr) return;
  const char* name = collision->Attribute("name");
  const std::string place =
      fmt::format("{}:{} '{}'", path, friction->GetLineNum(), name == nullptr ? "" : name);
  XMLElement* ode = Within(friction, "ode");
  bool is_endless = false;
  for (const char* direction : {"mu", "mu2"}) {
    XMLElement* mu = Within(ode, direction);
    const std::optional<double> written = CoefficientIn(mu);
    if (!written || (std::isfinite(*written) && *written >= 0.0)) continue;
    mu->SetText(base::kNoSlip);
    is_endless = true;
  }
  if (is_endless)
    notes->Add("collision",
               fmt::format("whose friction <mu> is infinite or negative: {} is taken, "
                           "by which nothing slips",
                           base::kNoSlip),
               place);
  XMLElement* bullet = Within(friction, "bullet");
  if (bullet != nullptr &&
      SmallestOf(bullet, "friction", "friction2") != SmallestOf(ode, "mu", "mu2"))
    notes->Add("collision",
               "whose friction in <bullet> differs from <mu> in <ode> (1 if it is not "
               "there), which is taken",
               place);
  XMLElement* torsional = Within(friction, "torsional");
  const auto radius = [&](const char* which) {
    return CoefficientIn(Within(torsional, which)).value_or(0.0);
  };
  if (std::max(radius("patch_radius"), radius("surface_radius")) > 0.0)
    notes->Add("collision", "whose <torsional> friction is left out", place);
}

}  // namespace hires::world
