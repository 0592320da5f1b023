#include "world/plain_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "world/liquid.h"
#include "world/solid_object.h"

namespace hires::world {
namespace {

using base::Between;

/// Of sizes as others call them, what they are here.
void RefuseOtherSizes(const base::ParamReader& in, bool is_round) {
  if (in.Has("diameter")) {
    in.Fail("diameter",
            is_round ? "wanted 'radius', half of it" : "wanted 'depth' and 'width' of a box");
  }
  if (in.Has("length")) {
    in.Fail("length", is_round ? "wanted 'height', how long it is along its axis"
                               : "wanted 'depth', how long it is along x");
  }
  for (const char* all : {"size", "dimensions"}) {
    if (!in.Has(all)) continue;
    in.Fail(all, is_round ? "wanted 'radius' and 'height', a number each"
                          : "wanted 'depth', 'width' and 'height', a number each");
  }
}

/// @param half_width, height  [m] of the vessel
Liquid ReadLiquidWithin(base::ParamReader in, double half_width, double height) {
  const Liquid liquid = ReadLiquid(in);
  if (liquid.radius > half_width)
    in.Fail("radius", fmt::format("wanted at most {:g}, as wide as the object", half_width));
  if (liquid.rim > height)
    in.Fail("rim", fmt::format("wanted at most {:g}, the object's height", height));
  return liquid;
}

}  // namespace

ObjectModel LoadPlainObject(const std::string& path) {
  base::ParamReader in = base::ParamReader::FromFile(path);
  ObjectModel model;
  std::vector<std::string> needed{"shape", "height", "mass"};
  if (in.Has("shape")) {
    const bool is_round = in.Get("shape", base::OneOf({"cylinder", "box"})) == "cylinder";
    RefuseOtherSizes(in, is_round);
    const std::vector<std::string> sizes =
        is_round ? std::vector<std::string>{"radius"} : std::vector<std::string>{"depth", "width"};
    needed.insert(needed.end(), sizes.begin(), sizes.end());
  }
  in.RequireKeys(needed);  // all that are missing at once
  const std::string shape = in.GetString("shape");
  const double height = in.Get("height", Between(kSmallestSolid, kLargestSolid));
  const double mass = in.Get("mass", Between(0.0001, 1000.0));
  if (shape == "cylinder") {
    const double radius = in.Get("radius", Between(kSmallestSolid, kLargestSolid));
    model = SolidObject(geometry::Cylinder{radius, height}, height, mass);
  } else {
    const double depth = in.Get("depth", Between(kSmallestSolid, kLargestSolid));
    const double width = in.Get("width", Between(kSmallestSolid, kLargestSolid));
    model = SolidObject(geometry::Box{{depth, width, height}}, height, mass);
  }
  model.name = std::filesystem::path(path).stem().string();
  if (in.Has("com_height")) {
    model.mass_properties.p_BBcm.z() = in.Get("com_height", Between(0.0, height));
  }
  if (in.Has("friction")) {
    model.collisions.front().friction = in.Get("friction", Between(0.0, 10.0));
  }
  if (in.Has("liquid")) {
    const geometry::Aabb size = geometry::BoundsOf(model.collisions.front().shape, {});
    model.liquid =
        ReadLiquidWithin(in.Sub("liquid"), std::min(size.upper.x(), size.upper.y()), height);
  }
  in.RejectUnknownKeys();
  return model;
}

}  // namespace hires::world
