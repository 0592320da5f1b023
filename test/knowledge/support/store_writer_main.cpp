// Writes a store at full rate until it is killed, going on where the store ends, and acknowledges
// on its standard output: after each call the number of the last change, eight bytes.
// store_writer PATH SEED TEXT_BYTES process|power
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "knowledge/support/store_workload.h"

namespace {

using hires::knowledge::Durability;
using hires::knowledge::Store;
using hires::knowledge::StoreOptions;
using hires::test_support::StoreWorkload;

int Run(const std::string& path, const StoreWorkload& workload, const StoreOptions& options) {
  Store store(path, hires::test_support::SmallOntology(), options);
  for (int number = StoreWorkload::Next(store);; ++number) {
    const std::uint64_t last = workload.Write(number, &store).back().sequence;
    if (write(STDOUT_FILENO, &last, sizeof last) != sizeof last) return 1;  // nobody listens
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    StoreOptions options;
    if (argv[4] == std::string("power")) options.durability = Durability::kPower;
    return Run(argv[1], {std::stoull(argv[2]), std::stoi(argv[3])}, options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "store_writer: %s\n", error.what());
    return 1;
  }
}
