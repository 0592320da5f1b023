// Feeds any bytes to the readers of HDDL; run it as CONTRIBUTING.md says. The only way out that
// counts as right, besides success, is a ConfigError. A text may hold a domain and a problem.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hires/base/error.h"
#include "planning/language/hddl_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hires::planning;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const Domain domain = ReadHddlDomain(text, "fuzz");
    ReadHddlProblem(text, "fuzz", domain);
  } catch (const hires::base::ConfigError&) {
  }
  return 0;
}
