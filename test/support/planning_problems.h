#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/rng.h"

/// Random planning problems of any size, as text in SHOP2's language. The vocabulary is that of
/// the problems that come with SHOP, so they fit those domains and the ones in
/// benchmark/planning/domains. The same size and seed give the same text.
namespace hires::test_support {

/// What a logistics problem holds. The defaults have the proportions of SHOP's problems: half as
/// many cities as parcels, two airplanes for five cities.
struct LogisticsSize {
  int num_parcels{30};
  int num_cities{15};      ///< each with one truck and one airport
  int places_per_city{3};  ///< the first one is the airport
  int num_airplanes{6};
};

inline LogisticsSize LogisticsOf(int num_parcels) {
  const int num_cities = std::max(2, num_parcels / 2);
  return {num_parcels, num_cities, 3, std::max(1, 2 * num_cities / 5)};
}

inline std::string PlaceName(int city, int place) {
  return "loc" + std::to_string(city + 1) + "-" + std::to_string(place + 1);
}

inline std::string LogisticsCity(int city, int num_places) {
  const std::string name = "city" + std::to_string(city + 1);
  const std::string number = std::to_string(city + 1);
  std::string text = "  (city " + name + ") (airport " + PlaceName(city, 0) + ")";
  text += " (truck truck" + number + "-1 " + name + ")";
  text += " (truck-at truck" + number + "-1 " + PlaceName(city, 0) + ")\n";
  for (int place = 0; place < num_places; ++place) {
    text += "  (location " + PlaceName(city, place) + ")";
    text += " (in-city " + PlaceName(city, place) + " " + name + ")\n";
  }
  return text;
}

/// Every parcel starts somewhere and shall be somewhere else.
/// @pre At least one of each, and two places in all.
inline std::string LogisticsProblem(const LogisticsSize& size, base::Rng rng) {
  const int num_places = size.num_cities * size.places_per_city;
  HIRES_CHECK(size.num_parcels >= 1 && size.num_airplanes >= 1 && num_places >= 2,
              "a logistics problem needs parcels, airplanes and places");
  const auto name_of = [&](int place) {
    return PlaceName(place / size.places_per_city, place % size.places_per_city);
  };
  std::string facts, tasks;
  for (int i = 1; i <= size.num_airplanes; ++i) {
    const std::string plane = "plane" + std::to_string(i);
    facts += "  (airplane " + plane + ") (airplane-at " + plane + " " +
             PlaceName(rng.Index(size.num_cities), 0) + ")\n";
  }
  for (int city = 0; city < size.num_cities; ++city) {
    facts += LogisticsCity(city, size.places_per_city);
  }
  for (int i = 1; i <= size.num_parcels; ++i) {
    const int start = rng.Index(num_places);
    const int goal = (start + 1 + rng.Index(num_places - 1)) % num_places;
    const std::string parcel = "package" + std::to_string(i);
    facts += "  (obj-at " + parcel + " " + name_of(start) + ")\n";
    tasks += "  (:task obj-at " + parcel + " " + name_of(goal) + ")\n";
  }
  return "(defproblem logistics-" + std::to_string(size.num_parcels) + " logistics (\n" + facts +
         ") (:unordered\n" + tasks + "))\n";
}

/// Blocks spread over towers: atoms on-table, on and clear. About sqrt(num_blocks) towers.
inline std::string RandomTowers(int num_blocks, base::Rng* rng) {
  std::vector<int> blocks(static_cast<std::size_t>(num_blocks));
  for (int i = 0; i < num_blocks; ++i) blocks[static_cast<std::size_t>(i)] = i + 1;
  for (int i = num_blocks - 1; i > 0; --i) {
    std::swap(blocks[static_cast<std::size_t>(i)],
              blocks[static_cast<std::size_t>(rng->Index(i + 1))]);
  }
  std::string text, below;
  for (const int number : blocks) {
    const std::string block = "b" + std::to_string(number);
    const bool begins = below.empty() || rng->Bernoulli(1.0 / std::sqrt(num_blocks));
    if (begins && !below.empty()) text += " (clear " + below + ")\n";
    text += begins ? "  (on-table " + block + ")" : " (on " + block + " " + below + ")";
    below = block;
  }
  return text + " (clear " + below + ")\n";
}

/// Towers that shall become other towers, every block's place given.
/// @pre num_blocks >= 1.
inline std::string BlocksProblem(int num_blocks, base::Rng rng) {
  HIRES_CHECK(num_blocks >= 1, "a blocks problem needs a block");
  std::string facts = "  (arm-empty)\n";
  for (int i = 1; i <= num_blocks; ++i) facts += "  (block b" + std::to_string(i) + ")\n";
  facts += RandomTowers(num_blocks, &rng);
  return "(defproblem blocks-" + std::to_string(num_blocks) + " blocks-normal (\n" + facts +
         ") ((achieve-goals (\n" + RandomTowers(num_blocks, &rng) + "))))\n";
}

}  // namespace hires::test_support
