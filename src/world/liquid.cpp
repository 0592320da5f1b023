#include "world/liquid.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "hires/base/text.h"
#include "world/solid_object.h"

namespace hires::world {

Liquid ReadLiquid(base::ParamReader in) {
  in.RequireKeys({"radius", "fill", "rim"});
  Liquid liquid;
  liquid.radius = in.Get("radius", base::Between(kSmallestSolid, kLargestSolid));
  liquid.rim = in.Get("rim", base::Between(kSmallestSolid, kLargestSolid));
  liquid.fill = in.Get("fill", base::Positive());
  if (liquid.fill > liquid.rim) {
    in.Fail("fill", fmt::format("wanted at most the rim, {:g} m: above it the liquid runs over",
                                liquid.rim));
  }
  in.RejectUnknownKeys();
  return liquid;
}

bool MayHoldUnknownLiquid(const ObjectModel& model) {
  if (model.liquid) return false;
  const std::string kind =
      base::ToLower(model.concept_name.empty() ? model.name : model.concept_name);
  for (const char* word :
       {"cup", "mug", "glass", "bottle", "can", "jug", "pitcher", "carafe", "pot", "bowl", "beaker",
        "bucket", "tea", "coffee", "drink", "beer", "wine"}) {
    if (kind.find(word) != std::string::npos) return true;
  }
  return model.concept_name.empty() &&
         std::all_of(model.collisions.begin(), model.collisions.end(), [](const auto& part) {
           return std::holds_alternative<geometry::Cylinder>(part.shape);
         });
}

}  // namespace hires::world
