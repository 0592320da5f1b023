// Feeds any bytes to the readers of SHOP2's language; run it as CONTRIBUTING.md says. The only way
// out that counts as right, besides success, is a ConfigError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "hires/base/error.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/shop2_reader.h"

namespace {

using namespace hires::planning;

/// Whatever `read` refuses is fine.
template <typename Read>
void Try(const Read& read) {
  try {
    read();
  } catch (const hires::base::ConfigError&) {
  }
}

/// What is written reads as the same.
void CheckRoundTrip(std::string_view text) {
  for (const Datum& datum : ReadData(text, "fuzz")) {
    const std::vector<Datum> again = ReadData(ToString(datum), "written");
    if (again.size() != 1 || again[0] != datum) std::abort();
  }
}

void ReadEverything(std::string_view text) {
  const std::vector<Problem> problems = ReadShop2Problems(text, "fuzz");
  const Domain domain = ReadShop2Domain(text, "fuzz");
  for (const Problem& problem : problems) CheckTasks(problem, domain);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Try([&] { CheckRoundTrip(text); });
  Try([&] { LanguageOf(text, "fuzz"); });
  Try([&] { ReadShop2Domain(text, "fuzz"); });
  Try([&] { ReadEverything(text); });
  return 0;
}
