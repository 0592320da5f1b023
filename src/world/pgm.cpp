#include "world/pgm.h"

#include <fmt/format.h>

#include "hires/base/check.h"
#include "hires/base/error.h"

namespace hires::world {
namespace {

constexpr std::int64_t kMaxNumber = 1'000'000'000;

bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

class PgmReader {
 public:
  PgmReader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  GreyImage Read() {
    const std::string magic = bytes_.substr(0, 2);
    if (magic != "P2" && magic != "P5") {
      Fail("begins neither as a PGM (P2, P5) nor as a PNG; convert it to one of these");
    }
    at_ = 2;
    GreyImage image;
    image.width = Size("width");
    image.height = Size("height");
    const std::int64_t num_pixels = std::int64_t{image.width} * image.height;
    if (num_pixels > kMaxPixels) {
      Fail(
          fmt::format("has {} pixels, at most {} are read; scale it down", num_pixels, kMaxPixels));
    }
    max_value_ = Number("maximum grey value");
    if (max_value_ < 1 || max_value_ > 65535) {
      Fail(fmt::format("has the maximum grey value {}, wanted 1 to 65535", max_value_));
    }
    image.pixels = magic == "P2" ? PlainPixels(num_pixels) : RawPixels(num_pixels);
    return image;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw base::ConfigError(fmt::format("{}: {} (byte {})", name_, what, at_));
  }

  void SkipSpaceAndComments() {
    while (at_ < bytes_.size() && (IsSpace(bytes_[at_]) || bytes_[at_] == '#')) {
      if (bytes_[at_] == '#') at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1);
      ++at_;
    }
  }

  std::int64_t Number(const std::string& what) {
    const std::size_t before = at_;
    SkipSpaceAndComments();
    if (at_ == before) Fail(fmt::format("has no space before the {}", what));
    if (at_ >= bytes_.size() || !IsDigit(bytes_[at_])) {
      Fail(fmt::format("has no number where the {} belongs; save the image again", what));
    }
    std::int64_t number = 0;
    for (; at_ < bytes_.size() && IsDigit(bytes_[at_]); ++at_) {
      number = 10 * number + (bytes_[at_] - '0');
      if (number > kMaxNumber) Fail(fmt::format("has a {} above {}", what, kMaxNumber));
    }
    return number;
  }

  int Size(const std::string& what) {
    const std::int64_t size = Number(what);
    if (size < 1) Fail(fmt::format("has the {} {}, wanted 1 or more", what, size));
    return static_cast<int>(size);
  }

  std::uint8_t Scaled(std::int64_t value) const {
    if (value > max_value_) {
      Fail(fmt::format("has the grey value {}, above its maximum {}", value, max_value_));
    }
    return static_cast<std::uint8_t>((value * 255 + max_value_ / 2) / max_value_);
  }

  std::vector<std::uint8_t> PlainPixels(std::int64_t num_pixels) {
    // Each value takes a digit and a space at least: a short file must not claim much memory.
    if (static_cast<std::int64_t>(bytes_.size()) < 2 * num_pixels) {
      Fail(fmt::format("ends before its {} pixels", num_pixels));
    }
    std::vector<std::uint8_t> pixels;
    pixels.reserve(num_pixels);
    for (std::int64_t i = 0; i < num_pixels; ++i) pixels.push_back(Scaled(Number("next pixel")));
    return pixels;
  }

  std::vector<std::uint8_t> RawPixels(std::int64_t num_pixels) {
    if (at_ >= bytes_.size() || !IsSpace(bytes_[at_])) Fail("has no space before its pixels");
    ++at_;
    const int sample_bytes = max_value_ < 256 ? 1 : 2;
    if (static_cast<std::int64_t>(bytes_.size() - at_) < num_pixels * sample_bytes) {
      Fail(fmt::format("ends before its {} pixels of {} byte(s); was it cut short?", num_pixels,
                       sample_bytes));
    }
    std::vector<std::uint8_t> pixels;
    pixels.reserve(num_pixels);
    for (std::int64_t i = 0; i < num_pixels; ++i) {
      std::int64_t value = 0;
      for (int k = 0; k < sample_bytes; ++k) {
        value = 256 * value + static_cast<unsigned char>(bytes_[at_++]);
      }
      pixels.push_back(Scaled(value));
    }
    return pixels;
  }

  const std::string& bytes_;
  const std::string& name_;
  std::size_t at_{0};
  std::int64_t max_value_{255};
};

}  // namespace

GreyImage ParsePgm(const std::string& bytes, const std::string& name) {
  return PgmReader(bytes, name).Read();
}

std::string FormatPgm(const GreyImage& image) {
  HIRES_CHECK(image.width >= 1 && image.height >= 1, "an image has pixels");
  HIRES_CHECK(image.pixels.size() == static_cast<std::size_t>(image.width) * image.height,
              "an image has width times height pixels");
  std::string text = fmt::format("P5\n{} {}\n255\n", image.width, image.height);
  text.append(image.pixels.begin(), image.pixels.end());
  return text;
}

}  // namespace hires::world
