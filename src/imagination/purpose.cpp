#include "hires/imagination/purpose.h"

#include "hires/base/text.h"

namespace hires::imagination {

Purpose PurposeOf(const base::ActionCall& action) {
  const auto argument = [&](std::size_t i) { return base::ToLower(action.arguments.at(i)); };
  const std::size_t count = action.arguments.size();
  const std::string name = base::ToLower(action.name);
  if (name == "pick_up_object" && count == 2) {
    return {Purpose::Kind::kTake, argument(0), argument(1), {}};
  }
  if (name == "pick_up_from_tray" && count == 2) {
    return {Purpose::Kind::kTake, argument(1), argument(0), {}};
  }
  if (name == "place_object" && count == 3) {
    return {Purpose::Kind::kPutOnArea, argument(0), argument(1), argument(2)};
  }
  if (name == "place_on_tray" && count == 2) {
    return {Purpose::Kind::kPutOnTray, argument(1), argument(0), {}};
  }
  return {};
}

}  // namespace hires::imagination
