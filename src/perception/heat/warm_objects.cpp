#include "hires/perception/warm_objects.h"

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>

#include "base/averages.h"
#include "hires/base/check.h"
#include "hires/perception/line_of_sight.h"

namespace hires::perception {
namespace {

constexpr double kCentikelvin = 0.01;  // [K]
constexpr int kNoRegion = -1;

using Pixels = std::vector<int>;  // indices into the picture

struct Region {
  WarmRegion region;
  Pixels pixels;
};

/// [K]  @pre there are pixels
double MedianOf(const HeatPicture& heat, const Pixels& pixels) {
  std::vector<std::uint16_t> values;
  for (const int i : pixels) values.push_back(heat.centikelvin[i]);
  return kCentikelvin * base::Median(std::move(values));
}

double HottestOf(const HeatPicture& heat, const Pixels& pixels) {
  std::uint16_t hottest = 0;
  for (const int i : pixels) hottest = std::max(hottest, heat.centikelvin[i]);
  return kCentikelvin * hottest;
}

/// Region of each pixel, by OpenCV's contours. A region within another's hole belongs to it.
std::vector<Region> RegionsOf(const HeatPicture& heat, const WarmParams& params) {
  cv::Mat warm(heat.height, heat.width, CV_8U);
  for (std::size_t i = 0; i < heat.centikelvin.size(); ++i) {
    warm.data[i] = kCentikelvin * heat.centikelvin[i] >= params.threshold ? 255 : 0;
  }
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(warm, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::Mat labels(heat.height, heat.width, CV_32S, cv::Scalar(kNoRegion));
  std::vector<Region> all(contours.size());
  for (std::size_t k = 0; k < contours.size(); ++k) {
    cv::drawContours(labels, contours, static_cast<int>(k), cv::Scalar(static_cast<double>(k)),
                     cv::FILLED);
    for (const cv::Point& at : contours[k]) all[k].region.contour.emplace_back(at.x, at.y);
  }
  for (int i = 0; i < heat.width * heat.height; ++i) {
    const int label = labels.at<int>(i / heat.width, i % heat.width);
    if (label != kNoRegion && warm.data[i] != 0) all[label].pixels.push_back(i);
  }
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const Region& one) {
                             return static_cast<int>(one.pixels.size()) < params.min_pixels;
                           }),
            all.end());
  std::sort(all.begin(), all.end(),
            [](const Region& a, const Region& b) { return a.pixels.front() < b.pixels.front(); });
  for (Region& one : all) {
    one.region.num_pixels = static_cast<int>(one.pixels.size());
    one.region.hottest = HottestOf(heat, one.pixels);
    one.region.median = MedianOf(heat, one.pixels);
  }
  return all;
}

/// Object -> its pixels in the picture, in the order of `objects`.
std::vector<Pixels> PixelsOf(const RangePicture& seen, const std::vector<std::string>& objects) {
  std::vector<int> object_of(seen.names.size(), -1);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    for (std::size_t owner = 0; owner < seen.names.size(); ++owner) {
      if (seen.names[owner] == objects[k]) object_of[owner] = static_cast<int>(k);
    }
  }
  std::vector<Pixels> pixels(objects.size());
  for (std::size_t i = 0; i < seen.owner.size(); ++i) {
    if (seen.owner[i] == RangePicture::kNothing) continue;
    const int object = object_of[seen.owner[i]];
    if (object >= 0) pixels[object].push_back(static_cast<int>(i));
  }
  return pixels;
}

Pixels Common(const Pixels& a, const Pixels& b) {  // both are sorted
  Pixels common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common;
}

/// The object by its own region, that with most of its pixels.
ObjectHeat HeatOf(const HeatPicture& heat, const std::string& name, const Pixels& own,
                  const std::vector<Region>& regions) {
  Pixels used;
  ObjectHeat object;
  object.name = name;
  for (const Region& one : regions) {
    const auto& names = one.region.objects;
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    const Pixels common = Common(own, one.pixels);
    if (common.size() > used.size()) used = common;
    for (const std::string& other : names) {
      if (other != name) object.mixed_with.push_back(other);
    }
  }
  if (used.empty()) used = own;
  object.temperature = MedianOf(heat, used);
  object.hottest = HottestOf(heat, used);
  object.num_pixels = static_cast<int>(used.size());
  return object;
}

/// Whether its origin is; what is cut off by the border shows too little of itself.
bool IsInPicture(const PinholeCamera& camera, const world::ObjectState& object, double max_range) {
  const Eigen::Vector3d& p_M = object.X_MO.translation;
  if ((p_M - camera.X_MC.translation).norm() > max_range) return false;
  const auto pixel = camera.Project(p_M);
  return pixel && pixel->x() >= 0.0 && pixel->x() < camera.width && pixel->y() >= 0.0 &&
         pixel->y() < camera.height;
}

}  // namespace

WarmParams ReadWarmParams(base::ParamReader in) {
  WarmParams params;
  params.threshold = in.Get("threshold", base::Between(200.0, 600.0));
  params.min_pixels = in.Get("min_pixels", base::Between(1, 100000));
  params.min_share = in.Get("min_share", base::Between(0.0, 1.0));
  params.max_range = in.Get("max_range", base::Between(0.1, 100.0));
  params.period = in.Get("period", base::Between(0.0, 60.0));
  in.RejectUnknownKeys();
  return params;
}

HeatReading ReadHeat(const HeatPicture& heat, const RangePicture& seen,
                     const std::vector<std::string>& objects, const WarmParams& params) {
  const auto size = static_cast<std::size_t>(heat.width) * heat.height;
  HIRES_CHECK(heat.width == seen.width && heat.height == seen.height &&
                  heat.centikelvin.size() == size && seen.owner.size() == size,
              "the thermal picture and what is known to be in it differ in size");
  if (size == 0) return {};
  std::vector<Region> regions = RegionsOf(heat, params);
  const std::vector<Pixels> pixels = PixelsOf(seen, objects);
  const auto is_enough = [&](const Pixels& own) {
    return static_cast<int>(own.size()) >= params.min_pixels;
  };
  for (Region& one : regions) {
    for (std::size_t k = 0; k < objects.size(); ++k) {
      const auto common = static_cast<double>(Common(pixels[k], one.pixels).size());
      if (is_enough(pixels[k]) &&
          common >= params.min_share * static_cast<double>(pixels[k].size())) {
        one.region.objects.push_back(objects[k]);
      }
    }
  }
  HeatReading reading;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (is_enough(pixels[k])) {
      reading.objects.push_back(HeatOf(heat, objects[k], pixels[k], regions));
    }
  }
  for (Region& one : regions) reading.regions.push_back(std::move(one.region));
  return reading;
}

HeatReading ReadHeat(const HeatView& view, const std::shared_ptr<const Surroundings>& surroundings,
                     const std::vector<world::ObjectState>& known, const WarmParams& params) {
  std::vector<std::string> names;
  for (const world::ObjectState& object : known) {
    const bool is_carried = !object.attached_to.empty();
    if (!is_carried && IsInPicture(view.camera, object, params.max_range)) {
      names.push_back(object.name);
    }
  }
  if (names.empty()) return {};
  const LineOfSight sight(surroundings, known, view.robot_M);
  return ReadHeat(view.heat, sight.Look(view.camera, params.max_range), names, params);
}

std::map<std::string, double> SureDegrees(const HeatReading& reading) {
  std::map<std::string, double> degrees;
  for (const ObjectHeat& object : reading.objects) {
    if (!object.is_ambiguous()) degrees[object.name] = object.temperature - kZeroCelsius;
  }
  return degrees;
}

}  // namespace hires::perception
