#include "lab/src/recognition/recognition_boxes.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;
using perception::BoxSums;
using perception::ErrorQuantiles;
using perception::ThingVerdict;

struct BoxPart {
  const char* name;
  BoxSums boxes;
};

BoxSums SumsOfSeen(const std::vector<ThingVerdict>& things, double from, double to) {
  std::vector<ThingVerdict> part;
  std::copy_if(things.begin(), things.end(), std::back_inserter(part),
               [&](const ThingVerdict& thing) {
                 return thing.view.part.share >= from && thing.view.part.share < to;
               });
  return perception::SumsOf(part).boxes;
}

/// Unknown things by how much of them is seen, and kinds left out of the catalogue.
std::vector<BoxPart> BoxPartsOf(const RecognitionReport& report) {
  constexpr double kInView = 0.95, kAll = 2.0;  // share of what could be seen; more than any
  const std::vector<ThingVerdict>&unknown = report.score.things(), &left_out = report.left_out;
  return {{"unlike all models", SumsOfSeen(unknown, 0.0, kAll)},
          {"unlike all models, at most 5 % hidden", SumsOfSeen(unknown, kInView, kAll)},
          {"unlike all models, more than 5 % hidden", SumsOfSeen(unknown, 0.0, kInView)},
          {"kinds left out", SumsOfSeen(left_out, 0.0, kAll)},
          {"kinds left out, at most 5 % hidden", SumsOfSeen(left_out, kInView, kAll)},
          {"kinds left out, more than 5 % hidden", SumsOfSeen(left_out, 0.0, kInView)}};
}

}  // namespace

std::string MillimetresText(double median, double share_95) {
  return reports::NumberText(1e3 * median, 1) + " / " + reports::NumberText(1e3 * share_95, 1);
}

std::string BoxesText(const RecognitionReport& report) {
  std::vector<std::vector<std::string>> rows{{"boxes of what is called unknown: median / 95 % [mm]",
                                              "number", "middle", "longer side", "shorter side",
                                              "height"}};
  for (const auto& [name, boxes] : BoxPartsOf(report)) {
    rows.push_back({name, std::to_string(boxes.num_boxes)});
    for (const ErrorQuantiles& error : {boxes.middle, boxes.longer, boxes.shorter, boxes.height})
      rows.back().push_back(MillimetresText(error.median, error.share_95));
  }
  return reports::FormatTable(rows);
}

ordered_json BoxesToJson(const RecognitionReport& report) {
  const auto quantiles = [](const ErrorQuantiles& error) {
    return ordered_json{{"median", reports::NumberOrNull(error.median)},
                        {"error_95", reports::NumberOrNull(error.share_95)}};
  };
  ordered_json parts = ordered_json::array();
  for (const auto& [name, boxes] : BoxPartsOf(report)) {
    parts.push_back({{"part", name},
                     {"boxes", boxes.num_boxes},
                     {"middle", quantiles(boxes.middle)},
                     {"longer", quantiles(boxes.longer)},
                     {"shorter", quantiles(boxes.shorter)},
                     {"height", quantiles(boxes.height)}});
  }
  return parts;
}

}  // namespace hires::lab
