#include "hires/base/local_time.h"

#include <ctime>

namespace hires::base {

std::string LocalTime() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%d-%H-%M-%S", &parts);
  return text;
}

}  // namespace hires::base
