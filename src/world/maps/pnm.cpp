#include "world/maps/pnm.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/error.h"

namespace hires::world {
namespace {

constexpr std::int64_t kMaxNumber = 1'000'000'000;

bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

class PnmReader {
 public:
  PnmReader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  /// @pre the bytes begin with P1 .. P6.
  MapPicture Read() {
    const int kind = bytes_[1] - '0';
    const bool is_raw = kind > 3;
    num_channels_ = kind % 3 == 0 ? 3 : 1;
    is_bitmap_ = kind % 3 == 1;
    at_ = 2;
    MapPicture picture;
    picture.width = Size("width");
    picture.height = Size("height");
    RequirePictureSize(picture.width, picture.height, name_);
    max_value_ = is_bitmap_ ? 1 : Number("maximum grey value");
    if (max_value_ < 1 || max_value_ > 65535) {
      Fail(fmt::format("has the maximum grey value {}, wanted 1 to 65535", max_value_));
    }
    const std::int64_t num_pixels = std::int64_t{picture.width} * picture.height;
    picture.colours =
        is_raw ? is_bitmap_ ? RawBits(picture) : RawPixels(num_pixels) : PlainPixels(num_pixels);
    return picture;
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

  int Scaled(std::int64_t value) const {
    if (value > max_value_) {
      Fail(fmt::format("has the grey value {}, above its maximum {}", value, max_value_));
    }
    return static_cast<int>((value * 255 + max_value_ / 2) / max_value_);
  }

  std::int64_t PlainBit() {  // bits need no space between them
    SkipSpaceAndComments();
    if (at_ >= bytes_.size() || (bytes_[at_] != '0' && bytes_[at_] != '1')) {
      Fail("has no 0 or 1 where the next pixel belongs; save the image again");
    }
    return '1' - bytes_[at_++];  // 1 is black
  }

  std::vector<std::uint16_t> PlainPixels(std::int64_t num_pixels) {
    // Each value takes a digit and a space at least (a bit the digit alone): a short file must not
    // claim much memory.
    const std::int64_t least = is_bitmap_ ? num_pixels : 2 * num_pixels * num_channels_;
    if (static_cast<std::int64_t>(bytes_.size()) < least) {
      Fail(fmt::format("ends before its {} pixels", num_pixels));
    }
    return Pixels(num_pixels, [&] { return is_bitmap_ ? PlainBit() : Number("next pixel"); });
  }

  void RequireBytes(std::int64_t count, std::int64_t num_pixels, int sample_bytes) {
    if (at_ >= bytes_.size() || !IsSpace(bytes_[at_])) Fail("has no space before its pixels");
    ++at_;
    if (static_cast<std::int64_t>(bytes_.size() - at_) >= count) return;
    Fail(fmt::format("ends before its {} pixels of {} byte(s); was it cut short?", num_pixels,
                     sample_bytes));
  }

  std::vector<std::uint16_t> RawPixels(std::int64_t num_pixels) {
    const int sample_bytes = max_value_ < 256 ? 1 : 2;
    RequireBytes(num_pixels * num_channels_ * sample_bytes, num_pixels,
                 num_channels_ * sample_bytes);
    return Pixels(num_pixels, [&] {
      std::int64_t value = 0;
      for (int k = 0; k < sample_bytes; ++k) {
        value = 256 * value + static_cast<unsigned char>(bytes_[at_++]);
      }
      return value;
    });
  }

  /// Rows begin at whole bytes, the first pixel is the highest bit, and 1 is black.
  std::vector<std::uint16_t> RawBits(const MapPicture& size) {
    const std::size_t row_bytes = (static_cast<std::size_t>(size.width) + 7) / 8;
    RequireBytes(static_cast<std::int64_t>(row_bytes) * size.height,
                 std::int64_t{size.width} * size.height, 1);
    std::vector<std::uint16_t> colours;
    for (int row = 0; row < size.height; ++row) {
      for (int column = 0; column < size.width; ++column) {
        const int bit = bytes_[at_ + row * row_bytes + column / 8] >> (7 - column % 8) & 1;
        colours.push_back(SumOfGrey(bit == 1 ? 0 : 255));
      }
    }
    return colours;
  }

  template <typename NextSample>
  std::vector<std::uint16_t> Pixels(std::int64_t num_pixels, const NextSample& next) {
    std::vector<std::uint16_t> colours;
    colours.reserve(static_cast<std::size_t>(num_pixels));
    for (std::int64_t i = 0; i < num_pixels; ++i) {
      int sum = 0;
      for (int k = 0; k < num_channels_; ++k) sum += Scaled(next());
      colours.push_back(static_cast<std::uint16_t>(num_channels_ == 1 ? SumOfGrey(sum) : sum));
    }
    return colours;
  }

  const std::string& bytes_;
  const std::string& name_;
  std::size_t at_{0};
  int num_channels_{1};
  bool is_bitmap_{false};
  std::int64_t max_value_{255};
};

}  // namespace

bool IsPnm(const std::string& bytes) {
  return bytes.size() >= 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6';
}

MapPicture ParsePnm(const std::string& bytes, const std::string& name) {
  HIRES_CHECK(IsPnm(bytes), "P1 to P6 begin so");
  return PnmReader(bytes, name).Read();
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
