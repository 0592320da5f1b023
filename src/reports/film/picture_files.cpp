#include "reports/film/picture_files.h"

#include <gif_lib.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "hires/base/check.h"

namespace hires::reports {
namespace {

using perception::Colour;
using perception::Picture;

constexpr int kRounds = 4;       // of Lloyd's algorithm: more change nothing that one sees
constexpr int kColours = 255;    // and one for what does not change
constexpr int kUnchanged = 255;  // its number

struct MapDeleter {
  void operator()(ColorMapObject* map) const { GifFreeMapObject(map); }
};
using ColourMap = std::unique_ptr<ColorMapObject, MapDeleter>;

/// Colours of pictures, and which of them is next to each colour.
class Palette {
 public:
  explicit Palette(const std::vector<Picture>& pictures) : map_(GifMakeMapObject(256, nullptr)) {
    HIRES_CHECK(map_ != nullptr, "memory for a palette");
    Choose(pictures);
    FindNearest();
    for (int i = 0; i < kRounds; ++i) {
      MoveToMeans(pictures);
      FindNearest();
    }
  }

  GifByteType Find(const Colour& colour) const { return nearest_[KeyOf(colour)]; }
  const ColorMapObject* map() const { return map_.get(); }

 private:
  static int KeyOf(const Colour& c) { return (c[0] >> 3) << 10 | (c[1] >> 3) << 5 | c[2] >> 3; }

  /// By every fourth pixel both ways.
  void Choose(const std::vector<Picture>& pictures) {
    std::vector<GifByteType> red, green, blue;
    for (const Picture& picture : pictures) {
      for (int row = 1; row < picture.height; row += 4) {
        for (int column = 1; column < picture.width; column += 4) {
          const Colour& colour = picture.At(column, row);
          red.push_back(colour[0]);
          green.push_back(colour[1]);
          blue.push_back(colour[2]);
        }
      }
    }
    std::vector<GifByteType> unused(red.size());
    int size = kColours;
    if (GifQuantizeBuffer(static_cast<unsigned>(red.size()), 1, &size, red.data(), green.data(),
                          blue.data(), unused.data(), map_->Colors) == GIF_ERROR) {
      throw std::runtime_error("giflib cannot choose colours: no memory");
    }
    num_colours_ = std::min(size, kColours);
  }

  /// giflib counts in 32 steps, which would tint what is nearly grey.
  void MoveToMeans(const std::vector<Picture>& pictures) {
    std::vector<std::array<long, 4>> sums(static_cast<std::size_t>(num_colours_));
    for (const Picture& picture : pictures) {
      for (const Colour& colour : picture.pixels) {
        std::array<long, 4>& sum = sums[Find(colour)];
        for (int i = 0; i < 3; ++i) sum[i] += colour[i];
        ++sum[3];
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto& [red, green, blue, count] = sums[i];
      if (count == 0) continue;
      map_->Colors[i] = {static_cast<GifByteType>(red / count),
                         static_cast<GifByteType>(green / count),
                         static_cast<GifByteType>(blue / count)};
    }
  }

  void FindNearest() {
    nearest_.resize(32 * 32 * 32);
    for (int key = 0; key < static_cast<int>(nearest_.size()); ++key) nearest_[key] = Nearest(key);
  }

  GifByteType Nearest(int key) const {
    const int wanted[] = {(key >> 10) * 8 + 4, (key >> 5 & 31) * 8 + 4, (key & 31) * 8 + 4};
    int best = 0, smallest = std::numeric_limits<int>::max();
    for (int i = 0; i < num_colours_; ++i) {
      const GifColorType& colour = map_->Colors[i];
      const int away[] = {colour.Red - wanted[0], colour.Green - wanted[1],
                          colour.Blue - wanted[2]};
      const int distance = away[0] * away[0] + away[1] * away[1] + away[2] * away[2];
      if (distance < smallest) {
        smallest = distance;
        best = i;
      }
    }
    return static_cast<GifByteType>(best);
  }

  ColourMap map_;
  int num_colours_{0};
  std::vector<GifByteType> nearest_;
};

int Append(GifFileType* file, const GifByteType* bytes, int count) {
  static_cast<std::string*>(file->UserData)->append(reinterpret_cast<const char*>(bytes), count);
  return count;
}

/// giflib's calls fail by what they return.
class GifWriter {
 public:
  GifWriter(int width, int height, const Palette& palette, std::string* out)
      : width_(width), height_(height) {
    int error = 0;
    file_ = EGifOpen(out, &Append, &error);
    if (file_ == nullptr) throw std::runtime_error("giflib has no memory");
    EGifSetGifVersion(file_, true);
    Require(EGifPutScreenDesc(file_, width, height, 8, 0, palette.map()));
    const char* application = "NETSCAPE2.0";  // plays again and again
    const GifByteType for_ever[] = {1, 0, 0};
    Require(EGifPutExtensionLeader(file_, APPLICATION_EXT_FUNC_CODE));
    Require(EGifPutExtensionBlock(file_, 11, application));
    Require(EGifPutExtensionBlock(file_, 3, for_ever));
    Require(EGifPutExtensionTrailer(file_));
  }
  ~GifWriter() {
    if (file_ != nullptr) EGifCloseFile(file_, nullptr);
  }
  GifWriter(const GifWriter&) = delete;
  GifWriter& operator=(const GifWriter&) = delete;

  void Write(std::vector<GifByteType>* indices, double delay) {
    GraphicsControlBlock control{};
    control.DisposalMode = DISPOSE_DO_NOT;
    control.DelayTime = static_cast<int>(std::lround(100.0 * delay));
    control.TransparentColor = kUnchanged;
    GifByteType extension[4];
    EGifGCBToExtension(&control, extension);
    Require(EGifPutExtension(file_, GRAPHICS_EXT_FUNC_CODE, 4, extension));
    Require(EGifPutImageDesc(file_, 0, 0, width_, height_, false, nullptr));
    for (int row = 0; row < height_; ++row) {
      Require(EGifPutLine(file_, indices->data() + static_cast<std::size_t>(row) * width_, width_));
    }
  }

  void Close() {
    Require(EGifCloseFile(file_, nullptr));
    file_ = nullptr;
  }

 private:
  void Require(int result) {
    if (result != GIF_ERROR) return;
    const char* why = GifErrorString(file_ == nullptr ? 0 : file_->Error);
    throw std::runtime_error(std::string("giflib: ") + (why == nullptr ? "failed" : why));
  }

  int width_, height_;
  GifFileType* file_{nullptr};
};

}  // namespace

std::string ToPng(const Picture& picture) {
  HIRES_CHECK(!picture.pixels.empty(), "a picture without pixels");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.pixels.data(), 0,
                                 nullptr)) {
    throw std::runtime_error(std::string("libpng: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

std::string ToGif(const std::vector<Picture>& frames, double delay, double last) {
  HIRES_CHECK(!frames.empty(), "a film without frames");
  const int width = frames[0].width, height = frames[0].height;
  const Palette palette(frames);
  std::string bytes;
  GifWriter writer(width, height, palette, &bytes);
  std::vector<GifByteType> shown(frames[0].pixels.size(), kUnchanged), drawn(shown.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    HIRES_CHECK(frames[k].width == width && frames[k].height == height, "frames of one size");
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const GifByteType index = palette.Find(frames[k].pixels[i]);
      drawn[i] = index == shown[i] ? kUnchanged : index;
      shown[i] = index;
    }
    writer.Write(&drawn, k + 1 == frames.size() ? last : delay);
  }
  writer.Close();
  return bytes;
}

}  // namespace hires::reports
