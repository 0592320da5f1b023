#include "cli/own_object.h"

#include "hires/world/world.h"

namespace hires::cli {

std::string NameOf(const std::string& object, imagination::SetupConfig* setup) {
  const bool is_file =
      object.find('/') != std::string::npos || object.find('.') != std::string::npos;
  if (!is_file) return object;
  setup->extra_objects.push_back(object);
  return world::ObjectNameIn(object);
}

}  // namespace hires::cli
