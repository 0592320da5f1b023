#include "imagination/purpose.h"

namespace hires::imagination {

Purpose PurposeOf(const actions::Catalogue& catalogue, const base::ActionCall& action) {
  const actions::ActionSpec* spec = catalogue.Find(action.name);
  if (spec == nullptr || action.arguments.size() != spec->parameters.size()) return {};
  const auto argument = [&](const std::string& parameter) {
    return actions::ArgumentOf(*spec, action, parameter);
  };
  const actions::PurposeSpec& purpose = spec->purpose;
  return {purpose.purpose, argument(purpose.object), argument(purpose.arm), argument(purpose.area)};
}

}  // namespace hires::imagination
