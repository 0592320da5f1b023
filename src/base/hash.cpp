#include "hires/base/hash.h"

#include <fmt/format.h>

#include <cstring>

namespace hires::base {

void Hasher::AddByte(unsigned char byte) {
  value_ ^= byte;
  value_ *= 1099511628211ULL;
}

void Hasher::Add(std::uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8) AddByte(static_cast<unsigned char>(value >> shift));
}

void Hasher::Add(double value) {
  if (value == 0.0) value = 0.0;  // drops the sign of -0.0
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  Add(bits);
}

void Hasher::Add(std::string_view bytes) {
  Add(static_cast<std::uint64_t>(bytes.size()));
  for (const char c : bytes) AddByte(static_cast<unsigned char>(c));
}

std::string HexOf(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace hires::base
